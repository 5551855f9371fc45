#!/bin/sh
# Runs the whole suite on the newer QGIS of another Debian, in a root folder of its own: nothing of this machine's
# system is changed. The first run takes some minutes and 4 GB, later ones only the tests.
#
#   SUITE=forky                  the Debian whose QGIS it is: forky has 3.44, trixie has 3.40
#   PLACE=/var/tmp/fleet-forky   where that root folder is kept; delete it to begin anew
#   ARGS='tests/plugin -k dock'  what else pytest is told, as in make test
#   MIRROR=http://...            where Debian's packages come from
set -eu
cd "$(dirname "$0")/.."

SUITE=${SUITE:-forky}
PLACE=${PLACE:-/var/tmp/fleet-$SUITE}
MIRROR=${MIRROR:-http://deb.debian.org/debian}
OURS=$PLACE/.fleet-newer # says that this program made the folder, and may empty it
TREE=$PLACE/srv/fleet/main
CERTIFICATES=/etc/ssl/certs/ca-certificates.crt
PACKAGES="qgis python3-qgis python3-venv xvfb make git ca-certificates postgresql mariadb-server python3-mysqldb nodejs npm"

say() { printf 'newer: %s\n' "$*"; }

stop() {
    printf 'newer: error: %s\n' "$1" >&2
    printf '       %s\n' "$2" >&2
    exit 1
}

inside() { chroot "$PLACE" /usr/bin/env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 "$@"; }

# quietly WHAT COMMAND...: runs it and shows its last lines when it fails
quietly() {
    what=$1
    shift
    "$@" >>"$PLACE.log" 2>&1 || {
        tail -n 15 "$PLACE.log" >&2
        stop "$what failed: see the lines above and $PLACE.log." "Mend that, then run it again: it goes on from there."
    }
}

check_machine() {
    [ "$(id -u)" -eq 0 ] || stop "this needs root, for chroot." "Run: sudo make test-newer"
    command -v debootstrap >/dev/null || stop "there is no debootstrap." "Run: apt-get install debootstrap"
    git rev-parse --git-dir >/dev/null || stop "git does not know $(pwd): see the line above." \
        "Run it in a clone; what is tested is what git lists there."
}

# One run at a time has the folder, and only a folder that was made for this.
claim_place() {
    case $PLACE in
    /?*) ;;
    *) stop "PLACE=$PLACE is no absolute path." "Give one, such as PLACE=/var/tmp/fleet-$SUITE" ;;
    esac
    if [ -e "$PLACE" ] && [ ! -e "$OURS" ] && [ -n "$(ls -A "$PLACE")" ]; then
        stop "$PLACE holds something that this program did not put there." "Give another PLACE, or empty that folder."
    fi
    mkdir -p "$(dirname "$PLACE")"
    exec 9>"$PLACE.lock"
    flock --nonblock 9 || stop "another run is at work in $PLACE." "Wait until it ends, or give another PLACE."
}

# The mounts and the processes in there belong to a namespace whose first process is the child. Whatever ends this
# program, SIGKILL included, ends the child too, and the kernel then takes away all that was in the namespace.
# The shell starts a child in the background deaf to Ctrl-C; the tests stop programs by that signal.
run_in_namespace() {
    trap 'stop "stopped by a signal; nothing of the run is left." "What was built stays in $PLACE."' HUP INT TERM
    setpriv --pdeathsig KILL unshare --mount --pid --fork --kill-child \
        env --default-signal=INT,QUIT FLEET_NEWER_INSIDE=1 "$0" &
    wait "$!"
}

build_root() {
    if [ ! -e "$PLACE/.base" ]; then
        say "building Debian $SUITE in $PLACE (log: $PLACE.log)"
        rm -rf --one-file-system "$PLACE" # what a run that was stopped left
        mkdir -p "$PLACE"
        touch "$OURS"
        : >"$PLACE.log"
        script=/usr/share/debootstrap/scripts/$SUITE
        [ -e "$script" ] || script=/usr/share/debootstrap/scripts/sid
        quietly debootstrap debootstrap --variant=minbase "$SUITE" "$PLACE" "$MIRROR" "$script"
        touch "$PLACE/.base"
    fi
    mount_all
    if [ "$(cat "$PLACE/.packages" 2>/dev/null)" != "$PACKAGES" ]; then
        say "installing QGIS and the database servers there (log: $PLACE.log)"
        install_packages
        printf '%s\n' "$PACKAGES" >"$PLACE/.packages"
    fi
    # Whatever this machine trusts to reach the package index is trusted there too.
    cp "$CERTIFICATES" "$PLACE$CERTIFICATES"
    cp -L /etc/resolv.conf "$PLACE/etc/resolv.conf"
}

mount_all() {
    mount --bind "$PLACE" "$PLACE" # programs that make namespaces want the root folder to be a mount
    mount -t proc proc "$PLACE/proc"
    mount --rbind /sys "$PLACE/sys" # a systemd that a test starts asks there for its control groups
    mount --rbind /dev "$PLACE/dev"
    mount -t tmpfs shm "$PLACE/dev/shm"
    if [ -d ../shared ]; then
        mkdir -p "$PLACE/srv/fleet/shared"
        mount --bind -o ro "$(cd ../shared && pwd -P)" "$PLACE/srv/fleet/shared"
    fi
}

install_packages() {
    printf '#!/bin/sh\nexit 101\n' >"$PLACE/usr/sbin/policy-rc.d" # no service starts in there
    chmod 755 "$PLACE/usr/sbin/policy-rc.d"
    quietly "dpkg" inside dpkg --configure -a # what a run that was stopped left half installed
    apt_install >>"$PLACE.log" 2>&1 || { # the package lists may be old
        quietly "apt-get update" inside apt-get update -q
        quietly "apt-get install" apt_install
    }
}

apt_install() {
    # shellcheck disable=SC2086 - one word for each package
    inside DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends $PACKAGES
}

# What git knows of this tree, changes that are not committed included; the environment in there stays.
copy_tree() {
    mkdir -p "$TREE"
    find "$TREE" -mindepth 1 -maxdepth 1 ! -name .venv -exec rm -rf --one-file-system {} +
    find "$PLACE/tmp" -xdev -mindepth 1 -delete # what the last run's tests left
    git ls-files --cached --others --exclude-standard -z |
        tar --null --files-from=- --ignore-failed-read --warning=no-failed-read --create --file=- |
        tar --extract --file=- --directory="$TREE"
}

say_versions() {
    inside /srv/fleet/main/.venv/bin/python -c '
import platform
from qgis.core import Qgis
from qgis.PyQt.QtCore import qVersion
print(f"newer: QGIS {Qgis.QGIS_VERSION}, Qt {qVersion()}, Python {platform.python_version()}")'
}

if [ -z "${FLEET_NEWER_INSIDE:-}" ]; then
    check_machine
    claim_place
    run_in_namespace
    exit
fi
build_root
copy_tree
inside PIP_CERT=$CERTIFICATES make -C /srv/fleet/main --no-print-directory setup
say_versions
inside make -C /srv/fleet/main --no-print-directory test "JOBS=${JOBS:-6}" "ARGS=${ARGS:-}"

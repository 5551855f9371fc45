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
PACKAGES="qgis python3-qgis python3-venv xvfb make git ca-certificates postgresql mariadb-server python3-mysqldb nodejs npm"

NAME=newer AGAIN="make test-newer"
. tools/debian_root.sh

check_machine() {
    check_programs
    git rev-parse --git-dir >/dev/null || stop "git does not know $(pwd): see the line above." \
        "Run it in a clone; what is tested is what git lists there."
}

# One run at a time has the folder, and only a folder that was made for this.
claim_place() {
    check_place
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
    build_base
    mount_all
    build_packages
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

#!/bin/sh
# Runs the whole suite on the newer QGIS of another Debian, in a root folder of its own: nothing of this machine's
# system is changed. The first run takes some minutes and 4 GB, later ones only the tests.
#
#   SUITE=forky                  the Debian whose QGIS it is
#   PLACE=/var/tmp/fleet-forky   where that root folder is kept; delete it to begin anew
#   ARGS='tests/plugin -k dock'  what else pytest is told, as in make test
set -eu
cd "$(dirname "$0")/.."

SUITE=${SUITE:-forky}
PLACE=${PLACE:-/var/tmp/fleet-$SUITE}
MIRROR=${MIRROR:-http://deb.debian.org/debian}
TREE=$PLACE/srv/fleet/main
PACKAGES="qgis python3-qgis python3-venv xvfb make git ca-certificates postgresql mariadb-server nodejs npm"

say() { printf 'newer: %s\n' "$*"; }

stop() {
    printf 'newer: error: %s\n' "$1" >&2
    printf '       %s\n' "$2" >&2
    exit 1
}

inside() { chroot "$PLACE" /usr/bin/env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 "$@"; }

quietly() {
    log=$1
    shift
    "$@" >"$log" 2>&1 || {
        tail -n 15 "$log" >&2
        stop "$1 failed: see the lines above and $log." "Mend that, then run it again."
    }
}

# The mounts belong to this process alone: they are gone when it ends, however it ends.
enter_namespace() {
    [ "$(id -u)" -eq 0 ] || stop "this needs root, for chroot." "Run: sudo make test-newer"
    command -v debootstrap >/dev/null || stop "there is no debootstrap." "Run: apt-get install debootstrap"
    exec unshare --mount --pid --fork --kill-child env FLEET_NEWER_INSIDE=1 "$0" "$@"
}

build_root() {
    [ -e "$PLACE/.base" ] || {
        say "building Debian $SUITE in $PLACE"
        script=/usr/share/debootstrap/scripts/$SUITE
        [ -e "$script" ] || script=/usr/share/debootstrap/scripts/sid
        quietly "$PLACE.log" debootstrap --variant=minbase "$SUITE" "$PLACE" "$MIRROR" "$script"
        touch "$PLACE/.base"
    }
    mount_all
    [ -e "$PLACE/.packages" ] || {
        say "installing QGIS and the database servers there"
        printf '#!/bin/sh\nexit 101\n' >"$PLACE/usr/sbin/policy-rc.d" # no service starts in there
        chmod 755 "$PLACE/usr/sbin/policy-rc.d"
        # shellcheck disable=SC2086
        quietly "$PLACE.log" inside DEBIAN_FRONTEND=noninteractive apt-get install -y -q \
            --no-install-recommends $PACKAGES
        touch "$PLACE/.packages"
    }
    # Whatever this machine trusts to reach the package index is trusted there too.
    cp /etc/ssl/certs/ca-certificates.crt "$PLACE/etc/ssl/certs/ca-certificates.crt"
    cp -L /etc/resolv.conf "$PLACE/etc/resolv.conf"
}

mount_all() {
    mount -t proc proc "$PLACE/proc"
    mount --rbind /dev "$PLACE/dev"
    mount -t tmpfs shm "$PLACE/dev/shm"
    if [ -d ../shared ]; then
        mkdir -p "$PLACE/srv/fleet/shared"
        mount --bind "$(cd ../shared && pwd -P)" "$PLACE/srv/fleet/shared"
    fi
}

# What git knows of this tree, changes that are not committed included; the environment in there stays.
copy_tree() {
    mkdir -p "$TREE"
    find "$TREE" -mindepth 1 -maxdepth 1 ! -name .venv -exec rm -rf {} +
    git ls-files --cached --others --exclude-standard -z |
        tar --null --files-from=- --ignore-failed-read --warning=no-failed-read --create --file=- |
        tar --extract --file=- --directory="$TREE"
}

[ -n "${FLEET_NEWER_INSIDE:-}" ] || enter_namespace "$@"
build_root
copy_tree
inside PIP_CERT=/etc/ssl/certs/ca-certificates.crt make -C /srv/fleet/main --no-print-directory setup
exec chroot "$PLACE" /usr/bin/env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 \
    make -C /srv/fleet/main --no-print-directory test "JOBS=${JOBS:-3}" "ARGS=${ARGS:-}"

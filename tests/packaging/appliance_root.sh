#!/bin/sh
# Builds, once, the Debian that the appliance's test installs into, and keeps it: what apt and pip would fetch there is
# there, so that the test needs no network.
#
#   PLACE=/var/tmp/fleet-appliance-bookworm   where it is kept; delete it to begin anew
#   ARCH=arm64      for other computers than this one; qemu-user-static runs their programs
#   ALSO=PACKAGES   more Debian packages; give a PLACE of its own with them
set -eu
cd "$(dirname "$0")/../.."

SUITE=${SUITE:-bookworm}
ARCH=${ARCH:-}
PLACE=${PLACE:-/var/tmp/fleet-appliance-$SUITE${ARCH:+-$ARCH}}
MIRROR=${MIRROR:-http://deb.debian.org/debian}
OURS=$PLACE/.fleet-appliance
PACKAGES="systemd systemd-sysv dbus iproute2 python3-venv ca-certificates nftables chrony avahi-daemon${ALSO:+ $ALSO}"
EXTRAS=postgresql,mariadb,speed

NAME=appliance_root AGAIN="this as root"
. tools/debian_root.sh

# The environment of the program with what it needs, but not the program, anew whenever the project needs other things.
# With it an installation takes two seconds of processor time, and twenty without.
build_environment() {
    [ "$(cat "$PLACE/.environment" 2>/dev/null)" != "$(needs)" ] || return 0
    say "installing the Python packages there (log: $PLACE.log)"
    rm -rf "$PLACE/opt/robot-bridge" "$PLACE/srv/sources"
    mkdir -p "$PLACE/srv/sources"
    cp -r pyproject.toml README.md LICENSE robot_bridge "$PLACE/srv/sources/"
    quietly "python3 -m venv" inside python3 -m venv /opt/robot-bridge
    pip="/opt/robot-bridge/bin/python -m pip --disable-pip-version-check"
    # shellcheck disable=SC2086 - its words
    quietly "pip install" inside PIP_CERT=$CERTIFICATES $pip install -q "/srv/sources[$EXTRAS]" 'setuptools>=77'
    # shellcheck disable=SC2086
    quietly "pip uninstall" inside $pip uninstall -q -y fleet-supervisor-robot-bridge
    rm -rf "$PLACE/srv/sources"
    printf '%s\n' "$(needs)" >"$PLACE/.environment"
}

needs() { sed -n '/^requires = /p; /^dependencies = /,/^]/p; /^postgresql\|^mariadb\|^speed/p' pyproject.toml; }

is_built() {
    [ "$(cat "$PLACE/.packages")" = "$PACKAGES" ] && [ "$(cat "$PLACE/.environment")" = "$(needs)" ]
} 2>/dev/null

if [ -z "${FLEET_ROOT_INSIDE:-}" ]; then
    check_programs
    check_place
    exec 9>"$PLACE.lock"
    is_built && exit
    flock 9 # who comes second finds it built; tests that use it hold it shared
    FLEET_ROOT_INSIDE=1 exec unshare --mount --pid --fork --kill-child "$0"
fi
build_base
mount -t proc proc "$PLACE/proc"
mount --rbind /dev "$PLACE/dev"
build_packages
build_environment

#!/bin/sh
# Builds, once, the Debian that the appliance's test installs into, and keeps it: what apt and pip would fetch there is
# there, so that the test needs no network.
#
#   PLACE=/var/tmp/fleet-appliance-bookworm   where it is kept; delete it to begin anew
set -eu
cd "$(dirname "$0")/../.."

SUITE=${SUITE:-bookworm}
PLACE=${PLACE:-/var/tmp/fleet-appliance-$SUITE}
MIRROR=${MIRROR:-http://deb.debian.org/debian}
OURS=$PLACE/.fleet-appliance
PACKAGES="systemd systemd-sysv dbus iproute2 python3-venv ca-certificates nftables chrony avahi-daemon"
EXTRAS=postgresql,mariadb,speed

NAME=appliance_root AGAIN="this as root"
. tools/debian_root.sh

# As `install.sh` finds them with --wheels; anew whenever the project needs others.
build_wheels() {
    needs=$(sha256sum pyproject.toml | cut -c1-64)
    [ "$(cat "$PLACE/.wheels" 2>/dev/null)" != "$needs" ] || return 0
    say "fetching the Python packages (log: $PLACE.log)"
    rm -rf "$PLACE/srv/wheels" "$PLACE/srv/sources"
    mkdir -p "$PLACE/srv/wheels" "$PLACE/srv/sources"
    cp -r pyproject.toml README.md LICENSE robot_bridge "$PLACE/srv/sources/"
    [ -e "$PLACE/srv/pip/bin/pip" ] || quietly "python3 -m venv" inside python3 -m venv /srv/pip
    quietly "pip download" inside PIP_CERT=$CERTIFICATES /srv/pip/bin/pip download -q --disable-pip-version-check \
        --dest /srv/wheels "/srv/sources[$EXTRAS]" 'setuptools>=77' wheel
    rm -rf "$PLACE"/srv/wheels/fleet_supervisor* "$PLACE"/srv/wheels/fleet-supervisor* "$PLACE/srv/sources"
    printf '%s\n' "$needs" >"$PLACE/.wheels"
}

if [ -z "${FLEET_ROOT_INSIDE:-}" ]; then
    check_programs
    check_place
    exec 9>"$PLACE.lock"
    flock 9 # who comes second finds it built
    FLEET_ROOT_INSIDE=1 exec unshare --mount --pid --fork --kill-child "$0"
fi
build_base
mount -t proc proc "$PLACE/proc"
mount --rbind /dev "$PLACE/dev"
build_packages
build_wheels

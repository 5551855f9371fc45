# A Debian in a root folder of its own, built once and kept; sourced by programs that set before
#
#   NAME      what their lines begin with
#   SUITE     the Debian, MIRROR where its packages come from, ARCH for which computers where not for this one
#   PLACE     the folder, PLACE.log beside it; PACKAGES what it has installed
#   OURS      a file in it that says that this program made the folder, and may empty it
#   AGAIN     the command to be run again, for advice
# shellcheck shell=sh
CERTIFICATES=/etc/ssl/certs/ca-certificates.crt

say() { printf '%s: %s\n' "$NAME" "$*"; }

stop() {
    printf '%s: error: %s\n' "$NAME" "$1" >&2
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

check_programs() {
    [ "$(id -u)" -eq 0 ] || stop "this needs root, for chroot." "Run: sudo $AGAIN"
    command -v debootstrap >/dev/null || stop "there is no debootstrap." "Run: apt-get install debootstrap"
}

check_place() {
    case $PLACE in
    /?*) ;;
    *) stop "PLACE=$PLACE is no absolute path." "Give one, such as PLACE=/var/tmp/fleet-$SUITE" ;;
    esac
    if [ -e "$PLACE" ] && [ ! -e "$OURS" ] && [ -n "$(ls -A "$PLACE")" ]; then
        stop "$PLACE holds something that this program did not put there." "Give another PLACE, or empty that folder."
    fi
    mkdir -p "$(dirname "$PLACE")"
}

build_base() {
    [ ! -e "$PLACE/.base" ] || return 0
    say "building Debian $SUITE in $PLACE (log: $PLACE.log)"
    rm -rf --one-file-system "$PLACE" # what a run that was stopped left
    mkdir -p "$PLACE"
    touch "$OURS"
    : >"$PLACE.log"
    script=/usr/share/debootstrap/scripts/$SUITE
    [ -e "$script" ] || script=/usr/share/debootstrap/scripts/sid
    quietly debootstrap debootstrap ${ARCH:+--arch="$ARCH"} --variant=minbase "$SUITE" "$PLACE" "$MIRROR" "$script"
    touch "$PLACE/.base"
}

# Brings PACKAGES there, once; /proc and /dev have to be there.
build_packages() {
    if [ "$(cat "$PLACE/.packages" 2>/dev/null)" != "$PACKAGES" ]; then
        say "installing packages there (log: $PLACE.log)"
        install_packages
        printf '%s\n' "$PACKAGES" >"$PLACE/.packages"
    fi
    # Whatever this machine trusts to reach the package index is trusted there too.
    cp "$CERTIFICATES" "$PLACE$CERTIFICATES"
    cp -L /etc/resolv.conf "$PLACE/etc/resolv.conf"
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

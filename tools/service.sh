#!/bin/sh
# Puts the gateway on this computer as the systemd service robot-bridge, or takes it away again.
#
#   tools/service.sh install | uninstall
#
#   DESTDIR=/path   goes before every path, for packaging; nothing is started or asked of systemd then
#   PREFIX=/path    where the program goes (default: /opt/robot-bridge)
#   PROGRAM=no      leaves the program out
set -eu
cd "$(dirname "$0")/.."

DESTDIR=${DESTDIR:-}
PREFIX=${PREFIX:-/opt/robot-bridge}
PROGRAM=${PROGRAM:-yes}
UNIT=$DESTDIR/etc/systemd/system/robot-bridge.service
LINK_UNIT=$DESTDIR/etc/systemd/system/robot-bridge-link@.service
USERS=$DESTDIR/usr/lib/sysusers.d/robot-bridge.conf
SETTINGS=$DESTDIR/etc/robot-bridge/robot-bridge.env

say() { printf 'service: %s\n' "$*"; }

stop() {
    printf 'service: error: %s\n' "$*" >&2
    exit 1
}

may_write() {
    [ -n "$DESTDIR" ] || [ "$(id -u)" -eq 0 ] || stop "this writes below /etc and $PREFIX: run it as root, or with sudo"
}

need_systemd() {
    [ -n "$DESTDIR" ] || command -v systemd-sysusers >/dev/null ||
        stop "systemd is not installed here: run the gateway by hand (docs/operation.md), or give DESTDIR="
}

# An image or a container is often set up where systemd is installed and does not run.
systemd_runs() { [ -z "$DESTDIR" ] && [ -d /run/systemd/system ]; }

install_program() {
    # Not the environment of this folder, which is for tests and may be anybody's.
    python3 -c 'import sys; sys.exit(sys.version_info < (3, 11))' || stop "python3 is older than 3.11"
    python3 -m venv "$DESTDIR$PREFIX" || stop "python3 cannot make an environment: install python3-venv"
    say "installing the program into $DESTDIR$PREFIX"
    "$DESTDIR$PREFIX/bin/python" -m pip install -q --disable-pip-version-check --upgrade \
        '.[postgresql,mariadb,speed]' || stop "pip could not install it: see the lines above"
}

install_service() {
    may_write
    need_systemd
    case $PREFIX in /*) ;; *) stop "PREFIX=$PREFIX is no absolute path" ;; esac
    [ "$PROGRAM" = no ] || install_program
    install -d "$(dirname "$UNIT")" "$(dirname "$USERS")"
    sed "s|@PREFIX@|$PREFIX|g" resources/service/robot-bridge.service > "$UNIT"
    sed "s|@PREFIX@|$PREFIX|g" resources/service/robot-bridge-link@.service > "$LINK_UNIT"
    install -m 644 resources/service/robot-bridge.sysusers "$USERS"
    [ -n "$DESTDIR" ] || systemd-sysusers "$USERS"
    install -d -m 750 "$(dirname "$SETTINGS")"
    [ -e "$SETTINGS" ] || install -m 640 resources/service/robot-bridge.env "$SETTINGS"
    if [ -z "$DESTDIR" ]; then
        chgrp -R robot-bridge "$(dirname "$SETTINGS")"
        install -d -m 750 -o robot-bridge -g robot-bridge /var/lib/robot-bridge
    fi
    say "installed $UNIT"
    say "publish a site into /var/lib/robot-bridge/site, or name its folder in $SETTINGS"
    if systemd_runs; then
        systemctl daemon-reload
        say "then start it, now and with the computer: systemctl enable --now robot-bridge"
    else
        say "then have it start with the computer: systemctl enable robot-bridge (systemd does not run here now)"
    fi
}

uninstall_service() {
    may_write
    if [ -z "$DESTDIR" ] && [ -e "$UNIT" ]; then
        systemctl disable --now robot-bridge || true
    fi
    rm -f "$UNIT" "$LINK_UNIT" "$USERS"
    if [ -e "$DESTDIR$PREFIX/pyvenv.cfg" ]; then
        rm -rf "$DESTDIR$PREFIX"
    fi
    if systemd_runs; then
        systemctl daemon-reload
    fi
    say "removed; settings ($(dirname "$SETTINGS")), data (/var/lib/robot-bridge) and the account robot-bridge stay"
}

case ${1:-} in
install) install_service ;;
uninstall) uninstall_service ;;
*) stop "say install or uninstall" ;;
esac

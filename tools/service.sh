#!/bin/sh
# Puts the gateway on this computer as the systemd service robot-bridge, and the map services as robot-bridge-maps, or
# takes both away again.
#
#   tools/service.sh install | install-maps | uninstall
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
ARCHIVE_UNIT=$DESTDIR/etc/systemd/system/robot-bridge-archive.service
ARCHIVE_TIMER=$DESTDIR/etc/systemd/system/robot-bridge-archive.timer
MAPS_UNIT=$DESTDIR/etc/systemd/system/robot-bridge-maps.service
USERS=$DESTDIR/usr/lib/sysusers.d/robot-bridge.conf
SETTINGS=$DESTDIR/etc/robot-bridge/robot-bridge.env
MAPS_SETTINGS=$DESTDIR/etc/robot-bridge/maps.env
GUARD=qgis_server_plugins/fleet_services

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
    # One that is there is used, unless it is of a Python that the system has no more.
    "$DESTDIR$PREFIX/bin/python" -c 'import pip' 2>/dev/null || python3 -m venv "$DESTDIR$PREFIX" || stop "python3 cannot make an environment: install python3-venv"
    say "installing the program into $DESTDIR$PREFIX"
    "$DESTDIR$PREFIX/bin/python" -m pip install -q --disable-pip-version-check --upgrade \
        '.[postgresql,mariadb,speed]' || stop "pip could not install it: see the lines above"
}

check_target() {
    may_write
    need_systemd
    case $PREFIX in /*) ;; *) stop "PREFIX=$PREFIX is no absolute path" ;; esac
}

# install_settings FILE TARGET: settings that nobody wrote yet, for the service's account to read
install_settings() {
    install -d -m 750 "$(dirname "$2")"
    [ -e "$2" ] || install -m 640 "$1" "$2"
    [ -n "$DESTDIR" ] || chgrp -R robot-bridge "$(dirname "$2")"
}

install_service() {
    check_target
    [ "$PROGRAM" = no ] || install_program
    install -d "$(dirname "$UNIT")" "$(dirname "$USERS")"
    sed "s|@PREFIX@|$PREFIX|g" resources/service/robot-bridge.service > "$UNIT"
    sed "s|@PREFIX@|$PREFIX|g" resources/service/robot-bridge-link@.service > "$LINK_UNIT"
    sed "s|@PREFIX@|$PREFIX|g" resources/service/robot-bridge-archive.service > "$ARCHIVE_UNIT"
    install -m 644 resources/service/robot-bridge-archive.timer "$ARCHIVE_TIMER"
    install -m 644 resources/service/robot-bridge.sysusers "$USERS"
    [ -n "$DESTDIR" ] || systemd-sysusers "$USERS"
    install_settings resources/service/robot-bridge.env "$SETTINGS"
    [ -n "$DESTDIR" ] || install -d -m 750 -o robot-bridge -g robot-bridge /var/lib/robot-bridge
    say "installed $UNIT"
    say "publish a site into /var/lib/robot-bridge/site, or name its folder in $SETTINGS"
    if systemd_runs; then
        systemctl daemon-reload
        say "then start it, now and with the computer: systemctl enable --now robot-bridge"
    else
        say "then have it start with the computer: systemctl enable robot-bridge (systemd does not run here now)"
    fi
}

install_maps() {
    check_target
    [ -n "$DESTDIR" ] || [ -e "$UNIT" ] || stop "the gateway's service is not here: make install-service first"
    [ -n "$DESTDIR" ] || { command -v qgis_mapserver >/dev/null && /usr/bin/python3 -c 'import qgis.core'; } ||
        stop "QGIS Server or PyQGIS of /usr/bin/python3 is missing: apt-get install qgis-server python3-qgis"
    packages=$(python3 -c 'import sys; print("lib/python{}.{}/site-packages".format(*sys.version_info))')
    install -D -m 644 tools/serve_maps.py "$DESTDIR$PREFIX/share/robot-bridge/serve_maps.py"
    for file in __init__.py metadata.txt; do
        install -D -m 644 "tools/$GUARD/$file" "$DESTDIR$PREFIX/share/robot-bridge/$GUARD/$file"
    done
    install -d "$(dirname "$MAPS_UNIT")"
    sed "s|@PREFIX@|$PREFIX|g; s|@PACKAGES@|$packages|g" resources/service/robot-bridge-maps.service > "$MAPS_UNIT"
    install_settings resources/service/maps.env "$MAPS_SETTINGS"
    say "installed $MAPS_UNIT"
    say "name your project in $MAPS_SETTINGS"
    ! systemd_runs || systemctl daemon-reload
    say "then start it, now and with the computer: systemctl enable --now robot-bridge-maps"
}

uninstall_service() {
    may_write
    for unit in "$MAPS_UNIT" "$ARCHIVE_TIMER" "$UNIT"; do
        if [ -z "$DESTDIR" ] && [ -e "$unit" ]; then
            systemctl disable --now "$(basename "$unit")" || true
        fi
    done
    rm -f "$UNIT" "$LINK_UNIT" "$ARCHIVE_UNIT" "$ARCHIVE_TIMER" "$MAPS_UNIT" "$USERS" "$DESTDIR$PREFIX/share/robot-bridge/serve_maps.py"
    rm -rf "$DESTDIR$PREFIX/share/robot-bridge/qgis_server_plugins"
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
install-maps) install_maps ;;
uninstall) uninstall_service ;;
*) stop "say install, install-maps or uninstall" ;;
esac

#!/bin/sh
# Makes this machine ready: QGIS with its Python bindings, Xvfb, the virtual environment .venv, and the database and MQTT
# servers that the tests start.
# Uses what is there; installs what is missing with apt; says what to do where there is no apt.
#
#   PYTHON=/path/to/python3   the Python that can import qgis.core (default: the first such one on PATH)
set -eu
cd "$(dirname "$0")/.."

VENV=.venv
STAMP=$VENV/.fleet-setup
OLDEST_QGIS=32200

say() { printf 'setup: %s\n' "$*"; }

stop() {
    printf 'setup: error: %s\n' "$1" >&2
    shift
    for line in "$@"; do printf '       %s\n' "$line" >&2; done
    exit 1
}

has() { command -v "$1" >/dev/null 2>&1; }

# The first Python that can import PyQGIS. The first python3 on PATH (pyenv, conda) often cannot while the
# system's, further back on PATH, can.
find_pyqgis() {
    printf '%s\n' "$PATH" | tr ':' '\n' | while read -r folder; do
        [ -x "$folder/python3" ] || continue
        if "$folder/python3" -c 'import qgis.core' >/dev/null 2>&1; then
            echo "$folder/python3"
            break
        fi
    done
}

missing_packages() {
    if [ -z "$python" ]; then
        echo python3-qgis
        echo python3-venv
    elif ! "$python" -c 'import ensurepip' >/dev/null 2>&1; then
        echo python3-venv
    fi
    has qgis.bin || has qgis || echo qgis
    has qgis_process.bin || has qgis_process || echo qgis
    has Xvfb || echo xvfb
}

# What the tests start servers of their own from, and the driver of robots on MariaDB in tests and benchmarks;
# nothing else needs them.
missing_servers() {
    has postgres || ls /usr/lib/postgresql/*/bin/postgres >/dev/null 2>&1 || echo postgresql
    has mariadbd || [ -x /usr/sbin/mariadbd ] || echo mariadb-server
    "$python" -c 'import MySQLdb' >/dev/null 2>&1 || echo python3-mysqldb
    ls /usr/share/postgresql/*/extension/postgis.control >/dev/null 2>&1 || echo postgresql-postgis
    has qgis_mapserver || echo qgis-server
    has nginx || [ -x /usr/sbin/nginx ] || echo nginx
    has chromium-headless-shell || has chromium || has google-chrome || browser
    has debootstrap || [ -x /usr/sbin/debootstrap ] || echo debootstrap
    has mosquitto || [ -x /usr/sbin/mosquitto ] || echo mosquitto
    ls /usr/lib/*/faketime/libfaketime.so.1 >/dev/null 2>&1 || echo libfaketime
}

# The Chromium without a desktop's windows, where the distribution has it: the tests' pages cost a third less.
browser() {
    if apt-cache show chromium-headless-shell >/dev/null 2>&1; then
        echo chromium-headless-shell
    else
        echo chromium
    fi
}

as_root() {
    if [ "$(id -u)" -eq 0 ]; then
        "$@"
    else
        sudo "$@"
    fi
}

may_become_root() {
    [ "$(id -u)" -eq 0 ] || { has sudo && { [ -t 0 ] || sudo -n true 2>/dev/null; }; }
}

apt_install() {
    as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends "$@"
}

install_packages() {
    if ! has apt-get; then
        stop "missing: $*. This machine has no apt, so nothing was installed." \
            "Install QGIS 3.22 or newer with its Python bindings, and Xvfb, for example:" \
            "  Fedora:  dnf install qgis python3-qgis xorg-x11-server-Xvfb" \
            "  Arch:    pacman -S qgis python-gdal xorg-server-xvfb" \
            "then run: make setup PYTHON=/path/to/the/python3/that/imports/qgis.core"
    fi
    if ! may_become_root; then
        stop "missing: $*. Installing needs root, and sudo is not usable here." \
            "Run as root: apt-get install --no-install-recommends $*" \
            "then again:  make setup"
    fi
    log=$(mktemp)
    say "installing $* (log: $log)"
    if ! apt_install "$@" >"$log" 2>&1; then
        say "the package lists are missing or old: apt-get update"
        as_root apt-get update -q >>"$log" 2>&1 || tail -n 5 "$log" >&2
        apt_install "$@" >>"$log" 2>&1 || {
            tail -n 15 "$log" >&2
            stop "apt-get could not install $*: see the lines above and $log." "Mend that, then run: make setup"
        }
    fi
    rm -f "$log"
}

# Installs those servers where that is possible; the services that come with them stay off.
install_servers() {
    if has apt-get && may_become_root; then
        say "installing $* for the tests"
        if apt_install "$@" >/dev/null 2>&1 ||
            { as_root apt-get update -q >/dev/null 2>&1; apt_install "$@" >/dev/null 2>&1; }; then
            for service in postgresql mariadb mosquitto; do
                case "$*" in *$service*) as_root systemctl disable --now $service >/dev/null 2>&1 || : ;; esac
            done
            return
        fi
    fi
    say "not installed: $*; the tests that need them will be skipped"
}

check_versions() {
    "$1" - "$OLDEST_QGIS" <<'PYTHON' || stop "$1 cannot be used: see the line above." \
        "Choose another one: make setup PYTHON=/path/to/python3"
import sys
from qgis.core import Qgis

if sys.version_info < (3, 11):
    sys.exit(f"the gateway needs Python 3.11 or newer, this one is {sys.version.split()[0]}")
if Qgis.QGIS_VERSION_INT < int(sys.argv[1]):
    sys.exit(f"QGIS 3.22 or newer is needed, this one is {Qgis.QGIS_VERSION}")
PYTHON
}

make_venv() {
    if [ -x $VENV/bin/python ] && ! $VENV/bin/python -c 'import qgis.core' >/dev/null 2>&1; then
        say "$VENV was made by a Python without PyQGIS (or by one that is gone): making it anew"
        rm -rf $VENV
    fi
    [ -x $VENV/bin/python ] || "$1" -m venv --system-site-packages $VENV
    # A distribution's pyproj looks for PROJ's data below the environment, and warns when it is not there.
    if [ -d /usr/share/proj ]; then
        mkdir -p $VENV/share
        ln -sfn /usr/share/proj $VENV/share/proj
    fi
    say "installing the Python packages of pyproject.toml into $VENV"
    $VENV/bin/python -m pip install -q --disable-pip-version-check -e '.[test,lint,docs]' || stop \
        "pip could not install the Python packages: see the lines above." \
        "Is the package index reachable from here? Then run: make setup"
}

if [ -n "${PYTHON:-}" ]; then
    "$PYTHON" -c 'import qgis.core' >/dev/null || stop "PYTHON=$PYTHON cannot import qgis.core: see the line above." \
        "Give the Python that QGIS uses, or leave PYTHON out to have it found or installed."
fi
python=${PYTHON:-$(find_pyqgis)}
packages=$(missing_packages | sort -u | tr '\n' ' ')
# shellcheck disable=SC2086 - one word for each package
[ -z "$packages" ] || install_packages $packages
python=${python:-$(find_pyqgis)}
[ -n "$python" ] || stop "QGIS is installed, but no python3 on PATH can import qgis.core." \
    "Tell which Python QGIS uses: make setup PYTHON=/path/to/python3"
servers=$(missing_servers | tr '\n' ' ')
# shellcheck disable=SC2086 - one word for each package
[ -z "$servers" ] || install_servers $servers
check_versions "$python"
make_venv "$python"
tools/asyncapi_parser.sh || say "without AsyncAPI's parser the test that asks it is skipped"
tools/nats_server.sh >/dev/null || say "without a NATS server the tests of gateways on it are skipped"
tools/vda5050_vehicles.sh >/dev/null || say "without virtual vehicles the tests that lead them are skipped"
touch $STAMP
say "ready: $($VENV/bin/python -c 'from qgis.core import Qgis; print("QGIS", Qgis.QGIS_VERSION)'), $VENV"

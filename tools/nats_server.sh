#!/bin/sh
# Puts a NATS server for the tests into .venv/nats; prints the path of its program.
# Uses the one on PATH where that is new enough; Debian 12's own is not, and Debian 13's package runs there.
# Status 3 when none can be had.
set -eu
cd "$(dirname "$0")/.."

FOLDER=.venv/nats
PROGRAM=$FOLDER/usr/sbin/nats-server
RELEASE=trixie

# Whether the version of a program, such as "nats-server: v2.10.27", is at least 2.10.26.
is_new() {
    [ -x "$1" ] || return 1
    version=$("$1" --version | sed 's/.*v//')
    [ "$(printf '2.10.26\n%s\n' "$version" | sort -V | head -n 1)" = 2.10.26 ]
}

found=$(command -v nats-server || :)
if [ -n "$found" ] && is_new "$found"; then
    echo "$found"
    exit
fi
if ! is_new $PROGRAM; then
    command -v apt-get >/dev/null && command -v dpkg-deb >/dev/null || exit 3
    apt=$(mktemp -d)
    trap 'rm -rf "$apt"' EXIT
    mkdir -p "$apt/lists/partial" "$apt/cache/archives/partial"
    keys=/usr/share/keyrings/debian-archive-keyring.gpg
    echo "deb [signed-by=$keys] http://deb.debian.org/debian $RELEASE main" >"$apt/sources.list"
    set -- -q -o Dir::Etc::sourcelist="$apt/sources.list" -o Dir::Etc::sourceparts=/dev/null \
        -o Dir::State::lists="$apt/lists" -o Dir::Cache="$apt/cache" -o APT::Sandbox::User= \
        -o Acquire::Languages=none
    apt-get "$@" update >&2 || exit 3
    (cd "$apt" && apt-get "$@" download nats-server) >&2 || exit 3
    mkdir -p $FOLDER
    dpkg-deb -x "$apt"/nats-server_*.deb $FOLDER
fi
is_new $PROGRAM || exit 3
echo $PROGRAM

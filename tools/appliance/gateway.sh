# The gateway: its database, program, site, certificate and first account. Sourced by install.sh.
# shellcheck shell=sh
BRIDGE=$PREFIX/bin/robot-bridge
STAMP=$PREFIX/.sources
PARTS=postgresql,mariadb,speed
ADMIN=$SETTINGS/admin.env

# --- The database: with SQLite there is nothing to set up, the gateway makes its file ---

set_up_database() {
    [ "$DATABASE" = postgresql ] || return 0
    need postgresql postgresql-client
    systemctl start postgresql || stop "PostgreSQL did not start" "See: journalctl -u 'postgresql*' -n 20"
    [ -e "$ADMIN" ] || make_server_administrator
}

as_server() { (cd / && setpriv --reuid=postgres --regid=postgres --init-groups "$@"); }

make_server_administrator() {
    password=$(od -An -N24 -tx1 /dev/urandom | tr -d ' \n')
    printf '%s\n' "$password" | write "$SETTINGS/admin.password" 600
    as_server psql --quiet --set ON_ERROR_STOP=1 <<SQL || stop "PostgreSQL made no account" "See the lines above."
select 'create role fleet_admin login superuser' where not exists (select from pg_roles where rolname = 'fleet_admin') \gexec
alter role fleet_admin password '$password';
select 'create database fleet owner fleet_admin' where not exists (select from pg_database where datname = 'fleet') \gexec
SQL
    # The last of it: where this file is, the others are.
    write "$ADMIN" 600 <<ENV
ROBOT_BRIDGE_DATABASE=postgresql://fleet_admin@127.0.0.1/fleet
ROBOT_BRIDGE_DATABASE_PASSWORD_FILE=$SETTINGS/admin.password
ENV
}

make_server_tables() {
    [ ! -e "$SETTINGS/database-password" ] || return 0
    administer database check >/dev/null 2>&1 || administer database create
    administer database account fleet_gateway >"$SETTINGS/.password" ||
        stop "PostgreSQL made no account for the gateway" "See the lines above; drop role fleet_gateway where it is there."
    chgrp robot-bridge "$SETTINGS/.password"
    chmod 640 "$SETTINGS/.password"
    set_option ROBOT_BRIDGE_DATABASE postgresql://fleet_gateway@127.0.0.1/fleet
    set_option ROBOT_BRIDGE_DATABASE_PASSWORD_FILE "$SETTINGS/database-password"
    mv "$SETTINGS/.password" "$SETTINGS/database-password"
}

# set_option NAME VALUE: in the service's settings, in the place of the example of it
set_option() { sed -i "s|^#\?$1=.*|$1=$2|" "$SETTINGS/robot-bridge.env"; }

# with_settings COMMAND...: with the gateway's own environment
with_settings() {
    as_bridge env "ROBOT_BRIDGE_SITE=$DATA/site" "ROBOT_BRIDGE_DATABASE=sqlite:///$DATA/fleet.db" \
        $(grep -h '^ROBOT_BRIDGE_\|^PGPASSFILE=' "$SETTINGS/robot-bridge.env") "$@"
}

# administer COMMAND...: robot-bridge by whoever may do everything in the database
administer() {
    if [ "$DATABASE" = postgresql ]; then
        env $(cat "$ADMIN") "$BRIDGE" "$@"
    else
        with_settings "$BRIDGE" "$@"
    fi
}

# --- The program ---

sources() { digest pyproject.toml robot_bridge; }

# by_pip COMMAND...: with pip told where packages come from, if it is no index
by_pip() {
    if [ -n "$WHEELS" ]; then
        env PIP_NO_INDEX=1 "PIP_FIND_LINKS=$WHEELS" "$@"
    else
        "$@"
    fi
}

set_up_gateway() {
    need python3 python3-venv
    if [ ! -e "$STAMP" ]; then
        [ "$(df -Pk /opt | awk 'NR == 2 { print $4 }')" -gt 700000 ] ||
            stop "less than 700 MB are free in /opt" "Free some, or take a larger card."
        install_program
    elif [ "$(cat "$STAMP")" != "$(sources)" ]; then
        stop "another version is installed" "Run: $HERE/install.sh --upgrade"
    else
        PREFIX=$PREFIX PROGRAM=no tools/service.sh install >/dev/null
    fi
    [ "$DATABASE" = sqlite ] || make_server_tables
}

install_program() {
    say "installing the program into $PREFIX; a small computer takes some minutes"
    by_pip env "PREFIX=$PREFIX" tools/service.sh install >/dev/null ||
        stop "the program could not be installed: see the lines above" \
            "Without a network give --wheels FOLDER (docs/appliance.md)."
    sources >"$STAMP"
}

# --- The site ---

set_up_site() {
    if [ -e "$DATA/site/site.toml" ]; then
        [ -z "$SITE" ] || say "$DATA/site is there and stays; publish into it, or remove it and give --site again"
        find_port
        return 0
    fi
    rm -rf "$DATA/.site"
    cp -r "${SITE:-resources/sample_site}" "$DATA/.site"
    chown -R robot-bridge: "$DATA/.site"
    mv "$DATA/.site" "$DATA/site"
    find_port
}

# --- What lets others in: a certificate, and an account ---

set_up_tls() {
    tls=$SETTINGS/tls
    if [ ! -e "$tls/server.pem" ]; then
        set -- --name "$HOST.local" --name "$HOST" --name localhost --ip 127.0.0.1
        for address in $(hostname -I 2>/dev/null); do
            case $address in fe80:*) ;; *) set -- "$@" --ip "$address" ;; esac
        done
        rm -rf "$tls.new"
        "$BRIDGE" tls create "$tls.new" "$@" >/dev/null || stop "no certificate was made" "See the lines above."
        mv "$tls.new" "$tls"
    fi
    chown root:robot-bridge "$tls" "$tls/server.pem" "$tls/ca.pem"
    chown robot-bridge: "$tls/server-key.pem"
    chmod 750 "$tls"
    [ -n "$(gateway_table)" ] || append_gateway_table
    make_first_account
}

gateway_table() { sed -n '/^\[gateway\]/,/^\[[^g]/p' "$DATA/site/site.toml"; }

# What site.toml says of the port goes before what was given: the gateway reads it there.
find_port() {
    port=$(gateway_table | sed -n 's/^port *= *\([0-9]*\).*/\1/p')
    [ "${port:-$PORT}" = "$PORT" ] || say "the port is $port, as $DATA/site/site.toml says under [gateway]"
    PORT=${port:-$PORT}
}

append_gateway_table() {
    cat >>"$DATA/site/site.toml" <<TOML

[gateway]
host = "0.0.0.0"
port = $PORT
certificate = "$SETTINGS/tls/server.pem"
key = "$SETTINGS/tls/server-key.pem"
TOML
}

# Without an account the gateway does not listen beyond this computer: docs/operation.md, TLS.
make_first_account() {
    [ ! -e "$SETTINGS/.account" ] || return 0
    if [ "$DATABASE" = sqlite ] && [ ! -e "$DATA/fleet.db" ]; then
        administer database create >/dev/null
    fi
    if [ -z "$(administer operators list)" ]; then
        make_account
    fi
    touch "$SETTINGS/.account"
}

make_account() {
    token=/root/robot-bridge-$OPERATOR.token
    (umask 077 && administer operators add "$OPERATOR" --role supervisor >"$token" 2>/dev/null) ||
        stop "the account of $OPERATOR could not be made" "Run: $(administration) operators add $OPERATOR --role supervisor"
}

# The words before a command that looks after accounts, for people who are root; a bare Debian has no sudo.
administration() {
    if [ "$DATABASE" = postgresql ]; then
        printf "env \$(cat %s) %s" "$ADMIN" "$BRIDGE"
    else
        printf 'runuser -u robot-bridge -- env ROBOT_BRIDGE_DATABASE=sqlite:///%s/fleet.db %s' "$DATA" "$BRIDGE"
    fi
}

# --- The service ---

gateway_facts() {
    gateway_table
    digest "$SETTINGS/robot-bridge.env" "$UNITS/robot-bridge.service" "$STAMP"
}

start_gateway() {
    running=$SETTINGS/.running # what it was started with
    if systemctl is-active -q robot-bridge && [ "$(cat $running 2>/dev/null)" != "$(gateway_facts)" ]; then
        systemctl restart robot-bridge || gateway_failed
    fi
    systemctl is-enabled -q robot-bridge || systemctl enable -q robot-bridge
    systemctl start robot-bridge || gateway_failed
    gateway_facts >$running
}

# The gateway's own last lines: -u would have systemd's about it among them, which can be more than it has itself.
show_gateway_log() { journalctl _SYSTEMD_UNIT=robot-bridge.service -n 5 -o cat --no-pager >&2 || true; }

gateway_failed() {
    show_gateway_log
    stop "the gateway does not start: see the lines above" "docs/operation.md says what to do about each of them."
}

run_doctor() {
    with_settings "$BRIDGE" doctor ||
        stop "doctor found a FAULT: see the lines above" "Each line says what to do."
}

say_what_next() {
    if ! wanted tls; then
        say "ready: http://127.0.0.1:$PORT/field, on this computer only"
        return 0
    fi
    say "ready: https://$HOST.local:$PORT/field, the field page"
    say "  phones and desks trust $SETTINGS/tls/ca.pem; take $SETTINGS/tls/ca-key.pem off this computer"
    [ ! -e "/root/robot-bridge-$OPERATOR.token" ] ||
        say "  $OPERATOR, a supervisor, signs in with /root/robot-bridge-$OPERATOR.token; delete it then"
    say "  another operator, as root: $(administration) operators add NAME --role operator"
}

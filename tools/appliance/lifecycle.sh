# To a newer version, back where that fails, and away. Sourced by install.sh.
# shellcheck shell=sh
BEFORE=$PREFIX.before

upgrade() {
    [ -e "$STAMP" ] || stop "no version is installed" "Run: $HERE/install.sh"
    if [ "$(cat "$STAMP")" = "$(sources)" ]; then
        say "this version is installed"
        rm -rf "$BEFORE"
        set_up
        check_and_tell
        return 0
    fi
    # The old one works on while the network is needed, and while it is copied.
    [ -n "$WHEELS" ] || step "fetch" fetch_packages
    if [ -e "$BEFORE" ]; then
        say "an upgrade was cut short: going on with it"
        systemctl stop robot-bridge
    else
        step "copy" copy_version
        step "backup" stop_and_back_up
    fi
    if bring_in_version; then
        rm -rf "$BEFORE"
        say "upgraded"
        STEP=
        set_up
        say_what_next
        return 0
    fi
    go_back
    STEP=
    stop "the new version did not come up, for the reason above; the old one runs on" \
        "Nothing is lost. Report it with the lines above and journalctl -u robot-bridge."
}

fetch_packages() {
    WHEELS=/var/cache/robot-bridge/wheels
    mkdir -p "$WHEELS"
    "$PREFIX/bin/python" -m pip download -q --disable-pip-version-check --dest "$WHEELS" ".[$PARTS]" 'setuptools>=77' ||
        stop "pip could not fetch the packages" "Is the network there? The old version works on. Or give --wheels FOLDER."
}

# What there is to go back to: the program and its units, and then the database as the old version leaves it.
copy_version() {
    rm -rf "$BEFORE.new"
    cp -a "$PREFIX" "$BEFORE.new" || stop "the old version could not be kept" "Free 500 MB in /opt."
    mkdir "$BEFORE.new/units"
    cp -a $UNITS/robot-bridge*.service "$BEFORE.new/units/"
}

stop_and_back_up() {
    systemctl stop robot-bridge
    back_up_all || {
        systemctl start robot-bridge
        stop "the database could not be backed up; the old version works on" "See the lines above."
    }
    mv "$BEFORE.new" "$BEFORE"
}

back_up_all() {
    if [ "$DATABASE" = postgresql ]; then
        # Whole, with its rights, as only the server's own program writes it.
        as_server pg_dump --create --clean --if-exists fleet >"$BEFORE.new/fleet.sql"
    else
        administer database backup --replace "$DATA/before-upgrade.backup" >/dev/null
    fi
}

# Its status says whether the new version works. Asked for that, the shell goes on behind what fails: each line returns.
bring_in_version() {
    STEP=version
    by_pip env "PREFIX=$PREFIX" tools/service.sh install >/dev/null || return 1
    [ ! -e $UNITS/robot-bridge-maps.service ] || PREFIX=$PREFIX tools/service.sh install-maps >/dev/null || return 1
    administer database upgrade || return 1
    systemctl daemon-reload
    systemctl start robot-bridge || { show_gateway_log; return 1; }
    with_settings "$BRIDGE" doctor || return 1
    sources >"$STAMP" && gateway_facts >$SETTINGS/.running
    ! systemctl is-active -q robot-bridge-maps || systemctl restart robot-bridge-maps
}

go_back() {
    say "going back to the old version"
    systemctl stop robot-bridge || true
    rm -rf "$PREFIX"
    mv "$BEFORE" "$PREFIX"
    cp -a "$PREFIX"/units/* $UNITS/
    systemctl daemon-reload
    if [ "$DATABASE" = postgresql ]; then
        as_server psql --quiet --set ON_ERROR_STOP=1 --dbname postgres <"$PREFIX/fleet.sql" >/dev/null ||
            stop "the database could not be put back" "Run as postgres: psql -d postgres -f $PREFIX/fleet.sql"
        rm "$PREFIX/fleet.sql"
    else
        administer database restore --replace "$DATA/before-upgrade.backup" >/dev/null ||
            stop "the database could not be put back" "Run: $(administration) database restore --replace $DATA/before-upgrade.backup"
    fi
    rm -rf "$PREFIX/units"
    systemctl start robot-bridge || stop "the old version does not start either" "See: journalctl -u robot-bridge -n 20"
}

# --- Away ---

take_away() {
    for unit in robot-bridge-backup.timer robot-bridge-maps.service; do
        systemctl disable -q --now $unit 2>/dev/null || true
    done
    rm -f $UNITS/robot-bridge-backup.service $UNITS/robot-bridge-backup.timer "$ANNOUNCED"
    PREFIX=$PREFIX tools/service.sh uninstall >/dev/null
    rm -rf "$BEFORE" "$BEFORE.new" /var/cache/robot-bridge
    if [ -e "$FIREWALL" ]; then
        rm -f "$FIREWALL"
        grep -vxF "$INCLUDE" /etc/nftables.conf | write /etc/nftables.conf 755
        nft delete table inet robot_bridge 2>/dev/null || true
    fi
    if [ "$TASK" = purge ]; then
        purge
    else
        say "removed; settings ($SETTINGS), data ($DATA) and backups ($BACKUPS) stay, and so do Debian's packages"
    fi
}

purge() {
    if [ "$DATABASE" = postgresql ] && [ -e "$ADMIN" ]; then
        as_server psql --quiet --command 'drop database if exists fleet with (force)' \
            --command 'drop role if exists fleet_admin, fleet_gateway, map_services' || true
    fi
    rm -rf "$SETTINGS" "$DATA" "$BACKUPS"
    rm -f /root/robot-bridge-*.token
    userdel robot-bridge 2>/dev/null || true
    say "removed with all data; Debian's packages stay"
}

# What stands around the gateway: clock, name, maps, backup, firewall. Sourced by install.sh.
# shellcheck shell=sh
FIREWALL=/etc/nftables.d/robot-bridge.nft
INCLUDE='include "/etc/nftables.d/*.nft"'
ANNOUNCED=/etc/avahi/services/robot-bridge.service

set_up_clock() {
    need chrony
    systemctl is-enabled -q chrony || systemctl enable -q chrony
    # In a container it has no clock of its own to set, and its unit says so.
    systemctl start chrony || stop "chrony did not start" "See: journalctl -u chrony -n 20"
}

set_up_mdns() {
    need avahi-daemon
    if [ "$(hostname)" != "$HOST" ]; then
        hostnamectl hostname "$HOST" || stop "the name $HOST could not be set" "See the lines above."
    fi
    fill avahi.service "$ANNOUNCED" 644 "s|@PORT@|$PORT|"
    start avahi-daemon
}

# --- Map services ---

set_up_maps() {
    project=${PROJECT:-$(find "$DATA/site" -maxdepth 1 -name '*.qg[sz]' | sort | head -n 1)}
    if [ -z "$project" ] && [ ! -e "$SETTINGS/maps.env" ]; then
        say "maps: no QGIS project is in $DATA/site, so none is served; give --project FILE for that"
        return 0
    fi
    need qgis-server python3-qgis
    PREFIX=$PREFIX tools/service.sh install-maps >/dev/null
    if [ -n "$PROJECT" ] || [ ! -e "$SETTINGS/.maps" ]; then
        make_views
        write_map_settings "$project" | write "$SETTINGS/maps.env" 640
        chgrp robot-bridge "$SETTINGS/maps.env"
        touch "$SETTINGS/.maps"
    fi
    start robot-bridge-maps
}

make_views() {
    install -d -m 750 -o robot-bridge -g robot-bridge "$DATA/maps"
    if [ "$DATABASE" = sqlite ]; then
        administer database views --site "$DATA/site" --vrt "$DATA/maps/fleet.vrt" >/dev/null
        return 0
    fi
    need postgresql-postgis
    as_server psql --quiet --dbname fleet --command 'create extension if not exists postgis'
    administer database views --site "$DATA/site" >/dev/null
    [ -e "$DATA/maps/.pgpass" ] || make_reader
}

make_reader() {
    password=$(administer database reader map_services) ||
        stop "PostgreSQL made no account for the maps" "See the lines above; drop role map_services where it is there."
    printf '127.0.0.1:5432:fleet:map_services:%s\n' "$password" | write "$DATA/maps/.pgpass" 600
    chown robot-bridge: "$DATA/maps/.pgpass"
}

write_map_settings() {
    fleet=$DATA/maps/fleet.vrt
    [ "$DATABASE" = sqlite ] || fleet=postgresql://map_services@127.0.0.1/fleet
    grep '^#' resources/service/maps.env
    echo "MAPS_OPTIONS=--project $1 --fleet $fleet --port 8790"
}

# --- Backup ---

set_up_backup() {
    account=robot-bridge
    [ "$DATABASE" = sqlite ] || account=root
    fill robot-bridge-backup.service "$UNITS/robot-bridge-backup.service" 644 "s|@PREFIX@|$PREFIX|g; s|@ACCOUNT@|$account|g"
    fill robot-bridge-backup.timer "$UNITS/robot-bridge-backup.timer" 644 ''
    systemctl daemon-reload
    start robot-bridge-backup.timer
    if [ -z "$(ls "$BACKUPS" 2>/dev/null)" ]; then
        systemctl start robot-bridge-backup ||
            stop "the first backup failed" "See: journalctl -u robot-bridge-backup -n 20"
    fi
}

# --- Firewall ---

# The ports of sshd, whatever they are: who works from afar is not to be locked out.
ssh_ports() { { sshd -T 2>/dev/null || echo "port 22"; } | awk '$1 == "port" { print $2 }' | sort -u; }

set_up_firewall() {
    need nftables
    # shellcheck disable=SC2046,SC2086 - one word for each port
    ports=$(printf '%s\n' $(ssh_ports) $PORT $OPEN | sort -nu | paste -sd, -)
    fill firewall.nft "$FIREWALL.new" 644 "s|@PORTS@|$ports|"
    nft --check --file "$FIREWALL.new" || stop "nft does not take the rules in $FIREWALL.new" "Is the kernel's nf_tables there?"
    mv "$FIREWALL.new" "$FIREWALL"
    grep -qxF "$INCLUDE" /etc/nftables.conf || printf '%s\n' "$INCLUDE" >>/etc/nftables.conf
    systemctl is-enabled -q nftables || systemctl enable -q nftables
    systemctl start nftables || stop "nftables did not start" "See: journalctl -u nftables -n 20; nft -c -f /etc/nftables.conf"
    nft --file "$FIREWALL"
}

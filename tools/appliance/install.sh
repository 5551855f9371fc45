#!/bin/sh
# Sets up a site on a bare small computer (Debian 12 or 13, amd64 or arm64), as root; docs/appliance.md.
# What is there already is left as it is, so it can be run again at any time.
set -eu
cd "$(dirname "$0")/../.."
HERE=tools/appliance
. $HERE/common.sh
. $HERE/gateway.sh
. $HERE/surroundings.sh
. $HERE/lifecycle.sh

usage() {
    cat <<'HELP'
tools/appliance/install.sh [OPTION ...]     set up, or complete what an earlier run began
tools/appliance/install.sh --upgrade        bring in the version of this folder; the old one goes on where that fails
tools/appliance/install.sh --remove         take all away but settings, data and backups
tools/appliance/install.sh --purge          take those away, too

  --database sqlite|postgresql   where rows are kept (sqlite; on a server robots may come over SQL)
  --site FOLDER      a published site to begin with (the sample site)
  --project FILE     QGIS project for the map services (the one in the site's folder)
  --name NAME        host name, reached as NAME.local (the name it has)
  --operator NAME    the first supervisor's account (admin)
  --port PORT        of the gateway (8765)
  --open PORT        one more TCP port that the firewall opens; may be repeated
  --wheels FOLDER    Python packages are taken from there, not fetched (pip download)
  --no-tls           the gateway listens on this computer only
  --no-firewall  --no-clock  --no-mdns  --no-maps  --no-backup     leave that part out, also in later runs
  --with PART        set up a part that an earlier run was told to leave out: tls, firewall, clock, mdns, maps, backup
HELP
}

# value OPTION VALUE COUNT: what stands behind an option
value() {
    [ "$3" -ge 2 ] || stop "$1 needs a value" "See: $HERE/install.sh --help"
    printf '%s' "$2"
}

read_options() {
    while [ $# -gt 0 ]; do
        case $1 in
        --database | --site | --project | --name | --operator | --port | --open | --wheels | --with)
            given=$(value "$1" "${2:-}" $#) || exit 1
            case $1 in
            --database) DATABASE=$given ;;
            --site) SITE=$given ;;
            --project) PROJECT=$given ;;
            --name) HOST=$given ;;
            --operator) OPERATOR=$given ;;
            --port) PORT=$given ;;
            --open) OPEN=$(with_word "$OPEN" "$given") ;;
            --wheels) WHEELS=$given ;;
            --with) WITHOUT=$(printf '%s\n' $WITHOUT | grep -vxF "$given" | paste -sd ' ' -) ;;
            esac
            shift
            ;;
        --no-tls | --no-firewall | --no-clock | --no-mdns | --no-maps | --no-backup)
            WITHOUT=$(with_word "$WITHOUT" "${1#--no-}")
            ;;
        --upgrade | --remove | --purge) TASK=${1#--} ;;
        --help | -h)
            usage
            exit
            ;;
        *) stop "there is no option $1" "See: $HERE/install.sh --help" ;;
        esac
        shift
    done
}

check_options() {
    case $DATABASE in
    sqlite | postgresql) ;;
    *) stop "--database $DATABASE is none that this sets up" "Give sqlite or postgresql." ;;
    esac
    for number in $PORT $OPEN; do
        case $number in
        *[!0-9]* | '') stop "$number is no port" "Give a number from 1 to 65535." ;;
        esac
        [ "$number" -ge 1 ] && [ "$number" -le 65535 ] || stop "$number is no port" "Give a number from 1 to 65535."
    done
    case $HOST in
    '' | *[!a-z0-9-]* | -*) stop "--name $HOST is no host name" "Give small letters, digits and hyphens." ;;
    esac
    [ -z "$SITE" ] || [ -f "$SITE/site.toml" ] ||
        stop "--site $SITE has no site.toml" "Give the folder of a published site (docs/site-preparation.md)."
    [ -z "$PROJECT" ] || [ -f "$PROJECT" ] || stop "--project $PROJECT is not there" "Give a QGIS project, .qgz or .qgs."
    [ -z "$WHEELS" ] || [ -d "$WHEELS" ] || stop "--wheels $WHEELS is no folder" "Make it with pip download."
}

check_machine() {
    [ "$(id -u)" -eq 0 ] || stop "this needs root" "Run: sudo $HERE/install.sh"
    system=$(. /etc/os-release && echo "${ID:-unknown} ${VERSION_ID:-unknown}")
    case $system in
    "debian 12" | "debian 13") ;;
    *) stop "this is $system" "It is for Debian 12 and 13; elsewhere: docs/operation.md" ;;
    esac
    case $(dpkg --print-architecture) in
    amd64 | arm64) ;;
    *) stop "this is $(dpkg --print-architecture)" "Install a Debian for amd64 or arm64 (64 bits)." ;;
    esac
    [ -d /run/systemd/system ] || stop "systemd does not run here" "Boot this computer with it; a chroot has none."
}

set_up() {
    step "choices" remember
    step "database" set_up_database
    step "gateway" set_up_gateway
    ! wanted clock || step "clock" set_up_clock
    step "site" set_up_site
    ! wanted mdns || step "name" set_up_mdns
    ! wanted tls || step "certificate" set_up_tls
    step "service" start_gateway
    ! wanted maps || step "maps" set_up_maps
    ! wanted backup || step "backup" set_up_backup
    # Last: whatever a step fails at, nobody is locked out by half an installation.
    ! wanted firewall || step "firewall" set_up_firewall
}

check_and_tell() {
    step "check" run_doctor
    say_what_next
}

recall
TASK=install SITE='' PROJECT='' WHEELS=''
read_options "$@"
check_machine
check_options
case $TASK in
install)
    set_up
    check_and_tell
    ;;
upgrade) upgrade ;;
remove | purge) take_away ;;
esac

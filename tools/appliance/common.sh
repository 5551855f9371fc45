# What the parts of the appliance share: words, files, packages, what was chosen. Sourced by install.sh.
# shellcheck shell=sh
PREFIX=/opt/robot-bridge
SETTINGS=/etc/robot-bridge
DATA=/var/lib/robot-bridge
BACKUPS=/var/lib/robot-bridge-backups
UNITS=/etc/systemd/system
CHOICES=$SETTINGS/appliance.conf

say() { printf 'appliance: %s\n' "$*"; }

# stop WHAT-WAS-WRONG WHAT-TO-DO
stop() {
    trap - EXIT
    printf 'appliance: error: %s%s\n' "${STEP:+$STEP: }" "$1" >&2
    printf '           %s\n' "$2" >&2
    [ -z "${STEP:-}" ] || printf '           Then run %s/install.sh again: it goes on from there.\n' "$HERE" >&2
    exit 1
}

# step NAME COMMAND: what fails in it is said under that name
step() {
    STEP=$1
    trap 'unforeseen $?' EXIT
    "$2"
    trap - EXIT
    STEP=
}

unforeseen() {
    [ "$1" -eq 0 ] || stop "it ended with status $1" "See the lines above, and mend what they name."
}

# with_word WORDS WORD: WORDS with WORD among them, once
with_word() {
    case " $1 " in
    *" $2 "*) printf '%s' "$1" ;;
    *) printf '%s' "${1:+$1 }$2" ;;
    esac
}

wanted() {
    case " $WITHOUT " in *" $1 "*) return 1 ;; esac
}

# --- What was chosen: a later run has it without being given it again ---

recall() {
    DATABASE=sqlite PORT=8765 OPEN='' OPERATOR=admin WITHOUT='' HOST=$(hostname)
    [ ! -r "$CHOICES" ] || . "$CHOICES"
    KEPT_DATABASE=
    [ ! -r "$CHOICES" ] || KEPT_DATABASE=$DATABASE
}

remember() {
    [ -z "$KEPT_DATABASE" ] || [ "$KEPT_DATABASE" = "$DATABASE" ] || stop "this site is kept in $KEPT_DATABASE" \
        "Leave out --database; another one begins anew: --purge first, and keep a backup (docs/appliance.md)."
    install -d -m 750 "$SETTINGS"
    {
        echo "# What tools/appliance/install.sh was given."
        for name in DATABASE PORT OPEN OPERATOR WITHOUT HOST; do
            eval "printf \"%s='%s'\\n\" $name \"\$$name\""
        done
    } | write "$CHOICES" 640
}

# --- Files and packages ---

# write FILE MODE: standard input, where FILE is not that already
write() {
    fresh=$(mktemp)
    cat >"$fresh"
    if ! cmp -s "$fresh" "$1"; then
        install -D -m "$2" "$fresh" "$1"
    fi
    rm -f "$fresh"
}

# fill TEMPLATE FILE MODE SED-EXPRESSION...: a file of resources/service with its places filled
fill() {
    template=resources/service/$1 file=$2 mode=$3
    shift 3
    sed "$@" "$template" | write "$file" "$mode"
}

# need PACKAGE...: installs with apt those that are missing
need() {
    missing=
    for package in "$@"; do
        [ "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null)" = installed ] || missing="$missing $package"
    done
    [ -n "$missing" ] || return 0
    say "installing$missing"
    # shellcheck disable=SC2086 - one word for each package
    apt_install $missing || { apt-get update -q && apt_install $missing; } ||
        stop "apt-get could not install$missing: see the lines above" "Is the network there, and room on the disk?"
}

apt_install() { DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends "$@" >/dev/null; }

# as_bridge COMMAND...: as the service's account
as_bridge() { setpriv --reuid=robot-bridge --regid=robot-bridge --init-groups "$@"; }

# start UNIT: enables it, and starts it where it does not run
start() {
    systemctl is-enabled -q "$1" || systemctl enable -q "$1"
    systemctl is-active -q "$1" || systemctl start "$1" || stop "$1 did not start" "See: journalctl -u $1 -n 20"
}

# digest PATH...: of what these files hold
digest() { find "$@" -type f ! -path '*/__pycache__/*' -print0 2>/dev/null | sort -z | xargs -0r sha256sum | sha256sum; }

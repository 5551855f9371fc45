#!/bin/sh
# Installs a package of npm, which the tests use as a peer, into .venv/FOLDER; prints where its modules are.
#
#   tools/npm_package.sh FOLDER PACKAGE VERSION   status 3 when it cannot be had: no Node 18, no npm, no package registry
set -eu
cd "$(dirname "$0")/.."

folder=$1 package=$2 version=$3
modules=$PWD/.venv/$folder/node_modules

cannot() {
    printf '%s: %s\n' "$folder" "$1" >&2
    exit 3
}

command -v node >/dev/null 2>&1 || cannot "there is no Node; install Node 18 or newer"
[ "$(node -p 'parseInt(process.versions.node)')" -ge 18 ] || cannot "Node $(node --version) is too old; 18 is needed"
if [ ! -d "$modules/$package" ]; then
    command -v npm >/dev/null 2>&1 || cannot "there is no npm to install $package with"
    npm install --silent --no-audit --no-fund --ignore-scripts --prefix ".venv/$folder" "$package@$version" >&2 ||
        cannot "npm could not install $package@$version: see the lines above"
fi
echo "$modules"

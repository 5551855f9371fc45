#!/bin/sh
# Installs vda-5050-lib, whose virtual vehicles the tests lead, into .venv/vda5050; prints where its modules are.
# Status 3 when it cannot be had: no Node 18, no npm, no package registry.
set -eu
cd "$(dirname "$0")/.."

exec tools/npm_package.sh vda5050 vda-5050-lib 1.4.0

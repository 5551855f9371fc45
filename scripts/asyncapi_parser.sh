#!/bin/sh
# Checks an AsyncAPI document with the specification's own parser, which is a Node program.
#
#   scripts/asyncapi_parser.sh FILE   what the parser has to say; status 1 when it does not accept the document,
#                                     3 when the parser cannot be had: no Node 18, no npm, no package registry
#   scripts/asyncapi_parser.sh        only installs the parser, into .venv/asyncapi
set -eu
cd "$(dirname "$0")/.."

HOME_OF_IT=.venv/asyncapi
PACKAGE=@asyncapi/parser@3.6.3

cannot() {
    printf 'asyncapi: %s\n' "$1" >&2
    exit 3
}

command -v node >/dev/null 2>&1 || cannot "there is no Node; install Node 18 or newer"
[ "$(node -p 'parseInt(process.versions.node)')" -ge 18 ] || cannot "Node $(node --version) is too old; 18 is needed"
if [ ! -d "$HOME_OF_IT/node_modules/@asyncapi/parser" ]; then
    command -v npm >/dev/null 2>&1 || cannot "there is no npm to install the parser with"
    npm install --silent --no-audit --no-fund --ignore-scripts --prefix "$HOME_OF_IT" "$PACKAGE" >&2 ||
        cannot "npm could not install $PACKAGE: see the lines above"
fi
[ $# -gt 0 ] || exit 0

file=$(realpath "$1")
cd "$HOME_OF_IT"
exec node --input-type=module - "$file" <<'JAVASCRIPT'
import { readFileSync } from "node:fs";
import { Parser } from "@asyncapi/parser";

const { document, diagnostics } = await new Parser().parse(readFileSync(process.argv[2], "utf8"));
for (const { severity, path, message } of diagnostics) {
    console.log(`${["error", "warning", "information", "hint"][severity]}: ${path.join("/")}: ${message}`);
}
process.exit(document === undefined ? 1 : 0);
JAVASCRIPT

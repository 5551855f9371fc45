#!/bin/sh
# Checks an AsyncAPI document with the specification's own parser, which is a Node program.
#
#   tools/asyncapi_parser.sh FILE   what the parser has to say; status 1 when it does not accept the document,
#                                     3 when the parser cannot be had: no Node 18, no npm, no package registry
#   tools/asyncapi_parser.sh        only installs the parser, into .venv/asyncapi
set -eu
cd "$(dirname "$0")/.."

modules=$(tools/npm_package.sh asyncapi @asyncapi/parser 3.6.3)
[ $# -gt 0 ] || exit 0

file=$(realpath "$1")
cd "$modules/.."
exec node --input-type=module - "$file" <<'JAVASCRIPT'
import { readFileSync } from "node:fs";
import { Parser } from "@asyncapi/parser";

const { document, diagnostics } = await new Parser().parse(readFileSync(process.argv[2], "utf8"));
for (const { severity, path, message } of diagnostics) {
    console.log(`${["error", "warning", "information", "hint"][severity]}: ${path.join("/")}: ${message}`);
}
process.exit(document === undefined ? 1 : 0);
JAVASCRIPT

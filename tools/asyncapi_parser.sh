#!/bin/sh
# Checks AsyncAPI documents with the specification's own parser, which is a Node program.
#
#   tools/asyncapi_parser.sh FILE ...   what the parser has to say of each; status 1 when it does not accept one,
#                                       3 when the parser cannot be had: no Node 18, no npm, no package registry
#   tools/asyncapi_parser.sh            only installs the parser, into .venv/asyncapi
set -eu
here=$PWD
cd "$(dirname "$0")/.."

modules=$(tools/npm_package.sh asyncapi @asyncapi/parser 3.6.3)
[ $# -gt 0 ] || exit 0

# It takes seconds to load, whatever it is to read then.
cd "$modules/.."
exec node --input-type=module - "$here" "$@" <<'JAVASCRIPT'
import { readFileSync } from "node:fs";
import { resolve } from "node:path";
import { Parser } from "@asyncapi/parser";

const [here, ...files] = process.argv.slice(2);
const parser = new Parser();
let refused = 0;
for (const file of files) {
    const { document, diagnostics } = await parser.parse(readFileSync(resolve(here, file), "utf8"));
    for (const { severity, path, message } of diagnostics) {
        const kind = ["error", "warning", "information", "hint"][severity];
        console.log(`${file}: ${kind}: ${path.join("/")}: ${message}`);
    }
    if (document === undefined) {
        console.log(`${file}: refused`);
        refused = 1;
    }
}
process.exit(refused);
JAVASCRIPT

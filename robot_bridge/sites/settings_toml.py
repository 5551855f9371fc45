"""The text of a ``site.toml``: written anew, or changed in place with every other line left as it was.

Python before 3.11, which some QGIS come with, reads no TOML: tables and keys are found by their shape.
"""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from typing import Any

_HEADER = re.compile(r"""^[ \t]*\[{1,2}[ \t]*(["'\w.\- \t]+?)[ \t]*\]{1,2}[ \t]*(?:#.*)?$""")
_KEY = re.compile(r"""^[ \t]*(["']?)([\w-]+)\1[ \t]*=[ \t]*(.*)$""")
# An unclosed text ends with its line: to look for its end from each of its quotes takes n² steps.
_QUOTED = re.compile(r'"(?:[^"\\]|\\.)*"?|\'[^\']*\'|#.*')
_LONGEST_HEADER = 200


def toml_value(value: Any) -> str:
    """Return a string, number, boolean or sequence as TOML."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, (tuple, list)):
        return f"[{', '.join(toml_value(item) for item in value)}]"
    return repr(value)


def changed_text(text: str, tables: Mapping[str, Mapping[str, Any]]) -> str:
    """Return ``text`` with the keys of ``tables`` set; comments, other keys and other tables stay."""
    lines = text.splitlines()
    for table, values in tables.items():
        lines = _with_table(lines, table, values)
    return "\n".join(lines) + "\n"


def value_text(text: str, table: str, key: str) -> str | None:
    """Return what stands behind ``key =`` in ``[table]``, without a comment; None where it does not stand."""
    lines = text.splitlines()
    start, end = _table(lines, table) or (0, 0)
    found = _keys(lines, start, end).get(key)
    if found is None:
        return None
    inner = "\n".join(lines[found[0] : found[1]]).partition("=")[2]
    return re.sub(_QUOTED, lambda m: "" if m[0].startswith("#") else m[0], inner).strip()


def _with_table(lines: list[str], table: str, values: Mapping[str, Any]) -> list[str]:
    place = _table(lines, table)
    if place is None:
        gap = [""] if lines and lines[-1].strip() else []
        return [*lines, *gap, f"[{table}]", *(f"{key} = {toml_value(v)}" for key, v in values.items())]
    start, end = place
    body, missing = lines[start:end], []
    for key, value in values.items():
        found = _keys(body, 0, len(body)).get(key)
        if found is None:
            missing.append(f"{key} = {toml_value(value)}")
        else:
            body[found[0] : found[1]] = [f"{key} = {toml_value(value)}"]
    while missing and body and not body[-1].strip():
        body.pop()
    tail = [""] if missing and end < len(lines) else []
    return [*lines[:start], *body, *missing, *tail, *lines[end:]]


def _table(lines: list[str], table: str) -> tuple[int, int] | None:
    """Return the lines [start, end) between the header of ``table`` and the next header."""
    headers = [
        (number, match[1].strip("\"'"))
        for number, line in enumerate(lines)
        if (match := _HEADER.match(line[:_LONGEST_HEADER]))
    ]
    for position, (number, name) in enumerate(headers):
        if name == table:
            end = headers[position + 1][0] if position + 1 < len(headers) else len(lines)
            return number + 1, end
    return None


def _keys(lines: list[str], start: int, end: int) -> dict[str, tuple[int, int]]:
    """Return the lines [first, last) of each key; an array may go over several."""
    found, number = {}, start
    while number < end:
        match = _KEY.match(lines[number])
        first, number = number, number + 1
        if match is None:
            continue
        open_brackets = _open_brackets(match[3])
        while open_brackets > 0 and number < end:
            open_brackets += _open_brackets(lines[number])
            number += 1
        found[match[2]] = (first, number)
    return found


def _open_brackets(text: str) -> int:
    bare = re.sub(_QUOTED, "", text)
    return bare.count("[") - bare.count("]")

"""Labels inside the text format: the characters that mean something there are written as ``\\HH``."""

from __future__ import annotations

import re

_RESERVED = re.compile(r"[;%#\\\x00-\x1f\x7f]")
_RESERVED_IN_EXT = re.compile(r"[;,=%#\\\x00-\x1f\x7f]")
_ESCAPED = re.compile(r"\\([0-9a-f]{2})")


def escape(text: str) -> str:
    """Return labels separated by commas as they are written."""
    return _RESERVED.sub(_code, text)


def escape_value(text: str) -> str:
    """Return a key or value of ``ext`` as it is written: commas and equal signs mean something there."""
    return _RESERVED_IN_EXT.sub(_code, text)


def unescape(text: str) -> str:
    """Return what a written label says."""
    return _ESCAPED.sub(lambda match: chr(int(match[1], 16)), text)


def _code(match: re.Match[str]) -> str:
    return f"\\{ord(match[0]):02x}"

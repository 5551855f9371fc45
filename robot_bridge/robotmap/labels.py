"""Labels inside the text format: characters that mean something there are written ``\\HH`` or ``\\uHHHH``."""

from __future__ import annotations

import re
from collections.abc import Mapping
from itertools import zip_longest

# The C1 controls and the line and paragraph separators end a line for some readers; lone surrogates are no
# UTF-8; blanks at either end are taken for indentation.
_ALWAYS = r"[\x00-\x1f\x7f-\x9f\u2028\u2029\ud800-\udfff\\;%#]|^ | $"
_RESERVED = re.compile(_ALWAYS)
_RESERVED_IN_KEY = re.compile(rf"{_ALWAYS}|[=,]")
_RESERVED_IN_VALUE = re.compile(rf"{_ALWAYS}|=")
_ESCAPED = re.compile(r"\\(?:([0-9a-f]{2})|u([0-9a-f]{4}))")


def escape(text: str) -> str:
    """Return labels separated by commas as they are written."""
    return _RESERVED.sub(_code, text)


def escape_key(text: str) -> str:
    """Return a key of ``ext`` as it is written: commas and equal signs mean something there."""
    return _RESERVED_IN_KEY.sub(_code, text)


def escape_value(text: str) -> str:
    """Return a value of ``ext`` as it is written: it may hold commas, as the normal ``n=0,0.08,1`` does."""
    return _RESERVED_IN_VALUE.sub(_code, text)


def unescape(text: str) -> str:
    """Return what a written label says."""
    return _ESCAPED.sub(lambda match: chr(int(match[1] or match[2], 16)), text)


def write_ext(ext: Mapping[str, str]) -> str:
    """Return extras as they are written after the semantics, ``key=value,...;``, or nothing."""
    if not ext:
        return ""
    return ",".join(f"{escape_key(key)}={escape_value(value)}" for key, value in ext.items()) + ";"


def read_ext(text: str) -> dict[str, str]:
    """Return the extras in ``text``, which is without its semicolon; raises ValueError if it has no key."""
    if not text:
        return {}
    pieces = text.split(",")
    # A value may hold commas, as the normal n=nx,ny,nz does: a piece without "=" belongs to the one before.
    begins = [place for place, piece in enumerate(pieces) if "=" in piece]
    if not begins or begins[0]:
        raise ValueError(text)
    pairs = (",".join(pieces[begin:end]).partition("=") for begin, end in zip_longest(begins, begins[1:]))
    return {unescape(key): unescape(value) for key, _, value in pairs}


def _code(match: re.Match[str]) -> str:
    code = ord(match[0])
    return f"\\{code:02x}" if code < 0x100 else f"\\u{code:04x}"

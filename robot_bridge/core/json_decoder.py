"""The only decoder of JSON from outside (tables, sockets, files), and of TOML from files.

The text may be malicious: length, depth, number of values and size of numbers are bounded before anything is
built, so that decoding takes time and memory in proportion to the text and never recurses deeper than
:attr:`JsonBounds.depth`. Every failure is a :class:`DecodingError`.
"""

from __future__ import annotations

import json
import re
from dataclasses import dataclass
from typing import Any

try:
    from msgspec import DecodeError
    from msgspec.json import decode as _quickly
except ModuleNotFoundError:  # in QGIS
    _quickly = None  # type: ignore[assignment]
    DecodeError = ValueError  # type: ignore[assignment, misc]

MOST_DIGITS = 40
"""Digits of an integer. No column holds as many; messages name the parameter that is too large."""
REPLACEMENT = "\N{REPLACEMENT CHARACTER}"


class DecodingError(ValueError):
    """A text that is not JSON, or is beyond the bounds; the message says which."""


@dataclass(frozen=True)
class JsonBounds:
    """Limits of a text: levels of nesting, characters, and number of values."""

    depth: int = 32
    length: int = 32 << 20
    values: int = 500_000


MESSAGE = JsonBounds()
"""A message or a row: an image as base64 is the longest, a path of many points has the most values."""
SHORT = JsonBounds(depth=8, length=16 << 10, values=1_000)
"""A row or a file that holds a few names and numbers."""
DOCUMENT = JsonBounds(length=256 << 20, values=10_000_000)
"""A file that a user chose to open."""

_BRACKETS = b"[]{}"
_OTHERS = bytes(set(range(256)) - set(_BRACKETS))
_NOT_STORED = re.compile("[\0\ud800-\udfff]")
# Input that the quick parser handles differently from what this module promises.
_NEEDS_CARE = re.compile(rf"\d{{{MOST_DIGITS + 1}}}")
_HALF_OF_A_PAIR = re.compile(r"\\u[dD][89a-fA-F]")


def decode_json(text: str | bytes, bounds: JsonBounds = MESSAGE) -> Any:
    """Return the value in ``text``; raises DecodingError and nothing else.

    NaN and infinite numbers are refused. NUL and unpaired surrogates, which no database stores, become
    U+FFFD, so that the rest of the text is not lost.
    """
    if isinstance(text, bytes):
        _check_length(len(text), bounds)
        try:
            text = text.decode("utf-8")
        except UnicodeDecodeError as error:
            raise DecodingError(f"it is not UTF-8: {error.reason} at byte {error.start}") from None
    check_bounds(text, bounds)
    has_escapes = "\\u" in text or not text.isascii()
    try:
        if _quickly is None or _NEEDS_CARE.search(text) or (has_escapes and _HALF_OF_A_PAIR.search(text)):
            value = _CAREFUL.decode(text)
        else:
            value = _quickly(text)
    except DecodingError:
        raise
    except (ValueError, DecodeError) as error:
        raise DecodingError(str(error)) from None
    return _stored(value) if has_escapes else value


def check_bounds(text: str, bounds: JsonBounds) -> None:
    """Raise DecodingError for a text that is too long or too deep, or holds too many values."""
    _check_length(len(text), bounds)
    _check_nesting(text, bounds)


def has_few_brackets(text: str | bytes, bounds: JsonBounds = MESSAGE) -> bool:
    """Return whether a text has so few opening brackets that no decoder can recurse too deeply.

    For messages that another decoder handles, as thousands of them arrive each second.
    """
    if isinstance(text, bytes):
        return text.count(b"[") + text.count(b"{") <= bounds.depth
    return text.count("[") + text.count("{") <= bounds.depth


def _check_length(length: int, bounds: JsonBounds) -> None:
    if length > bounds.length:
        raise DecodingError(f"it has {length} characters, and {bounds.length} are the most")


def _check_nesting(text: str, bounds: JsonBounds) -> None:
    """Refuse a text that is nested too deeply or holds too many values, without decoding it."""
    openings = text.count("[") + text.count("{")
    if openings <= bounds.depth and openings + text.count(",") < bounds.values:
        return
    # Two backslashes are one character, and so are a backslash and a quote: the quotes that are left begin
    # and end strings.
    bare = "".join(text.replace("\\\\", "").replace('\\"', "").split('"')[::2])
    if bare.count("[") + bare.count("{") + bare.count(",") >= bounds.values:
        raise DecodingError(f"it holds more than {bounds.values} values")
    nested = bare.encode("ascii", "ignore").translate(None, _OTHERS)
    for _level in range(bounds.depth):
        nested = nested.replace(b"[]", b"").replace(b"{}", b"")
    if nested:
        raise DecodingError(f"it is nested deeper than {bounds.depth} levels, or its brackets do not close")


def _finite(text: str) -> float:
    number = float(text)
    if number in (float("inf"), float("-inf")):
        raise DecodingError(f"the number {text[:MOST_DIGITS]} is too large")
    return number


def _whole(text: str) -> int:
    if len(text.lstrip("-")) > MOST_DIGITS:
        raise DecodingError(f"the number {text[:MOST_DIGITS]}... has more than {MOST_DIGITS} digits")
    return int(text)


def _no_number(text: str) -> Any:
    raise DecodingError(f"{text} is no number of JSON")


_CAREFUL = json.JSONDecoder(parse_float=_finite, parse_int=_whole, parse_constant=_no_number)


def _stored(value: Any) -> Any:
    """Return ``value`` with characters replaced that no database stores; recursion stays within the
    bounds."""
    if isinstance(value, str):
        return _NOT_STORED.sub(REPLACEMENT, value)
    if isinstance(value, list):
        return [_stored(one) for one in value]
    if isinstance(value, dict):
        return {_stored(name): _stored(one) for name, one in value.items()}
    return value


LARGEST_TOML = 256_000
"""characters; a site's settings and profiles of layers have a few thousand."""

_MOST_PARTS = 32
# tomllib walks all parts of a dotted key for each part: n² steps.
_LONG_KEY = re.compile(
    rf"""(?:(?<![\w-])(?:[\w-]+|"[^"\n]*"|'[^'\n]*')[ \t]*\.[ \t]*){{{_MOST_PARTS}}}""", re.ASCII
)


def toml_tables(text: str) -> dict[str, Any]:
    """Return the tables in TOML ``text``, in time proportional to its length.

    :raises ValueError: naming what is wrong: no TOML, too long, or nested too deeply.
    :raises ImportError: on Python before 3.11, which has no ``tomllib``.
    """
    import tomllib

    if len(text) > LARGEST_TOML:
        raise ValueError(f"it has {len(text)} characters, more than {LARGEST_TOML}")
    if (deep := _LONG_KEY.search(text)) is not None:
        line = text.count("\n", 0, deep.start()) + 1
        raise ValueError(f"a key has more than {_MOST_PARTS} parts (line {line})")
    try:
        return tomllib.loads(text)
    except RecursionError:
        raise ValueError("its arrays or tables are nested too deeply") from None

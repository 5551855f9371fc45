"""CBOR of one flat array, read without believing it: the little of RFC 8949 that a map needs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ..missing_packages import installation
from .errors import BinaryError, MissingCodecError

_UNSIGNED, _NEGATIVE, _BYTES, _TEXT, _ARRAY = 0, 1, 2, 3, 4
_LENGTH_BYTES = {24: 1, 25: 2, 26: 4, 27: 8}


def dumps(items: Sequence[int | str | bytes]) -> bytes:
    """Return ``items`` as a CBOR array; raises MissingCodecError without cbor2."""
    return bytes(_cbor2().dumps(list(items)))


def loads(content: bytes, count: int) -> list[int | str | bytes]:
    """Return the ``count`` items of the array in ``content``.

    Raises BinaryError for anything but whole numbers, texts and byte strings of stated length, before it is
    unpacked, and MissingCodecError without cbor2.
    """
    cbor2 = _cbor2()
    _check(content, count)
    try:
        items: list[int | str | bytes] = cbor2.loads(content)
    except (cbor2.CBORDecodeError, ValueError) as error:
        raise BinaryError(f"CBOR check: {error}; get the map once more") from None
    return items


def _check(content: bytes, count: int) -> None:
    """Go over the heads of the items, so that no length is believed that is not there."""
    kind, length, position = _head(content, 0)
    if kind != _ARRAY or length != count:
        raise BinaryError(f"CBOR check: an array of {count} items should be there; get the map once more")
    for item in range(count):
        kind, length, position = _head(content, position)
        if kind in (_BYTES, _TEXT):
            position += length
        elif kind not in (_UNSIGNED, _NEGATIVE):
            raise BinaryError(f"CBOR check: item {item} is of major type {kind}; get the map once more")
    if position != len(content):
        raise BinaryError(
            f"CBOR check: the items need {position} bytes and {len(content)} are there; get the map once more"
        )


def _head(content: bytes, position: int) -> tuple[int, int, int]:
    """Return major type, argument, and the position after them."""
    initial = content[position] if position < len(content) else 0xFF
    kind, argument = initial >> 5, initial & 0x1F
    if argument < 24:
        return kind, argument, position + 1
    size = _LENGTH_BYTES.get(argument, 0)
    end = position + 1 + size
    if not size or end > len(content):
        raise BinaryError(f"CBOR check: byte {position} begins no item; get the map once more")
    return kind, int.from_bytes(content[position + 1 : end], "big"), end


def _cbor2() -> Any:
    try:
        import cbor2
    except ImportError:
        raise MissingCodecError(
            "codec 2 of the binary format needs the Python package cbor2, which is not installed here; "
            f"install it {installation('cbor2')}, or use codec 1"
        ) from None
    return cbor2

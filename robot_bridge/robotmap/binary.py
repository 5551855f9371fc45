"""The binary format, which SetMap carries: an envelope that is checked before its content is believed.

offset  bytes  what
0       4      magic, ``RMAP``
4       1      version of the envelope, 1
5       1      codec of the body: 1 is the text in UTF-8 under zstd, 2 the map in columns of CBOR under LZMA
6       1      version of the codec: 0 for codec 1, 2 for codec 2
7       1      0, reserved
8       8      length of the text in bytes, little-endian
16      32     SHA-256 of the text
48             body
"""

from __future__ import annotations

import hashlib
import struct
from collections.abc import Callable, Iterable
from itertools import zip_longest
from typing import NamedTuple

from .columnar import pack_map, unpack_map
from .compression import by_lzma, by_zstd, by_zstd_in_pieces, check_zstd, from_lzma, from_zstd
from .errors import BinaryError, RobotMapError
from .model import RobotMap
from .reading_limits import LARGEST_TEXT, ReadingLimits
from .text import read_text, write_text

__all__ = [
    "CODEC_COLUMNS",
    "CODEC_TEXT",
    "LARGEST_TEXT",
    "MAGIC",
    "decode",
    "decode_text",
    "encode",
    "encode_pieces",
]

MAGIC = b"RMAP"
VERSION = 1
CODEC_TEXT, CODEC_COLUMNS = 1, 2
_ENVELOPE = struct.Struct("<4sBBBBQ32s")
_SPARE = 4096
"""bytes that the columns may have more than the text: an empty map is mostly their heads."""


class _Codec(NamedTuple):
    """The version of a body's layout, what compresses it, and what returns it up to a length."""

    version: int
    compress: Callable[[bytes], bytes]
    decompress: Callable[[bytes, int], bytes]


_CODECS = {CODEC_TEXT: _Codec(0, by_zstd, from_zstd), CODEC_COLUMNS: _Codec(2, by_lzma, from_lzma)}


def encode(content: RobotMap | str, codec: int = CODEC_TEXT) -> bytes:
    """Return a map, or a map's text, in the binary format.

    The default is codec 1: a robot reads it with zstd and what it has for text, and so does every robot made
    before codec 2. Codec 2 is about a third of that size and is for who asks for it.

    Raises BinaryError for a text that is too long, or that codec 2 cannot give back byte for byte: one with
    comments or with more than centimetres. Raises MissingCodecError without zstandard for codec 1, without
    cbor2 for codec 2; TextError where codec 2 is to carry a text that is no map.
    """
    if codec not in _CODECS:
        raise BinaryError(f"codec check: codec {codec!r} is not known, 1 and 2 are")
    text = content if isinstance(content, str) else write_text(content)
    raw = body = _utf_8(text)
    head = _envelope(codec, len(raw), hashlib.sha256(raw).digest())
    if codec == CODEC_COLUMNS:
        body = _columns(read_text(content) if isinstance(content, str) else content, text, len(raw))
    return head + _CODECS[codec].compress(body)


def encode_pieces(pieces: Callable[[], Iterable[str]]) -> bytes:
    """Return the map whose text is all of ``pieces`` in codec 1; they are asked for twice, and not kept.

    Raises BinaryError and MissingCodecError as :func:`encode`.
    """
    check_zstd()
    length, digest = 0, hashlib.sha256()
    for piece in pieces():
        raw = _utf_8(piece)
        length += len(raw)
        digest.update(raw)
    head = _envelope(CODEC_TEXT, length, digest.digest())
    return head + by_zstd_in_pieces(map(_utf_8, pieces()), length)


def decode(content: bytes, limit: int | None = None) -> RobotMap:
    """Return the map in ``content``.

    Without ``limit`` what it may unpack to goes by its own size, so that a stranger's file of 1 MB costs at
    most some 1 s and 200 MB. A ``limit`` in bytes of text is for maps of a gateway that is believed.

    Raises BinaryError naming the check that failed, MissingCodecError, or TextError for its text.
    """
    codec, length, digest, limits = _check_envelope(content, limit)
    if codec == CODEC_TEXT:
        return read_text(_text(content, length, digest, limits))
    return _unpacked(content, length, digest, limits)[0]


def decode_text(content: bytes, limit: int | None = None) -> str:
    """Return the text in ``content``; ``limit`` and errors as in :func:`decode`, but for TextError."""
    codec, length, digest, limits = _check_envelope(content, limit)
    if codec == CODEC_TEXT:
        return _text(content, length, digest, limits)
    return _unpacked(content, length, digest, limits)[1]


def _text(content: bytes, length: int, digest: bytes, limits: ReadingLimits) -> str:
    raw = from_zstd(content[_ENVELOPE.size :], length)
    _check_text(raw, length, digest)
    try:
        text = raw.decode()
    except UnicodeDecodeError as error:
        raise BinaryError(f"text check: the body is not UTF-8 ({error}); write the map anew") from None
    limits.check_text(text)
    return text


def _unpacked(content: bytes, length: int, digest: bytes, limits: ReadingLimits) -> tuple[RobotMap, str]:
    body = from_lzma(content[_ENVELOPE.size :], length + _SPARE)
    if len(body) > length + _SPARE:
        raise BinaryError(f"size check: the body unpacks to more than its text of {length} bytes")
    robot_map = unpack_map(body, limits._replace(text=length))
    try:
        text = write_text(robot_map)
    except RobotMapError as error:
        raise BinaryError(f"columns check: {error}; get the map once more") from None
    raw = _utf_8(text)
    _check_text(raw, length, digest)
    return robot_map, text


def _columns(robot_map: RobotMap, text: str, length: int) -> bytes:
    """Return the map in columns, having seen that its text comes back from them."""
    body = pack_map(robot_map)
    if len(body) > length + _SPARE:
        raise BinaryError("size check: the columns are larger than the text; use codec 1")
    back = write_text(unpack_map(body, ReadingLimits.of_text(length)))
    if back != text:
        pairs = enumerate(zip_longest(text.split("\n"), back.split("\n"), fillvalue="the end"), start=1)
        line, was, becomes = next((n, was, becomes) for n, (was, becomes) in pairs if was != becomes)
        raise BinaryError(
            f"codec check: codec 2 keeps whole centimetres and no comments, so line {line} "
            f"({was[:60]!r}) would come back as {becomes[:60]!r}; use codec 1"
        )
    return body


def _check_text(raw: bytes, length: int, digest: bytes) -> None:
    if len(raw) != length:
        found = "more" if len(raw) > length else str(len(raw))
        raise BinaryError(
            f"length check: the envelope says {length} bytes of text, the body holds {found}; "
            "the file is cut off or altered, get it once more"
        )
    if hashlib.sha256(raw).digest() != digest:
        raise BinaryError("SHA-256 check: the text is not the one that was written; get the map once more")


def _envelope(codec: int, length: int, digest: bytes) -> bytes:
    """Return what stands before the body of a text of ``length`` bytes, having seen that it may be read."""
    if length > LARGEST_TEXT:
        raise BinaryError(
            f"size check: the text has {length} bytes, a reader accepts {LARGEST_TEXT}; "
            "choose a smaller window"
        )
    return _ENVELOPE.pack(MAGIC, VERSION, codec, _CODECS[codec].version, 0, length, digest)


def _utf_8(text: str) -> bytes:
    try:
        return text.encode()
    except UnicodeEncodeError as error:
        raise BinaryError(f"text check: half a character cannot be written ({error}); correct it") from None


def _check_envelope(content: bytes, limit: int | None) -> tuple[int, int, bytes, ReadingLimits]:
    """Return codec, length and SHA-256 of the text, and what it may cost to read."""
    if not content.startswith(MAGIC):
        raise BinaryError(f"magic check: the bytes begin with {content[:4]!r}, a robot map with {MAGIC!r}")
    if len(content) < _ENVELOPE.size:
        raise BinaryError(
            f"envelope check: {len(content)} bytes are there, the envelope has {_ENVELOPE.size}; "
            "the file is cut off, get it once more"
        )
    _, version, codec, layout, reserved, length, digest = _ENVELOPE.unpack_from(content)
    if version != VERSION or reserved:
        raise BinaryError(f"version check: version {version}.{reserved} is not known, {VERSION}.0 is")
    if codec not in _CODECS:
        raise BinaryError(f"codec check: codec {codec} is not known, 1 and 2 are")
    if layout != _CODECS[codec].version:
        raise BinaryError(
            f"version check: version {layout} of codec {codec} is not known, {_CODECS[codec].version} is; "
            "export the map once more"
        )
    limits = ReadingLimits.of_file(len(content)) if limit is None else ReadingLimits.of_text(limit)
    if length > limits.text:
        raise BinaryError(
            f"size check: {length} bytes of text are declared, the limit for these {len(content)} bytes is "
            f"{limits.text}; export the map as text, or in tiles"
        )
    return codec, length, digest, limits

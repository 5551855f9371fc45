"""The binary format, which SetMap carries: an envelope that is checked before its content is believed.

    offset  bytes  what
    0       4      magic, ``RMAP``
    4       1      version of the envelope, 1
    5       1      codec of the body: 1 is the text in UTF-8 under zstd
    6       2      0, reserved
    8       8      length of the text in bytes, little-endian
    16      32     SHA-256 of the text
    48             body
"""

from __future__ import annotations

import hashlib
import struct
from typing import Any

from .errors import BinaryError, MissingCodecError
from .model import RobotMap
from .text import read_text, write_text

MAGIC = b"RMAP"
VERSION = 1
CODEC_ZSTD_TEXT = 1
LARGEST_TEXT = 256 << 20
"""bytes of text that a reader accepts unless told otherwise."""

_ENVELOPE = struct.Struct("<4sBBHQ32s")
_LEVEL = 12
_LARGEST_WINDOW = 1 << 27


def encode(content: RobotMap | str) -> bytes:
    """Return a map, or a map's text, in the binary format; raises MissingCodecError without zstandard."""
    raw = (content if isinstance(content, str) else write_text(content)).encode()
    if len(raw) > LARGEST_TEXT:
        raise BinaryError(
            f"size check: the text has {len(raw)} bytes, a reader accepts {LARGEST_TEXT}; "
            "choose a smaller window"
        )
    body = _zstandard().ZstdCompressor(level=_LEVEL).compress(raw)
    digest = hashlib.sha256(raw).digest()
    return _ENVELOPE.pack(MAGIC, VERSION, CODEC_ZSTD_TEXT, 0, len(raw), digest) + bytes(body)


def decode(content: bytes, limit: int = LARGEST_TEXT) -> RobotMap:
    """Return the map in ``content``; raises BinaryError, MissingCodecError, or TextError for its text."""
    return read_text(decode_text(content, limit))


def decode_text(content: bytes, limit: int = LARGEST_TEXT) -> str:
    """Return the text in ``content``, at most ``limit`` bytes of it; raises BinaryError naming the check."""
    length, digest = _check_envelope(content, limit)
    raw = _decompress(content[_ENVELOPE.size :], length)
    if len(raw) != length:
        found = "more" if len(raw) > length else str(len(raw))
        raise BinaryError(
            f"length check: the envelope says {length} bytes of text, the body holds {found}; "
            "the file is cut off or altered, get it once more"
        )
    if hashlib.sha256(raw).digest() != digest:
        raise BinaryError("SHA-256 check: the text is not the one that was written; get the map once more")
    try:
        return raw.decode()
    except UnicodeDecodeError as error:
        raise BinaryError(f"text check: the body is not UTF-8 ({error}); write the map anew") from None


def _check_envelope(content: bytes, limit: int) -> tuple[int, bytes]:
    if not content.startswith(MAGIC):
        raise BinaryError(f"magic check: the bytes begin with {content[:4]!r}, a robot map with {MAGIC!r}")
    if len(content) < _ENVELOPE.size:
        raise BinaryError(
            f"envelope check: {len(content)} bytes are there, the envelope has {_ENVELOPE.size}; "
            "the file is cut off, get it once more"
        )
    _, version, codec, reserved, length, digest = _ENVELOPE.unpack_from(content)
    if version != VERSION or reserved:
        raise BinaryError(f"version check: version {version}.{reserved} is not known, {VERSION}.0 is")
    if codec != CODEC_ZSTD_TEXT:
        raise BinaryError(f"codec check: codec {codec} is not known, {CODEC_ZSTD_TEXT} is")
    if length > limit:
        raise BinaryError(f"size check: {length} bytes of text are declared, the limit is {limit}")
    return length, digest


def _decompress(body: bytes, length: int) -> bytes:
    zstandard = _zstandard()
    decompressor = zstandard.ZstdDecompressor(max_window_size=_LARGEST_WINDOW)
    try:
        # One byte more than declared shows a body that holds too much, and no more than that is allocated.
        with decompressor.stream_reader(body) as reader:
            return bytes(reader.read(length + 1))
    except zstandard.ZstdError as error:
        raise BinaryError(
            f"body check: zstd cannot read it ({error}); the file is altered, get it once more"
        ) from None


def _zstandard() -> Any:
    try:
        import zstandard
    except ImportError:
        raise MissingCodecError(
            "the binary format needs the Python package zstandard, which is not installed here; "
            "install it (python3 -m pip install zstandard), or write the map as text"
        ) from None
    return zstandard

"""Binary format of robot maps, which SetMap carries: checked envelope and compression."""

from __future__ import annotations

import hashlib
import struct
from collections.abc import Callable, Iterable
from itertools import zip_longest
from typing import Any, NamedTuple

from ..errors import MapBinaryError, MissingCodecError, RobotMapError, installation
from .columnar import pack_map, unpack_map
from .columns import LARGEST_TEXT, ReadingLimits
from .model import RobotMap
from .text_format import read_text, write_text

# --- The two compressions of the binary format; unpacking is limited to a stated length ---

_LEVEL, _QUICK_LEVEL = 12, 6
_SMALL = 1 << 20
"""bytes of text of a window, for which a robot waits: smaller ones take a quarter of the time, for 8 % more
bytes at most."""
_LARGEST_WINDOW = 1 << 27
_DICTIONARY = 1 << 22
"""bytes of memory of an LZMA reader."""


def by_zstd(content: bytes) -> bytes:
    """Return ``content`` as a zstd frame; raises MissingCodecError without zstandard."""
    return bytes(_zstandard().ZstdCompressor(level=_level(len(content))).compress(content))


def by_zstd_in_pieces(pieces: Iterable[bytes], length: int) -> bytes:
    """Return ``pieces``, of ``length`` bytes together, as a zstd frame; raises MissingCodecError."""
    compressor = _zstandard().ZstdCompressor(level=_level(length)).compressobj(size=length)
    return b"".join([*map(compressor.compress, pieces), compressor.flush()])


def check_zstd() -> None:
    """Raise MissingCodecError without zstandard."""
    _zstandard()


def _level(length: int) -> int:
    return _LEVEL if length > _SMALL else _QUICK_LEVEL


def from_zstd(body: bytes, most: int) -> bytes:
    """Return the content of ``body``, or its first ``most`` + 1 bytes, which shows that it holds too much.

    Raises MapBinaryError for what is no zstd, and MissingCodecError without zstandard.
    """
    zstandard = _zstandard()
    decompressor = zstandard.ZstdDecompressor(max_window_size=_LARGEST_WINDOW)
    try:
        with decompressor.stream_reader(body) as reader:
            return bytes(reader.read(most + 1))
    except zstandard.ZstdError as error:
        raise MapBinaryError(
            f"body check: zstd cannot read it ({error}); the file is altered, get it once more"
        ) from None


def by_lzma(content: bytes) -> bytes:
    """Return ``content`` as raw LZMA with its end mark; raises MissingCodecError without Python's lzma.

    It adapts with each byte and stores no tables: on a window's two kilobytes it is 6 % smaller than zstd at
    its best.
    """
    lzma = _lzma()
    # A larger dictionary would only cost the encoder time to clear.
    dictionary = min(_DICTIONARY, max(4096, 1 << (len(content) - 1).bit_length()))
    filters = [{**_filter(lzma), "preset": 9 | lzma.PRESET_EXTREME, "dict_size": dictionary}]
    return bytes(lzma.compress(content, format=lzma.FORMAT_RAW, filters=filters))


def from_lzma(body: bytes, most: int) -> bytes:
    """Return the content of ``body``, or its first ``most`` + 1 bytes, which shows that it holds too much.

    Raises MapBinaryError for what is no LZMA, ends too early or goes on after its end mark, and
    MissingCodecError without Python's lzma.
    """
    lzma = _lzma()
    decompressor = lzma.LZMADecompressor(
        lzma.FORMAT_RAW, filters=[{**_filter(lzma), "dict_size": _DICTIONARY}]
    )
    try:
        content = bytes(decompressor.decompress(body, max_length=most + 1))
    except lzma.LZMAError as error:
        raise MapBinaryError(
            f"body check: LZMA cannot read it ({error}); the file is altered, get it once more"
        ) from None
    if len(content) <= most and (not decompressor.eof or decompressor.unused_data):
        found = "goes on after its end" if decompressor.eof else "has no end"
        raise MapBinaryError(f"body check: the LZMA {found}; the file is altered, get it once more")
    return content


def _filter(lzma: Any) -> dict[str, int]:
    # Numbers of all columns have similar bytes, independent of their position.
    return {"id": lzma.FILTER_LZMA1, "lc": 0, "lp": 0, "pb": 0}


def _zstandard() -> Any:
    try:
        import zstandard
    except ImportError:
        raise MissingCodecError(
            "codec 1 of the binary format needs the Python package zstandard, which is not installed here; "
            f"install it {installation('zstandard')}, or write the map as text"
        ) from None
    return zstandard


def _lzma() -> Any:
    try:
        import lzma
    except ImportError:
        raise MissingCodecError(
            "codec 2 of the binary format needs the module lzma, without which this Python was built; "
            "use codec 1, or a Python that has it"
        ) from None
    return lzma


# --- The binary format, which SetMap carries: an envelope that is checked before its content is trusted
# offset  bytes  what
# 0       4      magic, ``RMAP``
# 4       1      version of the envelope, 1
# 5       1      codec of the body: 1 is the text in UTF-8 under zstd, 2 the map in columns of CBOR under
# LZMA
# 6       1      version of the codec: 0 for codec 1, 2 for codec 2
# 7       1      0, reserved
# 8       8      length of the text in bytes, little-endian
# 16      32     SHA-256 of the text
# 48             body

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
"""bytes that columns may exceed the text by: an empty map consists mostly of their heads."""


class _Codec(NamedTuple):
    """The version of a body's layout, its compressor, and its decompressor with a length limit."""

    version: int
    compress: Callable[[bytes], bytes]
    decompress: Callable[[bytes, int], bytes]


_CODECS = {CODEC_TEXT: _Codec(0, by_zstd, from_zstd), CODEC_COLUMNS: _Codec(2, by_lzma, from_lzma)}


def encode(content: RobotMap | str, codec: int = CODEC_TEXT) -> bytes:
    """Return a map, or a map's text, in the binary format.

    The default is codec 1: a robot reads it with zstd and its text reader, as does every robot made before
    codec 2. Codec 2 is about a third of that size and is sent on request.

    Raises MapBinaryError for a text that is too long, or that codec 2 cannot give back byte for byte: one
    with comments or with more than centimetres. Raises MissingCodecError without zstandard for codec 1,
    without cbor2 for codec 2; MapTextError where codec 2 is to carry a text that is no map.
    """
    if codec not in _CODECS:
        raise MapBinaryError(f"codec check: codec {codec!r} is not known, 1 and 2 are")
    text = content if isinstance(content, str) else write_text(content)
    raw = body = _utf_8(text)
    head = _envelope(codec, len(raw), hashlib.sha256(raw).digest())
    if codec == CODEC_COLUMNS:
        body = _columns(read_text(content) if isinstance(content, str) else content, text, len(raw))
    return head + _CODECS[codec].compress(body)


def encode_pieces(pieces: Callable[[], Iterable[str]]) -> bytes:
    """Return the map with the text ``pieces()`` in codec 1; it is called twice, and nothing is kept.

    Raises MapBinaryError and MissingCodecError as :func:`encode`.
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

    Without ``limit`` the allowed unpacked size depends on its own size, so that an untrusted file of 1 MB
    costs at most about 1 s and 200 MB. A ``limit`` in bytes of text is for maps of a trusted gateway.

    Raises MapBinaryError naming the check that failed, MissingCodecError, or MapTextError for its text.
    """
    codec, length, digest, limits = _check_envelope(content, limit)
    if codec == CODEC_TEXT:
        return read_text(_text(content, length, digest, limits))
    return _unpacked(content, length, digest, limits)[0]


def decode_text(content: bytes, limit: int | None = None) -> str:
    """Return the text in ``content``; ``limit`` and errors as in :func:`decode`, except MapTextError."""
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
        raise MapBinaryError(f"text check: the body is not UTF-8 ({error}); write the map anew") from None
    limits.check_text(text)
    return text


def _unpacked(content: bytes, length: int, digest: bytes, limits: ReadingLimits) -> tuple[RobotMap, str]:
    body = from_lzma(content[_ENVELOPE.size :], length + _SPARE)
    if len(body) > length + _SPARE:
        raise MapBinaryError(f"size check: the body unpacks to more than its text of {length} bytes")
    robot_map = unpack_map(body, limits._replace(text=length))
    try:
        text = write_text(robot_map)
    except RobotMapError as error:
        raise MapBinaryError(f"columns check: {error}; get the map once more") from None
    raw = _utf_8(text)
    _check_text(raw, length, digest)
    return robot_map, text


def _columns(robot_map: RobotMap, text: str, length: int) -> bytes:
    """Return the map in columns, after checking that its text can be restored from them."""
    body = pack_map(robot_map)
    if len(body) > length + _SPARE:
        raise MapBinaryError("size check: the columns are larger than the text; use codec 1")
    back = write_text(unpack_map(body, ReadingLimits.of_text(length)))
    if back != text:
        pairs = enumerate(zip_longest(text.split("\n"), back.split("\n"), fillvalue="the end"), start=1)
        line, was, becomes = next((n, was, becomes) for n, (was, becomes) in pairs if was != becomes)
        raise MapBinaryError(
            f"codec check: codec 2 keeps whole centimetres and no comments, so line {line} "
            f"({was[:60]!r}) would come back as {becomes[:60]!r}; use codec 1"
        )
    return body


def _check_text(raw: bytes, length: int, digest: bytes) -> None:
    if len(raw) != length:
        found = "more" if len(raw) > length else str(len(raw))
        raise MapBinaryError(
            f"length check: the envelope says {length} bytes of text, the body holds {found}; "
            "the file is cut off or altered, get it once more"
        )
    if hashlib.sha256(raw).digest() != digest:
        raise MapBinaryError("SHA-256 check: the text is not the one that was written; get the map once more")


def _envelope(codec: int, length: int, digest: bytes) -> bytes:
    """Return the envelope for the body of a text of ``length`` bytes, after checking that readers accept
    it."""
    if length > LARGEST_TEXT:
        raise MapBinaryError(
            f"size check: the text has {length} bytes, a reader accepts {LARGEST_TEXT}; "
            "choose a smaller window"
        )
    return _ENVELOPE.pack(MAGIC, VERSION, codec, _CODECS[codec].version, 0, length, digest)


def _utf_8(text: str) -> bytes:
    try:
        return text.encode()
    except UnicodeEncodeError as error:
        raise MapBinaryError(
            f"text check: half a character cannot be written ({error}); correct it"
        ) from None


def _check_envelope(content: bytes, limit: int | None) -> tuple[int, int, bytes, ReadingLimits]:
    """Return codec, length and SHA-256 of the text, and the limits for reading it."""
    if not content.startswith(MAGIC):
        raise MapBinaryError(f"magic check: the bytes begin with {content[:4]!r}, a robot map with {MAGIC!r}")
    if len(content) < _ENVELOPE.size:
        raise MapBinaryError(
            f"envelope check: {len(content)} bytes are there, the envelope has {_ENVELOPE.size}; "
            "the file is cut off, get it once more"
        )
    _, version, codec, layout, reserved, length, digest = _ENVELOPE.unpack_from(content)
    if version != VERSION or reserved:
        raise MapBinaryError(f"version check: version {version}.{reserved} is not known, {VERSION}.0 is")
    if codec not in _CODECS:
        raise MapBinaryError(f"codec check: codec {codec} is not known, 1 and 2 are")
    if layout != _CODECS[codec].version:
        raise MapBinaryError(
            f"version check: version {layout} of codec {codec} is not known, {_CODECS[codec].version} is; "
            "export the map once more"
        )
    limits = ReadingLimits.of_file(len(content)) if limit is None else ReadingLimits.of_text(limit)
    if length > limits.text:
        raise MapBinaryError(
            f"size check: {length} bytes of text are declared, the limit for these {len(content)} bytes is "
            f"{limits.text}; export the map as text, or in tiles"
        )
    return codec, length, digest, limits

"""The two compressions of the binary format; nothing is unpacked beyond a stated length."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from ..missing_packages import installation
from .errors import BinaryError, MissingCodecError

_LEVEL, _QUICK_LEVEL = 12, 6
_SMALL = 1 << 20
"""bytes of a window's text, which a robot waits for: a quarter of the time, for 8 % more bytes at most."""
_LARGEST_WINDOW = 1 << 27
_DICTIONARY = 1 << 22
"""bytes that a reader of LZMA keeps in mind."""


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
    """Return what is in ``body``, or the first ``most`` + 1 bytes of it, which shows that it holds too much.

    Raises BinaryError for what is no zstd, and MissingCodecError without zstandard.
    """
    zstandard = _zstandard()
    decompressor = zstandard.ZstdDecompressor(max_window_size=_LARGEST_WINDOW)
    try:
        with decompressor.stream_reader(body) as reader:
            return bytes(reader.read(most + 1))
    except zstandard.ZstdError as error:
        raise BinaryError(
            f"body check: zstd cannot read it ({error}); the file is altered, get it once more"
        ) from None


def by_lzma(content: bytes) -> bytes:
    """Return ``content`` as raw LZMA with its end mark; raises MissingCodecError without Python's lzma.

    It adapts with each byte and has no tables to carry: on a window's two kilobytes it is 6 % smaller than
    zstd at its best.
    """
    lzma = _lzma()
    # More than the content is only room for the encoder to clear.
    dictionary = min(_DICTIONARY, max(4096, 1 << (len(content) - 1).bit_length()))
    filters = [{**_filter(lzma), "preset": 9 | lzma.PRESET_EXTREME, "dict_size": dictionary}]
    return bytes(lzma.compress(content, format=lzma.FORMAT_RAW, filters=filters))


def from_lzma(body: bytes, most: int) -> bytes:
    """Return what is in ``body``, or the first ``most`` + 1 bytes of it, which shows that it holds too much.

    Raises BinaryError for what is no LZMA, ends too early or goes on after its end mark, and
    MissingCodecError without Python's lzma.
    """
    lzma = _lzma()
    decompressor = lzma.LZMADecompressor(
        lzma.FORMAT_RAW, filters=[{**_filter(lzma), "dict_size": _DICTIONARY}]
    )
    try:
        content = bytes(decompressor.decompress(body, max_length=most + 1))
    except lzma.LZMAError as error:
        raise BinaryError(
            f"body check: LZMA cannot read it ({error}); the file is altered, get it once more"
        ) from None
    if len(content) <= most and (not decompressor.eof or decompressor.unused_data):
        found = "goes on after its end" if decompressor.eof else "has no end"
        raise BinaryError(f"body check: the LZMA {found}; the file is altered, get it once more")
    return content


def _filter(lzma: Any) -> dict[str, int]:
    # Numbers of all columns have much the same bytes, wherever they stand.
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

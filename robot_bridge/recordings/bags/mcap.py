"""Messages of an MCAP file (https://mcap.dev/spec), without its index."""

from __future__ import annotations

import io
import struct
from collections.abc import Iterator
from pathlib import Path
from typing import IO

from .message import LARGEST_RECORD, CutOffError, Message, exactly, plain, unpacked_by_lz4

MAGIC = b"\x89MCAP0\r\n"
_SCHEMA, _CHANNEL, _MESSAGE, _CHUNK, _DATA_END = 0x03, 0x04, 0x05, 0x06, 0x0F
_READ = (_SCHEMA, _CHANNEL, _MESSAGE, _CHUNK)


def messages(file: Path) -> Iterator[Message]:
    """Yield all messages; raises CutOffError where they end too early, and OSError."""
    with file.open("rb") as content:
        if exactly(content, len(MAGIC)) != MAGIC:
            raise CutOffError("it is no MCAP")
        yield from _Reading().of(content)


class _Reading:
    def __init__(self) -> None:
        self._kinds: dict[int, str] = {}
        self._channels: dict[int, tuple[str, str]] = {}
        self._number = 0

    def of(self, content: IO[bytes], *, is_chunk: bool = False) -> Iterator[Message]:
        while not (is_chunk and content.tell() == self._length(content)):
            code, length = struct.unpack("<BQ", exactly(content, 9))
            if code == _DATA_END:
                return
            if code not in _READ:
                content.seek(length, io.SEEK_CUR)
                continue
            record = exactly(content, length)
            try:
                yield from self._record(code, record, is_chunk=is_chunk)
            except (struct.error, UnicodeDecodeError, KeyError) as error:
                raise CutOffError(f"a record makes no sense ({error})") from None

    def _length(self, content: IO[bytes]) -> int:
        assert isinstance(content, io.BytesIO)
        return content.getbuffer().nbytes

    def _record(self, code: int, record: bytes, *, is_chunk: bool) -> Iterator[Message]:
        if code == _SCHEMA:
            self._kinds[_u16(record, 0)] = plain(_text(record, 2)[0])
        elif code == _CHANNEL:
            topic, _ = _text(record, 4)
            self._channels[_u16(record, 0)] = topic, self._kinds.get(_u16(record, 2), "")
        elif code == _MESSAGE:
            self._number += 1
            topic, kind = self._channels[_u16(record, 0)]
            (at,) = struct.unpack_from("<Q", record, 6)
            yield Message(self._number, topic, kind, at * 1e-9, record[22:])
        elif not is_chunk:
            yield from self.of(io.BytesIO(_unpacked(record)), is_chunk=True)


def _unpacked(record: bytes) -> bytes:
    (size,) = struct.unpack_from("<Q", record, 16)
    way, at = _text(record, 28)
    if size > LARGEST_RECORD:
        raise CutOffError(f"a chunk would have {size} bytes")
    packed = record[at + 8 :]
    if way == "":
        return packed
    if way == "zstd":
        return _unpacked_by_zstd(packed, size)
    if way == "lz4":
        return unpacked_by_lz4(packed, size)
    raise CutOffError(f"a chunk is packed by {way[:20]!r}, which is not known")


def _unpacked_by_zstd(packed: bytes, size: int) -> bytes:
    import zstandard

    try:
        # What the frame says of its own length goes before any bound.
        if zstandard.frame_content_size(packed) > size:
            raise CutOffError("a chunk is longer than it says")
        return zstandard.ZstdDecompressor().decompress(packed, max_output_size=size)
    except zstandard.ZstdError as error:
        raise CutOffError(f"a chunk cannot be unpacked ({error})") from None


def _u16(record: bytes, at: int) -> int:
    found: int = struct.unpack_from("<H", record, at)[0]
    return found


def _text(record: bytes, at: int) -> tuple[str, int]:
    """Return a text and where it ends."""
    (length,) = struct.unpack_from("<I", record, at)
    return record[at + 4 : at + 4 + length].decode("utf-8"), at + 4 + length

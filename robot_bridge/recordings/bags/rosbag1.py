"""Messages of a ROS 1 bag (format 2.0), without its index."""

from __future__ import annotations

import bz2
import io
import struct
from collections.abc import Iterator
from pathlib import Path
from typing import IO

from .message import LARGEST_RECORD, CutOffError, Message, exactly, plain, unpacked_by_lz4

MAGIC = b"#ROSBAG V2.0\n"
_MESSAGE, _CHUNK, _CONNECTION = 0x02, 0x05, 0x07
_LONGEST_HEADER = 1 << 20


def messages(file: Path) -> Iterator[Message]:
    """Yield all messages; raises CutOffError where they end too early, and OSError."""
    with file.open("rb") as content:
        if exactly(content, len(MAGIC)) != MAGIC:
            raise CutOffError("it is no ROS 1 bag of format 2.0")
        yield from _Reading().of(content)


class _Reading:
    def __init__(self) -> None:
        self._connections: dict[bytes, tuple[str, str]] = {}
        self._number = 0

    def of(self, content: IO[bytes], *, is_chunk: bool = False) -> Iterator[Message]:
        while start := content.read(4):
            try:
                header = _fields(exactly(content, _length(start, _LONGEST_HEADER)))
                data = exactly(content, _length(exactly(content, 4), LARGEST_RECORD))
                yield from self._record(header, data, is_chunk=is_chunk)
            except (struct.error, KeyError, IndexError, UnicodeDecodeError) as error:
                raise CutOffError(f"a record makes no sense ({error!r})") from None

    def _record(self, header: dict[bytes, bytes], data: bytes, *, is_chunk: bool) -> Iterator[Message]:
        code = header[b"op"][0]
        if code == _CONNECTION:
            kind = plain(_fields(data)[b"type"].decode())
            self._connections[header[b"conn"]] = header[b"topic"].decode(), kind
        elif code == _MESSAGE:
            self._number += 1
            seconds, nanoseconds = struct.unpack("<II", header[b"time"])
            topic, kind = self._connections[header[b"conn"]]
            yield Message(self._number, topic, kind, seconds + nanoseconds * 1e-9, data, is_ros1=True)
        elif code == _CHUNK and not is_chunk:
            (size,) = struct.unpack("<I", header[b"size"])
            unpacked = _unpacked(header[b"compression"].decode(), data, size)
            yield from self.of(io.BytesIO(unpacked), is_chunk=True)


def _unpacked(way: str, data: bytes, size: int) -> bytes:
    if way == "none":
        return data
    if size <= LARGEST_RECORD and way == "lz4":
        return unpacked_by_lz4(data, size)
    if size <= LARGEST_RECORD and way == "bz2":
        try:
            return bz2.BZ2Decompressor().decompress(data, max_length=size)
        except OSError as error:
            raise CutOffError(f"a chunk cannot be unpacked ({error})") from None
    raise CutOffError(f"a chunk of {size} bytes is packed by {way[:20]!r}, which is not read")


def _length(start: bytes, most: int) -> int:
    length: int = struct.unpack("<I", start)[0]
    if length > most:
        raise CutOffError(f"a record would have {length} bytes")
    return length


def _fields(header: bytes) -> dict[bytes, bytes]:
    fields, at = {}, 0
    while at < len(header):
        (length,) = struct.unpack_from("<I", header, at)
        name, _, value = header[at + 4 : at + 4 + length].partition(b"=")
        fields[name] = value
        at += 4 + length
    return fields

"""Positions from ROS bags: MCAP, ROS 1 bags (format 2.0), rosbag2 in SQLite."""

from __future__ import annotations

import bz2
import io
import math
import shutil
import sqlite3
import struct
import tempfile
from collections.abc import Callable, Iterator, Sequence
from contextlib import closing, contextmanager
from fnmatch import fnmatchcase
from itertools import chain
from pathlib import Path
from typing import IO, Any, NamedTuple

from ..core.messages.base import COORDINATE
from . import tracks

# --- A message in a bag, and the limits of all bags ---

LARGEST_RECORD = 1 << 28
"""bytes of a record in memory, both packed and unpacked."""


class Message(NamedTuple):
    """``data`` as it was sent, of type ``kind`` (``nav_msgs/Odometry``), ``t`` seconds since 1970.

    ``is_ros1`` says how it is encoded.
    """

    number: int
    topic: str
    kind: str
    t: float
    data: bytes
    is_ros1: bool = False


class CutOffError(Exception):
    """A bag that is truncated or damaged in the middle; the text says what is wrong."""


def exactly(file: IO[bytes], count: int) -> bytes:
    """Return the next ``count`` bytes; raises CutOffError."""
    if count > LARGEST_RECORD:
        raise CutOffError(f"a record would have {count} bytes")
    found = file.read(count)
    if len(found) < count:
        raise CutOffError("the file is cut off")
    return found


def plain(kind: str) -> str:
    """Return the name of a type without ROS 2's ``msg`` in it."""
    return kind.replace("/msg/", "/")


def unpacked_by_lz4(packed: bytes, size: int) -> bytes:
    """Return at most ``size`` bytes unpacked from an LZ4 frame; raises CutOffError."""
    # The package comes with rosbags, without which no bag is read.
    import lz4.frame

    try:
        unpacked: bytes = lz4.frame.LZ4FrameDecompressor().decompress(packed, max_length=size)
    except RuntimeError as error:
        raise CutOffError(f"a chunk cannot be unpacked ({error})") from None
    return unpacked


# --- Messages of an MCAP file (https://mcap.dev/spec), without its index ---

MCAP_MAGIC = b"\x89MCAP0\r\n"
_SCHEMA, _CHANNEL, _MESSAGE, _CHUNK, _DATA_END = 0x03, 0x04, 0x05, 0x06, 0x0F
_READ = (_SCHEMA, _CHANNEL, _MESSAGE, _CHUNK)


def mcap_messages(file: Path) -> Iterator[Message]:
    """Yield all messages; raises CutOffError if they end too early, and OSError."""
    with file.open("rb") as content:
        if exactly(content, len(MCAP_MAGIC)) != MCAP_MAGIC:
            raise CutOffError("it is no MCAP")
        yield from _McapReading().of(content)


class _McapReading:
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
            yield from self.of(io.BytesIO(_unpacked_chunk(record)), is_chunk=True)


def _unpacked_chunk(record: bytes) -> bytes:
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
        # A length stated in the frame takes precedence over any bound.
        if zstandard.frame_content_size(packed) > size:
            raise CutOffError("a chunk is longer than it says")
        return zstandard.ZstdDecompressor().decompress(packed, max_output_size=size)
    except zstandard.ZstdError as error:
        raise CutOffError(f"a chunk cannot be unpacked ({error})") from None


def _u16(record: bytes, at: int) -> int:
    found: int = struct.unpack_from("<H", record, at)[0]
    return found


def _text(record: bytes, at: int) -> tuple[str, int]:
    """Return a text and the position after it."""
    (length,) = struct.unpack_from("<I", record, at)
    return record[at + 4 : at + 4 + length].decode("utf-8"), at + 4 + length


# --- Messages of a ROS 1 bag (format 2.0), without its index ---

ROSBAG1_MAGIC = b"#ROSBAG V2.0\n"
_ROSBAG1_MESSAGE, _ROSBAG1_CHUNK, _CONNECTION = 0x02, 0x05, 0x07
_LONGEST_HEADER = 1 << 20


def rosbag1_messages(file: Path) -> Iterator[Message]:
    """Yield all messages; raises CutOffError if they end too early, and OSError."""
    with file.open("rb") as content:
        if exactly(content, len(ROSBAG1_MAGIC)) != ROSBAG1_MAGIC:
            raise CutOffError("it is no ROS 1 bag of format 2.0")
        yield from _Rosbag1Reading().of(content)


class _Rosbag1Reading:
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
        elif code == _ROSBAG1_MESSAGE:
            self._number += 1
            seconds, nanoseconds = struct.unpack("<II", header[b"time"])
            topic, kind = self._connections[header[b"conn"]]
            yield Message(self._number, topic, kind, seconds + nanoseconds * 1e-9, data, is_ros1=True)
        elif code == _ROSBAG1_CHUNK and not is_chunk:
            (size,) = struct.unpack("<I", header[b"size"])
            unpacked = _unpacked_data(header[b"compression"].decode(), data, size)
            yield from self.of(io.BytesIO(unpacked), is_chunk=True)


def _unpacked_data(way: str, data: bytes, size: int) -> bytes:
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


# --- Messages of a rosbag2 in SQLite ---

_MAGIC = b"SQLite format 3\0"
_HEADER = struct.Struct(">16xH10xI")
"""The size of a page (1 for 65 536) and the number of pages."""


def sqlite_messages(file: Path) -> Iterator[Message]:
    """Yield all messages in the order in which they were written; raises CutOffError and OSError."""
    missing = _missing_bytes(file)
    try:
        with _filled_up(file, missing) as whole:
            yield from _rows(whole)
    except sqlite3.Error as error:
        why = f"{missing} bytes are missing at its end" if missing else f"SQLite says: {error}"
        raise CutOffError(why) from None


def _rows(file: Path) -> Iterator[Message]:
    with closing(sqlite3.connect(f"{file.resolve().as_uri()}?mode=ro", uri=True)) as bag:
        bag.setlimit(sqlite3.SQLITE_LIMIT_LENGTH, LARGEST_RECORD)
        topics = {
            id: (str(name), plain(str(kind)))
            for id, name, kind in bag.execute("SELECT id, name, type FROM topics")
        }
        rows = bag.execute("SELECT id, topic_id, timestamp, data FROM messages ORDER BY id")
        for id, topic, at, data in rows:
            if topic not in topics or not isinstance(at, int) or not isinstance(data, bytes):
                raise CutOffError(f"row {id} of messages makes no sense")
            yield Message(id, *topics[topic], at * 1e-9, data)


def _missing_bytes(file: Path) -> int:
    """Return the bytes missing by the file's own header."""
    with file.open("rb") as content:
        header = content.read(_HEADER.size)
    if len(header) < _HEADER.size or not header.startswith(_MAGIC):
        return 0
    size, count = _HEADER.unpack(header)
    whole = int(count) * (65_536 if size == 1 else int(size))
    return max(0, whole - file.stat().st_size)


@contextmanager
def _filled_up(file: Path, missing: int) -> Iterator[Path]:
    """Yield the file; if truncated, a copy padded with zeros, since SQLite refuses shorter ones."""
    if not missing:
        yield file
        return
    with tempfile.TemporaryDirectory(prefix="robot-bridge-") as folder:
        copy = Path(folder) / "bag.db3"
        shutil.copyfile(file, copy)
        with copy.open("r+b") as content:
            content.truncate(copy.stat().st_size + missing)
        yield copy


# --- Positions from the messages in bags: topics of robots, and the content of their messages ---

EARTH = "sensor_msgs/NavSatFix"
KINDS = ("nav_msgs/Odometry", "geometry_msgs/PoseStamped", "geometry_msgs/PoseWithCovarianceStamped", EARTH)
LARGEST = 1 << 16
"""bytes of a message with a position."""
_FILES: dict[str, Callable[[Path], Iterator[Message]]] = {
    ".mcap": mcap_messages,
    ".db3": sqlite_messages,
    ".bag": rosbag1_messages,
}
_NO_FIX = -1
_UNIT = 0.1
"""Tolerance of a quaternion's length about 1."""


def read_bag(bag: Path, topics: Sequence[str], remarks: tracks.Remarks) -> tracks.Source:
    """Return the positions in a bag, a file or the folder of a rosbag2.

    ``topics`` are patterns of those to read, none for all with positions. Times are those at which messages
    were recorded.

    :raises RecordingError: for a bag without positions, for two topics of one robot, for degrees mixed with
        metres, and if the package rosbags is missing.
    """
    found = _BagReading(bag, topics, remarks).samples()
    first = next(found, None)
    if first is None:
        because = f"; {remarks.texts[0]}" if remarks.texts else ""
        which = "none of the topics asked for" if topics else "no topic"
        raise tracks.RecordingError(f"{bag}: {which} tells a position{because}")
    is_earth, sample = first
    return tracks.Source(
        tracks.WGS84 if is_earth else None, chain([sample], _of_one_kind(bag, found, is_earth))
    )


def _of_one_kind(
    bag: Path, found: Iterator[tuple[bool, tracks.Sample]], is_earth: bool
) -> Iterator[tracks.Sample]:
    for other, sample in found:
        if other is not is_earth:
            raise tracks.RecordingError(f"{bag} tells places in degrees and in metres; choose with topics")
        yield sample


class _BagReading:
    def __init__(self, bag: Path, topics: Sequence[str], remarks: tracks.Remarks) -> None:
        self._bag, self._topics, self._remarks = bag, topics, remarks
        self._robots: dict[str, str] = {}
        """the topic of each robot."""
        self._decode = _decoder()

    def samples(self) -> Iterator[tuple[bool, tracks.Sample]]:
        for file in self._files():
            try:
                for message in _FILES[file.suffix](file):
                    if message.kind in KINDS and self._is_wanted(message.topic):
                        yield from self._of(file, message)
            except CutOffError as error:
                self._remarks.add(f"{file}", f"nothing behind is read: {error}")
            except OSError as error:
                raise tracks.RecordingError(f"{file} cannot be read: {error.strerror or error}") from None

    def _files(self) -> list[Path]:
        if not self._bag.is_dir():
            return [self._bag]
        files = [file for file in self._bag.iterdir() if file.suffix in (".mcap", ".db3")]
        # NAME_2 is before NAME_10.
        return sorted(files, key=lambda file: (len(file.name), file.name))

    def _is_wanted(self, topic: str) -> bool:
        return not self._topics or any(fnmatchcase(topic, pattern) for pattern in self._topics)

    def _of(self, file: Path, message: Message) -> Iterator[tuple[bool, tracks.Sample]]:
        robot = message.topic.strip("/").rpartition("/")[0] or self._bag.name.split(".")[0]
        known = self._robots.setdefault(robot, message.topic)
        if known != message.topic:
            raise tracks.RecordingError(
                f"{self._bag}: {known} and {message.topic} both tell where robot {robot!r} is; choose with "
                f"topics = ['*/{known.rpartition('/')[2]}']"
            )
        try:
            if len(message.data) > LARGEST:
                raise tracks.ValueRefusedError("data", f"it has {len(message.data)} bytes")
            yield message.kind == EARTH, _bag_sample(message, robot, self._decode(message))
        except tracks.ValueRefusedError as error:
            self._remarks.add(f"{file}: message {message.number} of {message.topic}", str(error))


def _decoder() -> Callable[[Message], Any]:
    try:
        from rosbags.serde import SerdeError
        from rosbags.typesys import Stores, get_typestore
    except ModuleNotFoundError as error:
        raise tracks.RecordingError(
            f"bags need the Python package rosbags, and {error.name} is missing; install it with: pip "
            "install 'fleet-supervisor-robot-bridge[ros2]'"
        ) from None
    ros1, ros2 = get_typestore(Stores.ROS1_NOETIC), get_typestore(Stores.LATEST)

    def decode(message: Message) -> Any:
        kind = message.kind.replace("/", "/msg/")
        try:
            if message.is_ros1:
                return ros1.deserialize_ros1(message.data, kind)
            return ros2.deserialize_cdr(message.data, kind)
        except (SerdeError, IndexError, ValueError, OverflowError, MemoryError, KeyError) as error:
            raise tracks.ValueRefusedError("data", f"it is no {message.kind} ({error})") from None

    return decode


def _bag_sample(message: Message, robot: str, content: Any) -> tracks.Sample:
    number, t = message.number, message.t
    if message.kind == EARTH:
        if content.status.status <= _NO_FIX:
            raise tracks.ValueRefusedError("status", "the receiver has no fix")
        lon, lat = (
            _finite(content.longitude, "longitude", tracks.LONGITUDE),
            _finite(content.latitude, "latitude", tracks.LATITUDE),
        )
        return tracks.Sample(number, robot, t, lon, lat)
    pose = content.pose if message.kind == KINDS[1] else content.pose.pose
    x, y = (_finite(getattr(pose.position, name), f"position.{name}", COORDINATE) for name in "xy")
    v = math.nan
    if message.kind == KINDS[0]:
        ahead, aside = content.twist.twist.linear.x, content.twist.twist.linear.y
        v = _finite(
            math.copysign(math.hypot(ahead, aside), ahead or 1.0), "twist.linear", tracks.SPEED_BOUNDS
        )
    return tracks.Sample(number, robot, t, x, y, _yaw(pose.orientation), v)


def _yaw(q: Any) -> float:
    parts = [_finite(getattr(q, name), f"orientation.{name}", (-2.0, 2.0)) for name in "xyzw"]
    if abs(math.hypot(*parts) - 1.0) > _UNIT:
        raise tracks.ValueRefusedError("orientation", f"{tuple(parts)} is no rotation: its length is not 1")
    x, y, z, w = parts
    return math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))


def _finite(value: Any, column: str, bounds: tuple[float, float]) -> float:
    number = float(value)
    if not bounds[0] <= number <= bounds[1]:
        raise tracks.ValueRefusedError(
            column, f"{number} is not a number from {bounds[0]:g} to {bounds[1]:g}"
        )
    return number

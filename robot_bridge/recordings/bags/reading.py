"""Positions of the messages in bags: which topic is which robot's, and what its messages say."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from fnmatch import fnmatchcase
from itertools import chain
from pathlib import Path
from typing import Any

from ...messages.bounds import COORDINATE
from ..errors import RecordingError
from ..samples import (
    LATITUDE,
    LONGITUDE,
    SPEED_BOUNDS,
    WGS84,
    Remarks,
    Sample,
    Source,
    ValueRefusedError,
)
from . import mcap, rosbag1, sqlite_bag
from .message import CutOffError, Message

EARTH = "sensor_msgs/NavSatFix"
KINDS = ("nav_msgs/Odometry", "geometry_msgs/PoseStamped", "geometry_msgs/PoseWithCovarianceStamped", EARTH)
LARGEST = 1 << 16
"""bytes of a message that tells a position."""
_FILES: dict[str, Callable[[Path], Iterator[Message]]] = {
    ".mcap": mcap.messages,
    ".db3": sqlite_bag.messages,
    ".bag": rosbag1.messages,
}
_NO_FIX = -1
_UNIT = 0.1
"""How far a quaternion may be from length 1."""


def read_bag(bag: Path, topics: Sequence[str], remarks: Remarks) -> Source:
    """Return the positions in a bag, a file or the folder of a rosbag2.

    ``topics`` are patterns of those that are read, none for all that tell positions. Times are those at which
    messages were recorded.

    :raises RecordingError: for a bag without positions, for two topics of one robot, for degrees beside
        metres, and where the package rosbags is missing.
    """
    found = _Reading(bag, topics, remarks).samples()
    first = next(found, None)
    if first is None:
        because = f"; {remarks.texts[0]}" if remarks.texts else ""
        which = "none of the topics asked for" if topics else "no topic"
        raise RecordingError(f"{bag}: {which} tells a position{because}")
    is_earth, sample = first
    return Source(WGS84 if is_earth else None, chain([sample], _of_one_kind(bag, found, is_earth)))


def _of_one_kind(bag: Path, found: Iterator[tuple[bool, Sample]], is_earth: bool) -> Iterator[Sample]:
    for other, sample in found:
        if other is not is_earth:
            raise RecordingError(f"{bag} tells places in degrees and in metres; choose with topics")
        yield sample


class _Reading:
    def __init__(self, bag: Path, topics: Sequence[str], remarks: Remarks) -> None:
        self._bag, self._topics, self._remarks = bag, topics, remarks
        self._robots: dict[str, str] = {}
        """the topic of each robot."""
        self._decode = _decoder()

    def samples(self) -> Iterator[tuple[bool, Sample]]:
        for file in self._files():
            try:
                for message in _FILES[file.suffix](file):
                    if message.kind in KINDS and self._is_wanted(message.topic):
                        yield from self._of(file, message)
            except CutOffError as error:
                self._remarks.add(f"{file}", f"nothing behind is read: {error}")
            except OSError as error:
                raise RecordingError(f"{file} cannot be read: {error.strerror or error}") from None

    def _files(self) -> list[Path]:
        if not self._bag.is_dir():
            return [self._bag]
        files = [file for file in self._bag.iterdir() if file.suffix in (".mcap", ".db3")]
        # NAME_2 is before NAME_10.
        return sorted(files, key=lambda file: (len(file.name), file.name))

    def _is_wanted(self, topic: str) -> bool:
        return not self._topics or any(fnmatchcase(topic, pattern) for pattern in self._topics)

    def _of(self, file: Path, message: Message) -> Iterator[tuple[bool, Sample]]:
        robot = message.topic.strip("/").rpartition("/")[0] or self._bag.name.split(".")[0]
        known = self._robots.setdefault(robot, message.topic)
        if known != message.topic:
            raise RecordingError(
                f"{self._bag}: {known} and {message.topic} both tell where robot {robot!r} is; choose with "
                f"topics = ['*/{known.rpartition('/')[2]}']"
            )
        try:
            if len(message.data) > LARGEST:
                raise ValueRefusedError("data", f"it has {len(message.data)} bytes")
            yield message.kind == EARTH, _sample(message, robot, self._decode(message))
        except ValueRefusedError as error:
            self._remarks.add(f"{file}: message {message.number} of {message.topic}", str(error))


def _decoder() -> Callable[[Message], Any]:
    try:
        from rosbags.serde import SerdeError
        from rosbags.typesys import Stores, get_typestore
    except ModuleNotFoundError as error:
        raise RecordingError(
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
            raise ValueRefusedError("data", f"it is no {message.kind} ({error})") from None

    return decode


def _sample(message: Message, robot: str, said: Any) -> Sample:
    number, t = message.number, message.t
    if message.kind == EARTH:
        if said.status.status <= _NO_FIX:
            raise ValueRefusedError("status", "the receiver has no fix")
        lon, lat = (
            _finite(said.longitude, "longitude", LONGITUDE),
            _finite(said.latitude, "latitude", LATITUDE),
        )
        return Sample(number, robot, t, lon, lat)
    pose = said.pose if message.kind == KINDS[1] else said.pose.pose
    x, y = (_finite(getattr(pose.position, name), f"position.{name}", COORDINATE) for name in "xy")
    v = math.nan
    if message.kind == KINDS[0]:
        ahead, aside = said.twist.twist.linear.x, said.twist.twist.linear.y
        v = _finite(math.copysign(math.hypot(ahead, aside), ahead or 1.0), "twist.linear", SPEED_BOUNDS)
    return Sample(number, robot, t, x, y, _yaw(pose.orientation), v)


def _yaw(q: Any) -> float:
    parts = [_finite(getattr(q, name), f"orientation.{name}", (-2.0, 2.0)) for name in "xyzw"]
    if abs(math.hypot(*parts) - 1.0) > _UNIT:
        raise ValueRefusedError("orientation", f"{tuple(parts)} is no rotation: its length is not 1")
    x, y, z, w = parts
    return math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))


def _finite(value: Any, column: str, bounds: tuple[float, float]) -> float:
    number = float(value)
    if not bounds[0] <= number <= bounds[1]:
        raise ValueRefusedError(column, f"{number} is not a number from {bounds[0]:g} to {bounds[1]:g}")
    return number

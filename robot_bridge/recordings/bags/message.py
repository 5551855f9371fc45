"""A message as a bag holds it, and the bounds of all bags."""

from __future__ import annotations

from typing import IO, NamedTuple

LARGEST_RECORD = 1 << 28
"""bytes of a record that is taken into memory, as it stands in the file and unpacked."""


class Message(NamedTuple):
    """``data`` as it was sent, of type ``kind`` (``nav_msgs/Odometry``), ``t`` seconds since 1970.

    ``is_ros1`` tells how it is encoded.
    """

    number: int
    topic: str
    kind: str
    t: float
    data: bytes
    is_ros1: bool = False


class CutOffError(Exception):
    """A bag that ends, or makes no sense any more, in the middle; the text says what is wrong."""


def exactly(file: IO[bytes], count: int) -> bytes:
    """Return the next ``count`` bytes; raises CutOffError."""
    if count > LARGEST_RECORD:
        raise CutOffError(f"a record would have {count} bytes")
    found = file.read(count)
    if len(found) < count:
        raise CutOffError("the file is cut off")
    return found


def plain(kind: str) -> str:
    """Return the name of a type without the ``msg`` that ROS 2 puts into it."""
    return kind.replace("/msg/", "/")


def unpacked_by_lz4(packed: bytes, size: int) -> bytes:
    """Return at most ``size`` bytes of what is packed as an LZ4 frame; raises CutOffError."""
    # rosbags brings the package, and without it no bag is read.
    import lz4.frame

    try:
        unpacked: bytes = lz4.frame.LZ4FrameDecompressor().decompress(packed, max_length=size)
    except RuntimeError as error:
        raise CutOffError(f"a chunk cannot be unpacked ({error})") from None
    return unpacked

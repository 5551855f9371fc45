"""The binary frame of positions: a JSON head, and behind it a table of 64-bit floats.

Everything is little-endian: the length of the head as an unsigned 32-bit integer; the head, a JSON-RPC
notification ``positions``, filled up with spaces so that what follows begins at a multiple of 8 bytes; then
each of its ``columns``, one float for each of its ``robots``.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, NamedTuple

from .decoding import MESSAGE, Bounds, DecodingError, decode_json

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

METHOD = "positions"
POSITION_HEAD = 4
ALIGNMENT = 8
POSITION_VALUE = "<f8"


class PositionFrame(NamedTuple):
    """A frame in its parts: ``table`` is (columns, robots) and read-only, ``params`` are all of the head."""

    params: dict[str, Any]
    robots: list[str]
    columns: list[str]
    words: list[str]
    table: npt.NDArray[np.float64]


def packed_frame(head: bytes, columns: Iterable[npt.NDArray[np.float64]]) -> bytes:
    """Return ``head``, a JSON text, and the columns that it names as one frame."""
    import numpy as np

    length = -(-(POSITION_HEAD + len(head)) // ALIGNMENT) * ALIGNMENT - POSITION_HEAD
    values = (np.ascontiguousarray(column, dtype=POSITION_VALUE).tobytes() for column in columns)
    return b"".join([length.to_bytes(POSITION_HEAD, "little"), head.ljust(length), *values])


def split_frame(frame: bytes, bounds: Bounds = MESSAGE) -> PositionFrame:
    """Return the parts of a frame; raises DecodingError when it is none, or names something twice."""
    import numpy as np

    begin = POSITION_HEAD + int.from_bytes(frame[:POSITION_HEAD], "little")
    if not POSITION_HEAD <= begin <= len(frame):
        raise DecodingError("its head is longer than the frame")
    head = decode_json(bytes(frame[POSITION_HEAD:begin]), bounds)
    if not isinstance(head, dict) or head.get("method") != METHOD or not isinstance(head.get("params"), dict):
        raise DecodingError(f"it is a binary frame without the head of {METHOD}")
    params = head["params"]
    robots, columns, words = (_texts(name, params.get(name)) for name in ("robots", "columns", "words"))
    if len(set(robots)) < len(robots) or len(set(columns)) < len(columns):
        raise DecodingError("a robot or a column is named twice")
    if len(frame) - begin != len(robots) * len(columns) * ALIGNMENT:
        raise DecodingError(
            f"{len(frame) - begin} bytes follow the head; {len(columns)} columns of {len(robots)} robots "
            f"have {len(robots) * len(columns) * ALIGNMENT}"
        )
    table = np.frombuffer(frame, dtype=POSITION_VALUE, offset=begin).reshape(len(columns), len(robots))
    return PositionFrame(params, robots, columns, words, table)


def _texts(name: str, value: Any) -> list[str]:
    if not isinstance(value, list) or not all(isinstance(one, str) for one in value):
        raise DecodingError(f"{name} is no list of texts")
    return value

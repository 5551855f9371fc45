"""Positions of many robots in one frame: binary with a JSON head, or JSON."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from .json_decoder import MESSAGE, DecodingError, JsonBounds, decode_json
from .messages.base import MessageError
from .messages.robots import SendPos, is_status

# --- The binary frame of positions: a JSON head, followed by a table of 64-bit floats ---
# Everything is little-endian: the length of the head as an unsigned 32-bit integer; the head, a JSON-RPC
# notification ``positions``, padded with spaces so that the table begins at a multiple of 8 bytes;
# then each
# of its ``columns``, one float for each of its ``robots``.

METHOD = "positions"
POSITION_HEAD = 4
ALIGNMENT = 8
POSITION_VALUE, PLACE_VALUE = "<f8", "<f4"


class PositionFrame(NamedTuple):
    """The parts of a frame: ``table`` is (columns, robots) and read-only, ``params`` is the whole head."""

    params: dict[str, Any]
    robots: list[str]
    columns: list[str]
    words: list[str]
    table: npt.NDArray[np.float64]


def packed_frame(
    head: bytes, columns: Iterable[npt.NDArray[np.float64]], value: str = POSITION_VALUE
) -> bytes:
    """Return one frame of ``head``, a JSON text, and the columns that it names, of type ``value``."""
    length = -(-(POSITION_HEAD + len(head)) // ALIGNMENT) * ALIGNMENT - POSITION_HEAD
    values = (np.ascontiguousarray(column, dtype=value).tobytes() for column in columns)
    return b"".join([length.to_bytes(POSITION_HEAD, "little"), head.ljust(length), *values])


def split_frame(frame: bytes, bounds: JsonBounds = MESSAGE) -> PositionFrame:
    """Return the parts of a frame; raises DecodingError when it is none, or names something twice."""
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


# --- Positions of many robots of a link: in the binary frame of a desk, or as JSON ---

NUMBERS = {
    "x": "x",
    "y": "y",
    "theta": "theta",
    "v": "v",
    "device_time": "t",
    "fix_time": "fix_t",
    "battery": "battery",
    "accuracy": "accuracy",
    "altitude": "altitude",
}
"""Columns of numbers, with the parameters of SendPos that they hold."""
TEXTS = ("status", "theta_from")
"""Columns of indices into ``words``."""
NEEDED = ("x", "y", "theta", "v")
WAYS = ("course", "last", "unknown")
"""Values of ``theta_from``."""

_PARAMETERS = {name: name for name in TEXTS} | NUMBERS
_DIRECTION = (-math.pi, math.pi)
"""radians; angles beyond are equal to one within."""

Batch = list[tuple[str, SendPos | MessageError]]
Rows = npt.NDArray[np.bool_]


def poses_in_frame(frame: bytes) -> Batch:
    """Return each robot of a binary frame with its pose, or with the error in its row.

    Columns are checked as a whole, and rows one by one only on errors: ten thousand rows arrive each second.

    :raises DecodingError: when it is no such frame; MessageError for columns that robots may not send.
    """
    batch = split_frame(frame)
    _check_columns(batch)
    names = [_PARAMETERS[name] for name in batch.columns]
    right = np.ones(len(batch.robots), dtype=np.bool_)
    columns: list[list[Any]] = []
    for name, values in zip(batch.columns, batch.table, strict=True):
        if name in TEXTS:
            columns.append(_words(batch.words, values))
            right &= _right_words(name, batch.words, values)
        else:
            unknown = np.isnan(values) if name not in NEEDED else None
            columns.append(_known(values, unknown))
            right &= _right_numbers(NUMBERS[name], values, unknown)
    rows = zip(*columns, strict=True)
    if right.all():
        of_checked = SendPos.of_checked
        return [(robot, of_checked(names, row)) for robot, row in zip(batch.robots, rows, strict=True)]
    return [
        (robot, SendPos.of_checked(names, row) if is_right else _pose(dict(zip(names, row, strict=True))))
        for robot, row, is_right in zip(batch.robots, rows, right.tolist(), strict=True)
    ]


def entries_in(params: Any) -> list[dict[str, Any]]:
    """Return the entries of ``positions`` as JSON, each with its ``robot``; raises MessageError."""
    entries = params.get("positions") if isinstance(params, dict) else None
    if not isinstance(entries, list) or not all(isinstance(one, dict) for one in entries):
        raise MessageError('positions: give {"positions": [...]}, an object for each robot')
    return entries


def _known(values: npt.NDArray[np.float64], unknown: Rows | None) -> list[float | None]:
    if unknown is None or not unknown.any():
        known: list[float | None] = values.tolist()
        return known
    return [None if value != value else value for value in values.tolist()]


def _right_numbers(parameter: str, values: npt.NDArray[np.float64], unknown: Rows | None) -> Rows:
    """Return a mask of the valid values; NaN is valid for a parameter that may be unknown."""
    low, high = _DIRECTION if parameter == "theta" else SendPos.ranges[parameter]
    right: Rows = (values >= low) & (values <= high)
    return right if unknown is None else right | unknown


def _right_words(name: str, words: list[str], values: npt.NDArray[np.float64]) -> Rows:
    """Return a mask of the values that are indices of valid words, or unknown."""
    right = [word in WAYS if name == "theta_from" else is_status(word) for word in words]
    places = np.flatnonzero(right).astype(np.float64)
    found: Rows = np.isin(values, places) | np.isnan(values)
    return found


def _pose(values: dict[str, Any]) -> SendPos | MessageError:
    """Return the pose of a row that failed the checks of its columns, or its error."""
    status, way = values.get("status"), values.get("theta_from")
    if status is _NO_WORD:
        return MessageError("status is the place of no word")
    if way is not None and way not in WAYS:
        return MessageError(f"theta_from is {way!r:.40}; give one of {', '.join(WAYS)}, or none")
    try:
        return SendPos(**values)
    except MessageError as error:
        return error


_NO_WORD: Any = object()


def _words(words: list[str], values: npt.NDArray[np.float64]) -> list[Any]:
    """Return the word at each index in ``values``, None for NaN."""
    is_place = (values >= 0) & (values < len(words)) & (values == np.floor(values))
    missing = np.where(np.isnan(values), len(words) + 1, len(words))
    found = [*words, _NO_WORD, None]
    return [found[place] for place in np.where(is_place, values, missing).astype(np.int64).tolist()]


def _check_columns(batch: PositionFrame) -> None:
    unknown = [name for name in batch.columns if name not in NUMBERS and name not in TEXTS]
    missing = [name for name in NEEDED if name not in batch.columns]
    if unknown:
        raise MessageError(
            f"positions: column {unknown[0]!r:.40} is not a robot's to tell; known are "
            f"{', '.join((*NUMBERS, *TEXTS))}"
        )
    if missing:
        raise MessageError(f"positions: column {missing[0]!r} is missing")

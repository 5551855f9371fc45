"""The text format of the paper's Fig. 2, extended as ``docs/robot-map.md`` says; writing."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Sequence
from itertools import islice, zip_longest
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .errors import RobotMapError
from .labels import escape, write_ext
from .model import Obstacle, RobotMap
from .text_reader import read_text

__all__ = ["read_text", "write_obstacles", "write_text"]

_OBSTACLES = 256
"""obstacles whose segments are turned into texts together."""
_BLOCK = 4096
"""segments that are turned into Python's numbers at once, which take five times their room."""
_PLAIN_FROM, _PLAIN_BELOW = 1e-4, 1e16
"""Between these Python writes a number without an exponent."""


def write_text(robot_map: RobotMap, *, strict: bool = False) -> str:
    """Return a map as text.

    What was read from a text is written back byte for byte. ``strict`` writes what Fig. 2 has and nothing
    else: no leading lines, no ``ext``, no comments. Raises RobotMapError for a number that is not finite and
    for a leading line whose key is not one word.
    """
    parts = ["".join(_head(robot_map, strict)) if strict or robot_map.head is None else robot_map.head]
    for text in _texts(robot_map.obstacles, strict):
        # A text may end without a line break, and an obstacle read there may come to stand elsewhere.
        if not parts[-1].endswith("\n"):
            parts.append("\n")
        parts.append(text)
    return "".join(parts) + ("" if strict else robot_map.tail)


def write_obstacles(obstacles: Sequence[Obstacle]) -> str:
    """Return what :func:`write_text` writes of obstacles that were built and not read."""
    return "".join(_texts(obstacles, strict=False))


def format_number(value: float) -> str:
    """Return the shortest decimal that reads back as ``value``, such as ``-4`` or ``12.1``.

    Raises RobotMapError for NaN and infinity.
    """
    number = float(value)
    if not math.isfinite(number):
        raise RobotMapError(f"the number {number} cannot stand in a robot map; give a finite one")
    text = repr(number).removesuffix(".0")
    if "e" in text:
        text = np.format_float_positional(number, trim="-")
    return "0" if text == "-0" else text


def _head(robot_map: RobotMap, strict: bool) -> Iterator[str]:
    if not strict:
        for key, value in robot_map.meta.items():
            if not re.fullmatch(r"\S+", key):
                raise RobotMapError(f"the leading line {key!r} of a robot map: give a key of one word")
            yield f"%{key} {' '.join(value.split())}".rstrip(" ") + "\n"
    yield "border;\n"
    yield _point(*robot_map.border.left_upper)
    yield _point(*robot_map.border.right_lower)
    yield "#\n"


def _texts(obstacles: Sequence[Obstacle], strict: bool) -> Iterator[str]:
    """Yield each obstacle as it was read, or as it is written."""
    for begin in range(0, len(obstacles), _OBSTACLES):
        some = obstacles[begin : begin + _OBSTACLES]
        numbers = _numbers([one for one in some if strict or one.text is None])
        for obstacle in some:
            as_read = None if strict else obstacle.text
            yield "".join(_obstacle(obstacle, numbers, strict)) if as_read is None else as_read


def _obstacle(obstacle: Obstacle, numbers: Iterator[str], strict: bool) -> Iterator[str]:
    """Yield an obstacle's lines; ``numbers`` gives what stands before the labels of each of its segments."""
    ext = write_ext({} if strict else obstacle.ext)
    count = len(obstacle.a)
    yield "obstacle;\n"
    yield f"{obstacle.id};{int(obstacle.shape_type)};{count};{escape(obstacle.semantics)};{ext}\n#\n"
    extras = () if strict else obstacle.segment_ext
    if not extras and not any(obstacle.segment_semantics):
        for number, outdoor in zip(islice(numbers, count), obstacle.outdoor.tolist(), strict=True):
            yield f"{number}{'01'[outdoor]};;\n#\n"
        return
    rows = zip(islice(numbers, count), obstacle.outdoor.tolist(), obstacle.segment_semantics, strict=True)
    for (number, outdoor, semantics), ext_ in zip_longest(rows, extras):
        yield f"{number}{'01'[outdoor]};{escape(semantics)};{write_ext(ext_ or {})}\n#\n"


def _numbers(obstacles: Sequence[Obstacle]) -> Iterator[str]:
    """Yield the two ends and the height of each segment of ``obstacles``, as they are written."""
    if not obstacles:
        return
    ends = [np.concatenate(side) for side in zip(*((one.a, one.b) for one in obstacles), strict=True)]
    values = np.column_stack([*ends, np.concatenate([one.height for one in obstacles])])
    for begin in range(0, len(values), _BLOCK):
        yield from _number_lines(values[begin : begin + _BLOCK])


def _number_lines(values: NDArray[Any]) -> Iterator[str]:
    """Yield a text for each row of ``values``, (n, 5)."""
    size = np.abs(values)
    if not ((size < _PLAIN_BELOW) & ((size >= _PLAIN_FROM) | (size == 0))).all():
        for ax, ay, bx, by, height in values.tolist():
            yield f"{_point(ax, ay)}{_point(bx, by)}{format_number(height)};"
        return
    # A sum with zero has no sign of its own, as -0.0 has.
    for ax, ay, bx, by, height in (values + 0.0).tolist():
        yield f"{ax};{ay};\n{bx};{by};\n{height};".replace(".0;", ";")


def _point(x: float, y: float) -> str:
    return f"{format_number(x)};{format_number(y)};\n"

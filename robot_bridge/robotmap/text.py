"""The text format of the paper's Fig. 2, extended as ``docs/robot-map.md`` says; writing."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator

import numpy as np

from .errors import RobotMapError
from .labels import escape, write_ext
from .model import Obstacle, RobotMap
from .text_reader import read_text

__all__ = ["read_text", "write_text"]


def write_text(robot_map: RobotMap, *, strict: bool = False) -> str:
    """Return a map as text.

    What was read from a text is written back byte for byte. ``strict`` writes what Fig. 2 has and nothing
    else: no leading lines, no ``ext``, no comments. Raises RobotMapError for a number that is not finite and
    for a leading line whose key is not one word.
    """
    parts = ["".join(_head(robot_map, strict)) if strict or robot_map.head is None else robot_map.head]
    for obstacle in robot_map.obstacles:
        # A text may end without a line break, and an obstacle read there may come to stand elsewhere.
        if not parts[-1].endswith("\n"):
            parts.append("\n")
        as_read = None if strict else obstacle.text
        parts.append("".join(_obstacle(obstacle, strict)) if as_read is None else as_read)
    return "".join(parts) + ("" if strict else robot_map.tail)


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


def _obstacle(obstacle: Obstacle, strict: bool) -> Iterator[str]:
    ext = write_ext({} if strict else obstacle.ext)
    count = len(obstacle.a)
    yield "obstacle;\n"
    yield f"{obstacle.id};{int(obstacle.shape_type)};{count};{escape(obstacle.semantics)};{ext}\n#\n"
    for row in range(count):
        yield _point(*obstacle.a[row])
        yield _point(*obstacle.b[row])
        flag = "1" if obstacle.outdoor[row] else "0"
        label = escape(obstacle.segment_semantics[row])
        extras = {} if strict or not obstacle.segment_ext else obstacle.segment_ext[row]
        yield f"{format_number(obstacle.height[row])};{flag};{label};{write_ext(extras)}\n#\n"


def _point(x: float, y: float) -> str:
    return f"{format_number(x)};{format_number(y)};\n"

"""The text format of the paper's Fig. 2, extended as ``docs/robot-map.md`` says; writing."""

from __future__ import annotations

from collections.abc import Iterator

from .labels import escape, escape_value
from .model import Obstacle, RobotMap
from .text_reader import read_text

__all__ = ["read_text", "write_text"]


def write_text(robot_map: RobotMap, *, strict: bool = False) -> str:
    """Return a map as text.

    What was read from a text is written back byte for byte. ``strict`` writes what Fig. 2 has and nothing
    else: no leading lines, no ``ext``, no comments.
    """
    head = "".join(_head(robot_map, strict)) if strict or robot_map.head is None else robot_map.head
    body = (
        obstacle.text if obstacle.text is not None and not strict else "".join(_obstacle(obstacle, strict))
        for obstacle in robot_map.obstacles
    )
    return head + "".join(body) + ("" if strict else robot_map.tail)


def format_number(value: float) -> str:
    """Return metres in centimetres with no trailing zeros, such as ``-4`` or ``12.1``."""
    text = f"{value:.2f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def _head(robot_map: RobotMap, strict: bool) -> Iterator[str]:
    if not strict:
        for key, value in robot_map.meta.items():
            yield f"%{key} {' '.join(value.split())}\n"
    yield "border;\n"
    yield _point(*robot_map.border.left_upper)
    yield _point(*robot_map.border.right_lower)
    yield "#\n"


def _obstacle(obstacle: Obstacle, strict: bool) -> Iterator[str]:
    ext = "" if strict or not obstacle.ext else _ext(obstacle.ext)
    count = len(obstacle.a)
    yield "obstacle;\n"
    yield f"{obstacle.id};{int(obstacle.shape_type)};{count};{escape(obstacle.semantics)};{ext}\n#\n"
    for row in range(count):
        yield _point(*obstacle.a[row])
        yield _point(*obstacle.b[row])
        flag = "1" if obstacle.outdoor[row] else "0"
        label = escape(obstacle.segment_semantics[row])
        yield f"{format_number(obstacle.height[row])};{flag};{label};\n#\n"


def _point(x: float, y: float) -> str:
    return f"{format_number(x)};{format_number(y)};\n"


def _ext(ext: dict[str, str]) -> str:
    return ",".join(f"{escape_value(key)}={escape_value(value)}" for key, value in ext.items()) + ";"

"""Reading the text format, line by line, keeping how everything was written."""

from __future__ import annotations

import math
import re
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from ..counting import counted
from .errors import TextError
from .labels import read_ext, unescape
from .model import Border, Obstacle, RobotMap, ShapeType

# A digit can be matched in one way only: with two, a number of n digits that ends wrongly costs n² steps.
_DECIMAL = r"[+-]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][+-]?\d+)?"
_NUMBER = re.compile(_DECIMAL, re.ASCII)
_SEGMENT = re.compile(
    rf"({_DECIMAL});({_DECIMAL});\n({_DECIMAL});({_DECIMAL});\n({_DECIMAL});([01]);([^;%\n]*);\n#\n", re.ASCII
)
"""The four lines of a segment without blanks, comments and extras, as writers make them."""
_MOST_FIELDS = 5
"""of a line; what has more is refused without being taken apart further."""
_INTEGER = re.compile(r"[+-]?\d{1,18}", re.ASCII)
_META = re.compile(r"%\s*(\S+)(?:\s+(.*))?")
_BLANKS = " \t\r\n"

Segment = tuple[tuple[float, float], tuple[float, float], float, bool, str, dict[str, str]]


def read_text(text: str) -> RobotMap:
    """Return the map in ``text``; raises TextError naming the line, what was expected and what was found."""
    return _Reader(text).read()


class _Reader:
    """Goes through the lines once. Lines that are empty or only a comment are passed over and kept."""

    def __init__(self, text: str) -> None:
        # Not splitlines: a label may hold one of the other characters that it takes for line ends.
        self._lines: list[str] = re.findall(r"[^\n]*\n|[^\n]+", text)
        self._next = 0
        self._place = "the head of the map"
        self._warnings: list[str] = []

    def read(self) -> RobotMap:
        meta = self._read_meta()
        border = self._read_border()
        head = "".join(self._lines[: self._next])
        obstacles = []
        while self._skip_comments() < len(self._lines):
            obstacles.append(self._read_obstacle())
        tail_start = len(head) + sum(len(o.text or "") for o in obstacles)
        self._warn_of_repeated_ids(obstacles)
        robot_map = RobotMap(border, tuple(obstacles), meta, tuple(self._warnings))
        object.__setattr__(robot_map, "head", head)
        object.__setattr__(robot_map, "tail", "".join(self._lines)[tail_start:])
        return robot_map

    def _read_meta(self) -> dict[str, str]:
        meta = {}
        for line in self._lines[: self._skip_comments()]:
            match = _META.match(line.strip())
            if match:
                meta[match[1]] = (match[2] or "").strip()
        return meta

    def _read_border(self) -> Border:
        self._keyword("border;")
        left, upper = self._point()
        right, lower = self._point()
        self._separator()
        if right <= left or upper <= lower:
            self._fail_at(
                self._next - 1,
                "the left-upper corner of the border, then the right-lower one",
                f"({left}, {upper}) and ({right}, {lower})",
            )
        return Border(left, lower, right, upper)

    def _read_obstacle(self) -> Obstacle:
        start = self._next
        self._skip_comments()
        self._place = "an obstacle"
        self._keyword("obstacle;")
        id, shape_type, declared, semantics, ext = self._obstacle_line()
        self._place = f"obstacle {id}"
        line_number = self._next
        self._separator()
        segments = self._segments()
        if declared and not segments and self._skip_comments() >= len(self._lines):
            self._line(f"the first of {declared} segments")
        if len(segments) != declared:
            self._warnings.append(
                f"line {line_number}: obstacle {id} declares {counted(declared, 'segment')}, and "
                f"{len(segments)} came"
            )
        obstacle = _obstacle(id, shape_type, semantics, ext, segments)
        object.__setattr__(obstacle, "text", "".join(self._lines[start : self._next]))
        return obstacle

    def _obstacle_line(self) -> tuple[int, ShapeType, int, str, dict[str, str]]:
        expected = "'id;ST;NS;semantics;' with ST from 1 to 6"
        number, fields = self._fields(expected)
        if len(fields) not in (4, 5):
            self._fail_at(number, expected, self._lines[number].strip())
        if not all(_INTEGER.fullmatch(value) for value in fields[:3]) or fields[1] not in set("123456"):
            self._fail_at(number, expected, self._lines[number].strip())
        ext = self._ext(number, fields[4]) if len(fields) == 5 else {}
        return int(fields[0]), ShapeType(int(fields[1])), int(fields[2]), unescape(fields[3]), ext

    def _ext(self, number: int, text: str) -> dict[str, str]:
        try:
            return read_ext(text)
        except ValueError:
            self._fail_at(number, "'key=value,...;' after the semantics", text)

    def _segments(self) -> list[Segment]:
        segments = []
        while (segment := self._plain_segment()) or not self._at_obstacle_or_end():
            segments.append(segment or self._segment())
        return segments

    def _plain_segment(self) -> Segment | None:
        """Return the next segment if it stands in four lines as writers make them, read in one step."""
        match = _SEGMENT.fullmatch("".join(self._lines[self._next : self._next + 4]))
        if match is None:
            return None
        ax, ay, bx, by, height = map(float, match.group(1, 2, 3, 4, 5))
        if not math.isfinite(ax + ay + bx + by + height):
            return None
        self._next += 4
        return (ax, ay), (bx, by), height, match[6] == "1", unescape(match[7].strip(_BLANKS)), {}

    def _segment(self) -> Segment:
        a, b = self._point(), self._point()
        expected = "'height;0 or 1;semantics;'"
        number, fields = self._fields(expected)
        if len(fields) not in (3, 4) or fields[1] not in ("0", "1"):
            self._fail_at(number, expected, self._lines[number].strip())
        height = self._number(number, fields[0], expected)
        ext = self._ext(number, fields[3]) if len(fields) == 4 else {}
        self._separator()
        return a, b, height, fields[1] == "1", unescape(fields[2]), ext

    def _point(self) -> tuple[float, float]:
        expected = "a point such as '4.53;12.10;'"
        number, fields = self._fields(expected)
        if len(fields) != 2:
            self._fail_at(number, expected, self._lines[number].strip())
        return self._number(number, fields[0], expected), self._number(number, fields[1], expected)

    def _number(self, number: int, text: str, expected: str) -> float:
        value = float(text) if _NUMBER.fullmatch(text) else math.nan
        if not math.isfinite(value):
            self._fail_at(number, f"{expected} with finite numbers", self._lines[number].strip())
        return value

    def _fields(self, expected: str) -> tuple[int, list[str]]:
        """Return the next line's number and what stands before each of its semicolons."""
        number, content = self._line(expected)
        fields = [value.strip(_BLANKS) for value in content.split(";", _MOST_FIELDS + 1)]
        if fields.pop() and len(fields) <= _MOST_FIELDS:
            self._fail_at(number, f"{expected}, closed by ';'", self._lines[number].strip())
        return number, fields

    def _keyword(self, word: str) -> None:
        number, content = self._line(repr(word))
        if content != word:
            self._fail_at(number, repr(word), self._lines[number].strip())

    def _separator(self) -> None:
        self._keyword("#")

    def _line(self, expected: str) -> tuple[int, str]:
        number = self._skip_comments()
        if number >= len(self._lines):
            self._fail_cut_off(expected)
        self._next = number + 1
        return number, self._content(number)

    def _skip_comments(self) -> int:
        """Return the number of the next line that says something, and go there."""
        number = self._next
        while number < len(self._lines) and not self._content(number):
            number += 1
        return number

    def _content(self, number: int) -> str:
        """Return what a line says apart from its comment."""
        return self._lines[number].partition("%")[0].strip(_BLANKS)

    def _at_obstacle_or_end(self) -> bool:
        number = self._skip_comments()
        return number >= len(self._lines) or self._content(number) == "obstacle;"

    def _fail_cut_off(self, expected: str) -> NoReturn:
        raise TextError(
            f"line {len(self._lines)}: the text ends in {self._place} where {expected} should follow; "
            "it was cut off, so get the map once more"
        )

    def _fail_at(self, number: int, expected: str, found: str) -> NoReturn:
        # A last line without a line break is half a line, not a wrong one.
        if number == len(self._lines) - 1 and not self._lines[number].endswith("\n"):
            self._fail_cut_off(expected)
        raise TextError(f"line {number + 1}: in {self._place}, expected {expected}, found {found[:80]!r}")

    def _warn_of_repeated_ids(self, obstacles: list[Obstacle]) -> None:
        seen: set[int] = set()
        for obstacle in obstacles:
            if obstacle.id in seen:
                self._warnings.append(f"obstacle id {obstacle.id} is used more than once")
            seen.add(obstacle.id)


def _column(values: list[Any], dtype: type) -> NDArray[Any]:
    """Return an array that cannot be written to: the obstacle is written back as it was read."""
    column: NDArray[Any] = np.array(values, dtype=dtype)
    column.flags.writeable = False
    return column


_NO_POINTS = _column([], float).reshape(-1, 2)
_NO_NUMBERS = _column([], float)
_NO_FLAGS = _column([], bool)
"""Columns of all obstacles without segments: five arrays of each one's own are half a kilobyte."""


def _obstacle(
    id: int, shape_type: ShapeType, semantics: str, ext: dict[str, str], segments: list[Segment]
) -> Obstacle:
    if not segments:
        return Obstacle(
            id,
            shape_type,
            semantics,
            _NO_POINTS,
            _NO_POINTS,
            _NO_NUMBERS,
            _NO_FLAGS,
            segment_semantics=(),
            ext=ext,
        )
    return Obstacle(
        id=id,
        shape_type=shape_type,
        semantics=semantics,
        a=_column([s[0] for s in segments], float).reshape(-1, 2),
        b=_column([s[1] for s in segments], float).reshape(-1, 2),
        height=_column([s[2] for s in segments], float),
        outdoor=_column([s[3] for s in segments], bool),
        segment_semantics=tuple(s[4] for s in segments),
        ext=ext,
        segment_ext=tuple(s[5] for s in segments) if any(s[5] for s in segments) else (),
    )

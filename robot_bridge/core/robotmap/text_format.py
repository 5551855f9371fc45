"""Text format of robot maps (paper 1, Fig. 2; ``docs/robot-map.md``): writer and reader."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from itertools import islice, zip_longest
from operator import sub
from typing import Any, NoReturn

import numpy as np
from numpy.typing import NDArray

from ..errors import MapTextError, RobotMapError, counted
from .model import Border, BuiltObstacles, Obstacle, RobotMap, ShapeType

# --- Labels inside the text format: special characters are written ``\HH`` or ``\uHHHH``

# The C1 controls and the line and paragraph separators end a line for some readers; lone surrogates are no
# UTF-8; blanks at either end would be read as indentation.
_ALWAYS = r"[\x00-\x1f\x7f-\x9f\u2028\u2029\ud800-\udfff\\;%#]|^ | $"
_RESERVED = re.compile(_ALWAYS)
_RESERVED_IN_KEY = re.compile(rf"{_ALWAYS}|[=,]")
_RESERVED_IN_VALUE = re.compile(rf"{_ALWAYS}|=")
_ESCAPED = re.compile(r"\\(?:([0-9a-f]{2})|u([0-9a-f]{4}))")


def escape(text: str) -> str:
    """Return labels separated by commas in written form."""
    return _RESERVED.sub(_code, text)


def escape_key(text: str) -> str:
    """Return a key of ``ext`` in written form: commas and equal signs are special there."""
    return _RESERVED_IN_KEY.sub(_code, text)


def escape_value(text: str) -> str:
    """Return a value of ``ext`` in written form: it may hold commas, as in the normal ``n=0,0.08,1``."""
    return _RESERVED_IN_VALUE.sub(_code, text)


def unescape(text: str) -> str:
    """Return the label of a written form."""
    return _ESCAPED.sub(lambda match: chr(int(match[1] or match[2], 16)), text)


def write_ext(ext: Mapping[str, str]) -> str:
    """Return extras as written after the semantics, ``key=value,...;``, or an empty text."""
    if not ext:
        return ""
    return ",".join(f"{escape_key(key)}={escape_value(value)}" for key, value in ext.items()) + ";"


def read_ext(text: str) -> dict[str, str]:
    """Return the extras in ``text``, which is without its semicolon; raises ValueError if it has no key."""
    if not text:
        return {}
    pieces = text.split(",")
    # A value may hold commas, as the normal n=nx,ny,nz does: a piece without "=" belongs to the one before.
    begins = [place for place, piece in enumerate(pieces) if "=" in piece]
    if not begins or begins[0]:
        raise ValueError(text)
    pairs = (",".join(pieces[begin:end]).partition("=") for begin, end in zip_longest(begins, begins[1:]))
    return {unescape(key): unescape(value) for key, _, value in pairs}


def _code(match: re.Match[str]) -> str:
    code = ord(match[0])
    return f"\\{code:02x}" if code < 0x100 else f"\\u{code:04x}"


# --- Reading the text format line by line, preserving the original spelling ---

# A digit can be matched in one way only: with two, a malformed number of n digits would cost n² steps.
_DECIMAL = r"[+-]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][+-]?\d+)?"
_NUMBER = re.compile(_DECIMAL, re.ASCII)
_SEGMENT = re.compile(
    rf"({_DECIMAL});({_DECIMAL});\n({_DECIMAL});({_DECIMAL});\n({_DECIMAL});([01]);([^;%\n]*);\n#\n", re.ASCII
)
"""The four lines of a segment without blanks, comments and extras, as writers make them."""
_MOST_FIELDS = 5
"""of a line; one with more is refused without further parsing."""
_INTEGER = re.compile(r"[+-]?\d{1,18}", re.ASCII)
_META = re.compile(r"%\s*(\S+)(?:\s+(.*))?")
_BLANKS = " \t\r\n"

Segment = tuple[tuple[float, float], tuple[float, float], float, bool, str, dict[str, str]]


def read_text(text: str) -> RobotMap:
    """Return the map in ``text``; raises MapTextError with the line, what was expected and what was found."""
    return _Reader(text).read()


class _Reader:
    """Reads the lines once. Empty lines and comment lines are skipped and kept."""

    def __init__(self, text: str) -> None:
        # Not splitlines: a label may hold one of the other characters that it treats as line ends.
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
        obstacle = _parsed_obstacle(id, shape_type, semantics, ext, segments)
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
        """Return the next segment if it has the four plain lines of writers, read in one step."""
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
        """Return the next line's number and the fields before its semicolons."""
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
        """Advance to the next line with content, and return its number."""
        number = self._next
        while number < len(self._lines) and not self._content(number):
            number += 1
        return number

    def _content(self, number: int) -> str:
        """Return a line without its comment."""
        return self._lines[number].partition("%")[0].strip(_BLANKS)

    def _at_obstacle_or_end(self) -> bool:
        number = self._skip_comments()
        return number >= len(self._lines) or self._content(number) == "obstacle;"

    def _fail_cut_off(self, expected: str) -> NoReturn:
        raise MapTextError(
            f"line {len(self._lines)}: the text ends in {self._place} where {expected} should follow; "
            "it was cut off, so get the map once more"
        )

    def _fail_at(self, number: int, expected: str, found: str) -> NoReturn:
        # A last line without a line break is a truncated line, not a wrong one.
        if number == len(self._lines) - 1 and not self._lines[number].endswith("\n"):
            self._fail_cut_off(expected)
        raise MapTextError(f"line {number + 1}: in {self._place}, expected {expected}, found {found[:80]!r}")

    def _warn_of_repeated_ids(self, obstacles: list[Obstacle]) -> None:
        seen: set[int] = set()
        for obstacle in obstacles:
            if obstacle.id in seen:
                self._warnings.append(f"obstacle id {obstacle.id} is used more than once")
            seen.add(obstacle.id)


def _column(values: list[Any], dtype: type) -> NDArray[Any]:
    """Return a read-only array: the obstacle is written back as it was read."""
    column: NDArray[Any] = np.array(values, dtype=dtype)
    column.flags.writeable = False
    return column


_NO_POINTS = _column([], float).reshape(-1, 2)
_NO_NUMBERS = _column([], float)
_NO_FLAGS = _column([], bool)
"""Columns of all obstacles without segments: five arrays of each one's own are half a kilobyte."""


def _parsed_obstacle(
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


# --- The text format of the paper's Fig. 2, extended as ``docs/robot-map.md`` says; writing ---

__all__ = ["read_text", "write_obstacles", "write_text"]

_OBSTACLES = 256
"""obstacles whose segments are formatted together."""
_BLOCK = 4096
"""segments converted to Python numbers at once, which take five times their memory."""
_PLAIN_FROM, _PLAIN_BELOW = 1e-4, 1e16
"""Between these Python writes a number without an exponent."""
_MOST_CENTIMETRES = 1e13
"""Below this, two decimals of metres distinguish consecutive centimetres."""
_HUNDREDTHS = [f"{hundredths / 100:g}"[1:] + ";" for hundredths in range(100)]
"""The decimals after the whole metres."""


def write_text(robot_map: RobotMap, *, strict: bool = False) -> str:
    """Return a map as text.

    Obstacles read from a text are written back byte for byte. ``strict`` writes only what Fig. 2 has: no
    leading lines, no ``ext``, no comments. Raises RobotMapError for a number that is not finite and for a
    leading line whose key is not one word.
    """
    parts = ["".join(_head(robot_map, strict)) if strict or robot_map.head is None else robot_map.head]
    for text in _texts(robot_map.obstacles, strict):
        # A text may end without a line break, and an obstacle read there may be written elsewhere.
        if not parts[-1].endswith("\n"):
            parts.append("\n")
        parts.append(text)
    return "".join(parts) + ("" if strict else robot_map.tail)


def write_obstacles(obstacles: Sequence[Obstacle]) -> str:
    """Return the text that :func:`write_text` writes for obstacles that were built, not read."""
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
    """Yield the text of each obstacle, original or newly written."""
    if isinstance(obstacles, BuiltObstacles):
        yield from _built_texts(obstacles, strict)
        return
    for begin in range(0, len(obstacles), _OBSTACLES):
        some = obstacles[begin : begin + _OBSTACLES]
        numbers = _numbers([one for one in some if strict or one.text is None])
        for obstacle in some:
            as_read = None if strict else obstacle.text
            yield "".join(_obstacle_lines(obstacle, numbers, strict)) if as_read is None else as_read


def _obstacle_lines(obstacle: Obstacle, numbers: Iterator[str], strict: bool) -> Iterator[str]:
    """Yield an obstacle's lines; ``numbers`` yields the text before the labels of each of its segments."""
    ext = {} if strict else obstacle.ext
    count = len(obstacle.a)
    yield _obstacle_head(obstacle.id, obstacle.shape_type, count, obstacle.semantics, ext)
    extras = () if strict else obstacle.segment_ext
    if not extras and not any(obstacle.segment_semantics):
        for number, outdoor in zip(islice(numbers, count), obstacle.outdoor.tolist(), strict=True):
            yield f"{number}{'01'[outdoor]};;\n#\n"
        return
    rows = zip(islice(numbers, count), obstacle.outdoor.tolist(), obstacle.segment_semantics, strict=True)
    for (number, outdoor, semantics), ext_ in zip_longest(rows, extras):
        yield f"{number}{'01'[outdoor]};{escape(semantics)};{write_ext(ext_ or {})}\n#\n"


def _built_texts(built: BuiltObstacles, strict: bool) -> Iterator[str]:
    """Yield the text of each obstacle."""
    values = np.column_stack([built.a, built.b, built.height])
    numbers = zip(_all_number_lines(values), built.outdoor.tolist(), strict=True)
    lines = (f"{number}{'01'[outdoor]};;\n#\n" for number, outdoor in numbers)
    counts = map(sub, built.offsets[1:], built.offsets)
    heads = zip(built.ids, built.shape_types, counts, built.semantics, built.ext, strict=True)
    for id, shape_type, count, semantics, ext in heads:
        head = _obstacle_head(id, shape_type, count, semantics, {} if strict else ext)
        yield "".join([head, *islice(lines, count)])


def _obstacle_head(id: int, shape_type: ShapeType, count: int, semantics: str, ext: Mapping[str, str]) -> str:
    return f"obstacle;\n{id};{shape_type:d};{count};{escape(semantics)};{write_ext(ext)}\n#\n"


def _numbers(obstacles: Sequence[Obstacle]) -> Iterator[str]:
    """Yield the text of the two ends and the height of each segment of ``obstacles``."""
    if not obstacles:
        return
    ends = [np.concatenate(side) for side in zip(*((one.a, one.b) for one in obstacles), strict=True)]
    yield from _all_number_lines(np.column_stack([*ends, np.concatenate([one.height for one in obstacles])]))


def _all_number_lines(values: NDArray[Any]) -> Iterator[str]:
    """Yield a text for each row of ``values``, (n, 5), block by block."""
    for begin in range(0, len(values), _BLOCK):
        yield from _number_lines(values[begin : begin + _BLOCK])


def _number_lines(values: NDArray[Any]) -> Iterator[str]:
    """Yield a text for each row of ``values``, (n, 5)."""
    size = np.abs(values)
    if not ((size < _PLAIN_BELOW) & ((size >= _PLAIN_FROM) | (size == 0))).all():
        for ax, ay, bx, by, height in values.tolist():
            yield f"{_point(ax, ay)}{_point(bx, by)}{format_number(height)};"
        return
    centimetres = np.rint(values * 100)
    if ((centimetres / 100 == values) & (centimetres >= 0) & (centimetres < _MOST_CENTIMETRES)).all():
        rows = zip(*(part.tolist() for part in np.divmod(centimetres.astype(np.int64), 100)), strict=True)
        ends = _HUNDREDTHS
        for (ax, ay, bx, by, height), (i, j, k, m, n) in rows:
            yield f"{ax}{ends[i]}{ay}{ends[j]}\n{bx}{ends[k]}{by}{ends[m]}\n{height}{ends[n]}"
        return
    # Adding zero removes the sign of -0.0.
    for ax, ay, bx, by, height in (values + 0.0).tolist():
        yield f"{ax};{ay};\n{bx};{by};\n{height};".replace(".0;", ";")


def _point(x: float, y: float) -> str:
    return f"{format_number(x)};{format_number(y)};\n"

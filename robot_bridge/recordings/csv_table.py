"""CSV tables of positions: columns by name, one row per position or columns per robot."""

from __future__ import annotations

import csv
import gzip
import math
import re
import zlib
from collections.abc import Generator, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import IO

from . import tracks

# --- Columns of a table: one row per position, or columns per robot ---

KNOWN = ("time", "robot", "x", "y", "lat", "lon", "theta", "v")
"""Kinds of columns; each has this name unless the settings give another."""
ROBOT = "{robot}"
"""Placeholder of the robot's name in the names of columns per robot."""
THETA_UNITS = ("rad", "deg", "compass")
"""``compass`` is degrees clockwise from north, the others are counter-clockwise from the x axis."""


@dataclass(frozen=True)
class TableForm:
    """``columns`` are names of columns by kind, if they differ from the kind."""

    columns: Mapping[str, str]
    delimiter: str = ","
    time_unit: str = "s"
    theta_unit: str = "rad"

    def check(self) -> None:
        """Raise RecordingError, beginning with the key, for invalid values."""
        for key in self.columns:
            if key not in KNOWN:
                raise tracks.RecordingError(f"columns.{key} is not known; known are {', '.join(KNOWN)}")
        if len(self.delimiter) != 1:
            raise tracks.RecordingError(f"delimiter = {self.delimiter!r}: give one character")
        if self.time_unit not in tracks.UNITS:
            raise tracks.RecordingError(
                f"time_unit = {self.time_unit!r}: give one of {', '.join(tracks.UNITS)}"
            )
        if self.theta_unit not in THETA_UNITS:
            raise tracks.RecordingError(
                f"theta_unit = {self.theta_unit!r}: give one of {', '.join(THETA_UNITS)}"
            )
        if {"x", "y"} & self.columns.keys() and {"lat", "lon"} & self.columns.keys():
            raise tracks.RecordingError("columns: give x and y, or lat and lon")

    def radians(self, value: float) -> float:
        """Return a heading of the table as radians counter-clockwise from the x axis, in [-π, π]."""
        turned = {"rad": value, "deg": math.radians(value), "compass": math.radians(90.0 - value)}
        return math.remainder(turned[self.theta_unit], math.tau)


@dataclass(frozen=True)
class RobotColumns:
    """Indices of the columns with the position of a robot, None for missing ones.

    ``name`` is the robot's name, None if it is in column ``robot``.
    """

    name: str | None
    robot: int | None
    time: int
    x: int
    y: int
    theta: int | None
    v: int | None
    is_earth: bool


def robot_columns(head: Sequence[str], form: TableForm, alone: str) -> list[RobotColumns]:
    """Return the columns of each robot's position in the rows below ``head``.

    A table without a column for the robot belongs to one robot, named ``alone``.

    :raises RecordingError: for missing columns, listing the existing ones.
    """
    columns, given = dict(form.columns), form.columns
    is_earth = "lat" in given or "lon" in given or ("x" not in given and "x" not in head and "lat" in head)
    first, second = ("lon", "lat") if is_earth else ("x", "y")
    if ROBOT in columns.get(first, ""):
        names = _robots(columns[first], head)
    else:
        names = [None if "robot" in given or "robot" in head else alone]
    return [_of_robot(name, head, columns, (first, second)) for name in names]


def _robots(pattern: str, head: Sequence[str]) -> list[str | None]:
    before, _, behind = pattern.partition(ROBOT)
    form = re.compile(f"{re.escape(before)}(.+){re.escape(behind)}")
    names: list[str | None] = [found[1] for found in map(form.fullmatch, head) if found]
    if not names:
        raise tracks.RecordingError(f"no column is called like {pattern}; {_there(head)}")
    return names


def _of_robot(
    name: str | None, head: Sequence[str], columns: dict[str, str], place: tuple[str, str]
) -> RobotColumns:
    def find(key: str) -> int | None:
        column = columns.get(key, key).replace(ROBOT, name or "")
        if column in head:
            return head.index(column)
        if key in columns:
            raise tracks.RecordingError(f"columns.{key}: no column is called {column}; {_there(head)}")
        return None

    def need(key: str) -> int:
        found = find(key)
        if found is None:
            raise tracks.RecordingError(
                f"no column is called {key}; name the one that holds it with columns.{key}; {_there(head)}"
            )
        return found

    robot = find("robot") if name is None else None
    x, y = need(place[0]), need(place[1])
    return RobotColumns(name, robot, need("time"), x, y, find("theta"), find("v"), place[0] == "lon")


def _there(head: Sequence[str]) -> str:
    names = ", ".join(column[:40] for column in head[:30])
    return f"there are {names}{', …' if len(head) > 30 else ''}"


# --- Positions from CSV, also compressed: one row per position (long), or columns per robot (wide)

LONGEST_LINE = 1 << 20
"""characters."""
LONGEST_NAME = 128
MOST_ROWS = 2 * tracks.MOST_SAMPLES
"""rows that are read, including empty and unusable ones."""


def read_csv(file: Path, form: TableForm, remarks: tracks.Remarks) -> tracks.Source:
    """Return the positions in a table; unusable rows are recorded in ``remarks``.

    :raises RecordingError: for a file that cannot be opened, and columns that do not match.
    """
    rows = _rows(file, form.delimiter, remarks)
    head = [name.strip() for _, name_row in [next(rows, (0, []))] for name in name_row]
    if not head:
        rows.close()
        raise tracks.RecordingError(
            f"{file}: row 1: no names of columns stand there; the file is empty or cut off"
        )
    try:
        robots = robot_columns(head, form, file.name.split(".")[0])
    except tracks.RecordingError as error:
        rows.close()
        raise tracks.RecordingError(f"{file}: row 1: {error}") from None
    table = _Table(file, form, head, robots, remarks)
    return tracks.Source(tracks.WGS84 if robots[0].is_earth else None, table.samples(rows))


class _Table:
    def __init__(
        self,
        file: Path,
        form: TableForm,
        head: Sequence[str],
        robots: Sequence[RobotColumns],
        remarks: tracks.Remarks,
    ) -> None:
        self._file, self._form, self._head = file, form, head
        self._robots, self._remarks = robots, remarks

    def samples(self, rows: Iterator[tuple[int, list[str]]]) -> Iterator[tracks.Sample]:
        """Yield the positions of rows; unusable ones are recorded."""
        for row, cells in rows:
            if not cells:
                continue
            if len(cells) != len(self._head):
                # An unfinished last row of a recording has too few.
                what = f"{len(cells)} columns stand there, and row 1 names {len(self._head)}"
                self._remarks.add(f"{self._file}: row {row}", what)
                continue
            for robot in self._robots:
                try:
                    sample = self._sample(row, cells, robot)
                except tracks.ValueRefusedError as error:
                    self._remarks.add(f"{self._file}: row {row}", str(error))
                    continue
                if sample is not None:
                    yield sample

    def _sample(self, row: int, cells: Sequence[str], robot: RobotColumns) -> tracks.Sample | None:
        if robot.name is not None and len(self._robots) > 1 and not (cells[robot.x] or cells[robot.y]):
            return None
        x, y = tracks.place_bounds(robot.is_earth)
        return tracks.Sample(
            row,
            self._name(cells, robot),
            tracks.seconds_of(cells[robot.time], self._head[robot.time], self._form.time_unit),
            tracks.number(cells[robot.x], self._head[robot.x], x),
            tracks.number(cells[robot.y], self._head[robot.y], y),
            self._form.radians(self._optional(cells, robot.theta, tracks.THETA_BOUNDS)),
            self._optional(cells, robot.v, tracks.SPEED_BOUNDS),
        )

    def _name(self, cells: Sequence[str], robot: RobotColumns) -> str:
        if robot.robot is None:
            return str(robot.name)
        name = cells[robot.robot].strip()
        if not name or len(name) > LONGEST_NAME:
            raise tracks.ValueRefusedError(
                self._head[robot.robot], f"{tracks.shown(name)} is no name of a robot"
            )
        return name

    def _optional(self, cells: Sequence[str], column: int | None, bounds: tuple[float, float]) -> float:
        if column is None or not cells[column].strip():
            return tracks.NOTHING
        return tracks.number(cells[column], self._head[column], bounds)


def _rows(
    file: Path, delimiter: str, remarks: tracks.Remarks, most: int = MOST_ROWS
) -> Generator[tuple[int, list[str]], None, None]:
    """Yield rows with their numbers, as far as the file is readable."""
    lines = _lines(file)
    reader = csv.reader(lines, delimiter=delimiter)
    row = 0
    try:
        for row, cells in enumerate(reader, 1):
            if row > most:
                raise tracks.RecordingError(f"{file}: more than {most} rows; part the file")
            yield row, cells
    except (EOFError, zlib.error, OSError, csv.Error) as error:
        text = getattr(error, "strerror", None) or error
        if row == 0:
            raise tracks.RecordingError(f"{file} cannot be read: {text}") from None
        remarks.add(f"{file}: behind row {row}", f"the file is cut off or damaged: {text}")
    finally:
        lines.close()


def _lines(file: Path) -> Generator[str, None, None]:
    with _opened(file) as text:
        while line := text.readline(LONGEST_LINE):
            if len(line) == LONGEST_LINE:
                raise csv.Error(f"a line has more than {LONGEST_LINE} characters")
            yield line


def _opened(file: Path) -> IO[str]:
    # Invalid UTF-8 is reported for its cell.
    if file.suffix.lower() == ".gz":
        return gzip.open(file, "rt", encoding="utf-8-sig", errors="replace", newline="")
    return file.open(encoding="utf-8-sig", errors="replace", newline="")

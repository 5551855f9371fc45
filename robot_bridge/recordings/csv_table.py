"""Positions out of CSV, also compressed: one row a position (long), or columns for each robot (wide)."""

from __future__ import annotations

import csv
import gzip
import zlib
from collections.abc import Generator, Iterator, Sequence
from pathlib import Path
from typing import IO

from .columns import RobotColumns, TableForm, robot_columns
from .errors import RecordingError
from .samples import (
    MOST_SAMPLES,
    NOTHING,
    SPEED_BOUNDS,
    THETA_BOUNDS,
    WGS84,
    Remarks,
    Sample,
    Source,
    ValueRefusedError,
    number,
    place_bounds,
    shown,
)
from .times import seconds_of

LONGEST_LINE = 1 << 20
"""characters."""
LONGEST_NAME = 128
MOST_ROWS = 2 * MOST_SAMPLES
"""rows that are gone through, empty ones and such that cannot be used among them."""


def read_csv(file: Path, form: TableForm, remarks: Remarks) -> Source:
    """Return the positions in a table; rows that cannot be used are noted in ``remarks``.

    :raises RecordingError: for a file that cannot be opened, and columns that do not fit.
    """
    rows = _rows(file, form.delimiter, remarks)
    head = [name.strip() for _, name_row in [next(rows, (0, []))] for name in name_row]
    if not head:
        rows.close()
        raise RecordingError(f"{file}: row 1: no names of columns stand there; the file is empty or cut off")
    try:
        robots = robot_columns(head, form, file.name.split(".")[0])
    except RecordingError as error:
        rows.close()
        raise RecordingError(f"{file}: row 1: {error}") from None
    table = _Table(file, form, head, robots, remarks)
    return Source(WGS84 if robots[0].is_earth else None, table.samples(rows))


class _Table:
    def __init__(
        self,
        file: Path,
        form: TableForm,
        head: Sequence[str],
        robots: Sequence[RobotColumns],
        remarks: Remarks,
    ) -> None:
        self._file, self._form, self._head = file, form, head
        self._robots, self._remarks = robots, remarks

    def samples(self, rows: Iterator[tuple[int, list[str]]]) -> Iterator[Sample]:
        """Yield the positions of rows; those that cannot be used are noted."""
        for row, cells in rows:
            if not cells:
                continue
            if len(cells) != len(self._head):
                # A last row that the recording did not finish has too few.
                what = f"{len(cells)} columns stand there, and row 1 names {len(self._head)}"
                self._remarks.add(f"{self._file}: row {row}", what)
                continue
            for robot in self._robots:
                try:
                    sample = self._sample(row, cells, robot)
                except ValueRefusedError as error:
                    self._remarks.add(f"{self._file}: row {row}", str(error))
                    continue
                if sample is not None:
                    yield sample

    def _sample(self, row: int, cells: Sequence[str], robot: RobotColumns) -> Sample | None:
        if robot.name is not None and len(self._robots) > 1 and not (cells[robot.x] or cells[robot.y]):
            return None
        x, y = place_bounds(robot.is_earth)
        return Sample(
            row,
            self._name(cells, robot),
            seconds_of(cells[robot.time], self._head[robot.time], self._form.time_unit),
            number(cells[robot.x], self._head[robot.x], x),
            number(cells[robot.y], self._head[robot.y], y),
            self._form.radians(self._optional(cells, robot.theta, THETA_BOUNDS)),
            self._optional(cells, robot.v, SPEED_BOUNDS),
        )

    def _name(self, cells: Sequence[str], robot: RobotColumns) -> str:
        if robot.robot is None:
            return str(robot.name)
        name = cells[robot.robot].strip()
        if not name or len(name) > LONGEST_NAME:
            raise ValueRefusedError(self._head[robot.robot], f"{shown(name)} is no name of a robot")
        return name

    def _optional(self, cells: Sequence[str], column: int | None, bounds: tuple[float, float]) -> float:
        if column is None or not cells[column].strip():
            return NOTHING
        return number(cells[column], self._head[column], bounds)


def _rows(
    file: Path, delimiter: str, remarks: Remarks, most: int = MOST_ROWS
) -> Generator[tuple[int, list[str]], None, None]:
    """Yield rows with their numbers, as far as the file can be read."""
    lines = _lines(file)
    reader = csv.reader(lines, delimiter=delimiter)
    row = 0
    try:
        for row, cells in enumerate(reader, 1):
            if row > most:
                raise RecordingError(f"{file}: more than {most} rows; part the file")
            yield row, cells
    except (EOFError, zlib.error, OSError, csv.Error) as error:
        text = getattr(error, "strerror", None) or error
        if row == 0:
            raise RecordingError(f"{file} cannot be read: {text}") from None
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
    # What is no UTF-8 is seen in the cell where it stands.
    if file.suffix.lower() == ".gz":
        return gzip.open(file, "rt", encoding="utf-8-sig", errors="replace", newline="")
    return file.open(encoding="utf-8-sig", errors="replace", newline="")

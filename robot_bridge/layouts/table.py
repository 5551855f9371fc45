"""Cones from the rows of a table, such as a CSV file or a layer without geometry."""

from __future__ import annotations

import csv
import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..compass import theta_of
from ..known_names import told
from .cone import ORANGE, Cone
from .errors import TableError

_MOST_COLUMNS, _MOST_ROWS = 1000, 100_000
"""More than any table of cones has; what a file costs to read goes by its length up to there."""


@dataclass(frozen=True)
class Columns:
    """The names of the columns; an empty one is not there. ``heading`` is in degrees
    clockwise from the y axis.

    Rows count only where ``layout`` holds ``only``, when that is given.
    """

    x: str = "x_m"
    y: str = "y_m"
    id: str = ""
    order: str = ""
    heading: str = ""
    colour: str = ""
    role: str = ""
    layout: str = ""
    only: str = ""


def read_csv(file: Path) -> tuple[list[str], list[dict[str, str]]]:
    """Return the columns and the rows of a CSV file with a head line, in UTF-8.

    :raises TableError: naming file and row.
    """
    try:
        with file.open(encoding="utf-8-sig", newline="") as text:
            reader = csv.reader(text)
            head = next(reader, [])
            if len(head) > _MOST_COLUMNS:
                raise TableError(
                    f"{file.name} has {len(head)} columns, more than {_MOST_COLUMNS}: give a table of cones."
                )
            rows = list(_rows(reader, head, file.name))
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        reason = getattr(error, "strerror", None) or error
        raise TableError(
            f"{file} cannot be read ({reason}): give a CSV file in UTF-8 with a head line."
        ) from error
    return head, rows


def _rows(lines: Iterable[list[str]], head: list[str], name: str) -> Iterator[dict[str, str]]:
    """Yield the rows by column; the first that does not fit ends it, before the others are read."""
    for number, values in enumerate(filter(None, lines), 2):
        if len(values) != len(head):
            raise TableError(
                f"{name}, row {number}: it has not as many columns as the head line ({len(head)})."
            )
        if number > _MOST_ROWS + 1:
            raise TableError(f"{name} has more than {_MOST_ROWS} rows: part it into layouts.")
        yield dict(zip(head, values, strict=True))


def cones_of(
    rows: Iterable[Mapping[str, Any]], head: Sequence[str], columns: Columns, name: str, first: int = 2
) -> list[Cone]:
    """Return a cone for each of ``rows``; ``first`` is the number that people know the first one by.

    Without a column of ids, cones are named after ``name``; without one of orders they are placed as they
    come. Cones are sorted by order.

    :raises TableError: naming row and column, and what to do.
    """
    _check_columns(head, columns)
    kept = _wanted(list(enumerate(rows, first)), columns)
    cones = [_cone(_Row(number, row, columns), place, name) for place, (number, row) in enumerate(kept, 1)]
    _check_ids(cones, kept, columns)
    return sorted(cones, key=lambda cone: cone.order)


@dataclass(frozen=True)
class _Row:
    number: int
    values: Mapping[str, Any]
    columns: Columns

    def number_in(self, column: str) -> float:
        value = self.values[column]
        try:
            number = float(value)
        except (TypeError, ValueError):
            number = math.nan
        if not math.isfinite(number):
            raise TableError(f"Row {self.number}, column {column}: {value!r} is no number; correct it.")
        return number

    def text_in(self, column: str, otherwise: str) -> str:
        value = self.values[column] if column else None
        return str(value) if value not in (None, "") else otherwise


def _cone(row: _Row, place: int, name: str) -> Cone:
    columns = row.columns
    order = row.number_in(columns.order) if columns.order else float(place)
    if order != int(order):
        raise TableError(
            f"Row {row.number}, column {columns.order}: {order:g} is no whole number; correct it."
        )
    heading = row.number_in(columns.heading) if columns.heading else 0.0
    return Cone(
        id=row.text_in(columns.id, f"{name}-{place}"),
        order=int(order),
        x=row.number_in(columns.x),
        y=row.number_in(columns.y),
        theta=math.remainder(theta_of(heading), math.tau),
        colour=row.text_in(columns.colour, ORANGE),
        role=row.text_in(columns.role, ""),
    )


def _check_columns(head: Sequence[str], columns: Columns) -> None:
    wanted = (columns.x, columns.y, columns.id, columns.order, columns.heading, columns.colour, columns.role)
    if columns.only and not columns.layout:
        raise TableError(
            f"Of several layouts {columns.only!r} is to be taken, and no column says which row is of which: "
            f"choose it among {', '.join(head) or 'none'}."
        )
    for column in (*wanted, columns.layout):
        if column and column not in head:
            raise TableError(f"There is no column {column!r}: choose among {', '.join(head) or 'none'}.")


def _wanted(
    rows: list[tuple[int, Mapping[str, Any]]], columns: Columns
) -> list[tuple[int, Mapping[str, Any]]]:
    """Return the rows of the layout that is to be taken, all without one; each with its number."""
    if not rows:
        raise TableError("There is no row, so there is nothing to place.")
    if not columns.only:
        return rows
    kept = [(number, row) for number, row in rows if str(row[columns.layout]) == columns.only]
    if not kept:
        layouts = sorted({str(row[columns.layout]) for _, row in rows})
        raise TableError(
            f"No row has {columns.only!r} in column {columns.layout}, so there is nothing to place: choose "
            f"among {told(layouts)}."
        )
    return kept


def _check_ids(
    cones: Sequence[Cone], kept: Sequence[tuple[int, Mapping[str, Any]]], columns: Columns
) -> None:
    seen: dict[str, int] = {}
    for cone, (number, _) in zip(cones, kept, strict=True):
        if cone.id in seen:
            where = f"Row {number}, column {columns.id}" if columns.id else f"Row {number}"
            raise TableError(
                f"{where}: the id {cone.id!r} is that of row {seen[cone.id]} too; make it another."
            )
        seen[cone.id] = number

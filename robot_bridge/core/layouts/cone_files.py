"""Cones from files: tables, and track files of Formula Student simulators (YAML, SDF)."""

from __future__ import annotations

import csv
import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from xml.etree import ElementTree  # nosec B405 # entities are refused first

from ..errors import ConeTableError, installation, listed_names
from ..geometry import theta_of
from .layout import BIG_ORANGE, BLUE, COLOURS, ORANGE, YELLOW, Cone

# --- Cones from the track files of Formula Student simulators: YAML, SDF, and tables without a head line
# YAML as AMZ's fssim writes it: lists of points under ``cones_left`` (blue), ``cones_right`` (yellow),
# ``cones_orange`` and ``cones_orange_big``. SDF as Gazebo reads it: included models, models and links whose
# name or uri says ``cone``, with their colour. FSDS writes a table without a head line: colour, x, y and
# more.

X, Y, COLOUR = "x_m", "y_m", "colour"
HEAD = [X, Y, COLOUR]
"""The columns that every track is read into."""
LARGEST_FILE = 300_000
"""Bytes: more than ten thousand cones, and about two seconds for the slowest of the parsers."""
_GROUPS = {
    "cones_left": BLUE,
    "cones_right": YELLOW,
    "cones_orange": ORANGE,
    "cones_orange_big": BIG_ORANGE,
}
Rows = list[dict[str, str]]


def is_track(file: Path) -> bool:
    """Return whether ``file`` is a track in YAML or SDF, by its suffix."""
    return file.suffix.lower() in _READERS


def read_track(file: Path) -> Rows:
    """Return a row for each cone of a track in YAML or SDF.

    :raises ConeTableError: naming the file, the fault and the supported formats.
    """
    try:
        size = file.stat().st_size
        text = file.read_text(encoding="utf-8-sig") if size <= LARGEST_FILE else ""
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", None) or error
        raise ConeTableError(f"{file} cannot be read ({reason}): give a track in UTF-8.") from error
    if size > LARGEST_FILE:
        raise ConeTableError(
            f"{file.name} has {size} bytes, a track may have {LARGEST_FILE}: take out all but the cones."
        )
    rows = list(_READERS[file.suffix.lower()](text, file.name))
    if not rows:
        raise ConeTableError(
            f"{file.name} holds no cones: in YAML they stand under {', '.join(_GROUPS)}; in SDF in models or "
            "links with 'cone' in their name or uri."
        )
    return rows


def colour_table(head: list[str], rows: Rows) -> Rows | None:
    """Return a row for each cone of a table with columns of x and y for each colour; None for other tables.

    Such columns are called ``blue_x``, ``x_blue`` or ``blue x``, whatever the case; a place may be empty.
    """
    pairs = {colour: columns for colour in COLOURS if (columns := _pair_of(colour, head)) is not None}
    if not pairs:
        return None
    return [
        {X: row[x], Y: row[y], COLOUR: colour}
        for colour, (x, y) in pairs.items()
        for row in rows
        if str(row[x]).strip() or str(row[y]).strip()
    ]


def headless_rows(file: Path) -> Rows | None:
    """Return a row for each cone of a table whose first line is a cone: colour, x, y and more; else None.

    :raises ConeTableError: naming file and row.
    """
    try:
        with file.open(encoding="utf-8-sig", newline="") as text:
            lines = csv.reader(text)
            if not _is_cone(first := next(lines, [])):
                return None
            return [
                _headless_row(file.name, number, line)
                for number, line in enumerate([first, *lines], 1)
                if line
            ]
    except (OSError, UnicodeDecodeError, csv.Error):
        # The reader of tables with a head line reports the error.
        return None


def _headless_row(name: str, number: int, line: list[str]) -> dict[str, str]:
    if not _is_cone(line):
        raise ConeTableError(
            f"{name}, row {number}: a table without a head line has a colour ({', '.join(COLOURS)}), x and y "
            "in each row; correct it."
        )
    return {X: line[1], Y: line[2], COLOUR: _colour_in(line[0]) or line[0]}


def _is_cone(line: list[str]) -> bool:
    return len(line) >= 3 and _colour_in(line[0]) is not None and all(map(_is_number, line[1:3]))


def _yaml_rows(text: str, name: str) -> Iterator[dict[str, str]]:
    try:
        import yaml
    except ImportError as error:
        raise ConeTableError(
            f"{name} is YAML, and the Python package PyYAML is missing: install it {installation('PyYAML')}, "
            "or give the track as CSV."
        ) from error
    try:
        # Not libyaml's loader: deeply nested brackets crash its process.
        content = yaml.load(text, yaml.SafeLoader)
    except (yaml.YAMLError, RecursionError, ValueError) as error:
        raise ConeTableError(f"{name} is no YAML: {_first_line(error)}; correct it.") from error
    if not isinstance(content, Mapping):
        raise ConeTableError(f"{name} is no track: give lists of points under {', '.join(_GROUPS)}.")
    for group, colour in _GROUPS.items():
        points = content.get(group) or []
        if not isinstance(points, list):
            raise ConeTableError(f"{name}: {group} is no list of points [x, y]; correct it.")
        for number, point in enumerate(points, 1):
            if not isinstance(point, list) or len(point) < 2:
                raise ConeTableError(f"{name}: point {number} of {group} is no [x, y]; correct it.")
            yield {X: str(point[0]), Y: str(point[1]), COLOUR: colour}


def _sdf_rows(text: str, name: str) -> Iterator[dict[str, str]]:
    if "<!DOCTYPE" in text or "<!ENTITY" in text:
        raise ConeTableError(f"{name} defines entities, which no track needs: take them out.")
    try:
        root = ElementTree.fromstring(text)  # nosec B314 # entities are refused above
    except (ElementTree.ParseError, RecursionError, ValueError) as error:
        raise ConeTableError(f"{name} is no SDF: {_first_line(error)}; correct it.") from error
    for element in root.iter():
        if element.tag not in ("include", "model", "link"):
            continue
        words = (
            f"{element.get('name') or ''} {element.findtext('name') or ''} {element.findtext('uri') or ''}"
        )
        pose = element.findtext("pose")
        if "cone" not in words.lower() or pose is None:
            continue
        numbers = pose.split()
        if len(numbers) < 2:
            raise ConeTableError(
                f"{name}: the pose {pose.strip()!r} of {words.strip()!r} has no x and y; correct it."
            )
        yield {X: numbers[0], Y: numbers[1], COLOUR: _colour_in(words) or ORANGE}


_READERS: dict[str, Callable[[str, str], Iterator[dict[str, str]]]] = {
    ".yaml": _yaml_rows,
    ".yml": _yaml_rows,
    ".sdf": _sdf_rows,
    ".world": _sdf_rows,
}


def _pair_of(colour: str, head: list[str]) -> tuple[str, str] | None:
    found = []
    for axis in "xy":
        names = {f"{colour}_{axis}", f"{axis}_{colour}"}
        columns = [
            name for name in head if name.strip().lower().replace(" ", "_").removesuffix("_m") in names
        ]
        if not columns:
            return None
        found.append(columns[0])
    return found[0], found[1]


def _colour_in(words: str) -> str | None:
    """Return the colour in a name such as ``model://eufs/big_orange_cone``; None without one."""
    text = words.lower()
    if "orange" in text and "big" in text:
        return BIG_ORANGE
    return next((colour for colour in (ORANGE, BLUE, YELLOW) if colour in text), None)


def _is_number(text: Any) -> bool:
    try:
        return math.isfinite(float(text))
    except (TypeError, ValueError):
        return False


def _first_line(error: Exception) -> str:
    return (str(error) or type(error).__name__).partition("\n")[0]


# --- Cones from the rows of a table, such as a CSV file or a layer without geometry ---

_MOST_COLUMNS, _MOST_ROWS = 1000, 100_000
"""More than any table of cones has; up to these limits reading time is proportional to the file's length."""


@dataclass(frozen=True)
class ConeColumns:
    """The names of the columns; an empty name means no such column. ``heading`` is in degrees
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

    :raises ConeTableError: naming file and row.
    """
    try:
        with file.open(encoding="utf-8-sig", newline="") as text:
            reader = csv.reader(text)
            head = next(reader, [])
            if len(head) > _MOST_COLUMNS:
                raise ConeTableError(
                    f"{file.name} has {len(head)} columns, more than {_MOST_COLUMNS}: give a table of cones."
                )
            rows = list(_rows(reader, head, file.name))
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        reason = getattr(error, "strerror", None) or error
        raise ConeTableError(
            f"{file} cannot be read ({reason}): give a CSV file in UTF-8 with a head line."
        ) from error
    return head, rows


def _rows(lines: Iterable[list[str]], head: list[str], name: str) -> Iterator[dict[str, str]]:
    """Yield the rows by column; the first invalid row raises before the others are read."""
    for number, values in enumerate(filter(None, lines), 2):
        if len(values) != len(head):
            raise ConeTableError(
                f"{name}, row {number}: it has not as many columns as the head line ({len(head)})."
            )
        if number > _MOST_ROWS + 1:
            raise ConeTableError(f"{name} has more than {_MOST_ROWS} rows: part it into layouts.")
        yield dict(zip(head, values, strict=True))


def cones_of(
    rows: Iterable[Mapping[str, Any]], head: Sequence[str], columns: ConeColumns, name: str, first: int = 2
) -> list[Cone]:
    """Return a cone for each of ``rows``; ``first`` is the row number shown to users for the first one.

    Without a column of ids, cones are named after ``name``; without one of orders they are placed in the
    order of the rows. Cones are sorted by order.

    :raises ConeTableError: naming row and column, and what to do.
    """
    _check_columns(head, columns)
    kept = _kept_rows(list(enumerate(rows, first)), columns)
    cones = [_cone(_Row(number, row, columns), place, name) for place, (number, row) in enumerate(kept, 1)]
    _check_ids(cones, kept, columns)
    return sorted(cones, key=lambda cone: cone.order)


@dataclass(frozen=True)
class _Row:
    number: int
    values: Mapping[str, Any]
    columns: ConeColumns

    def number_in(self, column: str) -> float:
        value = self.values[column]
        try:
            number = float(value)
        except (TypeError, ValueError):
            number = math.nan
        if not math.isfinite(number):
            raise ConeTableError(f"Row {self.number}, column {column}: {value!r} is no number; correct it.")
        return number

    def text_in(self, column: str, otherwise: str) -> str:
        value = self.values[column] if column else None
        return str(value) if value not in (None, "") else otherwise


def _cone(row: _Row, place: int, name: str) -> Cone:
    columns = row.columns
    order = row.number_in(columns.order) if columns.order else float(place)
    if order != int(order):
        raise ConeTableError(
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


def _check_columns(head: Sequence[str], columns: ConeColumns) -> None:
    names = (columns.x, columns.y, columns.id, columns.order, columns.heading, columns.colour, columns.role)
    if columns.only and not columns.layout:
        raise ConeTableError(
            f"Of several layouts {columns.only!r} is to be taken, and no column says which row is of which: "
            f"choose it among {', '.join(head) or 'none'}."
        )
    for column in (*names, columns.layout):
        if column and column not in head:
            raise ConeTableError(f"There is no column {column!r}: choose among {', '.join(head) or 'none'}.")


def _kept_rows(
    rows: list[tuple[int, Mapping[str, Any]]], columns: ConeColumns
) -> list[tuple[int, Mapping[str, Any]]]:
    """Return the rows of the layout to read, all without one; each with its number."""
    if not rows:
        raise ConeTableError("There is no row, so there is nothing to place.")
    if not columns.only:
        return rows
    kept = [(number, row) for number, row in rows if str(row[columns.layout]) == columns.only]
    if not kept:
        layouts = sorted({str(row[columns.layout]) for _, row in rows})
        raise ConeTableError(
            f"No row has {columns.only!r} in column {columns.layout}, so there is nothing to place: choose "
            f"among {listed_names(layouts)}."
        )
    return kept


def _check_ids(
    cones: Sequence[Cone], kept: Sequence[tuple[int, Mapping[str, Any]]], columns: ConeColumns
) -> None:
    seen: dict[str, int] = {}
    for cone, (number, _) in zip(cones, kept, strict=True):
        if cone.id in seen:
            where = f"Row {number}, column {columns.id}" if columns.id else f"Row {number}"
            raise ConeTableError(
                f"{where}: the id {cone.id!r} is that of row {seen[cone.id]} too; make it another."
            )
        seen[cone.id] = number

"""Cones from the track files of Formula Student simulators: YAML, SDF, and tables without a head line.

YAML as AMZ's fssim writes it: lists of points under ``cones_left`` (blue), ``cones_right`` (yellow),
``cones_orange`` and ``cones_orange_big``. SDF as Gazebo reads it: included models, models and links whose
name or uri says ``cone``, with their colour. FSDS writes a table without a head line: colour, x, y and more.
"""

from __future__ import annotations

import csv
import math
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

from ..missing_packages import installation
from .cone import BIG_ORANGE, BLUE, COLOURS, ORANGE, YELLOW
from .errors import TableError

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
    """Tell by its suffix whether ``file`` is a track in YAML or SDF."""
    return file.suffix.lower() in _READERS


def read_track(file: Path) -> Rows:
    """Return a row for each cone of a track in YAML or SDF.

    :raises TableError: naming the file, what is wrong in it and what is read.
    """
    try:
        size = file.stat().st_size
        text = file.read_text(encoding="utf-8-sig") if size <= LARGEST_FILE else ""
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", None) or error
        raise TableError(f"{file} cannot be read ({reason}): give a track in UTF-8.") from error
    if size > LARGEST_FILE:
        raise TableError(
            f"{file.name} has {size} bytes, a track may have {LARGEST_FILE}: take out all but the cones."
        )
    rows = list(_READERS[file.suffix.lower()](text, file.name))
    if not rows:
        raise TableError(
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

    :raises TableError: naming file and row.
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
        # What reads tables with a head line says what is wrong.
        return None


def _headless_row(name: str, number: int, line: list[str]) -> dict[str, str]:
    if not _is_cone(line):
        raise TableError(
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
        raise TableError(
            f"{name} is YAML, and the Python package PyYAML is missing: install it {installation('PyYAML')}, "
            "or give the track as CSV."
        ) from error
    try:
        # Not libyaml's loader: brackets that are nested deep enough end its process.
        content = yaml.load(text, yaml.SafeLoader)
    except (yaml.YAMLError, RecursionError, ValueError) as error:
        raise TableError(f"{name} is no YAML: {_first_line(error)}; correct it.") from error
    if not isinstance(content, Mapping):
        raise TableError(f"{name} is no track: give lists of points under {', '.join(_GROUPS)}.")
    for group, colour in _GROUPS.items():
        points = content.get(group) or []
        if not isinstance(points, list):
            raise TableError(f"{name}: {group} is no list of points [x, y]; correct it.")
        for number, point in enumerate(points, 1):
            if not isinstance(point, list) or len(point) < 2:
                raise TableError(f"{name}: point {number} of {group} is no [x, y]; correct it.")
            yield {X: str(point[0]), Y: str(point[1]), COLOUR: colour}


def _sdf_rows(text: str, name: str) -> Iterator[dict[str, str]]:
    if "<!DOCTYPE" in text or "<!ENTITY" in text:
        raise TableError(f"{name} defines entities, which no track needs: take them out.")
    try:
        root = ElementTree.fromstring(text)
    except (ElementTree.ParseError, RecursionError, ValueError) as error:
        raise TableError(f"{name} is no SDF: {_first_line(error)}; correct it.") from error
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
            raise TableError(
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
        wanted = {f"{colour}_{axis}", f"{axis}_{colour}"}
        columns = [
            name for name in head if name.strip().lower().replace(" ", "_").removesuffix("_m") in wanted
        ]
        if not columns:
            return None
        found.append(columns[0])
    return found[0], found[1]


def _colour_in(words: str) -> str | None:
    """Return the colour that a name says, such as ``model://eufs/big_orange_cone``; None without one."""
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

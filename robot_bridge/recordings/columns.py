"""Which columns of a table hold what: one row a position, or columns for each robot."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from .errors import RecordingError
from .times import UNITS

KNOWN = ("time", "robot", "x", "y", "lat", "lon", "theta", "v")
"""What a column may hold; each is looked for under this name unless the settings say another."""
ROBOT = "{robot}"
"""What stands for the robot's name in the names of columns of which each robot has its own."""
THETA_UNITS = ("rad", "deg", "compass")
"""``compass`` is degrees clockwise from north, the others are counter-clockwise from the x axis."""


@dataclass(frozen=True)
class TableForm:
    """``columns`` are names of columns by what they hold, where they are called otherwise than that."""

    columns: Mapping[str, str]
    delimiter: str = ","
    time_unit: str = "s"
    theta_unit: str = "rad"

    def check(self) -> None:
        """Raise RecordingError, beginning with the key, for what cannot be."""
        for key in self.columns:
            if key not in KNOWN:
                raise RecordingError(f"columns.{key} is not known; known are {', '.join(KNOWN)}")
        if len(self.delimiter) != 1:
            raise RecordingError(f"delimiter = {self.delimiter!r}: give one character")
        if self.time_unit not in UNITS:
            raise RecordingError(f"time_unit = {self.time_unit!r}: give one of {', '.join(UNITS)}")
        if self.theta_unit not in THETA_UNITS:
            raise RecordingError(f"theta_unit = {self.theta_unit!r}: give one of {', '.join(THETA_UNITS)}")
        if {"x", "y"} & self.columns.keys() and {"lat", "lon"} & self.columns.keys():
            raise RecordingError("columns: give x and y, or lat and lon")

    def radians(self, value: float) -> float:
        """Return a heading of the table as radians counter-clockwise from the x axis, in [-π, π]."""
        turned = {"rad": value, "deg": math.radians(value), "compass": math.radians(90.0 - value)}
        return math.remainder(turned[self.theta_unit], math.tau)


@dataclass(frozen=True)
class RobotColumns:
    """Where in a row the position of a robot stands: numbers of columns, None for what is not there.

    ``name`` is the robot's name, None where it stands in column ``robot``.
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
    """Return where each robot's position stands in the rows below ``head``.

    A table without a column for the robot is one robot's, called ``alone``.

    :raises RecordingError: for columns that are not there, with those that are.
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
        raise RecordingError(f"no column is called like {pattern}; {_there(head)}")
    return names


def _of_robot(
    name: str | None, head: Sequence[str], columns: dict[str, str], place: tuple[str, str]
) -> RobotColumns:
    def find(key: str) -> int | None:
        wanted = columns.get(key, key).replace(ROBOT, name or "")
        if wanted in head:
            return head.index(wanted)
        if key in columns:
            raise RecordingError(f"columns.{key}: no column is called {wanted}; {_there(head)}")
        return None

    def need(key: str) -> int:
        found = find(key)
        if found is None:
            raise RecordingError(
                f"no column is called {key}; name the one that holds it with columns.{key}; {_there(head)}"
            )
        return found

    robot = find("robot") if name is None else None
    x, y = need(place[0]), need(place[1])
    return RobotColumns(name, robot, need("time"), x, y, find("theta"), find("v"), place[0] == "lon")


def _there(head: Sequence[str]) -> str:
    names = ", ".join(column[:40] for column in head[:30])
    return f"there are {names}{', …' if len(head) > 30 else ''}"

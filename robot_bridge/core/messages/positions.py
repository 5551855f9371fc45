"""Positions of robots for operators: reports, and a table of numbers for thousands."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass, field
from enum import Enum
from typing import Any

from .base import (
    COORDINATE,
    DeskRequest,
    Done,
    MessageError,
    Priority,
    Role,
    check_finite,
    check_robot_name,
    known_fields,
)
from .safety import PathDeclaration, RobotState

# --- Positions as a table of numbers, for desks that show thousands of robots ---
# A binary frame (:mod:`..position_frame`): a JSON-RPC notification ``positions`` whose params are
# :class:`PositionColumns`, and behind it each of its columns, one 64-bit float for each robot. Unknown values
# are NaN. A column of :data:`POSITION_TEXTS` holds indices into ``words``. A link reports its robots to the
# gateway in the same form.

POSITION_NUMBERS = (
    "age", "x", "y", "theta", "v", "device_time", "fix_time", "pose_age",
    "latency", "battery", "accuracy", "altitude",
)  # fmt: skip
POSITION_FLAGS = ("stopped",)
"""1 for true, 0 for false."""
POSITION_TEXTS = ("state", "link", "status", "command", "theta_from", "paths", "abilities", "doubt")
PLACE_COLUMNS = ("state", "x", "y", "theta", "doubt")
POSITION_ALWAYS = ("age", "stopped", "state", "link")
"""Columns known of every robot."""


ELSEWHERE = "gateway "
"""Prefix of the link of a robot that another gateway of the fleet has; the gateway's name follows."""


def link_elsewhere(gateway: str) -> str:
    """Return the link of a robot that the gateway named ``gateway`` has."""
    return f"{ELSEWHERE}{gateway}"


def gateway_of_link(link: str) -> str | None:
    """Return the name of the gateway that has the robot of this link, None for the reporting one."""
    return link[len(ELSEWHERE) :] if link.startswith(ELSEWHERE) else None


class PositionForm(str, Enum):
    """The form of positions: a JSON object for each robot, or a table of numbers behind a JSON head.

    ``places`` is the table of :data:`PLACE_COLUMNS` alone, as 32-bit floats: a quarter as long, for phones.
    """

    ROWS = "rows"
    COLUMNS = "columns"
    PLACES = "places"


# --- Updates on a fleet too large for a desk: robots in its view, and densities ---

MOST_IN_VIEW = 5000
"""robots in a view that are sent to a desk individually."""
MOST_ALWAYS = 500
"""robots that are sent to a desk wherever they are."""
MOST_ALARMED = 1000
"""robots with an alarm that are sent to a desk outside its view, or within one sent as a density."""
MOST_CELLS = 64
"""cells of a density along an axis."""
LARGEST_LIMIT = 1e6
"""metres."""
MOST_FOUND, LONGEST_SEARCH = 500, 63
"""robots in the answer to a search, and characters of the searched text."""


@dataclass(frozen=True)
class AlarmLimits:
    """Limits of alarms, besides those of lost robots and doubted positions.

    A robot has one with less than ``low_battery`` (share of a full one), an accuracy of ``unsure`` metres or
    worse, or more than ``outside`` metres off the site's bounds; None is never.
    """

    low_battery: float | None = None
    unsure: float | None = None
    outside: float | None = None

    def __post_init__(self) -> None:
        for name, most in (("low_battery", 1.0), ("unsure", LARGEST_LIMIT), ("outside", LARGEST_LIMIT)):
            value = getattr(self, name)
            if value is not None and not 0.0 <= value <= most:
                raise MessageError(f"{name} is {value}; give a number from 0 to {most:g}, or none")


@dataclass(frozen=True)
class View:
    """The part of the fleet that a desk shows: ``bounds`` is x_min, y_min, x_max, y_max in the site frame.

    Robots within them are sent individually, but if they are more than ``most``, only their number in each
    cell of a grid is sent. Those in ``always``, and those with an alarm by ``alarms``, are sent wherever they
    are.
    """

    bounds: tuple[float, float, float, float]
    always: list[str] = field(default_factory=list)
    most: int = MOST_IN_VIEW
    alarms: AlarmLimits = field(default_factory=AlarmLimits)

    def __post_init__(self) -> None:
        low, high = COORDINATE
        x_min, y_min, x_max, y_max = self.bounds
        if not (low <= x_min < x_max <= high and low <= y_min < y_max <= high):
            raise MessageError(
                f"bounds is {list(self.bounds)}; give x_min, y_min, x_max, y_max in metres, each from "
                f"{low:g} to {high:g}, with x_min < x_max and y_min < y_max"
            )
        if not 1 <= self.most <= MOST_IN_VIEW:
            raise MessageError(f"most is {self.most}; give 1 to {MOST_IN_VIEW} robots")
        if len(self.always) > MOST_ALWAYS:
            raise MessageError(f"always has {len(self.always)} robots; give at most {MOST_ALWAYS}")
        for name in self.always:
            check_robot_name(name)


@dataclass(frozen=True)
class Density:
    """The number of robots in each ``cell`` x ``cell`` metres of a grid of ``columns`` by ``rows``.

    Its first corner is ``x``, ``y`` in the site frame, multiples of ``cell``, which is a power of two.
    ``cells`` are the indices of those that hold robots, counted from 0 along x and then along y;
    ``fresh``, ``silent`` (stale or lost) and ``offline`` have a count for each of them.
    """

    cell: float
    x: float
    y: float
    columns: int
    rows: int
    cells: list[int]
    fresh: list[int]
    silent: list[int]
    offline: list[int]


@dataclass(frozen=True)
class FleetView:
    """The fleet for a desk that asked for a view: how many ``robots`` there are, and in which state.

    ``inside`` are in the bounds of its view, ``alarmed`` have an alarm; the first 1000 of these are sent.
    With ``density`` those inside are too many to be sent individually.
    """

    robots: int
    fresh: int
    stale: int
    lost: int
    offline: int
    inside: int
    alarmed: int
    density: Density | None = None


@dataclass(frozen=True)
class PositionColumns:
    """The contents of the table that follows, at the gateway's time ``t``.

    ``columns`` are names of RobotReport's fields, in the order in which they follow, 64-bit little-endian
    floats (32-bit in the form ``places``), one for each of ``robots``; NaN is an unknown value, and columns
    without any known value are left out. In columns ``state``, ``link``, ``status``, ``command``,
    ``theta_from``, ``paths``, ``abilities`` and ``doubt`` a number is an index into ``words``, counted from
    0. ``removed``, ``everything``, ``untracked`` and ``view`` are as in :class:`Positions`.
    """

    t: float
    robots: list[str]
    columns: list[str]
    words: list[str]
    removed: list[str] = field(default_factory=list)
    everything: bool = False
    untracked: list[str] = field(default_factory=list)
    view: FleetView | None = None


@dataclass  # not frozen: thousands are made every second, and a frozen one takes three times as long
class RobotReport:
    """One robot as the gateway knows it. ``age`` is seconds since its last message, when this was sent.

    A robot that has sent Ready but no position yet has no pose: x, y, theta, v are None. ``device_time`` and
    ``fix_time`` are the robot's own clocks, ``pose_age`` is seconds since it had its pose, by the gateway's.
    ``latency`` is the last measured round-trip time of the robot's link in seconds. ``paths`` is what the
    robot declared in Ready about its paths, None of one that declared nothing: it drives straight to a
    target, and places no cone at the end of a path. ``abilities`` are separated by spaces: empty for one that
    is only observed, None for one that can do everything. ``doubt`` is why its position may be wrong, None if
    it is trusted.
    """

    robot: str
    state: RobotState
    age: float
    link: str
    stopped: bool = False
    x: float | None = None
    y: float | None = None
    theta: float | None = None
    v: float | None = None
    device_time: float | None = None
    fix_time: float | None = None
    pose_age: float | None = None
    latency: float | None = None
    battery: float | None = None
    status: str | None = None
    command: str | None = None
    accuracy: float | None = None
    altitude: float | None = None
    theta_from: str | None = None
    paths: PathDeclaration | None = None
    abilities: str | None = None
    doubt: str | None = None


@dataclass(frozen=True)
class Positions:
    """Where robots are, at the gateway's time ``t``.

    With ``everything`` they are all existing robots; otherwise ``removed`` are gone for good. To a desk that
    asked for a view, ``everything`` are all that are sent individually, and ``untracked`` are sent no longer:
    they exist, but are out of view. ``view`` comes with each change of it.
    """

    t: float
    robots: list[RobotReport]
    removed: list[str] = field(default_factory=list)
    everything: bool = False
    untracked: list[str] = field(default_factory=list)
    view: FleetView | None = None


@dataclass(frozen=True)
class Subscribe(DeskRequest[Done]):
    """Ask for ``positions`` up to ``rate`` times a second: everything at first, then changes only.

    ``form`` says whether they come as an object for each robot or as a table of numbers. With ``view`` they
    are those of the robots in it; asked again with another view, only the differences follow.
    """

    method = "subscribe"
    least_role = Role.VIEWER
    rate: float = 5.0
    form: PositionForm = PositionForm.ROWS
    view: View | None = None

    def __post_init__(self) -> None:
        check_finite(rate=self.rate)
        if not 0 < self.rate <= 50:
            raise MessageError(f"rate is {self.rate}; give snapshots a second, above 0 and up to 50")


@dataclass(frozen=True)
class GetPositions(DeskRequest[Positions]):
    """Ask for the position of every robot (the second paper's ``get_positions``), or of those in a view."""

    method = "get_positions"
    least_role = Role.VIEWER
    view: View | None = None


@dataclass(frozen=True)
class FoundRobots:
    """Robots whose names were searched for, by name; ``count`` is how many there are with such a name."""

    t: float
    robots: list[RobotReport]
    count: int


@dataclass(frozen=True)
class FindRobots(DeskRequest[FoundRobots]):
    """Ask for robots with ``text`` in their names, in any case; every robot where it is empty.

    At most ``limit`` are returned, by name; the next ones are those ``after`` the last name of these. With
    ``whole`` they are those whose whole name is ``text``, in any case.
    """

    method = "find_robots"
    least_role = Role.VIEWER
    priority = Priority.SLOW
    text: str = ""
    after: str = ""
    limit: int = 50
    whole: bool = False

    def __post_init__(self) -> None:
        for name in ("text", "after"):
            value = getattr(self, name)
            if len(value) > LONGEST_SEARCH:
                raise MessageError(
                    f"{name} has {len(value)} characters; give at most {LONGEST_SEARCH}: no name is longer"
                )
        if not 1 <= self.limit <= MOST_FOUND:
            raise MessageError(f"limit is {self.limit}; give 1 to {MOST_FOUND} robots")


# --- Read from plain JSON values, as a gateway sent them; unknown fields of newer ones are ignored ---


def robot_report(values: dict[str, Any]) -> RobotReport:
    """Return the report that a gateway sent as JSON; unknown fields of newer gateways are ignored."""
    return RobotReport(**{**known_fields(RobotReport, values), "state": RobotState(values["state"])})


def fleet_view(values: dict[str, Any]) -> FleetView:
    """Return the fleet as a desk sees it by its view, as a gateway sent it as JSON.

    :raises ValueError: when a count is invalid, or the cells of a density lie outside its grid.
    """
    view = FleetView(**{**known_fields(FleetView, values), "density": None})
    _check_counts("view", *(getattr(view, f.name) for f in dataclasses.fields(view) if f.name != "density"))
    if values.get("density") is None:
        return view
    density = Density(**known_fields(Density, values["density"]))
    groups = (density.fresh, density.silent, density.offline)
    _check_counts(
        "density", density.columns, density.rows, *density.cells, *(n for one in groups for n in one)
    )
    corner = (density.cell, density.x, density.y)
    if (
        not all(isinstance(value, (int, float)) and math.isfinite(value) for value in corner)
        or density.cell <= 0
    ):
        raise ValueError(f"the cells of a density have no place or no size: {corner}")
    size = density.columns * density.rows
    if not 0 < size <= MOST_CELLS**2 or any(cell >= size for cell in density.cells):
        raise ValueError(f"a density has cells outside its {density.columns} x {density.rows}")
    if any(len(group) != len(density.cells) for group in groups):
        raise ValueError("a density has other counts than cells")
    return dataclasses.replace(view, density=density)


def _check_counts(name: str, *counts: Any) -> None:
    for count in counts:
        if isinstance(count, bool) or not isinstance(count, int) or count < 0:
            raise ValueError(f"a count of {name} is {count!r}")

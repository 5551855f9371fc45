"""Roads and their surfaces: routes, closures, conflicts, surface at a place."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, ClassVar, Literal, TypeVar

from . import base
from .base import DeskRequest, MessageError, Priority, Role, Texts, known_fields
from .safety import check_reason

# --- Requests of operators about roads: routes, closures, and conflicts of robots

LONGEST_ID = 64
LONGEST_CLOSURE = 10 * 366 * 86400.0
"""seconds."""


@dataclass(frozen=True)
class RouteReport:
    """A route that can be sent to a robot by SetPath: ``points`` are those that it drives.

    ``seconds`` is the robot's driving time: at ``speed_ms`` of the site's settings or its observed speed,
    whichever is more, and nowhere faster than the road allows. ``tight`` holds the corners that are tighter
    than the turning radius of the site's settings; ``note`` says what is unusual, such as a straight line
    instead of a road. ``engine`` names the routing engine, ``off_goal`` is metres from the goal to its road.
    """

    points: list[tuple[float, float]]
    metres: float
    seconds: float
    surfaces: list[SurfaceMetres] = field(default_factory=list)
    tight: list[tuple[float, float]] = field(default_factory=list)
    off_goal: float = 0.0
    note: str = ""
    engine: str = ""


@dataclass(frozen=True)
class GetRoute(DeskRequest[RouteReport]):
    """Ask for the route along roads from where ``robot`` is, or from ``start``, to (``x``, ``y``).

    ``surfaces`` names those that may be used (None: all), ``least_width`` metres that a road must have at
    least. With ``avoid_reserved`` roads used by other robots' tasks are left out. Places are metres in
    the site frame, or in the CRS ``crs``, such as ``EPSG:4326``: x (longitude, easting) before y.
    """

    method = "get_route"
    least_role = Role.VIEWER
    priority = Priority.SLOW
    x: float
    y: float
    robot: str | None = None
    start: tuple[float, float] | None = None
    fastest: bool = False
    surfaces: list[str] | None = None
    least_width: float = 0.0
    avoid_reserved: bool = False
    crs: str | None = None

    def __post_init__(self) -> None:
        base.check_crs(self.crs)
        base.check_finite(x=self.x, y=self.y, least_width=self.least_width)
        if (self.robot is None) == (self.start is None):
            raise MessageError("get_route: give one of robot and start: whose way it is, or from where")
        if self.robot is not None:
            base.check_robot_name(self.robot)
        if self.start is not None:
            base.check_finite(start_x=self.start[0], start_y=self.start[1])


@dataclass(frozen=True)
class SurfaceMetres:
    """Metres of a route on one surface; the name is empty where it is not known."""

    surface: str
    metres: float


@dataclass(frozen=True)
class RoadClosed:
    """The outcome of closing a road."""

    closure: ClosureReport
    robots: list[ReplannedRobot] = field(default_factory=list)


@dataclass(frozen=True)
class CloseRoad(DeskRequest[RoadClosed]):
    """Close the road nearest to (``x``, ``y``), from one junction to the next, for every robot.

    ``closure`` is an id that the client chooses: sent twice, done once. The road is open again after
    ``seconds``, if that is given. The road must be within ``reach`` metres.
    """

    method = "close_road"
    least_role = Role.OPERATOR
    closure: str
    x: float
    y: float
    reason: str | None = None
    seconds: float | None = None
    reach: float = 20.0

    def __post_init__(self) -> None:
        check_closure_id(self.closure)
        base.check_finite(x=self.x, y=self.y, reach=self.reach)
        check_reason(self.reason)
        if self.seconds is not None and not 0 < self.seconds <= LONGEST_CLOSURE:
            raise MessageError(
                f"seconds is {self.seconds}; give how long, above 0 and up to {LONGEST_CLOSURE:g}, or nothing"
            )


@dataclass(frozen=True)
class ClosureReport:
    """A road that is or was closed: ``line`` is the stretch, metres in the site frame.

    ``edges`` counts the edges of the network that it closes; 0 means that the site, as it is published now,
    has no such road. It opens by itself at ``until``. Times are seconds since 1970.
    """

    closure: str
    line: list[tuple[float, float]]
    closed_at: float
    closed_by: str
    level: int = 0
    edges: int = 0
    reason: str | None = None
    until: float | None = None
    opened_at: float | None = None
    opened_by: str | None = None


@dataclass(frozen=True)
class OpenRoad(DeskRequest[ClosureReport]):
    """Reopen the road that was closed under the id ``closure``."""

    method = "open_road"
    least_role = Role.OPERATOR
    closure: str
    reason: str | None = None

    def __post_init__(self) -> None:
        check_closure_id(self.closure)
        check_reason(self.reason)


@dataclass(frozen=True)
class Closures:
    """The roads that are closed now, oldest first."""

    closures: list[ClosureReport] = field(default_factory=list)


@dataclass(frozen=True)
class GetClosures(DeskRequest[Closures]):
    """Ask for the roads that are closed now."""

    method = "get_closures"
    least_role = Role.VIEWER


@dataclass(frozen=True)
class ReplannedRobot:
    """A robot whose path led along a road that was closed, and the outcome.

    ``became`` is ``another way``, ``stopped``, ``told only`` (the site's settings ask for no more), ``later``
    (as soon as it says where it is now, or the database can be written) or ``failed``: an operator must take
    care of that robot. ``command`` is the one that carries it out, if any.
    """

    robot: str
    became: Literal["another way", "stopped", "told only", "later", "failed"]
    text: str
    command: str | None = None


@dataclass(frozen=True)
class Conflicts:
    """The conflicts of all robots, soonest first, computed at the gateway's time ``t``.

    ``waiting`` names the robots that are held until another has passed.
    """

    t: float
    conflicts: list[ConflictReport] = field(default_factory=list)
    waiting: list[HoldReport] = field(default_factory=list)


@dataclass(frozen=True)
class GetConflicts(DeskRequest[Conflicts]):
    """Ask where robots will come too near to one another on their present paths."""

    method = "get_conflicts"
    least_role = Role.VIEWER
    priority = Priority.SLOW


@dataclass(frozen=True)
class ConflictReport:
    """Two robots that will be nearer to one another than their widths and the margin allow.

    ``kind`` is ``head-on``, ``crossing``, ``following`` or ``standing`` (``other`` does not move then). From
    ``begins`` to ``ends`` (None: for good), seconds since 1970; nearest at ``nearest_at``, with ``metres``
    between their middles, at (``x``, ``y``). ``clearance`` is the required distance of their middles in
    metres; None from an older gateway.
    """

    robot: str
    other: str
    kind: Literal["head-on", "crossing", "following", "standing"]
    begins: float
    nearest_at: float
    metres: float
    x: float
    y: float
    ends: float | None = None
    clearance: float | None = None


@dataclass(frozen=True)
class HoldReport:
    """A robot that waits at (``x``, ``y``) for another to pass; it continues at ``until`` or later."""

    robot: str
    other: str
    x: float
    y: float
    until: float
    by: str
    command: str


@dataclass(frozen=True)
class WaysOut:
    """The options of ``robot`` and ``other``, computed at the gateway's time ``t``."""

    t: float
    robot: str
    other: str
    ways: list[WayOut] = field(default_factory=list)


@dataclass(frozen=True)
class GetWaysOut(DeskRequest[WaysOut]):
    """Ask for the options of two robots in conflict; nothing is changed."""

    method = "get_ways_out"
    least_role = Role.VIEWER
    priority = Priority.SLOW
    robot: str
    other: str

    def __post_init__(self) -> None:
        base.check_robot_name(self.robot)
        base.check_robot_name(self.other)
        if self.robot == self.other:
            raise MessageError(f"get_ways_out: robot and other are both {self.robot!r}; give two robots")


@dataclass(frozen=True)
class WayOut:
    """An option of ``robot``, and whether it works now: ``text`` says what would happen, or why not.

    It gives way (resolve_conflict), or goes ``aside``: then ``points`` are the path to the nearest free
    place, metres in the site frame, to send like any route.
    """

    robot: str
    how: Literal["give way", "aside"]
    possible: bool
    text: str
    points: list[tuple[float, float]] = field(default_factory=list)


@dataclass(frozen=True)
class ConflictResolved:
    """The outcome: ``became`` is ``waits`` or ``another way``; ``command`` is the one sent to the robot."""

    robot: str
    became: Literal["waits", "another way"]
    text: str
    command: str
    delay: float = 0.0


@dataclass(frozen=True)
class ResolveConflict(DeskRequest[ConflictResolved]):
    """Resolve a conflict by an action of ``robot``; ``other`` continues unchanged.

    It waits, takes another route (``route``), or whichever gets it to its end sooner (``either``).
    """

    method = "resolve_conflict"
    least_role = Role.OPERATOR
    priority = Priority.MOVE_SEVERAL
    robot: str
    other: str
    by: Literal["waiting", "route", "either"] = "either"

    def __post_init__(self) -> None:
        base.check_robot_name(self.robot)
        base.check_robot_name(self.other)
        if self.robot == self.other:
            raise MessageError(f"resolve_conflict: robot and other are both {self.robot!r}; give two robots")


def check_closure_id(closure: str) -> None:
    """Refuse an id that cannot identify a closure; raises MessageError."""
    if not (8 <= len(closure) <= LONGEST_ID and closure.isprintable()):
        raise MessageError(f"closure is {closure!r}; give an id of 8 to {LONGEST_ID} characters, say a UUID")


# --- Road surface at a place: requests of robots and operators, and their answers ---
# The paper's tables have no such operation: GetSurface and SetSurface are this project's own.

MOST_OF_A_ROBOT = 1000
MOST_OF_A_DESK = 10_000
"""Places in one request."""
LONGEST_SOURCE = 128
"""characters."""


@dataclass(frozen=True)
class GetSurface:
    """The robot asks which road surface is at each of ``points``; an operation beside the paper's tables.

    They are metres in the site frame, or in the CRS ``crs``, such as ``EPSG:4326``, x (longitude, easting)
    before y whatever the CRS. ``source`` is a number or name chosen by the robot; SetSurface repeats it.
    """

    points: list[tuple[float, float]]
    crs: str | None = None
    source: str | None = None
    magic: int | None = None
    acknowledged: ClassVar[bool] = True
    texts: ClassVar[Texts] = {"source": LONGEST_SOURCE}

    def __post_init__(self) -> None:
        _check(self.points, self.crs, MOST_OF_A_ROBOT)
        base.check_texts(self)


@dataclass(frozen=True)
class SetSurface:
    """The answer to GetSurface: the class of the surface at each point in turn, such as ``asphalt``.

    None where there is no road surface, empty where its class is not known. ``source`` is the request's.
    """

    surfaces: list[str | None]
    source: str | None = None


@dataclass(frozen=True)
class Surfaces:
    """The surface at each point in turn, None where there is none."""

    surfaces: list[SurfaceAt | None]


@dataclass(frozen=True)
class GetSurfaces(DeskRequest[Surfaces]):
    """Ask which road surface is at each of ``points``, metres in the site frame, or in the CRS ``crs``.

    In a CRS such as ``EPSG:4326`` x (longitude, easting) comes before y whatever the CRS.
    """

    method = "get_surface"
    least_role = Role.VIEWER
    priority = Priority.SLOW
    points: list[tuple[float, float]]
    crs: str | None = None

    def __post_init__(self) -> None:
        _check(self.points, self.crs, MOST_OF_A_DESK)


@dataclass(frozen=True)
class SurfaceAt:
    """The road surface at a place: its class, its name if it has one, and where it comes from."""

    surface: str
    origin: Literal["drawn", "generated"]
    name: str | None = None


def _check(points: Sequence[tuple[float, float]], crs: str | None, most: int) -> None:
    if not 1 <= len(points) <= most:
        raise MessageError(f"points holds {len(points)} points; give 1 to {most}, more in further questions")
    for number, (x, y) in enumerate(points):
        base.check_finite(**{f"points[{number}].x": x, f"points[{number}].y": y})
    base.check_crs(crs)


# --- Read from plain JSON values; unknown fields of newer gateways are ignored ---

T = TypeVar("T")


def closures_report(values: dict[str, Any]) -> Closures:
    """Return the roads that are closed."""
    return Closures([closure_report(one) for one in values.get("closures", [])])


def closure_report(values: dict[str, Any]) -> ClosureReport:
    """Return one closed road."""
    return _made(ClosureReport, {**values, "line": _points(values["line"])})


def conflicts_report(values: dict[str, Any]) -> Conflicts:
    """Return the conflicts of robots."""
    return Conflicts(
        float(values["t"]),
        [_made(ConflictReport, one) for one in values.get("conflicts", [])],
        [_made(HoldReport, one) for one in values.get("waiting", [])],
    )


def ways_out_report(values: dict[str, Any]) -> WaysOut:
    """Return the options of two robots in conflict."""
    ways = [_made(WayOut, {**one, "points": _points(one.get("points", []))}) for one in values["ways"]]
    return WaysOut(float(values["t"]), str(values["robot"]), str(values["other"]), ways)


def replanned_robot(values: dict[str, Any]) -> ReplannedRobot:
    """Return the outcome for a robot whose road was closed."""
    return _made(ReplannedRobot, values)


def route_report(values: dict[str, Any]) -> RouteReport:
    """Return the requested route."""
    surfaces = [_made(SurfaceMetres, one) for one in values.get("surfaces", [])]
    points, tight = _points(values["points"]), _points(values.get("tight", []))
    return _made(RouteReport, {**values, "points": points, "tight": tight, "surfaces": surfaces})


def _made(kind: type[T], values: dict[str, Any]) -> T:
    return kind(**known_fields(kind, values))


def _points(pairs: list[Any]) -> list[tuple[float, float]]:
    points = [(float(x), float(y)) for x, y in pairs]
    if not all(math.isfinite(x) and math.isfinite(y) for x, y in points):
        raise ValueError("a point has a coordinate that is no number")
    return points

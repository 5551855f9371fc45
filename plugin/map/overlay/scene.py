"""Scene of all live objects: in the site frame, in the CRS of the map, and on the screen."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from enum import Enum
from functools import cached_property
from itertools import accumulate, chain

import numpy as np
import numpy.typing as npt
from qgis.core import QgsPointXY, QgsRectangle
from qgis.gui import QgsMapCanvas, QgsMapCanvasItem
from qgis.PyQt.QtGui import QColor, QImage, QPainter, QTransform

from ....robot_bridge.core.messages.commands import CommandReport
from ....robot_bridge.core.messages.positions import FleetView
from ....robot_bridge.core.messages.robots import SetPath
from ...control.pending_command import PendingCommand, Point
from ...gateway_client.command_cache import ON_PATH_M, PathApproach
from ...gateway_client.robot_states import RobotArrays
from ...layers.site_transform import SiteToMapTransform
from ...ui.errors import MapTransformError
from ...ui.glyphs import painting

Points = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Screen:
    """The visible part of the map and its display: two are equal when they show the same.

    ``centre`` is in map coordinates; ``at`` is its place in logical pixels; ``right`` and ``up`` are the
    pixels of one map unit along x and along y. ``width`` and ``height`` are logical pixels,
    ``ratio`` device pixels for each.
    """

    centre: tuple[float, float]
    at: tuple[float, float]
    right: tuple[float, float]
    up: tuple[float, float]
    width: int
    height: int
    ratio: float = 1.0

    def pixels(self, xy: Points) -> Points:
        """Return (n, 2) map coordinates as (n, 2) logical pixels."""
        pixels = self.ways(xy)
        # Column by column: numpy is slow where it goes along rows of two.
        pixels[:, 0] += self._shift[0]
        pixels[:, 1] += self._shift[1]
        return pixels

    def ways(self, xy: Points) -> Points:
        """Return (n, 2) vectors in map units as vectors in logical pixels."""
        return xy @ self._axes

    def seen(self, pixels: Points, margin: float) -> npt.NDArray[np.bool_]:
        """Return which of (n, 2) ``pixels`` are on the screen, or no farther than ``margin`` off it."""
        x, y = pixels[:, 0], pixels[:, 1]
        return (x > -margin) & (x < self.width + margin) & (y > -margin) & (y < self.height + margin)

    def since(self, earlier: Screen) -> QTransform:
        """Return the transform from pixels of ``earlier`` to those of this screen, both without rounding."""
        # Not by numpy's solver: on a busy machine that occasionally takes milliseconds, in a frame.
        (rx, ry), (ux, uy) = earlier.right, earlier.up
        scale = 1.0 / (rx * uy - ry * ux)
        to_map = QTransform(uy * scale, -ry * scale, -ux * scale, rx * scale, 0.0, 0.0)
        turned = to_map * QTransform(*self.right, *self.up, 0.0, 0.0)
        was_x, was_y = turned.map(*earlier.at)
        (x, y), *_ = self.pixels(np.array([earlier.centre])).tolist()
        return turned * QTransform.fromTranslate(x - was_x, y - was_y)

    @cached_property
    def _axes(self) -> Points:
        return np.array([self.right, self.up])

    @cached_property
    def _shift(self) -> tuple[float, float]:
        """The pixels of the map's (0, 0)."""
        (cx, cy), (rx, ry), (ux, uy) = self.centre, self.right, self.up
        return self.at[0] - cx * rx - cy * ux, self.at[1] - cx * ry - cy * uy


def screen_of(canvas: QgsMapCanvas, item: QgsMapCanvasItem, ratio: float) -> Screen:
    """Return the present screen of ``canvas``, panning and rotation included."""
    centre = canvas.center()
    at = item.toCanvasCoordinates(centre)
    axes = canvas.getCoordinateTransform().transform()
    seen = canvas.viewport().size()
    return Screen(
        (centre.x(), centre.y()),
        (at.x(), at.y()),
        (axes.m11(), axes.m12()),
        (axes.m21(), axes.m22()),
        seen.width(),
        seen.height(),
        ratio,
    )


def screen_image(screen: Screen, paint: Callable[[QPainter], None]) -> QImage:
    """Return a transparent image as large as ``screen`` painted on by ``paint``, in logical pixels."""
    width, height = round(screen.width * screen.ratio), round(screen.height * screen.ratio)
    image = QImage(width, height, QImage.Format.Format_ARGB32_Premultiplied)
    image.setDevicePixelRatio(screen.ratio)
    image.fill(QColor(0, 0, 0, 0))
    with painting(image) as painter:
        paint(painter)
    return image


INSIDE = 0.5
"""Fraction of the view, about its middle, in which a robot moves before the view moves."""
INSIDE_ALL = 0.96
"""The same where several are followed, which need room."""
AROUND = 1.25
"""Factor by which the view is larger than the robots' extent when it has to grow."""


class FollowMode(Enum):
    """The robots that are followed."""

    NOBODY = "nobody"
    SELECTED = "selected"
    ALL = "all"


def keep_in_view(canvas: QgsMapCanvas, screen: Screen, places: Points) -> bool:
    """Move the view where a robot leaves it, widen it where they do not all fit; return whether it moved.

    ``places`` (n, 2) are map coordinates; ``screen`` is what ``canvas`` shows now.
    """
    places = places[np.isfinite(places).all(axis=1)]
    if len(places) == 0:
        return False
    pixels = screen.pixels(places)
    size = np.array([screen.width, screen.height])
    part = INSIDE if len(places) == 1 else INSIDE_ALL
    if (np.abs(pixels - size / 2) <= size / 2 * part).all():
        return False
    needed = (np.ptp(pixels, axis=0) / size).max() * AROUND
    if needed > 1.0:
        canvas.zoomByFactor(float(needed))
    middle, _ = _box(canvas, places)
    canvas.setCenter(QgsPointXY(*middle.tolist()))
    canvas.refresh()
    return True


def show_places(canvas: QgsMapCanvas, places: Points) -> None:
    """Show the smallest part of the map that contains all of (n, 2) map coordinates, at any rotation."""
    middle, half = _box(canvas, places)
    # QGIS takes an extent as that of the map before it is rotated about its middle.
    canvas.setExtent(QgsRectangle(*(middle - half).tolist(), *(middle + half).tolist()))
    canvas.refresh()


def _box(canvas: QgsMapCanvas, places: Points) -> tuple[Points, Points]:
    """Return the middle, (2,) map coordinates, of the box about ``places`` that is upright on the screen, and
    half its width and height in map units."""
    turn = math.radians(canvas.rotation())
    to_screen = np.array([[math.cos(turn), -math.sin(turn)], [math.sin(turn), math.cos(turn)]])
    seen = places @ to_screen
    low, high = seen.min(axis=0), seen.max(axis=0)
    return to_screen @ ((low + high) / 2), (high - low) / 2


BACK = 5.0
"""Metres by which a robot may seem to go back on its way: where a way crosses itself, it has gone on."""


@dataclass(frozen=True, eq=False)
class TaskPath:
    """One robot's task: (n, 2) ``points`` in metres of the site frame, the last one the target.

    A target without a way has one point. Derived values are computed on first use: of many plans
    only for those of selected robots.
    """

    command: str
    robot: str
    points: Points
    cone: bool

    @property
    def is_way(self) -> bool:
        """Whether the robot was sent a path."""
        return len(self.points) > 1

    @cached_property
    def steps(self) -> Points:
        """Vector from each point to the next, (n - 1, 2)."""
        return np.diff(self.points, axis=0)

    @cached_property
    def lengths(self) -> Points:
        """Metres of each step, (n - 1,), more than zero."""
        return np.maximum(np.hypot(*self.steps.T), 1e-9)

    @cached_property
    def along(self) -> Points:
        """Metres along the way from its first point to each, (n,)."""
        return np.concatenate([[0.0], np.cumsum(np.hypot(*self.steps.T))])


class TaskPaths:
    """Makes the plans of commands once each, and tracks the robots along them."""

    def __init__(self) -> None:
        self._tasks: list[CommandReport] = []
        self._plans: list[TaskPath] = []
        self._known: dict[str, TaskPath | None] = {}
        self._driven: dict[str, float] = {}
        self._ways: dict[str, PathApproach] = {}
        """The approaches of robots to the first points of their ways."""
        self.is_whole = True
        """Whether every plan that was requested last is made."""

    def of(self, tasks: Iterable[CommandReport], at_once: int | None = None) -> list[TaskPath]:
        """Return the plans of ``tasks`` that have a place, in one list for as long as they are the same.

        At most ``at_once`` new ones are made, and the others by further calls.
        """
        tasks = list(tasks)
        if tasks == self._tasks and self.is_whole:
            return self._plans
        new = [task for task in tasks if task.command not in self._known]
        made = {task.command: _path_of(task) for task in new[:at_once]}
        known = {**self._known, **made}
        self._known = {task.command: known[task.command] for task in tasks if task.command in known}
        self._driven = {command: self._driven[command] for command in self._known if command in self._driven}
        self._ways = {command: self._ways[command] for command in self._known if command in self._ways}
        self._tasks, self.is_whole = tasks, len(made) == len(new)
        self._plans = [plan for plan in self._known.values() if plan is not None]
        return self._plans

    def remaining(self, plan: TaskPath, at: Points) -> float:
        """Return the remaining metres of a robot at (2,) ``at``, along its way if it has one.

        Before it has come to its way it drives to the first point of that.
        """
        if not plan.is_way:
            return float(np.hypot(*(plan.points[-1] - at)))
        start, step, length = plan.points[:-1], plan.steps, plan.lengths
        part = np.clip(((at - start) * step).sum(axis=1) / length**2, 0.0, 1.0)
        away = np.hypot(*(start + step * part[:, None] - at).T)
        to_first = float(np.hypot(*(plan.points[0] - at)))
        way = self._ways.setdefault(plan.command, PathApproach())
        way.go_on(float(away.min()), to_first)
        if not way.is_over:
            return to_first + float(plan.along[-1])
        along = plan.along[:-1] + part * length
        driven = self._driven.get(plan.command)
        nearest = _first_near(away) if driven is None else _near_ahead(away, along, driven)
        self._driven[plan.command] = float(along[nearest])
        return float(plan.along[-1] - along[nearest] + away[nearest])


def _first_near(away: Points) -> int:
    """Return the step at which a robot has come to its way, from its distance ``away`` from each.

    That is the earliest where a way ends at its beginning, or crosses itself.
    """
    near = away <= max(ON_PATH_M, float(away.min()))
    begin = int(near.argmax())
    beyond = np.flatnonzero(~near[begin:])
    end = begin + int(beyond[0]) if len(beyond) else len(near)
    return begin + int(away[begin:end].argmin())


def _near_ahead(away: Points, along: Points, driven: float) -> int:
    """Return the current step of a robot that has ``driven`` so many metres of its way."""
    ahead = along >= driven - BACK
    return int(np.where(ahead, away, np.inf).argmin() if ahead.any() else away.argmin())


def _path_of(task: CommandReport) -> TaskPath | None:
    if task.op == SetPath.__name__:
        given = task.params.get("points", [])
    else:
        given = [[task.params.get("x"), task.params.get("y")]]
    try:
        points = np.array(given, dtype=np.float64).reshape(-1, 2)
    except (TypeError, ValueError):
        return None
    if len(points) == 0 or not np.isfinite(points).all():
        return None
    return TaskPath(task.command, task.robot, points, bool(task.params.get("cone")))


_NOWHERE: Points = np.empty((0, 2))
_SITE_ORIGIN: Points = np.zeros((1, 2))


@dataclass(frozen=True)
class SiteScene:
    """All live objects, in the site frame, at ``now`` of the desk's clock.

    ``chosen`` are the selected robots, the one that receives commands last. ``remaining`` has the
    metres left for commands.
    """

    robots: RobotArrays
    now: float = 0.0
    chosen: tuple[str, ...] = ()
    plans: list[TaskPath] = field(default_factory=list)
    remaining: dict[str, float] = field(default_factory=dict)
    draft: PendingCommand | None = None
    cursor: Point | None = None
    fleet: FleetView | None = None
    """The whole fleet, where the robots are those in view."""
    rows: dict[str, int] = field(default_factory=dict)
    """The rows of the robots of draft and selection, and of those with a distance in ``remaining``."""


@dataclass(frozen=True)
class MapScene:
    """The same in the map's CRS: (n, 2) coordinates for each part; ``metre`` is the vector to 1 m before each
    robot, or along the site's x of one whose heading is not known. It is empty where the axes of
    ``transform``, which places other things, give it.

    Robots without a position, or with one that has no place there, have NaN.
    """

    scene: SiteScene
    robots: Points
    metre: Points
    plans: list[Points]
    draft: Points
    cursor: Points
    transform: SiteToMapTransform


class SceneTransformer:
    """Places scenes, each plan and each draft once for as long as the map keeps its CRS."""

    def __init__(self) -> None:
        self._transform: SiteToMapTransform | None = None
        self._plans: dict[TaskPath, Points] = {}
        self._of: list[TaskPath] | None = None
        self._ways: list[Points] = []
        """The placed plans of the list in the previous scene."""
        self._outline: object = None
        self._draft = _NOWHERE

    def placed(self, scene: SiteScene, transform: SiteToMapTransform) -> MapScene:
        """Place everything; a robot whose position has no place in the map's CRS is left out.

        :raises MapTransformError: when the site, or something else than a robot, has no place there.
        """
        if transform is not self._transform:
            self._transform, self._plans, self._of, self._outline = transform, {}, None, None
        known = self._plans
        new = [] if scene.plans is self._of else [plan for plan in scene.plans if plan not in known]
        outline = scene.draft.outline if scene.draft else ()
        is_known = outline is self._outline
        robots = scene.robots
        there = np.flatnonzero(np.isfinite(robots.xy[:, 0]) & np.isfinite(robots.xy[:, 1]))
        is_uneven = transform.axes is None
        others = [
            _points(() if is_known else outline),
            _points([scene.cursor] if scene.cursor else ()),
            *[plan.points for plan in new],
        ]
        try:
            parts = [*_robot_points(robots, there, is_uneven=is_uneven), *others]
            placed = transform.to_map(np.concatenate(parts))
        except MapTransformError:
            transform.to_map(_SITE_ORIGIN)
            there = there[_have_place(robots.xy[there], transform)]
            parts = [*_robot_points(robots, there, is_uneven=is_uneven), *others]
            placed = transform.to_map(np.concatenate(parts))
        at, before, draft, cursor, *ways = _parted(placed, parts)
        if scene.plans is not self._of:
            known.update(zip(new, ways, strict=True))
            self._plans = {plan: known[plan] for plan in scene.plans}
            self._of, self._ways = scene.plans, list(self._plans.values())
        if not is_known:
            self._outline, self._draft = outline, draft
        return MapScene(
            scene,
            _spread(at, there, len(robots.xy)),
            _spread(before - at, there, len(robots.xy)) if is_uneven else _NOWHERE,
            self._ways,
            self._draft,
            cursor,
            transform,
        )


def _robot_points(robots: RobotArrays, rows: npt.NDArray[np.intp], *, is_uneven: bool) -> list[Points]:
    """Return where the robots in ``rows`` are, and 1 m ahead of them where the map is ``is_uneven``."""
    # Taking rows with [] takes numpy ten times as long.
    xy = robots.xy if len(rows) == len(robots.xy) else robots.xy.take(rows, axis=0)
    return [xy, xy + _forward(robots.theta.take(rows)) if is_uneven else _NOWHERE]


def _have_place(xy: Points, transform: SiteToMapTransform) -> npt.NDArray[np.bool_]:
    """Return (n,) whether each position, and one a metre from it, has a place in the map's CRS."""
    around = np.stack([xy, xy + 1.0, xy - 1.0], axis=1)
    return np.isfinite(transform.to_map_or_nan(around)[:, 0, 0])


def _forward(theta: npt.NDArray[np.float64]) -> Points:
    """Return the vector of 1 m in each heading, along x where it is not known."""
    # Floats of half the size are precise enough for a heading; numpy is ten times as fast with them.
    turn = theta.astype(np.float32)
    turn[np.isnan(turn)] = 0.0
    way = np.empty((len(turn), 2))
    way[:, 0], way[:, 1] = np.cos(turn), np.sin(turn)
    return way


def _parted(whole: Points, parts: list[Points]) -> list[Points]:
    """Return ``whole`` split into pieces with the lengths of ``parts``."""
    ends = accumulate(len(part) for part in parts)
    return [whole[end - len(part) : end] for end, part in zip(ends, parts, strict=True)]


def _spread(values: Points, rows: npt.NDArray[np.intp], count: int) -> Points:
    if len(rows) == count:
        return values
    out = np.full((count, 2), np.nan)
    out[rows] = values
    return out


def _points(points: Sequence[Point]) -> Points:
    return np.fromiter(chain.from_iterable(points), np.float64).reshape(-1, 2) if points else _NOWHERE


Rows = npt.NDArray[np.intp]

BESIDE = 12.0
"""Pixels beyond the border at which a robot is still partly visible."""


@dataclass(frozen=True)
class InView:
    """The robots of a scene on one screen, in logical pixels.

    ``pixels`` (n, 2) is each robot's position, NaN where not known; ``rows`` (m,) are the visible ones.
    Of these ``there`` (m, 2) is the position, ``heading`` (m,) radians clockwise from +x, and ``scale`` the
    pixels per metre there, (m,) or the same for all. An unknown heading is that of the site's x.
    """

    pixels: Points
    rows: Rows
    there: Points
    heading: npt.NDArray[np.float32]
    scale: npt.NDArray[np.float64] | float


def in_view(placed: MapScene, screen: Screen) -> InView:
    """Return the robots of ``placed`` that are visible on ``screen``."""
    pixels = screen.pixels(placed.robots)
    rows = np.flatnonzero(screen.seen(pixels, BESIDE))
    # Taking rows with [] takes numpy ten times as long.
    there = pixels.take(rows, axis=0)
    axes = placed.transform.axes
    if axes is None:
        x, y = screen.ways(placed.metre.take(rows, axis=0)).T
        # Floats of half the size are precise enough, and numpy is several times as fast with them.
        # np.hypot, safe from overflow, takes five times as long.
        heading = np.arctan2(y.astype(np.float32), x.astype(np.float32))
        return InView(pixels, rows, there, heading, np.sqrt(x * x + y * y))
    # A canvas has one scale, and a site's axes are only rotated: the scale along its x holds everywhere.
    (x, y), (to_x, to_y) = screen.ways(axes).tolist()
    turned = math.copysign(1.0, x * to_y - y * to_x)
    theta = placed.scene.robots.theta.take(rows).astype(np.float32)
    theta[np.isnan(theta)] = 0.0
    return InView(
        pixels, rows, there, np.float32(math.atan2(y, x)) + theta * np.float32(turned), math.hypot(x, y)
    )

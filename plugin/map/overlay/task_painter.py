"""Painters of robots' tasks: the paths of commands, the pending command, and queues."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from itertools import accumulate

import numpy as np
import numpy.typing as npt
from qgis.gui import QgsMapCanvasItem
from qgis.PyQt import sip
from qgis.PyQt.QtCore import QPointF, QRectF, Qt
from qgis.PyQt.QtGui import QBrush, QColor, QFont, QImage, QPainter, QPen
from qgis.PyQt.QtWidgets import QStyleOptionGraphicsItem, QWidget

from ...control.fleet_controller import FleetController
from ...control.pending_command import CONE, START, TARGETS, ApproachKind, PendingCommand
from ...ui.errors import FleetError
from ...ui.glyphs import (
    CASING,
    PAPER,
    REFUSED,
    ROUTE,
    broken,
    dashes,
    draw_cone,
    lines,
    painting,
    polygon,
    ring,
    route,
)
from ...ui.glyphs import CONE as QUEUE_MARKS_CONE
from ...ui.language import tr
from .labels import Labels
from .robots_painter import CONE_TARGET, TARGET, Sprites
from .scene import MapScene, Screen, screen_image, screen_of

MANY = 60
"""With more paths lines are thin and targets small, and only selected robots have lines and distances.

With more points of a pending command its targets are small and its line is painted once into an image; more
clicks get no rings.
"""
Points = npt.NDArray[np.float64]
Marks = Callable[[float, float], Sprites]
"""Returns the marks for a pixel ratio and a size."""
SMALL = 0.5
FILL_SECONDS = 0.003
"""Time limit for painting ways in one frame."""


class PathsImage:
    """Shows a sheet of ways, moved along with the view, until the next one is filled.

    Of a thousand robots some have new ways in every frame, and painting all of them takes several frames. So
    each sheet is filled completely, and shows the state at its beginning.
    """

    def __init__(self) -> None:
        self.forget()

    def forget(self) -> None:
        """Show nothing until the next :meth:`prepare`."""
        self._shown: _PathsSheet | None = None
        self._next: _PathsSheet | None = None
        self.is_whole = True
        """Whether everything is painted, so that no more frames are needed."""

    def prepare(self, placed: MapScene, screen: Screen) -> None:
        """Paint some more of the ways visible on ``screen`` into the sheet."""
        if self._next is not None and self._next.transform is not placed.transform:
            self.forget()
        if self._next is None or (self._next.is_full and not self._next.is_of(placed, screen)):
            self._next = _PathsSheet(placed, screen)
        self._next.fill()
        self.is_whole = self._next.is_full and self._next.is_of(placed, screen)
        if self._next.is_full or self._shown is None:
            self._shown = self._next

    def paint(self, painter: QPainter, screen: Screen) -> None:
        """Show the prepared image at its place on ``screen``."""
        if self._shown is None or self._shown.image is None:
            return
        painter.save()
        if screen != self._shown.screen:
            painter.setTransform(screen.since(self._shown.screen), True)
        painter.drawImage(QPointF(0.0, 0.0), self._shown.image)
        painter.restore()


class _PathsSheet:
    """The ways of ``placed`` as visible on ``screen``; created empty and filled bit by bit."""

    def __init__(self, placed: MapScene, screen: Screen) -> None:
        self.screen = screen
        self.transform = placed.transform
        self._plans = placed.plans
        pairs = zip(placed.scene.plans, placed.plans, strict=True)
        self._left = [points for plan, points in pairs if plan.is_way]
        self.image = screen_image(screen, lambda _: None) if self._left else None
        """None where there is no way."""
        self._is_thin = len(self._left) > MANY

    @property
    def is_full(self) -> bool:
        """Whether every way is painted."""
        return not self._left

    def is_of(self, placed: MapScene, screen: Screen) -> bool:
        """Return whether it shows the plans of ``placed`` on this screen."""
        return self._plans is placed.plans and self.screen == screen

    def fill(self) -> None:
        """Paint more ways while there is time, at least one."""
        if self.is_full:
            return
        until = time.perf_counter() + FILL_SECONDS
        with painting(self.image) as painter:
            painter.setRenderHint(QPainter.RenderHint.Antialiasing, not self._is_thin)
            painter.setPen(QPen(ROUTE, 0.0))
            while self._left:
                pixels = self.screen.pixels(self._left.pop())
                if self._is_thin:
                    painter.drawPolyline(polygon(pixels))
                else:
                    route(painter, pixels, ROUTE)
                if time.perf_counter() > until:
                    break


class PathsPainter:
    """Caches everything that changes only with the plans."""

    def __init__(self, labels: Labels) -> None:
        self._labels = labels
        self._ways = PathsImage()
        self._of: list[Points] | None = None
        """The placed plans that the cache is for:"""
        self._ends = np.empty((0, 2))
        self._kinds = np.empty(0, dtype=np.intp)
        self.distances: list[tuple[float, float]] = []
        """The targets, in pixels, below which a distance was written last."""

    @property
    def is_whole(self) -> bool:
        """Whether everything is painted, so that no more frames are needed."""
        return self._ways.is_whole

    def prepare(self, placed: MapScene, screen: Screen, marks: Marks) -> None:
        """Prepare everything for :meth:`paint`: doing both at once would block the window."""
        plans = placed.scene.plans
        if not plans:
            self._ways.forget()
            self._of = None
            return
        if placed.plans is not self._of:
            self._apply(placed)
        self._ways.prepare(placed, screen)
        for size in (SMALL, 1.0):
            marks(screen.ratio, size)

    def paint(
        self, painter: QPainter, placed: MapScene, pixels: Points, screen: Screen, marks: Marks
    ) -> None:
        """Paint every plan that was prepared; ``pixels`` (n, 2) is each robot's position."""
        plans = placed.scene.plans
        self.distances = []
        if not plans:
            return
        self._ways.paint(painter, screen)
        targets = screen.pixels(self._ends)
        shown = list(range(len(plans))) if len(plans) <= MANY else _of_chosen(placed)
        _lines_to_targets(painter, placed, shown, pixels, targets)
        on = screen.seen(targets, 30.0)
        small = on.copy()
        small[shown] = False
        large = on & ~small
        marks(screen.ratio, SMALL).paint(painter, targets[small], self._kinds[small])
        marks(screen.ratio, 1.0).paint(painter, targets[large], self._kinds[large])
        seen = [k for k in shown if on[k]]
        self.distances = [(x, y) for x, y in targets[seen].tolist()]
        for k, (x, y) in zip(seen, self.distances, strict=True):
            self._distance(painter, placed.scene.remaining.get(plans[k].command), x, y, screen)

    def _apply(self, placed: MapScene) -> None:
        self._of = placed.plans
        self._ends = np.array([points[-1] for points in placed.plans])
        self._kinds = np.array([CONE_TARGET if plan.cone else TARGET for plan in placed.scene.plans])

    def _distance(self, painter: QPainter, metres: float | None, x: float, y: float, screen: Screen) -> None:
        if metres is None:
            return
        text = (
            tr(
                "{metres:.0f} m",
                metres=metres,
            )
            if metres < 9950
            else tr("{km:.0f} km", km=metres / 1000)
        )
        label = self._labels.picture(text, screen.ratio)
        painter.drawPixmap(QPointF(x - label.width() / screen.ratio / 2, y + 5), label)


def _of_chosen(placed: MapScene) -> list[int]:
    chosen = set(placed.scene.chosen)
    return [k for k, plan in enumerate(placed.scene.plans) if plan.robot in chosen][:MANY]


def _lines_to_targets(
    painter: QPainter, placed: MapScene, shown: Sequence[int], pixels: Points, targets: Points
) -> None:
    """Paint broken lines from robots at ``pixels`` to ``targets`` that have no way."""
    scene = placed.scene
    there = [k for k in shown if not scene.plans[k].is_way and scene.plans[k].robot in scene.rows]
    start = pixels[[scene.rows[scene.plans[k].robot] for k in there]]
    is_known = np.isfinite(start).all(axis=1)
    broken(painter, lines(start[is_known], targets[there][is_known]), PAPER, Qt.PenStyle.DotLine)


MANY_LEGS, FAR_PX = 2000, 10000.0
"""With more legs, or a longer way on the screen, a route is thin: in full width it would take over 10 ms."""


class PendingCommandPainter:
    """Caches an image of a large draft: stroking a thousand legs again for each frame takes seconds."""

    def __init__(self) -> None:
        self._image: QImage | None = None
        self._made_for: tuple = ()

    def paint(
        self, painter: QPainter, placed: MapScene, robots: Points, screen: Screen, marks: Marks
    ) -> None:
        """Paint the draft and the next leg to the mouse; ``robots`` (n, 2) are robots' positions, in pixels.

        ``marks`` returns the marks for a pixel ratio and a size.
        """
        draft = placed.scene.draft
        if draft is None:
            self._image, self._made_for = None, ()
            return
        is_wrong = bool(draft.findings.faults) and draft.override is None
        colour = REFUSED if is_wrong else PAPER
        points, cursor = screen.pixels(placed.draft), screen.pixels(placed.cursor)
        if draft.kind == START:
            _paint_start(painter, points, colour)
            return
        start = _robot_of(draft, placed, robots)
        if draft.way.is_along_roads:
            self._paint_way(painter, placed, points, screen, colour if is_wrong else ROUTE)
            _paint_targets(painter, points[-1:], colour)
            return
        targets = draft.kind in (CONE, TARGETS)
        first = Qt.PenStyle.DashLine if targets else Qt.PenStyle.DotLine
        dashes(painter, np.concatenate([start, points[:1]]), colour, first)
        if targets and len(points) > MANY:
            self._paint_many(painter, placed.draft, points, screen, colour, marks)
        elif targets:
            _paint_targets(painter, points, colour)
        else:
            self._paint_way(painter, placed, points, screen, colour if is_wrong else ROUTE)
        if not targets:
            _paint_clicks(painter, points, draft, colour)
            dashes(painter, np.concatenate([points[-1:], cursor]), colour, Qt.PenStyle.DashLine)

    def _paint_way(
        self, painter: QPainter, placed: MapScene, points: Points, screen: Screen, colour: QColor
    ) -> None:
        if len(points) > MANY:
            self._paint_many(painter, placed.draft, points, screen, colour, None)
        else:
            route(painter, points, colour)

    def _paint_many(
        self,
        painter: QPainter,
        on_map: Points,
        points: Points,
        screen: Screen,
        colour: QColor,
        marks: Marks | None,
    ) -> None:
        made_for = (on_map, screen, colour.rgba(), marks is None)
        if not self._made_for or self._made_for[0] is not on_map or self._made_for[1:] != made_for[1:]:
            self._image, self._made_for = _drawn(points, screen, colour, marks), made_for
        painter.drawImage(QPointF(0.0, 0.0), self._image)


def _drawn(points: Points, screen: Screen, colour: QColor, marks: Marks | None) -> QImage:
    def paint(painter: QPainter) -> None:
        if marks is None and _is_cheap(points, screen):
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            route(painter, points, colour)
            return
        painter.setPen(QPen(colour, 0.0))
        painter.drawPolyline(polygon(points))
        if marks is not None:
            seen = points[screen.seen(points, 30.0)]
            marks(screen.ratio, SMALL).paint(painter, seen, np.full(len(seen), CONE_TARGET))

    return screen_image(screen, paint)


def _is_cheap(points: Points, screen: Screen) -> bool:
    """Return whether a route through (n, 2) pixels is painted quickly: parts off the screen cost nothing."""
    low, high = np.minimum(points[:-1], points[1:]), np.maximum(points[:-1], points[1:])
    seen = (high > 0.0).all(axis=1) & (low < (screen.width, screen.height)).all(axis=1)
    length = np.hypot(*(high - low)[seen].T).sum()
    return len(points) <= MANY_LEGS and float(length) <= FAR_PX


def _robot_of(draft: PendingCommand, placed: MapScene, robots: Points) -> Points:
    """Return the position of the draft's robot, (1, 2) pixels; (0, 2) where that is not known.

    Nor while the way to a target is sought: a straight line would be mistaken for it.
    """
    row = placed.scene.rows.get(draft.robot)
    if row is None or draft.way.kind is ApproachKind.SOUGHT or not np.isfinite(robots[row]).all():
        return np.empty((0, 2))
    return robots[[row]]


def _paint_targets(painter: QPainter, points: Points, colour: QColor) -> None:
    dashes(painter, points, colour, Qt.PenStyle.DashLine)
    painter.setOpacity(0.85)
    for point in points:
        ring(painter, point, 12.0, colour)
        draw_cone(painter, QPointF(*point), 26.0)
    painter.setOpacity(1.0)


def _paint_clicks(painter: QPainter, points: Points, draft: PendingCommand, colour: QColor) -> None:
    """Paint a ring at each click of a route; a way along the roads has hundreds of points between two."""
    if len(draft.legs) > MANY:
        return
    for end in accumulate(draft.legs):
        ring(painter, points[end - 1], 3.5, colour)


def _paint_start(painter: QPainter, points: Points, colour: QColor) -> None:
    """Paint a start position, the first of ``points``; the second is in its heading, if it has one."""
    place, ahead = points[0], points[1:]
    for radius in (12.0, 3.0):
        ring(painter, place, radius, colour)
    length = float(np.hypot(*(ahead - place).T)[0]) if len(ahead) else 0.0
    if length > 0.0:
        tip = place + (ahead - place) / length * 34.0
        dashes(painter, np.concatenate([place[None], tip]), colour, Qt.PenStyle.SolidLine)


RADIUS = 9.0
MOST_DOTTED = 60
"""With more tasks the line between them is thin: a dotted one would take longer than a frame."""
MOST_NUMBERED = 200
"""Tasks with a number; the line continues through all."""
BELOW_ROBOTS = 80
"""Beneath the live overlay, which is at 90."""
INK = QColor(20, 24, 28)
NOWHERE: Points = np.empty((0, 2))


class QueueMarks(QgsMapCanvasItem):
    """Covers the whole viewport. Painted into an image once for each queue, selection and view: the robots
    above it are painted twenty times a second, and it with them.
    """

    def __init__(self, desk: FleetController):
        super().__init__(desk.canvas)
        self._desk = desk
        self.places = NOWHERE
        """Places of the tasks in order, (n, 2) in the map's CRS."""
        self._image: QImage | None = None
        self._made_for: Screen | None = None
        self.setZValue(BELOW_ROBOTS)
        desk.state.queues_changed.connect(self._place)
        desk.selection.changed.connect(self._place)
        desk.state.site_changed.connect(self._place)
        desk.canvas.destinationCrsChanged.connect(self._place)
        desk.project.transformContextChanged.connect(self._place)

    def remove(self) -> None:
        """Remove the item from the canvas."""
        self._desk.canvas.destinationCrsChanged.disconnect(self._place)
        self._desk.project.transformContextChanged.disconnect(self._place)
        if not sip.isdeleted(self._desk.canvas):
            self._desk.canvas.scene().removeItem(self)

    def boundingRect(self) -> QRectF:
        return QRectF(0, 0, self._desk.canvas.width(), self._desk.canvas.height())

    def updatePosition(self) -> None:
        self.prepareGeometryChange()
        self.setPos(0, 0)

    def paint(
        self, painter: QPainter, option: QStyleOptionGraphicsItem | None = None, widget: QWidget | None = None
    ) -> None:
        if len(self.places) == 0:
            return
        ratio = painter.device().devicePixelRatioF() if painter.device() else 1.0
        screen = screen_of(self._desk.canvas, self, ratio)
        if screen != self._made_for:
            pixels = screen.pixels(self.places)
            self._image, self._made_for = screen_image(screen, lambda on: _paint(on, pixels, screen)), screen
        painter.drawImage(QPointF(0.0, 0.0), self._image)

    def _place(self, *_: object) -> None:
        robot = self._desk.selection.last
        queue = self._desk.state.queues.get(robot) if robot is not None else None
        points = [(task.x, task.y) for task in queue.tasks] if queue is not None else []
        self.places, self._image, self._made_for = NOWHERE, None, None
        if points:
            try:
                self.places = self._desk.site_to_canvas.transform().to_map(np.array(points))
            except FleetError:
                # The live overlay reports why nothing can be placed on this map.
                self.places = NOWHERE
        self.update()


def _paint(painter: QPainter, pixels: Points, screen: Screen) -> None:
    """Paint tasks at (n, 2) ``pixels`` and the line through them."""
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    if len(pixels) <= MOST_DOTTED:
        legs = lines(pixels[:-1], pixels[1:])
        for colour, width in ((CASING, 3.4), (PAPER, 1.4)):
            painter.setPen(QPen(colour, width, Qt.PenStyle.DotLine))
            painter.drawLines(legs)
    else:
        painter.setPen(QPen(QUEUE_MARKS_CONE, 0.0))
        painter.drawPolyline(polygon(pixels))
    font = QFont(painter.font())
    font.setPixelSize(11)
    font.setBold(True)
    painter.setFont(font)
    numbered = pixels[:MOST_NUMBERED]
    # The first on top: where several are at one place it comes next.
    for number in np.flatnonzero(screen.seen(numbered, 2 * RADIUS))[::-1].tolist():
        _paint_number(painter, QPointF(*numbered[number].tolist()), number + 1)


def _paint_number(painter: QPainter, at: QPointF, number: int) -> None:
    painter.setPen(QPen(QUEUE_MARKS_CONE, 2.0))
    painter.setBrush(QBrush(PAPER))
    painter.drawEllipse(at, RADIUS, RADIUS)
    painter.setPen(INK)
    box = QRectF(at.x() - 2 * RADIUS, at.y() - RADIUS, 4 * RADIUS, 2 * RADIUS)
    painter.drawText(box, Qt.AlignmentFlag.AlignCenter, str(number))

"""Robots, painted: glyphs, selection, velocity, uncertainty, hints at the map's border, and their density."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
import numpy.typing as npt
from qgis.PyQt.QtCore import QPointF, QRectF, QSizeF, Qt
from qgis.PyQt.QtGui import QColor, QImage, QPainter, QPixmap, QTransform

from ....robot_bridge.core.messages.positions import Density
from ....robot_bridge.core.messages.safety import RobotState
from ...gateway_client.robot_table import STATES
from ...layers.site_transform import SiteToMapTransform
from ...ui.glyphs import CASING, PAPER, STATE_COLOURS, pen
from ...ui.language import tr_count
from . import primitives
from .labels import Labels
from .primitives import FORMAT
from .scene import InView, MapScene, Screen

Points = npt.NDArray[np.float64]
Rows = npt.NDArray[np.intp]

SIZES = ((150, 1.0), (1500, 0.7), (np.inf, 0.46))
"""Up to how many robots on the screen each is drawn in which size."""
NOTICEABLE = 0.7
"""No robot that needs to be noticed, because it is not fresh, is drawn smaller."""
VELOCITY_SECONDS = 2.0
"""A robot's line leads to where it will be after so long."""
NOSE = 15.5
"""Pixels that a robot drawn in full size reaches forward."""
SHORTEST_VELOCITY = 4.0
"""Pixels beyond the nose."""
MOST_VELOCITIES = 1500
FINE_VELOCITIES = 300
"""With more of them the lines are thin: smooth ones would take half of the frame."""
CORNERS = 32
SMALLEST_CIRCLE = 12.0
MOST_CIRCLES = 300
_FRESH, _STALE, _LOST, _OFFLINE = range(len(STATES))
_UPWARDS = (_OFFLINE, _FRESH, _STALE, _LOST)
"""In which order robots are painted, the selected ones last: what needs to be noticed lies on top."""
_LAYER = np.argsort(_UPWARDS).astype(np.uint16)
"""The place of each of STATES in that order."""
STRIP = 16
STRIPS = 4096
"""Pixels of a strip of the screen, and more strips than any screen has."""
_TURNS = np.arange(primitives.HEADINGS)
_CIRCLE = np.column_stack([f(np.arange(CORNERS) * 2 * np.pi / CORNERS) for f in (np.cos, np.sin)])


class RobotsPainter:
    """Paints the robots on one screen at a time."""

    def __init__(self) -> None:
        self._drawings: dict[tuple[float, int], primitives.Sprites] = {}
        self._marks: dict[float, primitives.Sprites] = {}
        self._made_for = 0.0, 0.0
        """The pixel ratio and the magnification that the drawings are for: of others none is kept."""
        self.magnification = 1.0
        """How many times as large as they come robots are drawn."""
        self.arrows = True
        """Whether the robots themselves are painted; their rings always are."""

    def set_magnification(self, times: float) -> None:
        """Draw robots so many times as large as they come."""
        self.magnification = times

    def draw_arrows(self, on: bool) -> None:
        """Draw an arrow for each robot, or none."""
        self.arrows = on

    def marks(self, ratio: float, size: float = 1.0) -> primitives.Sprites:
        """Return the marks of :func:`~.desk.live.atlases.mark_atlas`."""
        if self._made_for != (ratio, self.magnification):
            self._drawings.clear()
            self._marks.clear()
            self._made_for = ratio, self.magnification
        if size not in self._marks:
            self._marks[size] = primitives.Sprites(
                primitives.mark_atlas(ratio, size), primitives.cell(ratio, primitives.MARK_SIZE * size), ratio
            )
        return self._marks[size]

    def prepare(self, placed: MapScene, view: InView, screen: Screen) -> None:
        """Make the drawings that are missing for :meth:`paint`: that takes as long as all else in it."""
        self.marks(screen.ratio, self.magnification)
        size = _size(view)
        states = np.bincount(placed.scene.robots.state.take(view.rows))
        for state in np.flatnonzero(states).tolist() if self.arrows else []:
            self._sprites(_worth(state, size), state)

    def paint(
        self,
        painter: QPainter,
        placed: MapScene,
        view: InView,
        screen: Screen,
    ) -> None:
        """Paint those that are in view."""
        marks = self.marks(screen.ratio, self.magnification)
        robots, scene = placed.scene.robots, placed.scene
        size = _size(view)
        known = np.isfinite(robots.theta.take(view.rows))
        speed = robots.v.take(view.rows)
        _velocities(painter, view, speed, known, NOSE * size * self.magnification + SHORTEST_VELOCITY)
        chosen = [scene.rows[name] for name in scene.chosen if name in scene.rows]
        layer = _LAYER.take(robots.state)
        if chosen:
            rings = np.full(len(chosen), primitives.OTHER_RING)
            rings[-1:] = primitives.RING
            marks.paint(painter, view.pixels[chosen], rings)
            layer[chosen] += len(STATES)
        if not self.arrows:
            return
        cells = np.where(known, _directions(view.metre), primitives.HEADINGS)
        self._paint_drawings(painter, view.there, cells, layer.take(view.rows), size)

    def _paint_drawings(
        self,
        painter: QPainter,
        at: Points,
        cells: Rows,
        layer: npt.NDArray[np.uint16],
        size: float,
    ) -> None:
        """Paint one of the ``cells`` at each ``at``, layer upon layer."""
        order = _from_the_top(layer, at[:, 1])
        at, cells = at.take(order, axis=0), cells.take(order)
        ends = np.bincount(layer, minlength=2 * len(STATES)).cumsum().tolist()
        for k, (begin, end) in enumerate(pairwise([0, *ends])):
            if begin < end:
                is_chosen, of_state = divmod(k, len(STATES))
                worth = 1.0 if is_chosen else _worth(_UPWARDS[of_state], size)
                self._sprites(worth, _UPWARDS[of_state]).paint(painter, at[begin:end], cells[begin:end])

    def _sprites(self, size: float, state: int) -> primitives.Sprites:
        """Return the drawings of robots in a state, made when the first such robot is seen."""
        if (size, state) not in self._drawings:
            ratio, magnification = self._made_for
            drawn = size * magnification
            atlas = primitives.robot_atlas(ratio, drawn, STATES[state])
            self._drawings[size, state] = primitives.Sprites(atlas, primitives.cell(ratio, drawn), ratio)
        return self._drawings[size, state]


def _size(view: InView) -> float:
    """Return the size in which robots are drawn where so many are in view."""
    return next(size for most, size in SIZES if len(view.rows) <= most)


def _worth(state: int, size: float) -> float:
    """Return the size of robots in a state where those that are as they should be are drawn in ``size``."""
    return size if state == _FRESH else max(size, NOTICEABLE)


def _directions(way: Points) -> Rows:
    """Return which of the :data:`HEADINGS` (n, 2) ``way`` in pixels points in, clockwise from +x."""
    # Floats of half the size are exact enough, and numpy is several times as fast with them.
    x, y = way[:, 0].astype(np.float32), way[:, 1].astype(np.float32)
    turns = np.rint(np.arctan2(y, x) * np.float32(primitives.HEADINGS / (2 * np.pi)))
    # What is negative counts from the end.
    return _TURNS.take(turns.astype(np.intp))


def _from_the_top(layer: npt.NDArray[np.uint16], y: npt.NDArray[np.float64]) -> Rows:
    """Return in which order to paint: layer after layer, each from the top of the screen to its bottom.

    Ten thousand robots painted here and there take half as long again: a screen's lines lie apart in memory.
    Within a strip they keep their order, so that those that overlap do not change places all the time.
    """
    # What reaches in from above is less than a strip off the screen: cut off, that is the first one.
    strip = (y * (1 / STRIP)).astype(np.uint16)
    # numpy sorts numbers of 16 bits in a fifth of the time.
    return np.argsort(layer * np.uint16(STRIPS) + strip, kind="stable")


def circles(placed: MapScene, view: InView) -> list[tuple[int, Points]]:
    """Return the rows of robots whose accuracy is known and can be seen, with (m, 2) corners on the map."""
    robots = placed.scene.robots
    # What is NaN compares false.
    wide = view.rows[robots.accuracy.take(view.rows) * view.scale > SMALLEST_CIRCLE]
    if len(wide) > MOST_CIRCLES:
        wide = wide[np.argsort(-robots.accuracy[wide])[:MOST_CIRCLES]]
    if len(wide) == 0:
        return []
    corners = robots.xy[wide, None, :] + _CIRCLE * robots.accuracy[wide, None, None]
    on_map = placed.placement.to_map(corners.reshape(-1, 2)).reshape(len(wide), CORNERS, 2)
    return list(zip(wide.tolist(), on_map, strict=True))


def paint_circles(
    painter: QPainter, found: list[tuple[int, Points]], placed: MapScene, screen: Screen
) -> None:
    """Paint what :func:`circles` found: the robot is somewhere inside."""
    for row, corners in found:
        colour = QColor(STATE_COLOURS[STATES[placed.scene.robots.state[row]]])
        outline = primitives.polygon(screen.pixels(corners))
        painter.setPen(pen(PAPER, 2.6, 0.55))
        colour.setAlpha(30)
        painter.setBrush(colour)
        painter.drawPolygon(outline)
        colour.setAlpha(255)
        painter.setPen(pen(colour, 1.2))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.drawPolygon(outline)


def _velocities(
    painter: QPainter,
    view: InView,
    speed: npt.NDArray[np.float64],
    known: npt.NDArray[np.bool_],
    shortest: float,
) -> None:
    """Draw a line from each robot to where it will be soon, unless that is less than ``shortest`` pixels.

    ``speed`` is in metres a second, ``known`` whether there is a heading.
    """
    # What is NaN compares false.
    long = np.flatnonzero(np.abs(speed) * view.scale > shortest / VELOCITY_SECONDS)
    long = long[known[long]]
    if len(long) == 0 or len(long) > MOST_VELOCITIES:
        return
    start = view.there[long]
    end = start + view.metre[long] * (speed[long, None] * VELOCITY_SECONDS)
    if len(long) > FINE_VELOCITIES:
        painter.setRenderHint(QPainter.RenderHint.Antialiasing, False)
        painter.strokePath(primitives.segments(start, end), primitives.flat(pen(PAPER, 1.0)))
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        return
    long_ones = primitives.lines(start, end)
    for stroke in (pen(CASING, 4.2), pen(PAPER, 2.0)):
        painter.setPen(primitives.flat(stroke))
        painter.drawLines(long_ones)


MARGIN = 14.0
APART = 56.0
"""Pixels of the border that share one arrow."""
FIND_EVERY = 0.25
"""Seconds for which the arrows and their numbers stay as they are unless the view moves."""
_SLOTS = 10_000
"""More than fit along any border."""
_URGENT = np.array([1, 2, 3, 0])
"""The rank of each of STATES: an arrow for several robots has the colour of the one to worry about."""
_BY_RANK = np.argsort(_URGENT)


@dataclass(frozen=True)
class Hint:
    """One arrow: where, which way it points (radians clockwise from +x), and the rows it stands for."""

    x: float
    y: float
    turn: float
    rows: Rows

    @cached_property
    def area(self) -> tuple[float, float, float, float]:
        """About what the arrow and its text cover: left, top, right, bottom."""
        # A single robot has its name there, several their number.
        inward, wide = (48.0, 44.0) if len(self.rows) == 1 else (24.0, 16.0)
        x, y = self.x - inward * math.cos(self.turn), self.y - inward * math.sin(self.turn)
        return min(x, self.x) - wide, min(y, self.y) - 14.0, max(x, self.x) + wide, max(y, self.y) + 14.0


def hints(pixels: Points, beyond: Rows, screen: Screen) -> list[Hint]:
    """Return the arrows for the robots in rows ``beyond``; ``pixels`` (n, 2) is where each robot is."""
    if len(beyond) == 0:
        return []
    middle = np.array([screen.width, screen.height]) / 2.0
    way = pixels[beyond] - middle
    reach = (middle - MARGIN) / np.maximum(np.abs(way), 1e-9)
    at = middle + way * np.minimum(reach[:, 0], reach[:, 1])[:, None]
    slot = np.round(at / APART).astype(np.intp)
    _, of, count = np.unique(slot[:, 0] * _SLOTS + slot[:, 1], return_inverse=True, return_counts=True)
    order = np.argsort(of, kind="stable")
    first = np.cumsum(count) - count
    x, y, dx, dy = np.add.reduceat(np.hstack([at, way])[order], first).T / count
    groups = np.split(beyond[order], first[1:])
    turns = np.arctan2(dy, dx)
    return [Hint(*given) for given in zip(x.tolist(), y.tolist(), turns.tolist(), groups, strict=True)]


class BorderHints:
    """Finds the arrows a few times a second, and paints them from an atlas."""

    def __init__(self, labels: Labels) -> None:
        self._labels = labels
        self._atlases: dict[tuple[int, bool], primitives.Sprites] = {}
        self._ratio = 0.0
        self._found_for: tuple[Screen, list[str]] | None = None
        self._found_at = -np.inf
        self.hints: list[Hint] = []
        self._chosen: tuple[str, ...] | None = None
        """For which selection it was made ready what is painted; None when it has to be made again."""
        self._arrows: list[tuple[primitives.Sprites, Points, Rows]] = []
        self._texts: list[tuple[QPointF, QPixmap]] = []

    def find(self, placed: MapScene, view: InView, screen: Screen) -> None:
        """Find the arrows for robots that are not in view, unless that was done just now."""
        now, names = placed.scene.now, placed.scene.robots.names
        is_new = self._found_for is None or self._found_for[0] != screen or self._found_for[1] != names
        if not is_new and abs(now - self._found_at) < FIND_EVERY:
            return
        self._found_for, self._found_at = (screen, names), now
        beyond = np.isfinite(view.pixels[:, 0])
        beyond[view.rows] = False
        self.hints, self._chosen = hints(view.pixels, np.flatnonzero(beyond), screen), None

    def paint(self, painter: QPainter, placed: MapScene, screen: Screen) -> None:
        """Paint each arrow in its robots' colour, with their name or number."""
        if self._chosen != placed.scene.chosen:
            names, ranks = placed.scene.robots.names, _ranks(placed)
            self._arrows = self._coloured(placed, screen) if self.hints else []
            pressing = sorted(self.hints, key=lambda hint: -ranks[hint.rows].max())
            texts = [_beside(self._labels, hint, names, screen) for hint in pressing]
            self._texts = _apart(texts, screen.ratio)
            self._chosen = placed.scene.chosen
        for arrow, at, cells in self._arrows:
            arrow.paint(painter, at, cells)
        for place, text in self._texts:
            painter.drawPixmap(place, text)

    def _coloured(self, placed: MapScene, screen: Screen) -> list[tuple[primitives.Sprites, Points, Rows]]:
        """Return for each colour the arrow, the places where it stands, and its cells."""
        chosen = [placed.scene.rows[name] for name in placed.scene.chosen if name in placed.scene.rows]
        rows = np.concatenate([hint.rows for hint in self.hints])
        first = np.cumsum([0, *(len(hint.rows) for hint in self.hints[:-1])])
        states = _BY_RANK[np.maximum.reduceat(_URGENT[placed.scene.robots.state[rows]], first)]
        is_chosen = np.logical_or.reduceat(np.isin(rows, chosen), first)
        turns = np.array([hint.turn for hint in self.hints]) / (2 * np.pi)
        cells = np.round(turns * primitives.ARROW_TURNS).astype(np.intp) % primitives.ARROW_TURNS
        at = np.array([(hint.x, hint.y) for hint in self.hints])
        found = []
        for state, to_chosen in sorted({*zip(states.tolist(), is_chosen.tolist(), strict=True)}):
            those = np.flatnonzero((states == state) & (is_chosen == to_chosen))
            found.append((self._arrow(state, to_chosen, screen.ratio), at[those], cells[those]))
        return found

    def _arrow(self, state: int, to_chosen: bool, ratio: float) -> primitives.Sprites:
        """Return the arrow to robots in a state, made when it is needed first."""
        if ratio != self._ratio:
            self._atlases.clear()
            self._ratio = ratio
        if (state, to_chosen) not in self._atlases:
            atlas = primitives.arrow_atlas(ratio, STATES[state], to_chosen)
            self._atlases[state, to_chosen] = primitives.Sprites(
                atlas, primitives.cell(ratio, primitives.ARROW_SIZE), ratio
            )
        return self._atlases[state, to_chosen]


def _ranks(placed: MapScene) -> npt.NDArray[np.int64]:
    """Return how much each robot is to be noticed: a selected one most, then one to worry about."""
    ranks = _URGENT[placed.scene.robots.state]
    rows = placed.scene.rows
    ranks[[rows[name] for name in placed.scene.chosen if name in rows]] = len(STATES)
    return ranks


def _apart(texts: list[tuple[QPointF, QPixmap]], ratio: float) -> list[tuple[QPointF, QPixmap]]:
    """Leave out what would lie over a text before it; its arrow stays, and says by a click who it is."""
    shown: list[tuple[QPointF, QPixmap]] = []
    taken: list[QRectF] = []
    for place, picture in texts:
        area = QRectF(place, QSizeF(picture.size()) / ratio)
        if not any(area.intersects(other) for other in taken):
            shown.append((place, picture))
            taken.append(area)
    return shown


def _beside(labels: Labels, hint: Hint, names: list[str], screen: Screen) -> tuple[QPointF, QPixmap]:
    """Return the robot's name, or how many there are, and where it is whole on the arrow's inner side."""
    text = names[hint.rows[0]] if len(hint.rows) == 1 else str(len(hint.rows))
    picture = labels.picture(text, screen.ratio)
    width, height = picture.width() / screen.ratio, picture.height() / screen.ratio
    inward = 8.0 + math.hypot(width, height) / 2
    x = hint.x - math.cos(hint.turn) * inward - width / 2
    y = hint.y - math.sin(hint.turn) * inward - height / 2
    x = min(max(x, 0.0), screen.width - width)
    y = min(max(y, 0.0), screen.height - height)
    return QPointF(x, y), picture


# --- Robots that are too many to be drawn one by one: cells as dark as there are robots in them ---

FAINTEST, DARKEST = 0.3, 0.9
"""How much of the map a cell with one robot covers, and the fullest one."""
LEGEND_AT = 12
"""Pixels of the legend from the left and from below."""


class DensityPainter:
    """Paints the density of a scene, and says beneath what it is."""

    def __init__(self, labels: Labels) -> None:
        self._labels = labels
        self._made: tuple[Density, SiteToMapTransform] | None = None
        self._image = QImage()
        self._corners: Points = np.empty((0, 2))
        """(3, 2): the first corner of the grid in the map, the one along its x, and the one along its y."""

    def paint(self, painter: QPainter, placed: MapScene, screen: Screen) -> None:
        """Paint it, where the scene has one."""
        fleet = placed.scene.fleet
        if fleet is None or fleet.density is None:
            self._made = None
            return
        density = fleet.density
        if self._made is None or self._made[0] is not density or self._made[1] is not placed.placement:
            self._made = density, placed.placement
            self._image, self._corners = _picture(density), _corners(density, placed.placement)
        (x, y), along, up = screen.pixels(self._corners).tolist()
        columns, rows = density.columns, density.rows
        painter.save()
        to_screen = QTransform(
            (along[0] - x) / columns, (along[1] - y) / columns, (up[0] - x) / rows, (up[1] - y) / rows, x, y
        )
        painter.setTransform(to_screen, True)
        painter.setRenderHint(QPainter.RenderHint.SmoothPixmapTransform, False)
        painter.drawImage(QRectF(0, 0, columns, rows), self._image)
        painter.restore()
        text = tr_count(
            fleet.inside,
            "1 robot here, shown as a density; zoom in to see it",
            "%n robots here, shown as a density; zoom in to see each",
        )
        legend = self._labels.picture(text, screen.ratio)
        height = legend.height() / screen.ratio
        painter.drawPixmap(QPointF(LEGEND_AT, screen.height - LEGEND_AT - height), legend)


def _corners(density: Density, placement: SiteToMapTransform) -> Points:
    x, y = density.x, density.y
    width, height = density.columns * density.cell, density.rows * density.cell
    return placement.to_map(np.array([(x, y), (x + width, y), (x, y + height)]))


def _picture(density: Density) -> QImage:
    """Return a pixel for each cell: its colour is that of its robots' states, its cover by how many."""
    counts = np.array([density.fresh, density.silent, density.offline], dtype=np.float64)
    total = counts.sum(axis=0)
    colours = [STATE_COLOURS[state] for state in (RobotState.FRESH, RobotState.LOST, RobotState.OFFLINE)]
    rgb = np.array([(c.red(), c.green(), c.blue()) for c in colours], dtype=np.float64)
    mixed = (counts / np.maximum(total, 1.0)).T @ rgb
    # By the root: a cell with four times as many covers twice as much, and the emptiest ones are seen.
    cover = FAINTEST + (DARKEST - FAINTEST) * np.sqrt(total / total.max(initial=1.0))
    pixels = np.zeros((density.rows * density.columns, 4), dtype=np.uint8)
    cells = np.array(density.cells, dtype=np.intp)
    # Premultiplied, and in memory blue first.
    pixels[cells, :3] = (mixed * cover[:, None])[:, ::-1]
    pixels[cells, 3] = 255 * cover
    image = QImage(pixels.tobytes(), density.columns, density.rows, 4 * density.columns, FORMAT)
    # Of its own: what it was made of goes.
    return image.copy()

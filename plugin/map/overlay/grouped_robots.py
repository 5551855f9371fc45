"""Robots that are not drawn one by one: border arrows to those off the map, and the density of many."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from qgis.PyQt.QtCore import QPointF, QRectF
from qgis.PyQt.QtGui import QImage, QPainter, QTransform

from ....robot_bridge.core.messages.positions import Density
from ....robot_bridge.core.messages.safety import RobotState
from ...gateway_client.robot_states import STATES, UNSURE
from ...layers.site_transform import SiteToMapTransform
from ...ui.glyphs import PAPER, SELECTED, STATE_COLOURS, draw_arrow
from ...ui.language import tr_count
from .labels import Labels, TextAtlas, WrittenText
from .robots_painter import FORMAT, Cells, Sprites, cell, turned
from .scene import InView, MapScene, Screen

Points = npt.NDArray[np.float64]
Rows = npt.NDArray[np.intp]

# --- Arrows at the map's border to the robots beyond it ---

ARROW_SIZE = 0.95
"""Size in cells."""
ARROW_TURNS = 40
"""Number of directions in which arrows are drawn."""
MARGIN = 14.0
APART = 56.0
"""Pixels of the border that share one arrow."""
FIND_EVERY = 0.25
"""Seconds for which arrows and their numbers stay unless the view moves."""
_URGENT = np.array([1, 3, 4, 0, 2])
"""The rank of each display state: an arrow for several robots has the colour of the most critical."""
_BY_RANK = np.argsort(_URGENT)


def arrow_atlas(pixel_ratio: float, state: RobotState, is_chosen: bool) -> Cells:
    """Return the arrow to a robot beyond the border, turned as in :func:`.robots_painter.robot_atlas`."""
    side = cell(pixel_ratio, ARROW_SIZE)
    rim = SELECTED if is_chosen else PAPER
    return turned(lambda painter: draw_arrow(painter, state, rim), side, pixel_ratio, ARROW_TURNS)


@dataclass(frozen=True)
class Hint:
    """One arrow: position, direction (radians clockwise from +x), and the rows of its robots."""

    x: float
    y: float
    turn: float
    rows: Rows

    @cached_property
    def area(self) -> tuple[float, float, float, float]:
        """Approximate area of the arrow and its text: left, top, right, bottom."""
        # A single robot has its name there, several have their number.
        inward, wide = (48.0, 44.0) if len(self.rows) == 1 else (24.0, 16.0)
        x, y = self.x - inward * math.cos(self.turn), self.y - inward * math.sin(self.turn)
        return min(x, self.x) - wide, min(y, self.y) - 14.0, max(x, self.x) + wide, max(y, self.y) + 14.0


def hints(pixels: Points, beyond: Rows, screen: Screen) -> list[Hint]:
    """Return the arrows for the robots in rows ``beyond``; ``pixels`` (n, 2) is each robot's position."""
    if len(beyond) == 0:
        return []
    middle = np.array([screen.width, screen.height]) / 2.0
    way = pixels[beyond] - middle
    reach = (middle - MARGIN) / np.maximum(np.abs(way), 1e-9)
    at = middle + way * np.minimum(reach[:, 0], reach[:, 1])[:, None]
    across, down = np.round(np.maximum(at, 0.0) / APART).T
    # 16 bits, enough for a screen of 14 000 pixels square: numpy sorts those in a tenth of the time.
    slot = (across * (screen.height // APART + 2) + down).astype(np.uint16)
    order = np.argsort(slot, kind="stable")
    first = np.flatnonzero(np.diff(slot[order], prepend=slot[order[0]] + 1))
    count = np.diff(first, append=len(order))
    x, y, dx, dy = np.add.reduceat(np.hstack([at, way])[order], first).T / count
    groups = np.split(beyond[order], first[1:])
    turns = np.arctan2(dy, dx)
    return [Hint(*given) for given in zip(x.tolist(), y.tolist(), turns.tolist(), groups, strict=True)]


class BorderText(NamedTuple):
    """The name of an arrow's robot, or the number of its robots, and its edges in logical pixels."""

    text: str
    left: float
    top: float
    right: float
    bottom: float


class BorderHints:
    """Finds the arrows a few times per second, and paints them from an atlas."""

    def __init__(self) -> None:
        self._written = TextAtlas(1.0)
        self._drawings: dict[tuple[int, bool], Cells] = {}
        """The arrows of each state, to selected robots and to others; in the order of :attr:`_sprites`."""
        self._sprites: Sprites | None = None
        self._found_for: tuple[Screen, list[str]] | None = None
        self._found_at = -np.inf
        self.hints: list[Hint] = []
        self._chosen: tuple[str, ...] | None = None
        """The selection for which the painting was prepared; None when it must be prepared again."""
        self._arrows: tuple[Points, Rows] = np.empty((0, 2)), np.empty(0, dtype=np.intp)
        """(n, 2) places of the arrows, and their cells."""
        self.texts: list[BorderText] = []
        """The texts beside the arrows."""
        self._corners, self._parts = np.empty((0, 2)), np.empty((0, 6))
        """The same for each of their parts, as :meth:`TextAtlas.paint` takes them."""

    def find(self, placed: MapScene, view: InView, screen: Screen) -> bool:
        """Find the arrows for robots out of view, unless that was just done; return whether it was done."""
        now, names = placed.scene.now, placed.scene.robots.names
        is_new = self._found_for is None or self._found_for[0] != screen or self._found_for[1] != names
        if not is_new and abs(now - self._found_at) < FIND_EVERY:
            return False
        self._found_for, self._found_at = (screen, names), now
        beyond = np.isfinite(view.pixels[:, 0])
        beyond[view.rows] = False
        self.hints, self._chosen = hints(view.pixels, np.flatnonzero(beyond), screen), None
        return True

    def paint(self, painter: QPainter, placed: MapScene, screen: Screen) -> None:
        """Paint each arrow in its robots' colour, with their name or number."""
        if not self.hints:
            self.texts = []
            return
        if self._chosen != placed.scene.chosen:
            self._chosen = placed.scene.chosen
            self._arrange(placed, screen)
        self._sprites.paint(painter, *self._arrows)
        self._written.paint(painter, self._corners, self._parts)

    def _arrange(self, placed: MapScene, screen: Screen) -> None:
        """Prepare the painting of the arrows and of their texts."""
        if screen.ratio != self._written.ratio:
            self._written = TextAtlas(screen.ratio)
            self._drawings.clear()
        rows = np.concatenate([hint.rows for hint in self.hints])
        first = np.cumsum([0, *(len(hint.rows) for hint in self.hints[:-1])])
        self._arrows = self._coloured(placed, rows, first, screen)
        ranks = np.maximum.reduceat(_ranks(placed)[rows], first)
        pressing = [self.hints[k] for k in np.argsort(-ranks, kind="stable").tolist()]
        names = placed.scene.robots.names
        texts = [names[hint.rows[0]] if len(hint.rows) == 1 else str(len(hint.rows)) for hint in pressing]
        self._written.provide(texts, shown=[texts])
        written = map(self._written.written, texts)
        beside = [_beside(*each, screen) for each in zip(texts, written, pressing, strict=True)]
        self.texts = _apart(beside)
        shown = [(text, self._written.written(text.text).parts) for text in self.texts]
        corners = [(text.left, text.top) for text, parts in shown for _ in parts]
        self._corners = np.array(corners, dtype=np.float64).reshape(-1, 2)
        parts = [part for _, parts in shown for part in parts]
        self._parts = np.array(parts, dtype=np.float64).reshape(-1, 6)

    def _coloured(self, placed: MapScene, rows: Rows, first: Rows, screen: Screen) -> tuple[Points, Rows]:
        """Return the places of the arrows and their cells, those of one colour after those of another.

        ``rows`` are the robots of all hints, and ``first`` the index where those of each hint begin.
        """
        chosen = [placed.scene.rows[name] for name in placed.scene.chosen if name in placed.scene.rows]
        looks = _BY_RANK[np.maximum.reduceat(_URGENT[placed.scene.robots.shown_as[rows]], first)]
        # As for a stale one: an arrow has no outline that could be broken.
        states = np.where(looks == UNSURE, STATES.index(RobotState.STALE), looks)
        is_chosen = np.logical_or.reduceat(np.isin(rows, chosen), first)
        turns = np.array([hint.turn for hint in self.hints]) / (2 * np.pi)
        cells = np.round(turns * ARROW_TURNS).astype(np.intp) % ARROW_TURNS
        colours = [*zip(states.tolist(), is_chosen.tolist(), strict=True)]
        self._provide(set(colours), screen.ratio)
        places = {drawing: place for place, drawing in enumerate(self._drawings)}
        cells += ARROW_TURNS * np.array([places[colour] for colour in colours])
        at = np.array([(hint.x, hint.y) for hint in self.hints])
        order = sorted(range(len(colours)), key=colours.__getitem__)
        return at[order], cells[order]

    def _provide(self, drawings: set[tuple[int, bool]], ratio: float) -> None:
        """Have the arrows of a state, to selected robots or to others, drawn on first use."""
        missing = drawings - self._drawings.keys()
        if not missing:
            return
        for state, to_chosen in sorted(missing):
            self._drawings[state, to_chosen] = arrow_atlas(ratio, STATES[state], to_chosen)
        self._sprites = Sprites([*self._drawings.values()], ratio)


def _ranks(placed: MapScene) -> npt.NDArray[np.int64]:
    """Return the priority of each robot: a selected one first, then critical ones."""
    ranks = _URGENT[placed.scene.robots.shown_as]
    rows = placed.scene.rows
    ranks[[rows[name] for name in placed.scene.chosen if name in rows]] = len(_URGENT)
    return ranks


def _apart(texts: list[BorderText]) -> list[BorderText]:
    """Remove texts that overlap an earlier one; the arrow stays, and a click on it shows its robots."""
    boxes = np.array([text[1:] for text in texts]).reshape(-1, 4)
    first, last = boxes[:, :2], boxes[:, 2:]
    overlaps = ((first[:, None] < last) & (first < last[:, None])).all(axis=2)
    shown, covered = [], np.zeros(len(texts), dtype=np.bool_)
    for text, is_covered, over in zip(texts, covered, overlaps, strict=True):
        if not is_covered:
            shown.append(text)
            covered |= over
    return shown


def _beside(text: str, written: WrittenText, hint: Hint, screen: Screen) -> BorderText:
    """Return the place of the ``text`` of an arrow, fully visible inside of that."""
    inward = 8.0 + math.hypot(written.width, written.height) / 2
    x = hint.x - math.cos(hint.turn) * inward - written.width / 2
    y = hint.y - math.sin(hint.turn) * inward - written.height / 2
    x = min(max(x, 0.0), screen.width - written.width)
    y = min(max(y, 0.0), screen.height - written.height)
    return BorderText(text, x, y, x + written.width, y + written.height)


# --- Robots that are too many to be drawn one by one: cells shaded by their number of robots ---

FAINTEST, DARKEST = 0.3, 0.9
"""Opacity of a cell with one robot, and of the fullest one."""
LEGEND_AT = 12
"""Distance in pixels of the legend from the left and from below."""


class DensityPainter:
    """Paints the density of a scene, and a legend beneath."""

    def __init__(self, labels: Labels) -> None:
        self._labels = labels
        self._made: tuple[Density, SiteToMapTransform] | None = None
        self._image = QImage()
        self._corners: Points = np.empty((0, 2))
        """(3, 2): the first corner of the grid in the map, the one along its x, and the one along its y."""

    def paint(self, painter: QPainter, placed: MapScene, screen: Screen) -> None:
        """Paint the density, where the scene has one."""
        fleet = placed.scene.fleet
        if fleet is None or fleet.density is None:
            self._made = None
            return
        density = fleet.density
        if self._made is None or self._made[0] is not density or self._made[1] is not placed.transform:
            self._made = density, placed.transform
            self._image, self._corners = _picture(density), _corners(density, placed.transform)
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


def _corners(density: Density, transform: SiteToMapTransform) -> Points:
    x, y = density.x, density.y
    width, height = density.columns * density.cell, density.rows * density.cell
    return transform.to_map(np.array([(x, y), (x + width, y), (x, y + height)]))


def _picture(density: Density) -> QImage:
    """Return an image with a pixel per cell: its colour from its robots' states, its opacity by number."""
    counts = np.array([density.fresh, density.silent, density.offline], dtype=np.float64)
    total = counts.sum(axis=0)
    colours = [STATE_COLOURS[state] for state in (RobotState.FRESH, RobotState.LOST, RobotState.OFFLINE)]
    rgb = np.array([(c.red(), c.green(), c.blue()) for c in colours], dtype=np.float64)
    mixed = (counts / np.maximum(total, 1.0)).T @ rgb
    # By the square root: four times as many robots double the opacity, and the emptiest cells are visible.
    cover = FAINTEST + (DARKEST - FAINTEST) * np.sqrt(total / total.max(initial=1.0))
    pixels = np.zeros((density.rows * density.columns, 4), dtype=np.uint8)
    cells = np.array(density.cells, dtype=np.intp)
    # Premultiplied, and in memory blue first.
    pixels[cells, :3] = (mixed * cover[:, None])[:, ::-1]
    pixels[cells, 3] = 255 * cover
    image = QImage(pixels.tobytes(), density.columns, density.rows, 4 * density.columns, FORMAT)
    # A copy: the array it was made of is freed.
    return image.copy()

"""Robots that are not drawn one by one: border arrows to those off the map, and the density of many."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt
from qgis.PyQt.QtCore import QPointF, QRectF
from qgis.PyQt.QtGui import QImage, QPainter, QPixmap, QTransform

from ....robot_bridge.core.messages.positions import Density
from ....robot_bridge.core.messages.safety import RobotState
from ...gateway_client.robot_states import STATES, UNSURE
from ...layers.site_transform import SiteToMapTransform
from ...ui.glyphs import PAPER, SELECTED, STATE_COLOURS, draw_arrow
from ...ui.language import tr_count
from .labels import Labels
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


class BorderHints:
    """Finds the arrows a few times per second, and paints them from an atlas."""

    def __init__(self, labels: Labels) -> None:
        self._labels = labels
        self._atlases: dict[tuple[int, bool], Sprites] = {}
        self._ratio = 0.0
        self._found_for: tuple[Screen, list[str]] | None = None
        self._found_at = -np.inf
        self.hints: list[Hint] = []
        self._chosen: tuple[str, ...] | None = None
        """The selection for which the painting was prepared; None when it must be prepared again."""
        self._arrows: list[tuple[Sprites, Points, Rows]] = []
        self._texts: list[tuple[QPointF, QPixmap]] = []

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
        if self._chosen != placed.scene.chosen:
            self._chosen = placed.scene.chosen
            self._arrows, self._texts = self._made(placed, screen) if self.hints else ([], [])
        for arrow, at, cells in self._arrows:
            arrow.paint(painter, at, cells)
        for place, text in self._texts:
            painter.drawPixmap(place, text)

    def _made(
        self, placed: MapScene, screen: Screen
    ) -> tuple[list[tuple[Sprites, Points, Rows]], list[tuple[QPointF, QPixmap]]]:
        """Return the arrows as returned by :meth:`_coloured`, and the texts with their positions."""
        rows = np.concatenate([hint.rows for hint in self.hints])
        first = np.cumsum([0, *(len(hint.rows) for hint in self.hints[:-1])])
        ranks = np.maximum.reduceat(_ranks(placed)[rows], first)
        names = placed.scene.robots.names
        pressing = np.argsort(-ranks, kind="stable").tolist()
        texts = [_beside(self._labels, self.hints[k], names, screen) for k in pressing]
        return self._coloured(placed, rows, first, screen), _apart(texts, screen.ratio)

    def _coloured(
        self, placed: MapScene, rows: Rows, first: Rows, screen: Screen
    ) -> list[tuple[Sprites, Points, Rows]]:
        """Return for each colour the arrow, its positions, and its cells.

        ``rows`` are the robots of all hints, and ``first`` the index where those of each hint begin.
        """
        chosen = [placed.scene.rows[name] for name in placed.scene.chosen if name in placed.scene.rows]
        looks = _BY_RANK[np.maximum.reduceat(_URGENT[placed.scene.robots.shown_as[rows]], first)]
        # As for a stale one: an arrow has no outline that could be broken.
        states = np.where(looks == UNSURE, STATES.index(RobotState.STALE), looks)
        is_chosen = np.logical_or.reduceat(np.isin(rows, chosen), first)
        turns = np.array([hint.turn for hint in self.hints]) / (2 * np.pi)
        cells = np.round(turns * ARROW_TURNS).astype(np.intp) % ARROW_TURNS
        at = np.array([(hint.x, hint.y) for hint in self.hints])
        found = []
        for state, to_chosen in sorted({*zip(states.tolist(), is_chosen.tolist(), strict=True)}):
            those = np.flatnonzero((states == state) & (is_chosen == to_chosen))
            found.append((self._arrow(state, to_chosen, screen.ratio), at[those], cells[those]))
        return found

    def _arrow(self, state: int, to_chosen: bool, ratio: float) -> Sprites:
        """Return the arrow to robots in a state, created on first use."""
        if ratio != self._ratio:
            self._atlases.clear()
            self._ratio = ratio
        if (state, to_chosen) not in self._atlases:
            self._atlases[state, to_chosen] = Sprites([arrow_atlas(ratio, STATES[state], to_chosen)], ratio)
        return self._atlases[state, to_chosen]


def _ranks(placed: MapScene) -> npt.NDArray[np.int64]:
    """Return the priority of each robot: a selected one first, then critical ones."""
    ranks = _URGENT[placed.scene.robots.shown_as]
    rows = placed.scene.rows
    ranks[[rows[name] for name in placed.scene.chosen if name in rows]] = len(_URGENT)
    return ranks


def _apart(texts: list[tuple[QPointF, QPixmap]], ratio: float) -> list[tuple[QPointF, QPixmap]]:
    """Remove texts that overlap an earlier one; the arrow stays, and a click on it shows its robots."""
    first = np.array([(place.x(), place.y()) for place, _ in texts]).reshape(-1, 2)
    last = first + np.array([(text.width(), text.height()) for _, text in texts]).reshape(-1, 2) / ratio
    overlaps = ((first[:, None] < last) & (first < last[:, None])).all(axis=2)
    shown, covered = [], np.zeros(len(texts), dtype=np.bool_)
    for text, is_covered, over in zip(texts, covered, overlaps, strict=True):
        if not is_covered:
            shown.append(text)
            covered |= over
    return shown


def _beside(labels: Labels, hint: Hint, names: list[str], screen: Screen) -> tuple[QPointF, QPixmap]:
    """Return the robot's name, or the number of robots, and its place, fully visible inside of the arrow."""
    text = names[hint.rows[0]] if len(hint.rows) == 1 else str(len(hint.rows))
    picture = labels.picture(text, screen.ratio)
    width, height = picture.width() / screen.ratio, picture.height() / screen.ratio
    inward = 8.0 + math.hypot(width, height) / 2
    x = hint.x - math.cos(hint.turn) * inward - width / 2
    y = hint.y - math.sin(hint.turn) * inward - height / 2
    x = min(max(x, 0.0), screen.width - width)
    y = min(max(y, 0.0), screen.height - height)
    return QPointF(x, y), picture


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

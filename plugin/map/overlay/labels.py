"""Labels: short texts as images, their placement, and robots' names."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from itertools import chain
from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from qgis.PyQt.QtCore import QPointF, Qt
from qgis.PyQt.QtGui import QColor, QFont, QFontMetricsF, QPainter, QPixmap, QStaticText, QTransform

from ....robot_bridge.core.messages.safety import RobotState
from ...gateway_client.robot_states import STATES, UNSURE, RobotArrays
from ...gateway_client.state_words import ROBOT_STATES, display_state_in_words
from ...ui.glyphs import PAPER, painting
from ...ui.language import tr
from .robots_painter import Fragments
from .scene import InView, MapScene, Screen

INK = QColor("#101418")
MOST = 600
"""Images that are kept: about twice as many as fit on a screen."""
MARGIN = 4
CASING = 1.6
"""Width in pixels of the halo around the letters."""
_AT = QPointF(MARGIN, MARGIN)
_AROUND = [
    _AT + QPointF(CASING * math.cos(turn), CASING * math.sin(turn))
    for turn in (k * math.pi / 4 for k in range(8))
]
"""Offsets of the letters in their image, and of the halo around them."""
HEIGHT = 18
"""Line spacing in logical pixels."""


class Labels:
    """Renders each text once; painting text for each robot and frame would cost more than all else."""

    def __init__(self) -> None:
        self._pictures: dict[tuple[str, float], QPixmap] = {}

    def picture(self, text: str, ratio: float) -> QPixmap:
        """Return ``text`` as an image for ``ratio`` device pixels per logical pixel."""
        key = (text, ratio)
        picture = self._pictures.pop(key, None)
        if picture is None:
            picture = _drawn(text, ratio)
        # The least recently used come first, and are dropped first.
        self._pictures[key] = picture
        if len(self._pictures) > MOST:
            del self._pictures[next(iter(self._pictures))]
        return picture


def age_in_words(seconds: float) -> str:
    """Return an age, as in ``12 s``, ``5 min``, ``3 h``, ``2 d``."""
    if seconds < 60:
        return tr("{seconds:.0f} s", seconds=seconds)
    if seconds < 3600:
        return tr("{minutes:.0f} min", minutes=seconds / 60)
    return (
        tr(
            "{hours:.0f} h",
            hours=seconds / 3600,
        )
        if seconds < 48 * 3600
        else tr("{days:.0f} d", days=seconds / 86400)
    )


def _drawn(text: str, ratio: float) -> QPixmap:
    width, height = _size(text, QFontMetricsF(_font()))
    pixmap = QPixmap(math.ceil(width * ratio), math.ceil(height * ratio))
    pixmap.setDevicePixelRatio(ratio)
    pixmap.fill(QColor(0, 0, 0, 0))
    with painting(pixmap) as painter:
        painter.setFont(_font())
        _write(painter, text)
    return pixmap


def _font() -> QFont:
    font = QFont()
    font.setPixelSize(13)
    font.setBold(True)
    return font


def _size(text: str, metrics: QFontMetricsF) -> tuple[int, int]:
    """Return the width and the height of a text's image, in logical pixels."""
    width = math.ceil(metrics.horizontalAdvance(text)) + 2 * MARGIN
    return width, math.ceil(metrics.height()) + 2 * MARGIN


def _write(painter: QPainter, text: str) -> None:
    written = QStaticText(text)
    written.setTextFormat(Qt.TextFormat.PlainText)
    painter.setPen(PAPER)
    # Stroking the letters' outlines would take six times as long as writing them eight times.
    for beside in _AROUND:
        painter.drawStaticText(beside, written)
    painter.setPen(INK)
    painter.drawStaticText(_AT, written)


Points = npt.NDArray[np.float64]
LINE = 96
"""Logical pixels of a text that are on one line of the image below: longer ones continue on the next."""
FEWEST_LINES, MOST_LINES = 64, 1200
"""Range of the number of lines of the image as texts are added: about four times what fits on a screen."""
AROUND_INK = CASING + 1.5
"""Pixels around the letters that hold their halo and its antialiasing."""
HIGHEST = 30_000
"""Device pixels: Qt paints no farther than to 32767."""


Part = tuple[int, int, int, int, int, int]


class WrittenText(NamedTuple):
    """A text in a :class:`TextAtlas`: the size of its whole image in logical pixels, and its inked parts:
    the offset of each from the left and the top of the whole, and its left, top, width and height in the
    atlas, all in device pixels."""

    width: float
    height: float
    parts: tuple[Part, ...]


class TextAtlas:
    """Short texts in one image, out of which many are painted at once; ``ratio`` device pixels are a
    logical one.

    Painting each from an image of its own takes four times as long.
    """

    def __init__(self, ratio: float) -> None:
        self.ratio = ratio
        self._texts: dict[str, WrittenText] = {}
        self._font = _font()
        self._metrics = QFontMetricsF(self._font)
        self._width = round(LINE * ratio)
        self._used = 0
        """Device pixels from the top that are in use."""
        self._picture = self._empty(0)
        self._fragments = Fragments(ratio)

    def __contains__(self, text: str) -> bool:
        return text in self._texts

    def provide(self, texts: Iterable[str], shown: Iterable[Iterable[str]]) -> None:
        """Draw those of ``texts`` that are missing. If there is no room, of the other texts only those
        ``shown`` are kept, and all are placed again."""
        for text in texts:
            if text not in self._texts:
                self._add(text, shown)

    def written(self, text: str) -> WrittenText:
        """Return a text in the atlas."""
        return self._texts[text]

    def paint(self, painter: QPainter, corner: Points, parts: Points) -> None:
        """Paint ``parts``, (n, 6) as in :class:`WrittenText`, of texts whose images begin at each left
        upper ``corner``, (n, 2) logical pixels."""
        if len(parts) == 0:
            return
        table = self._fragments.table(len(parts))
        table[:, 2:6] = parts[:, 2:]
        # Whole device pixels keep letters sharp.
        at = np.floor(corner * self.ratio + 0.5) + parts[:, :2] + parts[:, 4:] / 2
        table[:, :2] = at / self.ratio
        self._fragments.paint(painter, self._picture)

    def _add(self, text: str, shown: Iterable[Iterable[str]]) -> None:
        metrics, ratio = self._metrics, self.ratio
        width, height = _size(text, metrics)
        ink = metrics.tightBoundingRect(text).translated(MARGIN, MARGIN + metrics.ascent())
        ink.adjust(-AROUND_INK, -AROUND_INK, AROUND_INK, AROUND_INK)
        left, top = max(0, math.floor(ink.left() * ratio)), max(0, math.floor(ink.top() * ratio))
        right = min(math.ceil(width * ratio), math.ceil(ink.right() * ratio))
        lines = min(math.ceil(height * ratio), math.ceil(ink.bottom() * ratio)) - top
        begins = range(left, right, self._width)
        if self._used + lines * len(begins) > self._picture.height():
            self._make_room(lines * len(begins), shown)
        parts = []
        with painting(self._picture) as painter:
            painter.setFont(self._font)
            for begin in begins:
                across = min(right - begin, self._width)
                painter.setClipRect(0, self._used, across, lines)
                painter.setTransform(QTransform(ratio, 0.0, 0.0, ratio, -begin, self._used - top))
                _write(painter, text)
                painter.resetTransform()
                parts.append((begin, top, 0, self._used, across, lines))
                self._used += lines
        whole = math.ceil(width * ratio) / ratio, math.ceil(height * ratio) / ratio
        self._texts[text] = WrittenText(*whole, tuple(parts))

    def _make_room(self, height: int, shown: Iterable[Iterable[str]]) -> None:
        """Begin another image with room for ``height``: twice as large for all texts, or at least half
        that size for those that are ``shown``, and for the newest."""
        before, picture = self._texts, self._picture
        fewest, most = (min(HIGHEST, round(n * HEIGHT * self.ratio)) for n in (FEWEST_LINES, MOST_LINES))
        kept = {text: before[text] for text in chain.from_iterable(shown) if text in before}
        needed = height + sum(_height(one.parts) for one in kept.values())
        room = max(min(most, 2 * picture.height()), fewest, min(HIGHEST, 2 * needed))
        for text, one in reversed(before.items()):
            needed += 0 if text in kept else _height(one.parts)
            if needed > (room if room > picture.height() else room / 2):
                break
            kept[text] = one
        self._texts, self._used, self._picture = {}, 0, self._empty(room)
        # The newest last again.
        self._copy({text: before[text] for text in before if text in kept}, picture)

    def _copy(self, texts: dict[str, WrittenText], picture: QPixmap) -> None:
        """Copy ``texts``, whose parts are in ``picture``, into the atlas too."""
        with painting(self._picture) as painter:
            painter.setCompositionMode(QPainter.CompositionMode.CompositionMode_Source)
            for text, one in texts.items():
                parts = []
                for left, top, x, y, width, height in one.parts:
                    painter.drawPixmap(0, self._used, picture, x, y, width, height)
                    parts.append((left, top, 0, self._used, width, height))
                    self._used += height
                self._texts[text] = one._replace(parts=tuple(parts))

    def _empty(self, height: int) -> QPixmap:
        picture = QPixmap(self._width, height)
        picture.fill(QColor(0, 0, 0, 0))
        return picture


def _height(parts: Iterable[Part]) -> int:
    return sum(part[-1] for part in parts)


Widths = npt.NDArray[np.float64]
Cells = npt.NDArray[np.intp]
GRID = 6.0
"""Pixels of a cell of the occupancy grid."""
LINES = int(HEIGHT // GRID) + 1
"""Lines of cells that a text covers, wherever it begins."""


class LabelPlacer:
    """The areas of the screen taken by (n, 2) ``robots`` in pixels and by texts.

    ``texts`` are left, top, right and bottom of existing texts.
    """

    def __init__(
        self, screen: Screen, robots: Points, texts: Sequence[tuple[float, float, float, float]] = ()
    ) -> None:
        self._lines, self._columns = int(screen.height // GRID) + LINES, int(screen.width // GRID) + 2
        self._robots = self._counted(robots)
        self._taken = [0] * self._lines
        """For each line the cells, as bits, that are blocked for texts that begin on it."""
        for left, top, right, bottom in texts:
            cells = _bits(max(0, int(left // GRID)), max(0, int(right // GRID) + 1))
            self._cover(int(top // GRID), int(bottom // GRID) + 1, cells)

    def cells(self, corner: Points, width: Widths) -> Cells:
        """Return (3, n) the first line, the left cell, and the one just right of texts of ``width``
        that begin at the left upper ``corner``, (n, 2), all in pixels.
        """
        x, y = corner[:, 0], corner[:, 1]
        found = np.empty((3, len(corner)), dtype=np.intp)
        edges = (y, self._lines - LINES), (x, self._columns), (x + width + GRID, self._columns)
        for cell, (edge, most) in zip(found, edges, strict=True):
            # numpy takes ten times as long for //.
            cell[:] = np.minimum(np.maximum(np.floor(edge * (1.0 / GRID)), 0), most)
        return found

    def without_robots(self, cells: Cells) -> npt.NDArray[np.bool_]:
        """Return which texts, given as by :meth:`cells`, cover no robot."""
        line, left, right = cells
        stride = self._lines + 2
        return self._robots.take(right * stride + line) == self._robots.take(left * stride + line)

    def place_labels(self, cells: Cells) -> list[int]:
        """Place texts in order, except those that overlap an earlier one; return their indices."""
        found = []
        for index, (line, left, right) in enumerate(cells.T.tolist()):
            bits = _bits(left, right)
            if not self._taken[line] & bits:
                self._cover(line, line + LINES, bits)
                found.append(index)
        return found

    def _cover(self, top: int, bottom: int, cells: int) -> None:
        """Block ``cells`` of the lines from ``top`` to before ``bottom``."""
        for line in range(max(0, top - LINES + 1), min(self._lines, bottom)):
            self._taken[line] |= cells

    def _counted(self, robots: Points) -> npt.NDArray[np.int32]:
        """Return for each cell the number of cells left of it in which a text beginning on its line covers a
        robot: where that differs between two cells, a robot is between them.
        """
        # Positions off the screen go to lines and columns that no text covers.
        line = np.minimum(np.maximum(np.floor(robots[:, 1] * (1.0 / GRID)), -1), self._lines) + 1
        column = np.minimum(np.maximum(np.floor(robots[:, 0] * (1.0 / GRID)), -1), self._columns - 1) + 1
        # Row-major: numpy sums up rows faster than along them.
        shape = self._columns + 1, self._lines + 2
        stands = np.zeros(shape[0] * shape[1] + LINES, dtype=np.uint8)
        stands[(column * shape[1] + line).astype(np.intp)] = 1
        below = stands[1 : 1 - LINES].copy()
        for down in range(1, LINES):
            below |= stands[1 + down : len(below) + 1 + down]
        return below.reshape(shape).cumsum(axis=0, dtype=np.int32)


def _bits(left: int, right: int) -> int:
    """Return an integer with the bits of the cells from ``left`` to before ``right`` set."""
    return (1 << right) - (1 << left)


Rows = npt.NDArray[np.intp]

CHOOSE_EVERY = 0.25
"""Seconds for which the same robots keep their texts, so that names do not flicker as robots pass."""
NEW_IN_A_FRAME = 8
"""Images of names rendered per frame: a map full of new ones must not block the window."""
BESIDE = (15.0, -12.0)
"""Offset of a text's beginning, at its middle, from the robot."""
LETTER = 8.0
"""Approximate width of a letter."""
SPOT = (36.0, 16.0)
"""Size in pixels of a spot, in which only one text is tried."""
SPOTS = 10_000
"""More than any screen has from top to bottom."""
STATE_LETTERS = 14.0
"""Letters that a robot's state and age take at most, except for hours and days."""
_URGENT = np.array([5, 3, 1, 7, 3], dtype=np.int8)
"""The rank of each display state: lost, then stale and unsure, then fresh, then offline,
each preceded by those whose texts were already shown. Small numbers: numpy sorts them
faster."""


class NamesPainter:
    """Chooses the robots whose names are shown, and paints them."""

    def __init__(self) -> None:
        self._named: Rows = np.empty(0, dtype=np.intp)
        self._written: list[list[str]] = []
        self._widths = np.empty(0)
        self._atlas = TextAtlas(1.0)
        self._shown: list[int] = []
        self._waiting: list[int] = []
        """Indices of the written texts whose images exist, and of those whose do not yet."""
        self._parts = np.empty((0, 6))
        self._of = np.empty(0, dtype=np.intp)
        self._beside = np.empty((0, 2))
        """The parts of the atlas to paint, the index of their text, and their offsets."""
        self._chosen_at = -np.inf
        self._has_waited = False
        self._screen: Screen | None = None
        self._names: list[str] = []
        self._lengths = np.empty(0)
        """Length of each name."""

    def paint(
        self,
        painter: QPainter,
        placed: MapScene,
        view: InView,
        screen: Screen,
        taken: Sequence[tuple[float, float, float, float]] = (),
        *,
        may_wait: bool = False,
    ) -> None:
        """Paint names of robots in view.

        ``taken`` are left, top, right and bottom of areas with texts. If it ``may_wait``, the choice of
        names stays unless the view moves: there is much else to do for this frame.
        """
        robots = placed.scene.robots
        now = placed.scene.now
        is_due = abs(now - self._chosen_at) >= CHOOSE_EVERY
        if is_due and may_wait and not self._has_waited:
            # For one frame at most: of frames that come slowly each has as much to do.
            is_due, self._has_waited = False, True
        if is_due or screen != self._screen or self._are_others(robots):
            self._named = self._chosen(placed, view, screen, taken)
            self._chosen_at, self._screen, self._has_waited = now, screen, False
            self._written = [texts(robots, row) for row in self._named.tolist()]
            self._widths = np.array([_width(parts) for parts in self._written])
            self._wait_for_pictures(screen.ratio)
        if self._waiting:
            self._make_pictures()
        corners = _corners(view.pixels.take(self._named, axis=0), self._widths, screen)
        self._atlas.paint(painter, corners.take(self._of, axis=0) + self._beside, self._parts)

    def _wait_for_pictures(self, ratio: float) -> None:
        """Paint at once the texts whose images exist already."""
        if ratio != self._atlas.ratio:
            self._atlas = TextAtlas(ratio)
        self._shown, self._waiting = [], []
        for k, parts in enumerate(self._written):
            (self._shown if all(text in self._atlas for text in parts) else self._waiting).append(k)
        self._arrange()

    def _make_pictures(self) -> None:
        """Render some of the missing images; the others follow with the next frames."""
        new = NEW_IN_A_FRAME
        while self._waiting and new > 0:
            self._shown.append(self._waiting.pop(0))
            new -= sum(text not in self._atlas for text in self._written[self._shown[-1]])
            self._atlas.provide(self._written[self._shown[-1]], shown=self._written)
        self._arrange()

    def _arrange(self) -> None:
        """Arrange the parts of the texts shown beside their robots, one after the other."""
        parts, of, beside = [], [], []
        for k in self._shown:
            along = 0.0
            for text in self._written[k]:
                one = self._atlas.written(text)
                parts += one.parts
                of += [k] * len(one.parts)
                beside += [(along, (HEIGHT - one.height) / 2)] * len(one.parts)
                along += one.width - 2 * MARGIN + 4
        self._parts = np.array(parts, dtype=np.float64).reshape(-1, 6)
        self._of = np.array(of, dtype=np.intp)
        self._beside = np.array(beside, dtype=np.float64).reshape(-1, 2)

    def _are_others(self, robots: RobotArrays) -> bool:
        """Return whether the row of a chosen robot is another robot's now."""
        if robots.names is self._names:
            return False
        rows = self._named.tolist()
        if rows and max(rows) >= len(robots.names):
            return True
        return any(robots.names[row] != parts[0] for row, parts in zip(rows, self._written, strict=True))

    def _chosen(
        self,
        placed: MapScene,
        view: InView,
        screen: Screen,
        taken: Sequence[tuple[float, float, float, float]] = (),
    ) -> Rows:
        """Return the rows whose texts do not cover another's text or robot, the most urgent first."""
        robots, scene, seen = placed.scene.robots, placed.scene, view.rows
        rank = _URGENT.take(robots.shown_as)
        rank[self._named[self._named < len(rank)]] -= 1
        rank[[scene.rows[name] for name in scene.chosen if name in scene.rows]] = -1
        rank = rank.take(seen)
        if robots.names is not self._names and robots.names != self._names:
            self._lengths = np.fromiter(map(len, robots.names), np.float64, len(robots.names))
        self._names = robots.names
        more = np.where(robots.shown_as.take(seen) > 0, STATE_LETTERS + 1.0, 1.0)
        width = LETTER * (self._lengths.take(seen) + more)
        corner = _corners(view.there, width, screen)
        room = LabelPlacer(screen, view.there, taken)
        # Urgent texts may cover a robot; the others are placed where there is none.
        cells = room.cells(corner, width)
        possible = np.flatnonzero((rank < 4) | room.without_robots(cells))
        order = possible[np.argsort(rank[possible], kind="stable")]
        order = order[_first_of_each_spot(corner.take(order, axis=0))]
        return seen[order[room.place_labels(cells.take(order, axis=1))]]


def texts(robots: RobotArrays, row: int) -> list[str]:
    """Return the texts beside a robot: its name; and its state and its last message's age unless fresh."""
    look = robots.shown_as[row]
    if look == UNSURE:
        return [robots.names[row], f"· {display_state_in_words(UNSURE)}"]
    state = STATES[look]
    if state is RobotState.FRESH:
        return [robots.names[row]]
    if state is RobotState.OFFLINE:
        return [robots.names[row], tr("· offline")]
    return [robots.names[row], f"· {ROBOT_STATES[state]} {age_in_words(robots.age[row])}"]


def _width(written: list[str]) -> float:
    return LETTER * sum(len(text) + 1 for text in written)


def _corners(pixels: Points, width: npt.NDArray[np.float64], screen: Screen) -> Points:
    """Return the left upper corners of texts beside robots at (n, 2) ``pixels``, moved to be complete."""
    right = pixels[:, 0] + BESIDE[0]
    top = pixels[:, 1] + (BESIDE[1] - HEIGHT / 2)
    corners = np.empty_like(pixels)
    corners[:, 0] = np.where(right + width <= screen.width, right, pixels[:, 0] - BESIDE[0] - width)
    corners[:, 1] = np.minimum(np.maximum(top, 0.0), screen.height - HEIGHT)
    return corners


def _first_of_each_spot(corner: Points) -> Rows:
    """Return the indices of the first text in each spot, to try no spot twice."""
    across, down = np.floor(corner[:, 0] * (1.0 / SPOT[0])), np.floor(corner[:, 1] * (1.0 / SPOT[1]))
    _, first = np.unique(across * SPOTS + down, return_index=True)
    return np.sort(first)

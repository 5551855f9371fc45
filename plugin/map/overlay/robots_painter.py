"""Painting of robots from atlases, many at once; selection, velocity and uncertainty."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import partial
from itertools import accumulate

import numpy as np
import numpy.typing as npt
from qgis.PyQt import sip
from qgis.PyQt.QtCore import QPointF, Qt
from qgis.PyQt.QtGui import QColor, QImage, QPainter, QPen, QPixmap

from ....robot_bridge.core.messages.safety import RobotState
from ...gateway_client.robot_states import STATES, UNSURE
from ...ui.glyphs import (
    CASING,
    CELL,
    PAPER,
    SELECTED,
    STATE_COLOURS,
    UNSURE_COLOUR,
    draw_cone,
    draw_robot,
    flat,
    lines,
    painting,
    pen,
    polygon,
    segments,
)
from .scene import InView, MapScene, Screen

Points = npt.NDArray[np.float64]
Rows = npt.NDArray[np.intp]

# --- Sprites: drawings in atlases, painted many at once ---

Cells = npt.NDArray[np.uint32]
Draw = Callable[[QPainter], None]

FORMAT = QImage.Format.Format_ARGB32_Premultiplied


def turned(draw: Draw, side: int, scale: float, turns: int) -> Cells:
    """Return (``turns``, side, side) pixels: in cell k the drawing points k / ``turns`` of a turn clockwise
    from +x.

    ``draw`` draws around (0, 0), pointing along +x, symmetric about that axis; ``scale`` device
    pixels are one of its own. ``turns`` is a multiple of eight.
    """
    quarter, half = turns // 4, turns // 2
    cells = np.empty((turns, side, side), dtype=np.uint32)
    for k in range(turns // 8 + 1):
        cells[k] = drawn(draw, side, scale, k * 360.0 / turns)
        cells[quarter - k] = cells[k].T
    for k in range(quarter + 1):
        cells[half - k] = cells[k][:, ::-1]
    for k in range(1, half):
        cells[turns - k] = cells[k][::-1]
    return cells


def drawn(draw: Draw, side: int, scale: float, degrees: float = 0.0) -> Cells:
    """Return (side, side) pixels with the drawing centred, turned clockwise."""
    image = QImage(side, side, FORMAT)
    image.fill(0)
    with painting(image) as painter:
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.translate(side / 2, side / 2)
        painter.scale(scale, scale)
        painter.rotate(degrees)
        draw(painter)
    return pixels_of(image)


def pixels_of(image: QImage) -> Cells:
    """Return (height, width) pixels of an image with 32 bits each."""
    bits = image.constBits()
    bits.setsize(image.sizeInBytes())
    return np.frombuffer(bits, dtype=np.uint32).reshape(image.height(), image.width()).copy()


BLOCK = 8
"""Pixels that Qt blends at once, from addresses that are multiples of so many pixels. Those before the first
and behind the last whole block it blends with masks, which takes several times as long, unless they are
transparent: with one pixel less than a block on either side of a picture they are, wherever it is painted."""


def in_a_column(cells: Sequence[Cells], beside: int = 0) -> QPixmap:
    """Return cells of (height, width) pixels as one image, from the top down: contiguous in memory.

    ``beside`` transparent pixels are on the left of each, and at least as many on its right.
    """
    width = max(cell.shape[1] for cell in cells) + 2 * beside
    column = np.zeros((sum(map(len, cells)), width), dtype=np.uint32)
    for bottom, cell in zip(accumulate(map(len, cells)), cells, strict=True):
        column[bottom - len(cell) : bottom, beside : beside + cell.shape[1]] = cell
    # A copy: the image only refers to the array.
    return QPixmap.fromImage(QImage(column.data, width, len(column), width * 4, FORMAT).copy())


def trimmed(atlas: Cells) -> Rows:
    """Return (4, n) top, bottom, left and right of what is inked of each of (n, side, side) pixels, at least
    one pixel."""
    edges = []
    for axis in (2, 1):
        inked = atlas.any(axis=axis)
        first, last = inked.argmax(axis=1), inked.shape[1] - inked[:, ::-1].argmax(axis=1)
        edges += [first, np.where(inked.any(axis=1), last, first + 1)]
    return np.array(edges)


HEADINGS = 88
"""Directions in which robots are drawn; finer steps would not be visible."""
MARK_SIZE = 1.5625
"""Size in cells."""
RING, OTHER_RING, TARGET, CONE_TARGET = range(4)
_MARKS = ((18.0, SELECTED, 3.0), (16.0, SELECTED, 1.6), (4.0, PAPER, 2.2), (4.0, PAPER, 2.2))
"""Radius, colour and width of each mark's circle."""


def cell(pixel_ratio: float, size: float = 1.0) -> int:
    """Return the side in device pixels of the square that holds a robot of ``size``."""
    return round(CELL * size * pixel_ratio)


def robot_atlas(pixel_ratio: float, size: float, state: RobotState, *, unsure: bool = False) -> Cells:
    """Return a robot in ``state`` in cells of :func:`cell` device pixels; ``unsure`` as one that may be
    elsewhere.

    In cell k it points k / :data:`HEADINGS` of a turn clockwise from +x; in the last one its heading is
    unknown. ``size`` 1 is the drawing's own size.
    """
    side = cell(pixel_ratio, size)
    scale = side / CELL

    def draw(painter: QPainter, *, with_heading: bool) -> None:
        draw_robot(painter, state, with_heading, unsure=unsure)

    pointing = turned(partial(draw, with_heading=True), side, scale, HEADINGS)
    unknown = drawn(partial(draw, with_heading=False), side, scale)
    return np.concatenate([pointing, unknown[None]])


def mark_atlas(pixel_ratio: float, size: float = 1.0) -> Cells:
    """Return the marks, a cell each: the ring of the selected robot that receives commands, that of others
    selected with it, a target, and a cone target, both with their spot in the middle."""
    side = cell(pixel_ratio, MARK_SIZE * size)
    scale = side / (CELL * MARK_SIZE)
    return np.stack([drawn(_mark(mark), side, scale) for mark in range(len(_MARKS))])


def _mark(mark: int) -> Draw:
    radius, colour, width = _MARKS[mark]

    def draw(painter: QPainter) -> None:
        painter.setBrush(Qt.BrushStyle.NoBrush)
        for stroke in (pen(CASING, width + 2.4), pen(colour, width)):
            painter.setPen(stroke)
            painter.drawEllipse(QPointF(0.0, 0.0), radius, radius)
        if mark == CONE_TARGET:
            draw_cone(painter, QPointF(0.0, 0.0))

    return draw


FIELDS = 10
"""x, y, source left, top, width, height, scale x, scale y, rotation, opacity: Qt's PixmapFragment."""


class Fragments:
    """Parts of one image, painted many at once; ``ratio`` device pixels are a logical one."""

    def __init__(self, ratio: float) -> None:
        self.scale = 1.0 / ratio
        self._fragments = None
        self._table = np.empty((0, FIELDS))
        self._painted = 0

    def table(self, count: int) -> npt.NDArray[np.float64]:
        """Return the table of the parts to paint, (``count``, :data:`FIELDS`), with scale and opacity."""
        self._provide(count)
        # Parts painted before and gone now must not show: a size of zero hides them.
        self._table[count : self._painted, 4:6] = 0.0
        self._painted = count
        return self._table[:count]

    def paint(self, painter: QPainter, picture: QPixmap) -> None:
        """Paint the filled-in parts out of ``picture``."""
        painter.drawPixmapFragments(self._fragments, picture)

    def _provide(self, count: int) -> None:
        if count <= len(self._table) <= max(64, 4 * count):
            return
        size = max(16, count + count // 4)
        self._fragments = sip.array(QPainter.PixmapFragment, size)
        raw = sip.voidptr(self._fragments, size * FIELDS * 8, True)
        self._table = np.frombuffer(raw, dtype=np.float64).reshape(size, FIELDS)
        self._table[:] = 0.0
        self._table[:, 6:8] = self.scale
        self._table[:, 9] = 1.0
        self._painted = 0


class Sprites:
    """Drawings out of one image, ``ratio`` device pixels a logical one.

    ``atlases`` are (n, side, side) device pixels each; cells are numbered through all of them. Only the inked
    part of each is kept, and painted.
    """

    def __init__(self, atlases: Sequence[Cells], ratio: float) -> None:
        edges = np.concatenate([trimmed(atlas) for atlas in atlases], axis=1)
        cells = (cell for atlas in atlases for cell in atlas)
        kept = [
            cell[top:bottom, left:right]
            for cell, (top, bottom, left, right) in zip(cells, edges.T.tolist(), strict=True)
        ]
        self._atlas = in_a_column(kept, BLOCK - 1)
        self._ratio = ratio
        self._fragments = Fragments(ratio)
        top, bottom, left, right = edges
        height, width = bottom - top, right - left + 2 * (BLOCK - 1)
        self._cells = np.zeros((len(kept), FIELDS))
        """The fragment's values of each cell; its position is that of the middle of the inked part from
        the left and upper border, in logical pixels."""
        middle = (left + right) / 2 / ratio, (top + bottom) / 2 / ratio
        self._cells[:, :2] = np.column_stack(middle)
        self._cells[:, 3] = np.cumsum(height) - height
        self._cells[:, 4:6] = np.column_stack([width, height])
        self._cells[:, 6:8] = self._fragments.scale
        self._cells[:, 9] = 1.0
        self._half = np.repeat([atlas.shape[1] / 2 for atlas in atlases], [len(atlas) for atlas in atlases])
        """Device pixels from the left and the upper border of each to its middle."""

    def paint(
        self,
        painter: QPainter,
        centre: npt.NDArray[np.float64],
        cell: npt.NDArray[np.intp],
    ) -> None:
        """Paint ``cell``, (n,), around each ``centre``, (n, 2) logical pixels."""
        if len(centre) == 0:
            return
        # All cells exist: numpy's check would copy the whole table once more.
        table = self._fragments.table(len(centre))
        np.take(self._cells, cell, axis=0, out=table, mode="clip")
        half = self._half.take(cell)
        for axis in range(2):
            at = centre[:, axis] * self._ratio - half
            # A whole device pixel keeps the drawing sharp.
            np.rint(at, out=at)
            at /= self._ratio
            table[:, axis] += at
        self._fragments.paint(painter, self._atlas)


# --- The robots on one screen ---

SIZES = ((150, 1.0), (1500, 0.7), (np.inf, 0.46))
"""Up to which number of robots on the screen each is drawn in which size."""
NOTICEABLE = 0.7
"""Least size of a robot that needs attention, because it is not fresh."""
VELOCITY_SECONDS = 2.0
"""Seconds of driving that a robot's velocity line represents."""
NOSE = 15.5
"""Pixels from the middle to the tip of a robot drawn in full size."""
SHORTEST_VELOCITY = 4.0
"""Pixels beyond the tip."""
MOST_VELOCITIES = 1500
FINE_VELOCITIES = 300
"""With more of them the lines are thin: antialiased ones would take half of the frame."""
CORNERS = 32
SMALLEST_CIRCLE = 12.0
MOST_CIRCLES = 300
LARGEST_PICTURE = 90.0
"""Device pixels of radius up to which a circle is painted by a picture."""
NEW_PICTURES = 12
"""Pictures of circles drawn for one frame, 0.3 ms each."""
MOST_PICTURES = 400
"""Pictures kept, of up to 0.14 MB each."""
MOST_LARGE = 4
"""Large circles up to which each is filled and has its halo."""
HALO = 2.6
_FRESH, _STALE, _LOST, _OFFLINE = range(len(STATES))
_UPWARDS = (_OFFLINE, _FRESH, UNSURE, _STALE, _LOST)
"""The order in which robots are painted, selected ones last: those that need attention are on top."""
_LAYER = np.argsort(_UPWARDS).astype(np.uint16)
"""The place of each display state in that order."""
STRIP = 16
STRIPS = 4096
"""Height in pixels of a strip of the screen, and more strips than any screen has."""
_TURNS = np.arange(HEADINGS + 1) % HEADINGS
_CIRCLE = np.column_stack([f(np.arange(CORNERS) * 2 * np.pi / CORNERS) for f in (np.cos, np.sin)])


class RobotsPainter:
    """Paints the robots on one screen at a time."""

    def __init__(self) -> None:
        self._drawings: dict[tuple[float, int], Cells] = {}
        """By size and display state; in the order of :attr:`_sprites`."""
        self._sprites: Sprites | None = None
        self._marks: dict[float, Sprites] = {}
        self._made_for = 0.0, 0.0
        """The pixel ratio and the magnification of the drawings: those for others are dropped."""
        self.magnification = 1.0
        """The factor by which robots are magnified."""
        self.arrows = True
        """Whether the robots themselves are painted; their rings always are."""

    def set_magnification(self, times: float) -> None:
        """Draw robots magnified by this factor."""
        self.magnification = times

    def draw_arrows(self, on: bool) -> None:
        """Draw an arrow for each robot, or none."""
        self.arrows = on

    def marks(self, ratio: float, size: float = 1.0) -> Sprites:
        """Return the marks of :func:`mark_atlas`."""
        if self._made_for != (ratio, self.magnification):
            self._drawings.clear()
            self._sprites = None
            self._marks.clear()
            self._made_for = ratio, self.magnification
        if size not in self._marks:
            self._marks[size] = Sprites([mark_atlas(ratio, size)], ratio)
        return self._marks[size]

    def prepare(self, placed: MapScene, view: InView, screen: Screen) -> None:
        """Make the drawings that :meth:`paint` needs: that takes as long as all else in it."""
        self.marks(screen.ratio, self.magnification)
        size = _size(view)
        looks = np.bincount(placed.scene.robots.shown_as.take(view.rows))
        if self.arrows:
            self._provide({(_worth(look, size), look) for look in np.flatnonzero(looks).tolist()})

    def paint(
        self,
        painter: QPainter,
        placed: MapScene,
        view: InView,
        screen: Screen,
    ) -> None:
        """Paint the robots in view."""
        marks = self.marks(screen.ratio, self.magnification)
        robots, scene = placed.scene.robots, placed.scene
        size = _size(view)
        known = np.isfinite(robots.theta.take(view.rows))
        speed = robots.v.take(view.rows)
        _velocities(painter, view, speed, known, NOSE * size * self.magnification + SHORTEST_VELOCITY)
        chosen = [scene.rows[name] for name in scene.chosen if name in scene.rows]
        layer = _LAYER.take(robots.shown_as)
        if chosen:
            rings = np.full(len(chosen), OTHER_RING)
            rings[-1:] = RING
            marks.paint(painter, view.pixels[chosen], rings)
            layer[chosen] += len(_UPWARDS)
        if not self.arrows:
            return
        cells = np.where(known, _directions(view.heading), HEADINGS)
        self._paint_drawings(painter, view.there, cells, layer.take(view.rows), size)

    def _paint_drawings(
        self,
        painter: QPainter,
        at: Points,
        cells: Rows,
        layer: npt.NDArray[np.uint16],
        size: float,
    ) -> None:
        """Paint one of the ``cells`` of its drawing at each ``at``, layer by layer."""
        shown = {k: _drawing(k, size) for k in np.flatnonzero(np.bincount(layer)).tolist()}
        if not shown:
            return
        self._provide({*shown.values()})
        places = list(self._drawings)
        first = np.zeros(2 * len(_UPWARDS), dtype=np.intp)
        first[[*shown]] = [(HEADINGS + 1) * places.index(drawing) for drawing in shown.values()]
        order = _from_the_top(layer, at[:, 1])
        cells = cells + first.take(layer)
        self._sprites.paint(painter, at.take(order, axis=0), cells.take(order))

    def _provide(self, drawings: set[tuple[float, int]]) -> None:
        """Have the drawings of robots of a size and a display state, made on first use."""
        missing = drawings - self._drawings.keys()
        if not missing:
            return
        ratio, magnification = self._made_for
        for size, look in sorted(missing):
            state = STATES[_FRESH if look == UNSURE else look]
            self._drawings[size, look] = robot_atlas(
                ratio, size * magnification, state, unsure=look == UNSURE
            )
        self._sprites = Sprites([*self._drawings.values()], ratio)


def _size(view: InView) -> float:
    """Return the size in which robots are drawn for this number in view."""
    return next(size for most, size in SIZES if len(view.rows) <= most)


def _worth(look: int, size: float) -> float:
    """Return the size of robots of a display state where normal ones are drawn in ``size``."""
    return size if look == _FRESH else max(size, NOTICEABLE)


def _drawing(layer: int, size: float) -> tuple[float, int]:
    """Return size and display state of the robots in a layer where most are drawn in ``size``."""
    is_chosen, place = divmod(layer, len(_UPWARDS))
    look = _UPWARDS[place]
    return (1.0 if is_chosen else _worth(look, size)), look


def _directions(heading: npt.NDArray[np.float32]) -> Rows:
    """Return the index among :data:`HEADINGS` of each ``heading``, (n,) radians clockwise from +x."""
    turns = np.rint(heading * np.float32(HEADINGS / (2 * np.pi)))
    # numpy takes several times as long for %, and for integers of 64 bits.
    turns -= np.floor(turns * np.float32(1.0 / HEADINGS)) * np.float32(HEADINGS)
    return _TURNS.take(turns.astype(np.intp))


def _from_the_top(layer: npt.NDArray[np.uint16], y: npt.NDArray[np.float64]) -> Rows:
    """Return the painting order: layer by layer, each from the top of the screen to its bottom.

    Ten thousand robots painted in random order take half as long again: a screen's lines are apart in memory.
    Within a strip they keep their order, so that overlapping ones do not flicker.
    """
    # A robot that reaches in from above is less than a strip off the screen: clipped, that is the first one.
    strip = (y * (1 / STRIP)).astype(np.uint16)
    # numpy sorts numbers of 16 bits in a fifth of the time.
    return np.argsort(layer * np.uint16(STRIPS) + strip, kind="stable")


Circles = tuple[Rows, Points]
"""Rows of robots, (m,), and the corners of their circles of accuracy on the map, (m, :data:`CORNERS`, 2)."""
NO_CIRCLES: Circles = np.empty(0, dtype=np.intp), np.empty((0, CORNERS, 2))


def circles(placed: MapScene, view: InView) -> Circles:
    """Return the circles of the robots with a known accuracy large enough to see.

    One that has no place in the map's CRS is left out.
    """
    robots = placed.scene.robots
    # NaN compares false.
    wide = view.rows[robots.accuracy.take(view.rows) * view.scale > SMALLEST_CIRCLE]
    if len(wide) > MOST_CIRCLES:
        wide = wide[np.argsort(-robots.accuracy[wide])[:MOST_CIRCLES]]
    if len(wide) == 0:
        return NO_CIRCLES
    corners = placed.transform.to_map_or_nan(
        robots.xy[wide, None, :] + _CIRCLE * robots.accuracy[wide, None, None]
    )
    is_placed = np.isfinite(corners[:, 0, 0])
    return wide[is_placed], corners[is_placed]


class CirclesPainter:
    """Paints circles of accuracy: the robot is somewhere inside.

    Small ones are pictures, drawn once for each size and colour. Large ones are drawn each time; many of
    those as thin lines.
    """

    def __init__(self) -> None:
        self._found = NO_CIRCLES
        self._pictures: dict[CircleKey, QPixmap] = {}
        self.is_whole = True
        """Whether every small circle has its picture; one without is a thin line until then."""

    def prepare(self, placed: MapScene, view: InView, screen: Screen) -> None:
        """Find the circles of a new scene, and draw pictures for :meth:`paint`, a few at once."""
        self._found = circles(placed, view)
        if len(self._found[0]) == 0:
            self.is_whole = True
            return
        around, _, keys = self._on_screen(placed, screen)
        missing = {key: k for k, key in enumerate(keys) if key and key not in self._pictures}
        if len(self._pictures) + len(missing) > MOST_PICTURES:
            self._pictures.clear()
        for key, k in [*missing.items()][:NEW_PICTURES]:
            self._pictures[key] = _circle_picture(around[k], key)
        self.is_whole = len(missing) <= NEW_PICTURES

    def paint(self, painter: QPainter, placed: MapScene, screen: Screen) -> None:
        """Paint the circles that were found last."""
        if len(self._found[0]) == 0:
            return
        around, middle, keys = self._on_screen(placed, screen)
        looks = placed.scene.robots.shown_as.take(self._found[0]).tolist()
        thin = {look: QPen(_colour_of(look), 0.0) for look in {*looks}}
        is_many = keys.count(None) > MOST_LARGE
        painter.setRenderHint(QPainter.RenderHint.Antialiasing, not is_many)
        # On whole device pixels: Qt blends a picture that lies between them many times slower.
        pixels = (np.rint(middle * screen.ratio) / screen.ratio).tolist()
        around += middle[:, None]
        for corners, (x, y), look, key in zip(around, pixels, looks, keys, strict=True):
            picture = self._pictures.get(key)
            if picture is not None:
                half = picture.width() / 2 / screen.ratio
                painter.drawPixmap(QPointF(x - half, y - half), picture)
            elif key or is_many:
                # Qt draws a line of one pixel in a tenth of the time.
                painter.setPen(thin[look])
                painter.setBrush(Qt.BrushStyle.NoBrush)
                painter.drawPolygon(polygon(corners))
            else:
                _draw_circle(painter, corners, look)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)

    def _on_screen(self, placed: MapScene, screen: Screen) -> tuple[Points, Points, list[CircleKey | None]]:
        """Return the circles in logical pixels: (m, :data:`CORNERS`, 2) corners from each one's middle, the
        middles, (m, 2), and what their pictures are found by, None of large ones."""
        rows, corners = self._found
        shapes = screen.pixels(corners.reshape(-1, 2)).reshape(corners.shape)
        middle = shapes.mean(axis=1)
        shapes -= middle[:, None]
        axes = np.rint(shapes[:, (0, CORNERS // 4)] * screen.ratio).reshape(-1, 4)
        looks = placed.scene.robots.shown_as.take(rows).tolist()
        return (
            shapes,
            middle,
            [
                (look, screen.ratio, *ends) if max(map(abs, ends)) <= LARGEST_PICTURE else None
                for look, ends in zip(looks, axes.tolist(), strict=True)
            ],
        )


CircleKey = tuple[float, ...]
"""What makes circles of accuracy look the same: display state, pixel ratio, and from the middle to the ends
of two axes that are perpendicular on the site, x and y each, in whole device pixels."""


def _circle_picture(around: Points, key: CircleKey) -> QPixmap:
    """Return a circle with its corners ``around`` (0, 0), in the middle of its picture."""
    look, ratio, *_ = key
    side = 2 * math.ceil(np.abs(around).max() * ratio + HALO * ratio)
    picture = QPixmap(side, side)
    picture.fill(QColor(0, 0, 0, 0))
    with painting(picture) as painter:
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.translate(side / 2, side / 2)
        painter.scale(ratio, ratio)
        _draw_circle(painter, around, int(look))
    picture.setDevicePixelRatio(ratio)
    return picture


def _draw_circle(painter: QPainter, corners: Points, look: int) -> None:
    """Draw a circle of accuracy with (n, 2) ``corners`` in the colour of a display state."""
    colour, circle = _colour_of(look), polygon(corners)
    fill = QColor(colour)
    fill.setAlpha(30)
    painter.setPen(pen(PAPER, HALO, 0.55))
    painter.setBrush(fill)
    painter.drawPolygon(circle)
    painter.setPen(pen(colour, 1.2))
    painter.setBrush(Qt.BrushStyle.NoBrush)
    painter.drawPolygon(circle)


def _colour_of(look: int) -> QColor:
    return UNSURE_COLOUR if look == UNSURE else STATE_COLOURS[STATES[look]]


def _velocities(
    painter: QPainter,
    view: InView,
    speed: npt.NDArray[np.float64],
    known: npt.NDArray[np.bool_],
    shortest: float,
) -> None:
    """Draw a line from each robot to its expected position, unless that is less than ``shortest`` pixels.

    ``speed`` is in metres per second, ``known`` whether there is a heading.
    """
    # NaN compares false.
    long = np.flatnonzero(np.abs(speed) * view.scale > shortest / VELOCITY_SECONDS)
    long = long[known[long]]
    if len(long) == 0 or len(long) > MOST_VELOCITIES:
        return
    start = view.there[long]
    heading, pixels = view.heading[long], (speed * view.scale)[long] * VELOCITY_SECONDS
    end = start + np.column_stack([np.cos(heading) * pixels, np.sin(heading) * pixels])
    if len(long) > FINE_VELOCITIES:
        painter.setRenderHint(QPainter.RenderHint.Antialiasing, False)
        painter.strokePath(segments(start, end), flat(pen(PAPER, 1.0)))
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        return
    long_ones = lines(start, end)
    for stroke in (pen(CASING, 4.2), pen(PAPER, 2.0)):
        painter.setPen(flat(stroke))
        painter.drawLines(long_ones)

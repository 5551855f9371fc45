"""Trails: samples of robots' past positions, and their image, which follows the view."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from qgis.PyQt.QtCore import QPointF
from qgis.PyQt.QtGui import QColor, QImage, QPainter

from ...layers.site_transform import SiteToMapTransform
from ...ui.glyphs import CASING, TRAIL
from .scene import Screen

Points = npt.NDArray[np.float64]

SHORTEST_STEP = 0.05
"""Metres: a standing robot adds no samples."""
SHORTEST_WAIT = 0.4
"""Seconds between samples."""


@dataclass(frozen=True)
class TrailLength:
    """Length of trails for up to this number of robots: many long ones would hide the map."""

    robots: float
    seconds: float
    wide: bool

    @property
    def samples(self) -> int:
        """The number of samples for that length."""
        return int(self.seconds / SHORTEST_WAIT) + 2


LENGTHS = (
    TrailLength(25, 90.0, True),
    TrailLength(300, 30.0, True),
    TrailLength(np.inf, 15.0, False),
)


class Trails:
    """The last positions of every robot in the site frame, with their times.

    One row per robot, as in :class:`~.gateway_client.robot_states.RobotArrays`; a ring of samples for each.
    Samples taken at the same time are side by side, as robots that report together are sampled
    together.
    """

    def __init__(self) -> None:
        self.length = LENGTHS[0]
        self.generation = 0
        """Counts how often something was forgotten, or the length of trails changed."""
        self._forget()

    def __len__(self) -> int:
        return len(self._taken)

    @property
    def taken(self) -> npt.NDArray[np.intp]:
        """The number of samples taken of each robot so far."""
        return self._taken.copy()

    def clear(self) -> None:
        """Forget every trail."""
        self.length = LENGTHS[0]
        self._forget()
        self.generation += 1

    def drop(self, rows: npt.NDArray[np.intp]) -> None:
        """Forget the trails of robots that no longer exist; those below them move up."""
        rows = rows[rows < len(self)]
        self._ring = np.delete(self._ring, rows, axis=1)
        self._taken = np.delete(self._taken, rows)
        self._last, self._last_time = np.delete(self._last, rows, axis=0), np.delete(self._last_time, rows)
        self.generation += 1

    def extend(self, xy: Points, now: float) -> None:
        """Add the robots' positions: (n, 2) metres in the site frame, NaN where not known."""
        self._provide(len(xy))
        rows = self._due(xy, now)
        if len(rows) == 0:
            return
        samples = np.empty((len(rows), 3))
        # Taking rows with [] takes numpy ten times as long.
        samples[:, :2], samples[:, 2] = xy.take(rows, axis=0), now
        self._last[rows], self._last_time[rows] = samples[:, :2], now
        self._ring[self._taken[rows] % len(self._ring), rows] = samples
        self._taken[rows] += 1

    def before(self, taken: npt.NDArray[np.intp]) -> Points:
        """Return for the first robots the last of ``taken`` samples, (n, 3): x, y, time; NaN where gone."""
        rows = np.arange(len(taken))
        sample = self._ring.reshape(-1, 3).take((taken - 1) % len(self._ring) * len(self) + rows, axis=0)
        sample[(taken < 1) | (taken <= self._taken[rows] - len(self._ring))] = np.nan
        return sample

    def of(self, row: int, now: float) -> Points:
        """Return the (m, 3) trail of one robot: x, y in metres, age in seconds; oldest first."""
        samples = np.roll(self._ring[:, row], -int(self._taken[row]), axis=0)
        samples = samples[now - samples[:, 2] <= self.length.seconds]
        return np.column_stack([samples[:, :2], now - samples[:, 2]])

    def _empty(self, robots: int) -> Points:
        return np.full((self.length.samples, robots, 3), np.nan)

    def _due(self, xy: Points, now: float) -> npt.NDArray[np.intp]:
        """Return the rows of the robots that have moved long enough after their last samples."""
        # For a robot without samples the last time is NaN, which compares false.
        rows = np.flatnonzero(self._last_time <= now - SHORTEST_WAIT)
        if len(rows):
            away = np.abs(xy.take(rows, axis=0) - self._last.take(rows, axis=0))
            rows = rows[away[:, 0] + away[:, 1] >= SHORTEST_STEP]
        first = np.flatnonzero(np.isnan(self._last_time))
        if len(first):
            rows = np.concatenate([rows, first[np.isfinite(xy[first]).all(axis=1)]])
        return rows

    def _forget(self) -> None:
        self._ring = self._empty(0)
        self._taken = np.zeros(0, dtype=np.intp)
        # Each robot's newest sample again: gathering them from the ring takes ten times as long.
        self._last, self._last_time = np.empty((0, 2)), np.empty(0)

    def _provide(self, robots: int) -> None:
        length = next(length for length in LENGTHS if robots <= length.robots)
        # They only become shorter until all are forgotten: cut-off samples do not come back.
        if length.samples < self.length.samples:
            self._cut(length)
        missing = robots - len(self)
        if missing > 0:
            self._ring = np.concatenate([self._ring, self._empty(missing)], axis=1)
            self._taken = np.concatenate([self._taken, np.zeros(missing, dtype=np.intp)])
            self._last = np.concatenate([self._last, np.full((missing, 2), np.nan)])
            self._last_time = np.concatenate([self._last_time, np.full(missing, np.nan)])

    def _cut(self, length: TrailLength) -> None:
        kept = [self.before(self._taken - back) for back in range(length.samples)]
        self.length = length
        self._ring = self._empty(len(self))
        rows = np.arange(len(self))
        for back, sample in enumerate(kept):
            self._ring[(self._taken - 1 - back) % length.samples, rows] = sample
        self.generation += 1


Numbers = npt.NDArray[np.float64]
Pixels = npt.NDArray[np.intp]
Shades = npt.NDArray[np.uint8]

SHADES = 64
FADED = SHADES - 1
"""The last shade, which is invisible."""
BANDS = 16
"""Frames after which the whole image has been faded: each does the same fraction of it."""
FILL_SECONDS = 0.003
"""Time limit for filling in one frame."""
LONGEST_STEP = 4000
"""Pixels: a longer step between two samples is a robot whose position jumped; no trail is drawn."""
MANY_SEEN = 0.15
"""Fraction of pixels with a trail above which it is faster to colour all than to search for those."""
NEVER = -1e9


class TrailSheet:
    """The trails as visible on ``screen``; ``transform`` takes metres of the site to map coordinates.

    It is created empty and filled from the newest to the oldest, over as many frames as needed.
    """

    def __init__(self, trails: Trails, screen: Screen, transform: SiteToMapTransform, now: float) -> None:
        width, height = math.ceil(screen.width * screen.ratio), math.ceil(screen.height * screen.ratio)
        self.screen = screen
        self.filled = False
        self._trails = trails
        self._transform = transform
        self._epoch = now
        self._times = np.full((height, width), NEVER, dtype=np.float32)
        self._argb = np.zeros((height, width), dtype=np.uint32)
        form = QImage.Format.Format_ARGB32_Premultiplied
        self.image = QImage(self._argb.data, width, height, width * 4, form)
        self._reach = max(1, round(screen.ratio)) if trails.length.wide else 0
        self._core = _shades(TRAIL, 1.0 if self._reach else 0.85)
        self._casing = _shades(CASING, 0.45)
        self._band = 0
        self._here: Points | None = None
        self._later: tuple[Points, Points] | None = None
        self._taken = trails.taken

    def extend(self, pixels: Points, now: float) -> None:
        """Extend the trails to (n, 2) ``pixels`` of its screen, robots' positions, NaN where not known."""
        here = pixels * self.screen.ratio
        if self._here is None:
            self._later = here[: len(self._taken)], np.full(len(self._taken), now)
        else:
            self._draw_newest(self._here, here[: len(self._here)], now)
        self._here = here
        # Lines drawn in this frame are visible in this frame.
        bands = 1 if self.filled else BANDS
        self._fill()
        self._fade(now, bands)

    def _fill(self) -> None:
        """Draw older parts of the trails, each sample to the one after it, while there is time."""
        until = time.perf_counter() + FILL_SECONDS
        oldest = self._epoch - self._trails.length.seconds
        while not self.filled:
            sample = self._trails.before(self._taken)
            there = np.flatnonzero(sample[:, 2] >= oldest)
            if len(there) == 0:
                self.filled = True
                return
            earlier = np.full((len(sample), 2), np.nan)
            places = self._transform.to_map_or_nan(sample.take(there, axis=0)[:, :2])
            earlier[there] = self.screen.pixels(places) * self.screen.ratio
            later, times = self._later
            self._stamp(earlier, later, times)
            self._later = earlier, sample[:, 2]
            self._taken = self._taken - 1
            # A trail ends at a sample without a place: finding many of those in each step takes long.
            self._taken[there[np.isnan(places[:, 0])]] = 0
            if time.perf_counter() > until:
                return

    def _draw_newest(self, start: Points, end: Points, now: float) -> None:
        """Draw the lines from ``start`` to ``end``, (n, 2) device pixels: they are the newest."""
        pixels, _ = _on_lines(start, end, self._times.shape)
        self._times.reshape(-1)[pixels] = now - self._epoch
        self._colour(pixels)

    def _stamp(self, start: Points, end: Points, times: Points) -> None:
        """Record ``times`` in the pixels on the lines from ``start`` to ``end``, unless they are newer."""
        pixels, lines = _on_lines(start, end, self._times.shape)
        noted, drawn = self._times.reshape(-1), (times - self._epoch)[lines]
        newer = np.flatnonzero(drawn > noted[pixels])
        # Of several robots on one pixel the last one written remains: the newest.
        newer = newer[np.argsort(drawn[newer], kind="stable")]
        noted[pixels[newer]] = drawn[newer]

    def _colour(self, pixels: Pixels) -> None:
        """Colour new pixels without waiting for their band's turn."""
        if self._reach == 0:
            self._argb.reshape(-1)[pixels] = self._core[0]
            return
        height, width = self._argb.shape
        y, x = np.divmod(pixels, width)
        reach = range(-self._reach, self._reach + 1)
        for dx, dy in ((dx, dy) for dx in reach for dy in reach if abs(dx) + abs(dy) <= self._reach):
            self._argb[np.clip(y + dy, 0, height - 1), np.clip(x + dx, 0, width - 1)] = self._core[0]

    def _fade(self, now: float, bands: int) -> None:
        """Colour the next ``bands`` again."""
        height = len(self._times)
        rows = -(-height // BANDS)
        for _ in range(bands):
            top, bottom = self._band * rows, min(height, (self._band + 1) * rows)
            if top < bottom:
                colour = self._colour_wide if self._reach else self._colour_thin
                colour(top, bottom, now)
            self._band = (self._band + 1) % BANDS

    def _colour_thin(self, top: int, bottom: int, now: float) -> None:
        """Colour the pixels of the trails."""
        times, band = self._times[top:bottom].reshape(-1), self._argb[top:bottom].reshape(-1)
        seen = times > np.float32(now - self._epoch - self._trails.length.seconds)
        if np.count_nonzero(seen) > len(seen) * MANY_SEEN:
            self._core.take(self._age(times, now).astype(np.intp), out=band, mode="clip")
            return
        where = np.flatnonzero(seen)
        band[:] = 0
        band[where] = self._core.take(self._age(times.take(where), now).astype(np.intp), mode="clip")

    def _colour_wide(self, top: int, bottom: int, now: float) -> None:
        """Colour also the pixels around them."""
        above = max(0, top - 2 * self._reach)
        times = self._times[above : bottom + 2 * self._reach]
        inside = slice(top - above, bottom - above)
        if times.max() < now - self._epoch - self._trails.length.seconds:
            self._argb[top:bottom] = 0
            return
        core = _spread(self._shade(times, now), self._reach)
        casing = _spread(core, self._reach)
        # Most of a map has no trail: processing only pixels that have one is several times as fast.
        seen = np.flatnonzero(casing[inside] < FADED)
        shades = core[inside].ravel()[seen]
        around = self._casing[casing[inside].ravel()[seen]]
        colours = np.where(shades < FADED, self._core[shades], around)
        band = self._argb[top:bottom].reshape(-1)
        band[:] = 0
        band[seen] = colours

    def _shade(self, times: npt.NDArray[np.float32], now: float) -> Shades:
        """Return indices into the shades: 0 for new pixels, :data:`FADED` for those that have faded away."""
        age = self._age(times, now)
        # np.clip takes ten times as long.
        np.minimum(age, FADED, out=age)
        return np.maximum(age, 0, out=age).astype(np.uint8)

    def _age(self, times: npt.NDArray[np.float32], now: float) -> npt.NDArray[np.float32]:
        """Return the age of ``times``, in shades, limited to :data:`FADED`.

        Indexing by it with mode "clip" is twice as fast as clipping it before.
        """
        age = np.float32(now - self._epoch) - times
        age *= np.float32(FADED / self._trails.length.seconds)
        return age


def _on_lines(start: Points, end: Points, shape: tuple[int, int]) -> tuple[Pixels, Pixels]:
    """Return the pixels on the lines, each line's first one left out, and the line that each is on.

    Pixels are counted from the left, line after line of an image of ``shape``, height and width.
    """
    # Columns apart: numpy is slow where it goes along rows of two.
    x, y, to_x, to_y = start[:, 0], start[:, 1], end[:, 0], end[:, 1]
    last_x, last_y = np.floor(to_x), np.floor(to_y)
    # Most of ten thousand robots stay on their pixel from one frame to the next, or move by one.
    lines = np.flatnonzero((np.floor(x) != last_x) | (np.floor(y) != last_y))
    x, y, to_x, to_y = x.take(lines), y.take(lines), to_x.take(lines), to_y.take(lines)
    reach = np.maximum(np.abs(to_x - x), np.abs(to_y - y))
    # NaN compares false.
    is_way = reach < LONGEST_STEP
    pixels, those = _inside(last_x.take(lines), last_y.take(lines), is_way, shape)
    long = np.flatnonzero((reach > 1.0) & is_way)
    if len(long):
        more, which = _between(*(edge.take(long) for edge in (x, y, to_x, to_y, reach)), shape)
        pixels, those = np.concatenate([pixels, more]), np.concatenate([those, long.take(which)])
    return pixels, lines.take(those)


def _between(
    x: Numbers, y: Numbers, to_x: Numbers, to_y: Numbers, reach: Numbers, shape: tuple[int, int]
) -> tuple[Pixels, Pixels]:
    """Return the pixels between the ends of lines, a step apart, and the line that each is on."""
    height, width = shape
    on = (np.maximum(x, to_x) >= 0) & (np.maximum(y, to_y) >= 0)
    on = np.flatnonzero(on & (np.minimum(x, to_x) < width) & (np.minimum(y, to_y) < height))
    steps = np.ceil(reach.take(on)).astype(np.intp)
    count = steps - 1
    which = np.repeat(on, count)
    back = np.repeat(np.cumsum(count), count) - np.arange(len(which))
    part = back / np.repeat(steps, count)
    at_x = np.floor(to_x.take(which) - (to_x - x).take(which) * part)
    at_y = np.floor(to_y.take(which) - (to_y - y).take(which) * part)
    pixels, those = _inside(at_x, at_y, True, shape)
    return pixels, which.take(those)


def _inside(
    x: Numbers, y: Numbers, selected: npt.NDArray[np.bool_] | bool, shape: tuple[int, int]
) -> tuple[Pixels, Pixels]:
    """Return the positions on the image of those that are ``selected``, and their indices."""
    height, width = shape
    those = np.flatnonzero((x >= 0) & (x < width) & (y >= 0) & (y < height) & selected)
    return (y * width + x).take(those).astype(np.intp), those


def _spread(shades: Shades, reach: int) -> Shades:
    """Return for each pixel the newest of the shades at most ``reach`` steps away."""
    for _ in range(reach):
        out = shades.copy()
        np.minimum(out[1:], shades[:-1], out=out[1:])
        np.minimum(out[:-1], shades[1:], out=out[:-1])
        np.minimum(out[:, 1:], shades[:, :-1], out=out[:, 1:])
        np.minimum(out[:, :-1], shades[:, 1:], out=out[:, :-1])
        shades = out
    return shades


def _shades(colour: QColor, strength: float) -> npt.NDArray[np.uint32]:
    """Return ``colour`` from opaque to transparent, premultiplied ARGB."""
    alpha = np.linspace(colour.alphaF() * strength, 0.0, SHADES)
    red, green, blue = (np.round(part * alpha).astype(np.uint32) for part in colour.getRgb()[:3])
    return np.round(alpha * 255).astype(np.uint32) << 24 | red << 16 | green << 8 | blue


class TrailImage:
    """Shows a sheet of trails, moved along with the view, until one for the new view is filled."""

    def __init__(self, trails: Trails) -> None:
        self._trails = trails
        self.forget()

    def forget(self) -> None:
        """Draw nothing until the next :meth:`extend`."""
        self._shown: TrailSheet | None = None
        self._newest: TrailSheet | None = None
        self._view: tuple = ()
        self._made_for: tuple = ()

    def extend(
        self,
        xy: Points,
        screen: Screen,
        transform: SiteToMapTransform,
        now: float,
        pixels: Points | None = None,
    ) -> None:
        """Extend the trails to (n, 2) ``xy``, the robots' positions in map coordinates, NaN where not known.

        ``now`` is on the clock of the trails' samples. ``pixels`` is ``xy`` on the ``screen``, where that is
        computed already.
        """
        view = (self._trails.generation, transform, screen)
        if view[:2] != self._made_for[:2]:
            self.forget()
        # While the view moves a new sheet would be outdated before it is filled.
        at_rest = view == self._view or self._newest is None
        self._view = view
        if view != self._made_for and at_rest:
            self._newest = TrailSheet(self._trails, screen, transform, now)
            self._made_for = view
        if pixels is None or screen != self._newest.screen:
            pixels = self._newest.screen.pixels(xy)
        self._newest.extend(pixels, now)
        if self._newest.filled or self._shown is None:
            self._shown = self._newest

    def paint(self, painter: QPainter, screen: Screen) -> None:
        """Draw the known trails on ``screen``."""
        if self._shown is None:
            return
        painter.save()
        if screen != self._shown.screen:
            painter.setTransform(screen.since(self._shown.screen), True)
        # The image is in device pixels; setting its pixel ratio would make it a copy of the array.
        painter.scale(1 / self._shown.screen.ratio, 1 / self._shown.screen.ratio)
        painter.drawImage(QPointF(0.0, 0.0), self._shown.image)
        painter.restore()

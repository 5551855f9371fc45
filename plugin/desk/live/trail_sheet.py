"""Trails on one screen, in an image that stays: each pixel knows when a robot was there last."""

from __future__ import annotations

import math
import time
from collections.abc import Callable

import numpy as np
import numpy.typing as npt
from qgis.PyQt.QtGui import QColor, QImage

from ..colours import CASING, TRAIL
from .screen import Screen
from .trails import Trails

Points = npt.NDArray[np.float64]
Pixels = npt.NDArray[np.intp]
Shades = npt.NDArray[np.uint8]

SHADES = 64
FADED = SHADES - 1
"""The last shade, of which nothing is seen."""
BANDS = 16
"""Frames after which the whole image has faded by as much as it has to: each does the same part of it."""
FILL_SECONDS = 0.003
"""What filling may take of one frame."""
LONGEST_STEP = 4000
"""Pixels: a longer step between two samples is a robot that was put elsewhere; no trail leads there."""
NEVER = -1e9


class TrailSheet:
    """The trails as ``screen`` shows them; ``to_map`` takes (n, 2) metres of the site to map coordinates.

    It is made empty and filled from the newest to the oldest, over as many frames as that takes.
    """

    def __init__(
        self, trails: Trails, screen: Screen, to_map: Callable[[Points], Points], now: float
    ) -> None:
        width, height = math.ceil(screen.width * screen.ratio), math.ceil(screen.height * screen.ratio)
        self.screen = screen
        self.filled = False
        self._trails = trails
        self._to_map = to_map
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

    def extend(self, xy: Points, now: float) -> None:
        """Draw on to (n, 2) ``xy``, where the robots are now in map coordinates, NaN where not known."""
        here = self.screen.pixels(xy) * self.screen.ratio
        if self._here is None:
            self._later = here[: len(self._taken)], np.full(len(self._taken), now)
        else:
            known = len(self._here)
            x, y = self._stamp(self._here, here[:known], np.full(known, now))
            self._colour(x, y)
        self._here = here
        # What is filled in this frame is to be seen in this frame.
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
            earlier[there] = self.screen.pixels(self._to_map(sample[there, :2])) * self.screen.ratio
            later, times = self._later
            self._stamp(earlier, later, times)
            self._later = earlier, sample[:, 2]
            self._taken = self._taken - 1
            if time.perf_counter() > until:
                return

    def _stamp(self, start: Points, end: Points, times: Points) -> tuple[Pixels, Pixels]:
        """Note ``times`` in the pixels on the lines from ``start`` to ``end``, (n, 2) device pixels."""
        x, y, times = _on_lines(start, end, times - self._epoch, self._times.shape)
        newer = np.flatnonzero(times > self._times[y, x])
        # Of several robots on one pixel the last one written stays: the newest.
        newer = newer[np.argsort(times[newer], kind="stable")]
        x, y = x[newer], y[newer]
        self._times[y, x] = times[newer]
        return x, y

    def _colour(self, x: Pixels, y: Pixels) -> None:
        """Colour new pixels without waiting for their band's turn."""
        height, width = self._argb.shape
        reach = range(-self._reach, self._reach + 1)
        for dx, dy in ((dx, dy) for dx in reach for dy in reach if abs(dx) + abs(dy) <= self._reach):
            self._argb[np.clip(y + dy, 0, height - 1), np.clip(x + dx, 0, width - 1)] = self._core[0]

    def _fade(self, now: float, bands: int) -> None:
        """Colour the next ``bands`` anew."""
        height = len(self._times)
        rows = -(-height // BANDS)
        for _ in range(bands):
            self._colour_band(self._band * rows, min(height, (self._band + 1) * rows), now)
            self._band = (self._band + 1) % BANDS

    def _colour_band(self, top: int, bottom: int, now: float) -> None:
        if bottom <= top:
            return
        above = max(0, top - 2 * self._reach)
        times = self._times[above : bottom + 2 * self._reach]
        inside = slice(top - above, bottom - above)
        if times.max() < now - self._epoch - self._trails.length.seconds:
            self._argb[top:bottom] = 0
            return
        core = _spread(self._shade(times, now), self._reach)
        casing = _spread(core, self._reach)
        # Most of a map has no trail: to look up only what has one is several times as fast.
        seen = np.flatnonzero(casing[inside] < FADED)
        shades = core[inside].ravel()[seen]
        colours = self._core[shades]
        if self._reach:
            colours = np.where(shades < FADED, colours, self._casing[casing[inside].ravel()[seen]])
        band = self._argb[top:bottom].reshape(-1)
        band[:] = 0
        band[seen] = colours

    def _shade(self, times: npt.NDArray[np.float32], now: float) -> Shades:
        """Return indices into the shades: 0 for what is new, :data:`FADED` for what has faded away."""
        age = np.float32(now - self._epoch) - times
        age *= np.float32(FADED / self._trails.length.seconds)
        # np.clip takes ten times as long.
        np.minimum(age, FADED, out=age)
        return np.maximum(age, 0, out=age).astype(np.uint8)


def _on_lines(
    start: Points, end: Points, times: Points, shape: tuple[int, int]
) -> tuple[Pixels, Pixels, Points]:
    """Return the pixels on the lines, as x and y, each line's first one left out, and the time of each."""
    height, width = shape
    # Columns apart: numpy is slow where it goes along rows of two.
    x, y, to_x, to_y = start[:, 0], start[:, 1], end[:, 0], end[:, 1]
    # Most of ten thousand robots stay on their pixel from one frame to the next.
    lines = np.flatnonzero((np.floor(x) != np.floor(to_x)) | (np.floor(y) != np.floor(to_y)))
    x, y = x[lines], y[lines]
    dx, dy = to_x[lines] - x, to_y[lines] - y
    reach = np.maximum(np.abs(dx), np.abs(dy))
    # What is NaN compares false.
    on = (np.maximum(x, x + dx) >= 0) & (np.maximum(y, y + dy) >= 0) & (reach < LONGEST_STEP)
    on &= (np.minimum(x, x + dx) < width) & (np.minimum(y, y + dy) < height)
    on = np.flatnonzero(on)
    steps = np.ceil(reach[on]).astype(np.intp)
    which = np.repeat(on, steps)
    before = np.repeat(np.cumsum(steps) - steps, steps)
    part = (np.arange(len(which)) - before + 1) / np.repeat(steps, steps)
    x = np.floor(x[which] + dx[which] * part).astype(np.intp)
    y = np.floor(y[which] + dy[which] * part).astype(np.intp)
    inside = np.flatnonzero((x >= 0) & (x < width) & (y >= 0) & (y < height))
    return x[inside], y[inside], times[lines[which[inside]]]


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
    """Return ``colour`` from full to nothing, premultiplied ARGB."""
    alpha = np.linspace(colour.alphaF() * strength, 0.0, SHADES)
    red, green, blue = (np.round(part * alpha).astype(np.uint32) for part in colour.getRgb()[:3])
    return np.round(alpha * 255).astype(np.uint32) << 24 | red << 16 | green << 8 | blue

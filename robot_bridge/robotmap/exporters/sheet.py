"""The sheet that a picture of a map is drawn on: where metres come to lie, and what stands round the map."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any
from xml.sax.saxutils import escape

import numpy as np
from numpy.typing import NDArray

from ..model import Border
from .palette import FACE, GRID_LINE, INK, QUIET, Colours

_LEFT, _TOP, _RIGHT, _BOTTOM = 62.0, 66.0, 210.0, 40.0
_SMALLEST_SIDE = 300.0
FONT = 'font-family="DejaVu Sans, Verdana, sans-serif"'


@dataclass(frozen=True)
class Sheet:
    """A map's border on a sheet, ``scale`` pixels a metre, y upwards as in the site frame."""

    border: Border
    scale: float

    @classmethod
    def of(cls, border: Border, size: float) -> Sheet:
        """Return the sheet whose map is ``size`` pixels on its longer side."""
        return cls(border, size / max(border.x_max - border.x_min, border.y_max - border.y_min))

    @property
    def map_width(self) -> float:
        """Pixels."""
        return (self.border.x_max - self.border.x_min) * self.scale

    @property
    def map_height(self) -> float:
        """Pixels."""
        return (self.border.y_max - self.border.y_min) * self.scale

    @property
    def width(self) -> int:
        """Pixels of the whole sheet."""
        return math.ceil(_LEFT + max(self.map_width, _SMALLEST_SIDE / 2) + _RIGHT)

    @property
    def height(self) -> int:
        """Pixels of the whole sheet."""
        return math.ceil(_TOP + max(self.map_height, _SMALLEST_SIDE) + _BOTTOM)

    def pixels(self, points: NDArray[Any]) -> NDArray[Any]:
        """Return (n, 2) metres in the site frame as (n, 2) pixels of the sheet."""
        x = _LEFT + (points[:, 0] - self.border.x_min) * self.scale
        y = _TOP + (self.border.y_max - points[:, 1]) * self.scale
        return np.column_stack([x, y])

    def face(self) -> Iterator[str]:
        """Yield the ground with its grid of metres."""
        yield _rectangle(_LEFT, _TOP, self.map_width, self.map_height, f'fill="{FACE}"')
        for x in self._ticks(self.border.x_min, self.border.x_max):
            yield self._line([(x, self.border.y_min), (x, self.border.y_max)])
        for y in self._ticks(self.border.y_min, self.border.y_max):
            yield self._line([(self.border.x_min, y), (self.border.x_max, y)])

    def surround(self, title: str, subtitle: str) -> Iterator[str]:
        """Yield what covers the margins: paper, frame, the grid's metres and the title."""
        right, bottom = _LEFT + self.map_width, _TOP + self.map_height
        yield (
            f'<path d="M0 0H{self.width}V{self.height}H0ZM{_LEFT} {_TOP}V{bottom:.1f}H{right:.1f}V{_TOP}Z" '
            'fill="#ffffff" fill-rule="evenodd"/>'
        )
        yield _rectangle(
            _LEFT, _TOP, self.map_width, self.map_height, f'fill="none" stroke="{INK}" stroke-width="1.6"'
        )
        for x in self._ticks(self.border.x_min, self.border.x_max):
            place = _LEFT + (x - self.border.x_min) * self.scale
            yield text(place, bottom + 17, _metres(x), 10.5, QUIET, "middle")
        for y in self._ticks(self.border.y_min, self.border.y_max):
            place = _TOP + (self.border.y_max - y) * self.scale
            yield text(_LEFT - 7, place + 4, _metres(y), 10.5, QUIET, "end")
        yield text(_LEFT, 32, title, 20, INK, "start", bold=True)
        yield text(_LEFT, 52, subtitle, 12, QUIET, "start")

    def margin(self, north: float | None, legend: Sequence[tuple[str, Colours]]) -> Iterator[str]:
        """Yield the right margin: north arrow, legend, scale bar.

        ``north`` is the angle of grid north, radians clockwise from the sheet's upward direction; None shows
        the site's y axis instead.
        """
        left = _LEFT + max(self.map_width, _SMALLEST_SIDE / 2) + 26
        angle, letter = (0.0, "y") if north is None else (math.degrees(north), "N")
        yield (
            f'<g transform="translate({left + 22:.1f} {_TOP + 34}) rotate({angle:.3f})">'
            f'<path d="M0 -30L11 14L0 6Z" fill="{INK}"/>'
            f'<path d="M0 -30L-11 14L0 6Z" fill="#ffffff" stroke="{INK}" stroke-width="1.2"/></g>'
        )
        yield text(left + 22, _TOP + 74, letter, 13, INK, "middle", bold=True)
        top = _TOP + 108
        for number, (label, colours) in enumerate(legend):
            y = top + 24 * number
            marks = f'rx="2.5" fill="{colours.fill}" stroke="{colours.stroke}" stroke-width="1.6"'
            yield _rectangle(left, y - 11, 20, 14, marks)
            yield text(left + 30, y, label, 12, INK, "start")
        yield from self._scale_bar(left, max(_TOP + self.map_height, top + 24 * len(legend) + 30))

    def _scale_bar(self, left: float, bottom: float) -> Iterator[str]:
        length = _nice(120 / self.scale)
        half = length * self.scale / 2
        yield _rectangle(left, bottom - 8, half, 7, f'fill="{INK}" stroke="{INK}" stroke-width="1"')
        yield _rectangle(left + half, bottom - 8, half, 7, f'fill="#ffffff" stroke="{INK}" stroke-width="1"')
        yield text(left, bottom - 14, "0", 10.5, INK, "middle")
        yield text(left + 2 * half, bottom - 14, f"{length:g} m", 10.5, INK, "middle")

    def _ticks(self, low: float, high: float) -> list[float]:
        step = _nice(130 / self.scale)
        first = math.ceil(low / step - 1e-9)
        return [k * step for k in range(first, math.floor(high / step + 1e-9) + 1)]

    def _line(self, ends: list[tuple[float, float]]) -> str:
        (x1, y1), (x2, y2) = self.pixels(np.array(ends)).tolist()
        return f'<path d="M{x1:.1f} {y1:.1f}L{x2:.1f} {y2:.1f}" stroke="{GRID_LINE}" stroke-width="1.2"/>'


def text(
    x: float, y: float, words: str, size: float, colour: str, anchor: str, bold: bool = False, halo: str = ""
) -> str:
    """Return a line of text; what XML cannot hold is left out."""
    shown = escape("".join(letter for letter in words if letter.isprintable()))
    weight = ' font-weight="bold"' if bold else ""
    place = f'x="{x:.1f}" y="{y:.1f}" {FONT} font-size="{size:g}" text-anchor="{anchor}"{weight}'
    line = f'<text {place} fill="{colour}">{shown}</text>'
    if not halo:
        return line
    return f'<text {place} fill="{halo}" stroke="{halo}" stroke-width="3">{shown}</text>{line}'


def _rectangle(x: float, y: float, width: float, height: float, style: str) -> str:
    return f'<rect x="{x:.1f}" y="{y:.1f}" width="{width:.1f}" height="{height:.1f}" {style}/>'


def _nice(length: float) -> float:
    """Return the largest 1, 2 or 5 times a power of ten that is at most ``length``."""
    power = 10.0 ** math.floor(math.log10(length))
    return next(step * power for step in (5.0, 2.0, 1.0) if step * power <= length * (1 + 1e-9))


def _metres(value: float) -> str:
    return f"{value:.10g}".replace("-", "−")

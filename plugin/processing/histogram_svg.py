"""A histogram of deviations as SVG."""

from __future__ import annotations

import itertools
import math
from xml.sax.saxutils import escape

import numpy as np
import numpy.typing as npt

from ..language import tr

WIDTH, HEIGHT = 860.0, 400.0
LEFT, RIGHT, TOP, BOTTOM = 70.0, 20.0, 30.0, 62.0
MOST_BARS = 24
WITHIN, BEYOND = "#2a6f97", "#c62828"


def bars(values: npt.NDArray[np.float64], tolerance: float) -> tuple[npt.NDArray, npt.NDArray]:
    """Return counts (k,) and edges (k + 1,) in metres, from 0; the tolerance is one of the edges.

    A value on an edge counts below it, so that a deviation of just the tolerance is within it. What lies
    beyond the last edge is counted in the last bar.
    """
    most = max(float(values.max()), tolerance)
    step = tolerance / max(1, round(tolerance / _round(most / 12.0)))
    count = min(MOST_BARS, math.ceil(round(most / step, 6)))
    edges = step * np.arange(count + 1)
    below = np.searchsorted(edges, np.round(values, 9), side="left") - 1
    return np.bincount(np.clip(below, 0, count - 1), minlength=count), edges


def histogram(values: npt.NDArray[np.float64], tolerance: float) -> str:
    """Return the histogram of ``values`` in metres, those beyond ``tolerance`` in red."""
    counts, edges = bars(values, tolerance)
    most = int(counts.max())
    x = LEFT + (WIDTH - LEFT - RIGHT) * edges / edges[-1]
    per = (HEIGHT - TOP - BOTTOM) / most
    floor = HEIGHT - BOTTOM
    parts = [_head()]
    for height in ticks(most):
        y = floor - height * per
        parts.append(f'<path d="M{LEFT} {y:.1f}H{WIDTH - RIGHT}" stroke="#ced4da" stroke-width="1"/>')
        parts.append(_text(LEFT - 8, y + 6, str(height), "end"))
    for k, count in enumerate(counts.tolist()):
        colour = WITHIN if edges[k + 1] <= tolerance + 1e-9 else BEYOND
        top, wide = floor - count * per, x[k + 1] - x[k]
        parts.append(
            f'<rect x="{x[k] + 1:.1f}" y="{top:.1f}" width="{max(wide - 2, 1):.1f}" '
            f'height="{count * per:.1f}" fill="{colour}"/>'
        )
    every = max(1, math.ceil(len(edges) / 11))
    parts += [_text(x[k], floor + 22, f"{edges[k] * 100:.4g}", "middle") for k in range(0, len(edges), every)]
    if values.max() > edges[-1] + 1e-9:
        parts.append(
            _text(
                WIDTH - RIGHT, HEIGHT - 10, tr("last bar: up to {metres:.2f} m", metres=values.max()), "end"
            )
        )
    at = LEFT + (WIDTH - LEFT - RIGHT) * tolerance / edges[-1]
    line = f'<path d="M{at:.1f} {TOP - 6}V{floor}" stroke="#212529" stroke-width="2" stroke-dasharray="7 5"/>'
    parts += [
        line,
        _text(min(at, WIDTH - 90), TOP - 10, tr("tolerance {cm:.4g} cm", cm=tolerance * 100), "middle"),
    ]
    parts.append(
        f'<path d="M{LEFT} {TOP}V{floor}H{WIDTH - RIGHT}" fill="none" stroke="#212529" stroke-width="1.6"/>'
    )
    parts.append(_text((LEFT + WIDTH - RIGHT) / 2, HEIGHT - 10, tr("deviation in cm"), "middle"))
    upwards = f'<g transform="translate(18 {(TOP + floor) / 2:.1f}) rotate(-90)">'
    parts.append(f"{upwards}{_text(0, 0, tr('cones'), 'middle')}</g>")
    return "\n".join([*parts, "</svg>"])


def _head() -> str:
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH:g}" height="{HEIGHT:g}" '
        f'viewBox="0 0 {WIDTH:g} {HEIGHT:g}" font-family="sans-serif" font-size="17" fill="#212529">'
    )


def _text(x: float, y: float, text: str, anchor: str) -> str:
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}">{escape(text)}</text>'


def _round(step: float) -> float:
    """Return 1, 2 or 5 times a power of ten, no less than ``step`` metres and no less than a millimetre."""
    power = 10.0 ** math.floor(math.log10(max(step, 0.001)))
    return next(power * digit for digit in (1, 2, 5, 10) if power * digit >= max(step, 0.001) - 1e-12)


def ticks(most: int) -> list[int]:
    """Return round numbers of cones from 0 to ``most``, at most six."""
    steps = (digit * 10**power for power in itertools.count() for digit in (1, 2, 5))
    step = next(step for step in steps if most < 6 * step)
    return list(range(0, most + 1, step))

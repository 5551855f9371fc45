"""Which way the surface of a ramp faces, where its polygon says how high its corners are."""

from __future__ import annotations

import numpy as np
from qgis.core import QgsGeometry

from ...robot_bridge.robotmap.chords import ramp_normal
from ...robot_bridge.robotmap.errors import ShapingError
from ..language import tr

NORMAL = "n"
"""The extra of a ramp: the upward unit normal of its surface in the site frame (paper 1, section II)."""


def corner_heights(geometry: QgsGeometry) -> dict[tuple[float, float], float]:
    """Return the Z of each corner (x, y) of ``geometry``; NaN for one that has two, as of a step."""
    heights: dict[tuple[float, float], float] = {}
    for point in geometry.vertices() if geometry.constGet().is3D() else ():
        z = point.z()
        known = heights.setdefault((point.x(), point.y()), z)
        if known != z:
            heights[point.x(), point.y()] = np.nan
    return heights


def normal_extra(points: np.ndarray, z: np.ndarray, notes: list[str]) -> dict[str, str]:
    """Return the extra of a ramp whose outline is ``points``, (n, 2) in the site frame, ``z``, (n,), high.

    There is none without a height for each corner, nor where all are equal: such a polygon was drawn in 3D
    without its heights. A surface that cannot be driven on is told in ``notes``.
    """
    if not np.isfinite(z).all() or not np.ptp(z):
        return {}
    try:
        return {NORMAL: ramp_normal(np.column_stack([points, z]))}
    except ShapingError:
        notes.append(tr("its corners span no surface that one can drive on; its normal is left out"))
        return {}

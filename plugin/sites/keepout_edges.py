"""Roads that lead through areas that nobody may drive into, found by QGIS's own geometry."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
from qgis.core import QgsGeometry, QgsPointXY

from ...robot_bridge.roads.network import Network

Floats = npt.NDArray[np.float64]


def edges_through(network: Network, areas: Sequence[Sequence[Floats]]) -> list[int]:
    """Return the edges that come into one of ``areas``, each an outer ring and its holes, (n, 2) each.

    What runs along the rim comes into none.
    """
    if not len(network):
        return []
    lines = [network.edges.line(edge) for edge in range(len(network))]
    lowest = np.array([line.min(axis=0) for line in lines])
    highest = np.array([line.max(axis=0) for line in lines])
    found: set[int] = set()
    for rings in areas:
        area = QgsGeometry.fromPolygonXY([_points(ring) for ring in rings]).makeValid()
        engine = QgsGeometry.createGeometryEngine(area.constGet())
        engine.prepareGeometry()
        near = (lowest <= rings[0].max(axis=0)).all(axis=1) & (highest >= rings[0].min(axis=0)).all(axis=1)
        for edge in np.flatnonzero(near).tolist():
            line = QgsGeometry.fromPolylineXY(_points(lines[edge]))
            if engine.crosses(line.constGet()) or engine.contains(line.constGet()):
                found.add(edge)
    return sorted(found)


def _points(xy: Floats) -> list[QgsPointXY]:
    return [QgsPointXY(x, y) for x, y in xy.tolist()]

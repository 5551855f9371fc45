"""What else tells the polygon at a point: QgsSpatialIndex with prepared geometries, and shapely's STRtree."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import shapely
from qgis.core import QgsFeature, QgsGeometry, QgsPoint, QgsRectangle, QgsSpatialIndex

Single = Callable[[float, float], int]
Bulk = Callable[[np.ndarray], np.ndarray]


def by_spatial_index(shapes: np.ndarray, rank: np.ndarray) -> Single:
    """Return the query of a QgsSpatialIndex whose geometries are prepared once."""
    index, engines, kept = QgsSpatialIndex(), [], []
    for number, wkb in enumerate(shapely.to_wkb(shapes)):
        geometry = QgsGeometry()
        geometry.fromWkb(wkb)
        feature = QgsFeature(number)
        feature.setGeometry(geometry)
        index.addFeature(feature)
        engine = QgsGeometry.createGeometryEngine(geometry.constGet())
        engine.prepareGeometry()
        engines.append(engine)
        kept.append(geometry)
    ranks = rank.tolist()

    def query(x: float, y: float) -> int:
        point = QgsPoint(x, y)
        found = [k for k in index.intersects(QgsRectangle(x, y, x, y)) if engines[k].intersects(point)]
        return min(found, key=ranks.__getitem__, default=-1)

    # The engines read the geometries and do not keep them.
    query.kept = kept  # type: ignore[attr-defined]
    return query


def by_tree(shapes: np.ndarray, rank: np.ndarray) -> tuple[Bulk, Single]:
    """Return the queries of a shapely STRtree, in bulk and single."""
    shapely.prepare(shapes)
    tree = shapely.STRtree(shapes)

    def bulk(places: np.ndarray) -> np.ndarray:
        place, found = tree.query(shapely.points(places), predicate="intersects")
        order = np.lexsort([rank[found], place])
        place, found = place[order], found[order]
        first = np.append(True, place[1:] != place[:-1])[: len(place)]
        told = np.full(len(places), -1)
        told[place[first]] = found[first]
        return told

    def single(x: float, y: float) -> int:
        found = tree.query(shapely.Point(x, y), predicate="intersects")
        return int(found[np.argmin(rank[found])]) if len(found) else -1

    return bulk, single

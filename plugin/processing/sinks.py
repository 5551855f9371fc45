"""Shapes written to the layers that an algorithm makes."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from qgis.core import (
    QgsFeature,
    QgsFeatureSink,
    QgsFields,
    QgsGeometry,
    QgsLineString,
    QgsMultiLineString,
    QgsPolygon,
    QgsProcessingFeedback,
)

from ..language import tr
from .whole_file import OutputError

AT_ONCE = 1000
"""How many features go into a layer together; a cancel is seen between them."""


def polygon(rings: Sequence[np.ndarray]) -> QgsGeometry:
    """Return the polygon of ``rings``, (n, 2) each and closed, the outer one first."""
    area = QgsPolygon(_line(rings[0]))
    for ring in rings[1:]:
        area.addInteriorRing(_line(ring))
    return QgsGeometry(area)


def lines(parts: Iterable[np.ndarray]) -> QgsGeometry:
    """Return one geometry of several lines, (n, 2) each."""
    several = QgsMultiLineString()
    for part in parts:
        several.addGeometry(_line(part))
    return QgsGeometry(several)


def line(points: np.ndarray) -> QgsGeometry:
    """Return the line along ``points``, (n, 2)."""
    return QgsGeometry(_line(points))


def fill(
    sink: QgsFeatureSink,
    fields: QgsFields,
    rows: Sequence[tuple[QgsGeometry, Sequence[Any]]],
    feedback: QgsProcessingFeedback,
) -> bool:
    """Add a feature for each (geometry, values) to ``sink``; return False when cancelled on the way.

    :raises OutputError: when the layer does not take them.
    """
    for start in range(0, len(rows), AT_ONCE):
        if feedback.isCanceled():
            return False
        features = [_feature(fields, *row) for row in rows[start : start + AT_ONCE]]
        if not sink.addFeatures(features, QgsFeatureSink.Flag.FastInsert):
            raise OutputError(
                tr(
                    "A layer cannot be written ({reason}): choose another place or format for it, and check "
                    "the free space.",
                    reason=sink.lastError() or tr("no reason is given"),
                )
            )
    return True


def _feature(fields: QgsFields, geometry: QgsGeometry, values: Sequence[Any]) -> QgsFeature:
    feature = QgsFeature(fields)
    feature.setGeometry(geometry)
    feature.setAttributes(list(values))
    return feature


def _line(points: np.ndarray) -> QgsLineString:
    return QgsLineString(points[:, 0].tolist(), points[:, 1].tolist())

"""Polygons of a layer as the areas of a mask."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from qgis.core import (
    QgsExpression,
    QgsExpressionContext,
    QgsFeature,
    QgsFeedback,
    QgsProcessingFeatureSource,
)

from ...robot_bridge.robotmap.exporters.masks import MaskArea
from ..language import tr
from ..sites.feature_filter import FeatureFilter
from ..sites.placing import LayerPlacing, SitePlacing
from ..sites.shapes import polygons_of, shapes_of
from .errors import ParameterError

Speed = Callable[[QgsFeature], float]


def areas_of(
    source: QgsProcessingFeatureSource,
    site: SitePlacing,
    counted: FeatureFilter | None,
    feedback: QgsFeedback,
    speed: Speed | None = None,
) -> tuple[list[MaskArea], list[str]]:
    """Return the areas of a layer in the site frame, and a warning for each feature that is not as it was.

    Only features that are ``counted`` are read. With ``speed`` an area without a speed above 0 is left out.
    Stops early when cancelled.

    :raises LayerCrsError: when the layer's coordinates have no known place on the site.
    """
    placing = site.of_layer(source.sourceName(), source.sourceCrs())
    areas: list[MaskArea] = []
    warnings: list[str] = []
    for feature in source.getFeatures():
        if feedback.isCanceled():
            break
        name = tr("Layer {sourcename}, feature {id}", sourcename=source.sourceName(), id=feature.id())
        notes: list[str] = []
        if counted is None or counted.keeps(feature, notes):
            limit = math.nan if speed is None else speed(feature)
            if speed is None or 0 < limit < math.inf:
                areas += [MaskArea(rings, name, limit) for rings in _polygons(feature, placing, notes)]
            else:
                notes.append(tr("has no speed above 0 m/s, so it sets no limit; it is left out"))
        warnings += [f"{name}: {note}" for note in notes]
    return areas, warnings


def speed_by(text: str, source: QgsProcessingFeatureSource, context: QgsExpressionContext) -> Speed:
    """Return the way from a feature to its speed in m/s by an expression; NaN where it has none.

    :raises ParameterError: when the expression is none.
    """
    expression = QgsExpression(text)
    context.setFields(source.fields())
    if expression.hasParserError() or not expression.prepare(context):
        reason = expression.parserErrorString() or expression.evalErrorString()
        raise ParameterError(
            tr(
                "SPEED {text!r} is no expression ({reason}): write a field's name or a number.",
                text=text,
                reason=reason,
            )
        )

    def speed(feature: QgsFeature) -> float:
        context.setFeature(feature)
        value = expression.evaluate(context)
        try:
            return float(value)
        except (TypeError, ValueError):
            return math.nan

    return speed


def _polygons(feature: QgsFeature, placing: LayerPlacing, notes: list[str]) -> list[list[np.ndarray]]:
    """Return the rings of each polygon of ``feature`` in the site frame; what is odd goes into ``notes``."""
    geometry = placing.of_feature(feature, notes)
    if geometry is None:
        return []
    shapes, odd = shapes_of(geometry)
    notes += odd
    return [[placing.to_site(ring) for ring in rings] for rings in polygons_of(shapes)]

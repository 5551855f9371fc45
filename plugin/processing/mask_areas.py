"""Polygons of a layer as the areas of a mask."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

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
from ..sites.placing import LayerPlacing, PlacingError, SitePlacing
from ..sites.shapes import Shape, polygons_of, shapes_of
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
        doubts: list[str] = []
        if counted is not None and not counted.keeps(feature, doubts):
            warnings += [f"{name}: {doubt}" for doubt in doubts]
            continue
        limit = math.nan if speed is None else speed(feature)
        if speed is not None and not 0 < limit < math.inf:
            warnings.append(
                tr("{name}: it has no speed above 0 m/s, so it sets no limit; it is left out", name=name)
            )
            continue
        try:
            shapes, notes = _shapes(feature, placing)
        except PlacingError as error:
            shapes, notes = (
                [],
                [tr("cannot be transformed into the site's CRS ({error}); it is left out", error=error)],
            )
        warnings += [f"{name}: {note}" for note in notes]
        areas += [
            MaskArea([placing.to_site(ring) for ring in rings], name, limit) for rings in polygons_of(shapes)
        ]
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


def _shapes(feature: QgsFeature, placing: LayerPlacing) -> tuple[Sequence[Shape], list[str]]:
    geometry = feature.geometry()
    if geometry.isNull() or geometry.isEmpty():
        return [], [tr("has no geometry; it is left out")]
    return shapes_of(placing.to_metres(geometry))

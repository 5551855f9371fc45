"""The features of a layer near many places."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from qgis.core import (
    QgsFeature,
    QgsFeatureRequest,
    QgsGeometry,
    QgsGeometryEngine,
    QgsRectangle,
    QgsSpatialIndex,
    QgsVectorLayer,
)

from ...language import tr
from ...sites.feature_filter import FeatureFilter
from ..time_slices import Steps

FEW = 20
"""Places that the layer is asked for one by one; for more it is read once."""

Near = list[tuple[QgsFeature, list[int]]]
"""Features, each with the numbers of the places that it is near to."""


class LayerFeatures:
    """Those features of a layer that count.

    :raises ExpressionError: when the filter of the layer is no expression.
    """

    def __init__(self, layer: QgsVectorLayer):
        self._layer = layer
        self._counted = FeatureFilter.of_layer(layer, layer.createExpressionContext())

    def near(self, boxes: Sequence[QgsRectangle]) -> Steps[Near]:
        """Find the features whose boxes meet one of ``boxes``, which are in the layer's CRS."""
        if len(boxes) <= FEW:
            return (yield from self._near_few(boxes))
        around = QgsRectangle(boxes[0])
        index = QgsSpatialIndex()
        for number, box in enumerate(boxes):
            around.combineExtentWith(box)
            index.addFeature(number, box)
            yield 0.0
        found = []
        for feature in self._layer.getFeatures(QgsFeatureRequest().setFilterRect(around)):
            numbers = index.intersects(feature.geometry().boundingBox())
            if numbers and self._counts(feature):
                found.append((feature, sorted(numbers)))
            yield 0.0
        return found

    def _near_few(self, boxes: Sequence[QgsRectangle]) -> Steps[Near]:
        features: dict[int, QgsFeature] = {}
        near: dict[int, list[int]] = {}
        for number, box in enumerate(boxes):
            for feature in self._read(box):
                features[feature.id()] = feature
                near.setdefault(feature.id(), []).append(number)
                yield 0.0
            yield 0.0
        return [(features[id], numbers) for id, numbers in near.items()]

    def _read(self, box: QgsRectangle) -> Iterator[QgsFeature]:
        for feature in self._layer.getFeatures(QgsFeatureRequest().setFilterRect(box)):
            if self._counts(feature):
                yield feature

    def _counts(self, feature: QgsFeature) -> bool:
        doubts: list[str] = []
        # What the filter cannot tell of may be in the way.
        return self._counted.keeps(feature, doubts) or bool(doubts)


def engine_of(geometry: QgsGeometry, times: int) -> QgsGeometryEngine:
    """Return what answers so many questions about ``geometry``, which has to outlive it."""
    engine = QgsGeometry.createGeometryEngine(geometry.constGet())
    if times > 1:
        engine.prepareGeometry()
    return engine


def name_of(feature: QgsFeature, layer: QgsVectorLayer) -> str:
    """Return what a feature is called, by its attribute ``name``, else by its layer and number."""
    index = layer.fields().lookupField("name")
    name = feature.attribute(index) if index >= 0 else None
    if isinstance(name, str) and name:
        return name
    return tr("{layer} (feature {id})", layer=layer.name(), id=feature.id())

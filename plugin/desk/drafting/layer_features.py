"""The features of a layer near many places."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from qgis.core import QgsFeature, QgsFeatureRequest, QgsRectangle, QgsSpatialIndex, QgsVectorLayer

from ...sites.feature_filter import FeatureFilter

FEW = 20
"""Places that the layer is asked for one by one; for more it is read once."""


class LayerFeatures:
    """Those features of a layer that count.

    :raises ExpressionError: when the filter of the layer is no expression.
    """

    def __init__(self, layer: QgsVectorLayer):
        self._layer = layer
        self._counted = FeatureFilter.of_layer(layer, layer.createExpressionContext())

    def near(self, boxes: Sequence[QgsRectangle]) -> Iterator[tuple[int, QgsFeature]]:
        """Yield the number of each of ``boxes``, in the layer's CRS, with each feature whose box meets it."""
        if len(boxes) <= FEW:
            for number, box in enumerate(boxes):
                for feature in self._read(box):
                    yield number, feature
            return
        around = QgsRectangle(boxes[0])
        for box in boxes[1:]:
            around.combineExtentWith(box)
        features = {feature.id(): feature for feature in self._read(around)}
        index = QgsSpatialIndex()
        for feature in features.values():
            index.addFeature(feature)
        for number, box in enumerate(boxes):
            for id in index.intersects(box):
                yield number, features[id]

    def _read(self, box: QgsRectangle) -> Iterator[QgsFeature]:
        for feature in self._layer.getFeatures(QgsFeatureRequest().setFilterRect(box)):
            doubts: list[str] = []
            # What the filter cannot tell of may be in the way.
            if self._counted.keeps(feature, doubts) or doubts:
                yield feature

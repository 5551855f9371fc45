"""What all tests of the plugin share: layers in memory."""

from __future__ import annotations

import pytest
from qgis.core import QgsFeature, QgsGeometry, QgsVectorLayer

HEIGHT = "&field=height:double"


def memory_layer(name="walls", kind="LineString", fields=HEIGHT, features=(), crs="EPSG:32633"):
    """Return a layer; each of ``features`` is (WKT or QgsGeometry or None, *values)."""
    layer = QgsVectorLayer(f"{kind}?crs={crs}{fields}", name, "memory")
    assert layer.isValid()
    made = []
    for shape, *values in features:
        feature = QgsFeature(layer.fields())
        if shape is not None:
            feature.setGeometry(QgsGeometry.fromWkt(shape) if isinstance(shape, str) else shape)
        feature.setAttributes(list(values))
        made.append(feature)
    ok, added = layer.dataProvider().addFeatures(made)
    assert ok and len(added) == len(made)
    layer.updateExtents()
    return layer


@pytest.fixture
def make_layer(qgis_app):
    """Make a layer in memory of what QGIS calls it: a type, fields, and WKT with values."""
    return memory_layer

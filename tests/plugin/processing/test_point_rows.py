"""Points with values: placed in the site frame, named by their fields, and refused with where and what."""

from __future__ import annotations

import math

import pytest
from fleet_supervisor.plugin.layers.site_transform import SiteGeoreference
from fleet_supervisor.plugin.processing.common.cone_layers import point_rows
from fleet_supervisor.plugin.ui.errors import LayerCrsError, LayerReadingError
from fleet_supervisor.robot_bridge.core.sites.frame import SiteFrame
from qgis.core import QgsCoordinateReferenceSystem, QgsCoordinateTransformContext

UTM = "EPSG:32633"
FIELDS = "&field=id:string&field=name:string&field=demand:double&field=speed:string"


@pytest.fixture
def rows(make_layer):
    """Return the points of a layer; the site's origin is 100 m east and 200 m north in its CRS."""

    def read(*features, kind="Point", crs=UTM):
        site = SiteGeoreference(
            QgsCoordinateReferenceSystem(UTM),
            SiteFrame(UTM, (500100.0, 5200200.0)),
            QgsCoordinateTransformContext(),
        )
        layer = make_layer("cones", kind, FIELDS, features, crs)
        placing = site.of_layer(layer.name(), layer.crs())
        return list(point_rows(layer.name(), layer.getFeatures(), placing, ("id", "name")))

    return read


def test_a_point_is_placed_named_and_read(rows):
    first, second, third = rows(
        ("Point(500107 5200209)", "c1", "one", 2.0, "0.5"),
        ("Point(500107 5200209)", "", "two", None, None),
        ("Point(500107 5200209)", None, None, 1.0, ""),
    )
    assert (first.name, second.name, third.name) == ("c1", "two", "3")
    assert (first.x, first.y) == pytest.approx((7.0, 9.0))
    assert (first.whole("demand", 1), first.number("speed", 9.0)) == (2, 0.5)
    assert (second.whole("demand", 1), second.number("speed", 9.0), third.number("speed", 9.0)) == (
        1,
        9.0,
        9.0,
    )


def test_a_layer_in_another_crs_comes_to_the_same_place(rows):
    # 15 degrees east is the middle of the zone: easting 500 000.
    (row,) = rows(("Point(15 46.95)", "c1", None, None, None), crs="EPSG:4326")
    assert row.x == pytest.approx(-100.0, abs=0.01) and math.isfinite(row.y)


@pytest.mark.parametrize(
    ("value", "read", "told"),
    [
        ((1.5, None), lambda row: row.whole("demand", 1), "demand is 1.5; give a whole number"),
        ((math.nan, None), lambda row: row.whole("demand", 1), "demand is nan, which is no number"),
        ((None, "fast"), lambda row: row.number("speed", 1.0), "speed is 'fast', which is no number"),
        ((None, "inf"), lambda row: row.number("speed", 1.0), "speed is 'inf', which is no number"),
    ],
)
def test_a_value_that_cannot_be_used_is_named(rows, value, read, told):
    (row,) = rows(("Point(500107 5200209)", "c1", None, *value))
    with pytest.raises(LayerReadingError, match=f"^cones, feature 1: {told}"):
        read(row)


@pytest.mark.parametrize(
    ("kind", "shape"),
    [
        ("MultiPoint", "MultiPoint(500107 5200209, 500108 5200209)"),
        ("Point", "Point EMPTY"),
        ("LineString", "LineString(500107 5200209, 500108 5200209)"),
    ],
)
def test_what_is_not_one_point_is_named(rows, kind, shape):
    told = r"^cones, feature 1 is not one point with a place on the site"
    with pytest.raises(LayerReadingError, match=told):
        rows((shape, "c1", None, None, None), kind=kind)


def test_a_layer_without_a_crs_is_placed_nowhere(rows):
    with pytest.raises(LayerCrsError, match="The layer cones has no CRS"):
        rows(("Point(7 9)", "c1", None, None, None), crs="")

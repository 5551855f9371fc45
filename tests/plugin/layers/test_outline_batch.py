"""Features made into outlines together are what they are one by one, in their order."""

import random

import numpy as np
import pytest
from fleet_supervisor.plugin.layers import obstacle_layers
from fleet_supervisor.plugin.layers.geometry import line_wkb, multi_line_wkb, polygon_wkb, rings_of
from fleet_supervisor.plugin.layers.layer_expressions import ObstacleValues
from fleet_supervisor.plugin.layers.layer_source import FeatureWarnings
from fleet_supervisor.plugin.layers.obstacle_layers import OutlineBatch
from fleet_supervisor.plugin.layers.roles import LayerExpressions, set_expressions, set_role
from fleet_supervisor.plugin.layers.site_transform import LayerToSiteTransform
from fleet_supervisor.robot_bridge.core.robotmap.outlines import Outlines
from fleet_supervisor.robot_bridge.core.sites.frame import SiteFrame
from qgis.core import QgsGeometry

SOUND = (
    "Polygon((0 0, 10 0, 10 10, 0 10, 0 0), (2 2, 4 2, 4 4, 2 2), (6 6, 8 6, 8 8, 6 6))",
    "MultiPolygon(((0 0, 1 0, 1 1, 0 0)), ((5 5, 9 5, 9 9, 5 5), (7 6, 8 6, 8 7, 7 6)))",
    "LineString(0 0, 4 0, 4 7)",
    "MultiLineString((0 0, 4 0), (1 1, 2 2, 3 1))",
    "PolygonZ((0 0 1, 10 0 2, 10 10 3, 0 0 1))",
    "LineStringZM(0 0 1 2, 4 0 3 4)",
)
ODD = (
    "Polygon((0 0, 4 4, 4 0, 0 4, 0 0))",
    "Polygon((0 0, 4 4, 2 2, 0 0))",
    "LineString(1 1, 1 1, 4 4)",
    "LineString(3 3, 3 3)",
    "Polygon((0 0, 9 0, 9 9, 0 0), (20 20, 21 20, 21 21, 20 20))",
    "CurvePolygon(CircularString(0 0, 4 0, 4 4, 0 4, 0 0))",
    "LineString(0 0, 1e300 0)",
    "GeometryCollection(Polygon((0 0, 1 0, 1 1, 0 0)), LineString(3 3, 4 4))",
)


@pytest.fixture
def outlines(qgis_app, monkeypatch):
    """Return the outlines of shapes with their heights, and the warnings; ``plain`` reads them by bytes."""
    read = obstacle_layers.rings_of

    def run(shapes, heights, plain, rotation=0.0):
        monkeypatch.setattr(obstacle_layers, "rings_of", read if plain else lambda wkb: None)
        warnings = FeatureWarnings()
        batch = OutlineBatch(
            "all", "", LayerToSiteTransform(None, SiteFrame("", (3.0, 4.0), rotation)), warnings
        )
        for number, (shape, height) in enumerate(zip(shapes, heights, strict=True)):
            values = ObstacleValues(height, height == 3.0, height == 3.0, 0.0, f"label {height}", True, [])
            geometry = QgsGeometry.fromWkt(shape)
            batch.add(number, geometry.asWkb().data(), geometry, values)
        made = Outlines.joined(list(batch.outlines()))
        return made, [*warnings.texts(), str(batch.unknown)]

    return run


@pytest.mark.parametrize("rotation", [0.0, 0.3])
def test_features_read_by_their_bytes_are_those_that_qgis_takes_apart(outlines, rotation):
    chance = random.Random(7)
    shapes = [chance.choice(SOUND if chance.random() < 0.8 else ODD) for _ in range(400)]
    heights = [chance.choice([2.0, 3.0]) for _ in shapes]
    (quick, said), (slow, told) = (outlines(shapes, heights, plain, rotation) for plain in (True, False))
    assert said == told and len(said) > len(ODD) // 2
    assert len(quick) == len(slow) > 400
    for name in ("offsets", "shape_type", "courtyard", "height", "outdoor", "semantics", "source", "ext"):
        assert list(getattr(quick, name)) == list(getattr(slow, name)), name
    np.testing.assert_allclose(quick.coordinates, slow.coordinates, rtol=0, atol=1e-9)


@pytest.mark.parametrize("shape", SOUND)
def test_what_is_sound_is_not_taken_apart(outlines, monkeypatch, shape):
    monkeypatch.setattr(obstacle_layers, "shapes_of", None)
    made, said = outlines([shape], [2.0], plain=True)
    assert len(made) and said == ["feature "]


def test_a_ring_is_closed_in_any_frame(make_layer, read):
    rings = [(f"Polygon(({k}.1 0.7, {k}.9 0.3, {k}.5 3.3, {k}.1 0.7))", 1.0) for k in range(50)]
    posts = make_layer("posts", "Point", features=[(f"Point({k} {k}.3)", 1.0) for k in range(50)])
    set_role(posts, "furniture")
    set_expressions(posts, LayerExpressions(rotation="17"))
    parts = read(make_layer("all", "Polygon", features=rings), posts, rotation=1.1).parts
    assert sum(map(len, parts)) == 100
    for part in parts:
        first, last = part.offsets[:-1], part.offsets[1:] - 1
        np.testing.assert_array_equal(part.coordinates[first], part.coordinates[last])


def test_joined_outlines_are_the_parts_one_after_the_other(make_layer, read):
    walls = make_layer("walls", features=[("LineString(0 0, 4 0)", 1.0)])
    arches = make_layer("arches", features=[("LineString(0 9, 4 9)", None)])
    set_expressions(arches, LayerExpressions(base="2"))
    reading = read(walls, arches)
    joined = reading.outlines()
    assert len(reading.parts) == 2 and joined.base.tolist() == [0.0, 2.0]
    assert list(joined.ext) == [{}, {"h": "est"}]
    np.testing.assert_array_equal(joined.coordinates, Outlines.from_rows(reading.rows).coordinates)
    assert len(Outlines.joined([])) == 0


@pytest.mark.parametrize("text", SOUND[:4])
def test_bytes_that_are_read_are_those_that_are_written(text):
    wkb = QgsGeometry.fromWkt(text).asWkb().data()
    rings = rings_of(wkb)
    if text.startswith("Polygon"):
        assert polygon_wkb(rings.points) == wkb
    elif text.startswith("LineString"):
        assert line_wkb(rings.points[0]) == wkb
    elif text.startswith("MultiLine"):
        assert multi_line_wkb(rings.points) == wkb


@pytest.mark.parametrize("text", ["Point(1 1)", "CircularString(0 0, 1 1, 2 0)", "GeometryCollection EMPTY"])
def test_other_geometries_have_no_rings(text):
    assert rings_of(QgsGeometry.fromWkt(text).asWkb().data()) is None

"""Layers become outlines with heights and labels; nothing is lost without a word."""

from __future__ import annotations

import math

import pytest
import shapely
from fleet_supervisor.plugin.layers.layer_source import rows_without_index, subset_without_geometry
from fleet_supervisor.plugin.layers.roles import (
    KEEPOUT,
    RAMP,
    STAIRS,
    LayerExpressions,
    set_expressions,
    set_role,
)
from fleet_supervisor.plugin.ui.errors import ExpressionError, LayerTypeError
from fleet_supervisor.robot_bridge.core.robotmap.model import ShapeType
from qgis.core import (
    NULL,
    QgsCoordinateTransformContext,
    QgsDataSourceUri,
    QgsFeature,
    QgsFeedback,
    QgsGeometry,
    QgsVectorFileWriter,
    QgsVectorLayer,
)

LINE = "LineString(0 0, 4 0)"
SQUARE = "Polygon((0 0, 10 0, 10 10, 0 10, 0 0))"
HEIGHT = "&field=height:double"


def heights(reading):
    return [row.height for row in reading.rows]


@pytest.mark.parametrize("field", ["height", "Height", "height_m"])
def test_the_field_height_is_the_height_and_the_layers_name_is_the_label(make_layer, read, field):
    (row,) = read(make_layer("gate", fields=f"&field={field}:double", features=[(LINE, 2.5)])).rows
    assert (row.height, row.semantics, row.outdoor, row.source) == (2.5, "gate", True, "gate:1")


def test_text_is_a_height_where_it_is_a_number_of_metres(make_layer, read):
    texts = ["12", "12.5 m", "3,5", "2 storeys", "-4", "", NULL]
    reading = read(make_layer(fields="&field=height:string", features=[(LINE, text) for text in texts]))
    assert heights(reading) == [12, 12.5, 3.5, 3, 3, 3, 3]
    assert reading.warnings == [
        "Layer walls, feature 4: its height '2 storeys' is not a number of metres of 0 or more; "
        "the default is used",
        "Layer walls, feature 5: its height '-4' is not a number of metres of 0 or more; the default is used",
        "Layer walls: 4 heights are not known and estimated as 3 m (features 4, 5, 6, 7)",
    ]
    assert [row.ext for row in reading.rows] == [{}] * 3 + [{"h": "est"}] * 4


def test_expressions_see_the_feature_and_the_layer(make_layer, read):
    general = LayerExpressions('"h" * 2', "@layer_name || ',' || $id", '"h" > 1.5')
    layer = make_layer("wall", fields="&field=h:double", features=[(LINE, 1.0), (LINE, 2.0)])
    rows = read(layer, general=general).rows
    assert [(row.height, row.semantics, row.outdoor) for row in rows] == [
        (2, "wall,1", False),
        (4, "wall,2", True),
    ]


def test_a_layers_own_expressions_win_over_the_general_ones(make_layer, read):
    own, other = (make_layer(name, features=[(LINE,)]) for name in ("own", "other"))
    set_expressions(own, LayerExpressions(height="1", outdoor="false"))
    rows = read(own, other, general=LayerExpressions("9", "'label'", "true")).rows
    assert [(row.height, row.semantics, row.outdoor) for row in rows] == [
        (1, "label", False),
        (9, "label", True),
    ]


def test_an_expression_about_a_field_that_one_layer_lacks_is_one_warning_for_that_layer(make_layer, read):
    with_field = make_layer("tall", fields="&field=h:double", features=[(LINE, 7.0)])
    without = make_layer("flat", features=[(LINE,)] * 9)
    reading = read(with_field, without, general=LayerExpressions(height='"h"'), default_height=2.0)
    assert heights(reading) == [7] + [2] * 9
    assert reading.warnings == [
        "Layer flat: it has no field h, which the height expression '\"h\"' reads; "
        "the default is used for all its features",
        "Layer flat: 9 heights are not known and estimated as 2 m (features 1, 2, 3, 4, 5 and 4 more)",
    ]


def test_a_height_that_is_not_known_is_estimated_by_the_layer_and_marked_and_only_then_by_default(
    make_layer, read
):
    fields = "&field=height:string&field=levels:string"
    houses = [("12", "4"), (NULL, "4"), ("high", "2"), ("", NULL), (NULL, "many")]
    layer = make_layer("houses", fields=fields, features=[(LINE, *values) for values in houses])
    set_expressions(layer, LayerExpressions(estimate='3 * "levels"'))
    reading = read(layer, default_height=5.0)
    assert heights(reading) == [12, 12, 6, 5, 5]
    assert [row.ext for row in reading.rows] == [{}] + [{"h": "est"}] * 4
    assert reading.warnings[0].startswith("Layer houses, feature 3: its height 'high' is not a number of")
    assert reading.warnings[0].endswith("; the estimate is used")
    assert reading.warnings[1].startswith("Layer houses, feature 5: the estimate expression fails: Cannot")
    assert reading.warnings[2:] == [
        "Layer houses: 2 heights are not known and estimated as 5 m (features 4, 5)"
    ]


def test_where_a_thing_begins_is_said_by_its_layer_else_by_the_general_expression(make_layer, read):
    fields = "&field=height:double&field=foot:string"
    feet = [(LINE, 1.0, foot) for foot in ("2.5", "2,5 m", "-0.5", "", NULL, "high")]
    arches, signs, walls = (
        make_layer("arches", fields=fields, features=feet),
        make_layer("signs"),
        make_layer(),
    )
    for layer in (signs, walls):
        layer.dataProvider().addFeature(next(arches.getFeatures()))
    set_expressions(arches, LayerExpressions(base='"foot"'))
    set_expressions(signs, LayerExpressions(base="2.2"))
    reading = read(arches, signs, walls, general=LayerExpressions(base="1"))
    assert [row.base for row in reading.rows] == [2.5, 2.5, -0.5, 0, 0, 0, 2.2, 1]
    assert reading.warnings == [
        "Layer arches, feature 6: its base 'high' is not a number of metres; "
        "it is taken to stand on the ground"
    ]


def test_what_is_no_expression_is_refused_before_a_feature_is_read(make_layer, read):
    with pytest.raises(ExpressionError, match=r"height expression '1 \+' for the layer walls is not one"):
        read(make_layer(features=[(None,)]), general=LayerExpressions(height="1 +"))


def test_an_expression_that_fails_on_a_feature_is_a_warning_with_its_id(make_layer, read):
    reading = read(make_layer(features=[(LINE,)]), general=LayerExpressions(height="to_int('a')"))
    assert reading.warnings[0].startswith("Layer walls, feature 1: the height expression fails: Cannot conv")
    assert heights(reading) == [3]


def test_an_outdoor_flag_that_is_neither_is_named(make_layer, read):
    reading = read(
        make_layer(fields=HEIGHT, features=[(LINE, 1.0)]), general=LayerExpressions(outdoor="'maybe'")
    )
    assert reading.rows[0].outdoor is True
    assert reading.warnings == [
        "Layer walls, feature 1: its outdoor flag 'maybe' is neither true nor false; true is used"
    ]


NOWHERE = "Layer walls, feature 1: has no geometry; it is left out"


@pytest.mark.parametrize("stored", [False, True])
def test_features_outside_the_window_are_not_asked_for_and_those_without_geometry_are_named(
    make_layer, read, tmp_path, stored
):
    features = [(None, 1.0), ("LineString(900 900, 950 900)", -1.0), (LINE, 1.0)]
    layer = make_layer(fields=HEIGHT, features=features)
    if stored:
        layer = saved(layer, tmp_path / "walls.gpkg")
    reading = read(layer, window=(-5, -5, 5, 5))
    assert [row.source for row in reading.rows] == ["walls:3"]
    assert reading.warnings == [NOWHERE]
    whole = read(layer, window=None)
    assert [row.source for row in whole.rows] == ["walls:2", "walls:3"]
    assert whole.warnings[0] == NOWHERE


def test_what_the_index_of_a_geopackage_lacks_has_no_geometry(make_layer, read, tmp_path):
    nothing = {3, 70, 71, 4097, 9000}
    features = [(None if id in nothing else f"LineString({id} 900, {id} 950)", 1.0) for id in range(1, 9001)]
    features[69] = ("LineString EMPTY", 1.0)
    file = tmp_path / "walls.gpkg"
    layer = saved(make_layer(fields=HEIGHT, features=features), file)
    assert layer.dataProvider().deleteFeatures([5, 71])
    assert rows_without_index(layer.source()) == [3, 5, 70, 71, 4097, 9000]
    reading = read(layer, window=(-5, -5, 5, 5))
    assert reading.warnings == ["Layer walls, features 3, 70, 4097, 9000: has no geometry; it is left out"]
    assert layer.dataProvider().deleteFeatures(list(range(100, 9000)))
    assert layer.setSubsetString('"height" < 9') and rows_without_index(layer.source()) is None
    plain = QgsVectorLayer(f"{file}|layername=walls", "walls", "ogr")
    assert plain.dataProvider().addFeatures([far_away(plain, 40_000)])[0]
    assert rows_without_index(plain.source()) is None
    assert read(plain, window=(-5, -5, 5, 5)).warnings == [
        "Layer walls, features 3, 70, 9000: has no geometry; it is left out"
    ]


def far_away(layer, id):
    feature = QgsFeature(layer.fields())
    feature.setAttributes([id, 1.0])
    feature.setGeometry(QgsGeometry.fromWkt(LINE.replace("0", "900")))
    return feature


def test_what_does_not_count_needs_no_geometry(make_layer, read, tmp_path):
    features = [(None, 1.0), (None, 2.0), (None, 3.0), (LINE, 3.0)]
    layer = saved(make_layer(fields=HEIGHT, features=features), tmp_path / "walls.gpkg")
    assert layer.setSubsetString('"height" > 1')
    set_expressions(layer, LayerExpressions(filter='"height" < 3'))
    reading = read(layer, window=(-5, -5, 5, 5))
    assert reading.rows == []
    assert reading.warnings == ["Layer walls, feature 2: has no geometry; it is left out"]


def test_changes_that_are_not_saved_are_looked_at_for_geometry_too(make_layer, read, tmp_path):
    layer = saved(make_layer(fields=HEIGHT, features=[(None, 1.0)]), tmp_path / "walls.gpkg")
    assert layer.startEditing() and layer.changeGeometry(1, QgsGeometry.fromWkt(LINE))
    reading = read(layer, window=(-5, -5, 5, 5))
    assert [row.source for row in reading.rows] == ["walls:1"] and reading.warnings == []


def test_a_database_is_asked_for_what_has_no_geometry():
    uri = 'dbname=\'city\' table="public"."walls" (geom) sql=height > 1'
    found = QgsDataSourceUri(subset_without_geometry("postgres", uri))
    assert found.sql() == '(height > 1) AND "geom" IS NULL'
    assert (found.table(), found.geometryColumn()) == ("walls", "geom")


def saved(layer, file):
    """Return ``layer`` as a layer of a GeoPackage."""
    options = QgsVectorFileWriter.SaveVectorOptions()
    options.layerName = layer.name()
    transforms = QgsCoordinateTransformContext()
    assert not QgsVectorFileWriter.writeAsVectorFormatV3(layer, str(file), transforms, options)[0]
    return QgsVectorLayer(f"{file}|layername={layer.name()}", layer.name(), "ogr")


def test_layers_of_one_name_are_told_apart(make_layer, read):
    rows = read(*(make_layer(features=[(LINE,)]) for _ in range(3))).rows
    assert [row.source for row in rows] == ["walls:1", "walls (2):1", "walls (3):1"]


def test_a_layer_of_points_is_refused_by_name(make_layer, read):
    with pytest.raises(LayerTypeError, match=r"trees holds points.*leave it out.*Buffer"):
        read(make_layer("trees", "Point", features=[("Point(1 1)",)]))


def test_a_ramp_has_no_height_and_a_flight_of_stairs_the_height_of_a_riser(make_layer, read):
    ramp = make_layer("ramp", "Polygon", fields=HEIGHT, features=[(SQUARE, 0.5)])
    stairs = make_layer(
        "steps",
        "MultiLineString",
        fields=HEIGHT,
        features=[("MultiLineString((0 0, 4 0), (0 1, 4 1))", 0.17)],
    )
    set_role(ramp, RAMP)
    set_role(stairs, STAIRS)
    reading = read(ramp, stairs)
    assert [(row.shape_type, row.height) for row in reading.rows] == [
        (ShapeType.RAMP, 0.0),
        (ShapeType.STAIRS, 0.17),
    ]
    assert reading.warnings == []


SLOPE = "PolygonZ((0 0 5, 10 0 5, 10 2 6, 0 2 6, 0 0 5))"


@pytest.mark.parametrize(
    ("rotation", "normal"), [(0.0, (0, -0.4472, 0.8944)), (math.pi / 2, (-0.4472, 0, 0.8944))]
)
def test_a_ramp_drawn_in_3d_says_in_the_site_frame_which_way_it_faces(make_layer, read, rotation, normal):
    ramp = make_layer("ramp", "PolygonZ", features=[(SLOPE,)])
    set_role(ramp, RAMP)
    reading = read(ramp, rotation=rotation)
    (row,) = reading.rows
    assert reading.warnings == []
    assert tuple(float(n) for n in row.ext["n"].split(",")) == pytest.approx(normal, abs=1e-4)


def test_each_part_of_a_ramp_has_its_own_normal_and_a_hole_that_of_its_ring(make_layer, read):
    parts = (
        "((0 0 0, 10 0 0, 10 9 9, 0 9 9, 0 0 0), (2 2 2, 2 4 4, 4 4 4, 2 2 2))",
        "((20 0 0, 29 0 9, 29 5 9, 20 5 0, 20 0 0))",
    )
    ramp = make_layer("ramp", "MultiPolygonZ", features=[(f"MultiPolygonZ({', '.join(parts)})",)])
    set_role(ramp, RAMP)
    rows = read(ramp).rows
    assert [(row.courtyard, row.ext["n"]) for row in rows] == [
        (False, "0,-0.7071,0.7071"),
        (True, "0,-0.7071,0.7071"),
        (False, "-0.7071,0,0.7071"),
    ]


@pytest.mark.parametrize(
    "shape",
    [
        SQUARE,
        "PolygonZ((0 0 7, 10 0 7, 10 2 7, 0 2 7, 0 0 7))",
        "PolygonZ((0 0 5, 10 0 5, 10 2 6, 0 2 6, 0 0 4))",
        "PolygonZ((0 0 0, 10 2 1, 10 0 0, 0 2 1, 0 0 0))",
    ],
)
def test_a_ramp_without_a_height_for_each_corner_has_no_normal(make_layer, read, shape):
    ramp = make_layer("ramp", shape.partition("(")[0], features=[(shape,)])
    set_role(ramp, RAMP)
    rows = read(ramp).rows
    assert rows and all(row.ext == {} for row in rows)


def test_a_ramp_that_stands_upright_is_named(make_layer, read):
    wall = "PolygonZ((0 0 0, 10 0 0, 10 0.001 99, 0 0.001 99, 0 0 0))"
    ramp = make_layer("ramp", "PolygonZ", features=[(wall,)])
    set_role(ramp, RAMP)
    reading = read(ramp)
    assert [row.ext for row in reading.rows] == [{}]
    assert reading.warnings == [
        "Layer ramp, feature 1: its corners span no surface that one can drive on; its normal is left out"
    ]


def test_the_z_of_what_is_no_ramp_says_nothing(make_layer, read):
    assert read(make_layer("house", "PolygonZ", fields=HEIGHT, features=[(SLOPE, 3.0)])).rows[0].ext == {}


def test_layers_whose_role_does_not_fit_are_named(make_layer, read):
    area, stairs = (make_layer(n, "Polygon", fields=HEIGHT, features=[(SQUARE, 1.0)]) for n in ("no", "up"))
    set_role(area, KEEPOUT)
    set_role(stairs, STAIRS)
    assert read(area, stairs).warnings == [
        "Layer no: its role is keepout, yet it is exported as obstacles",
        "Layer up: its role stairs wants lines, one a riser; other features are exported as plain "
        "obstacles (feature 1)",
    ]


def test_a_cancel_stops_the_reading_at_once(make_layer, read):
    feedback = QgsFeedback()
    feedback.cancel()
    reading = read(make_layer(features=[(LINE,)] * 3), feedback=feedback)
    assert (reading.complete, reading.rows) == (False, [])


def test_points_of_furniture_become_octagons_that_hold_a_circle_of_their_width(make_layer, read):
    trees = [("Point(10 5)", 2.0), ("MultiPoint((0 0), (4 0))", None), ("Point(7 7)", -1.0)]
    layer = make_layer("trees", "Point", fields="&field=across:double&field=height:double", features=trees)
    layer.setCustomProperty("fleet/role", "furniture")
    layer.setCustomProperty("fleet/width", '"across"')
    reading = read(layer)
    assert [row.source for row in reading.rows] == ["trees:1", "trees:2", "trees:2", "trees:3"]
    octagon = shapely.Polygon(reading.rows[0].points)
    assert octagon.is_valid and len(reading.rows[0].points) == 9
    assert octagon.contains(shapely.Point(10, 5).buffer(0.999))
    assert octagon.exterior.distance(shapely.Point(10, 5)) == pytest.approx(1.0)
    assert shapely.Polygon(reading.rows[2].points).centroid.coords[0] == pytest.approx((4.0, 0.0))
    assert shapely.Polygon(reading.rows[1].points).exterior.distance(shapely.Point(0, 0)) == pytest.approx(
        0.25
    )
    assert any("feature 3: its width -1.0 is not a number" in warning for warning in reading.warnings)

"""``fleet:buildroadsurfaces`` and ``fleet:surfaceatpoint`` on layers of all kinds."""

from __future__ import annotations

import numpy as np
import pytest
from fleet_supervisor.plugin.layers.roles import LayerExpressions, LayerSetup, keep_setup
from qgis.core import (
    NULL,
    QgsCoordinateReferenceSystem,
    QgsCoordinateTransform,
    QgsGeometry,
    QgsPointXY,
    QgsProcessingContext,
    QgsProcessingException,
    QgsProject,
    QgsVectorLayer,
)

ROAD = "&field=width_m:double&field=surface:string"
AREA = "&field=surface:string&field=name:string&field=origin:string"
BOX = "POLYGON(({0} {1}, {2} {1}, {2} {3}, {0} {3}, {0} {1}))"
ROADS = [
    ("LINESTRING(0 0, 100 0)", 6.0, "asphalt"),
    ("LINESTRING(50 -20, 50 20)", 4.0, "slippery"),
    ("LINESTRING(80 -20, 80 20)", 8.0, "parking pavement"),
]


@pytest.fixture
def project():
    return QgsProject()


@pytest.fixture
def run(provider, listener, project):
    """Run one of the algorithms and return its outputs."""
    import processing

    outputs = {"buildroadsurfaces": ("SURFACES", "FINDINGS"), "surfaceatpoint": ("OUTPUT",)}

    def do(name, feedback=None, **parameters):
        context = QgsProcessingContext()
        context.setProject(project)
        everything = {**dict.fromkeys(outputs[name], "memory:"), **parameters}
        return processing.run(f"fleet:{name}", everything, context=context, feedback=feedback or listener)

    return do


def areas(layer):
    """Return the square metres of each class and origin."""
    found = {}
    for one in layer.getFeatures():
        assert one["area_m2"] == pytest.approx(one.geometry().area(), abs=0.001)
        key = one["surface"], one["origin"]
        found[key] = found.get(key, 0.0) + one.geometry().area()
    return found


def told(layer, field="surface"):
    return [None if one[field] == NULL else one[field] for one in layer.getFeatures()]


# --- fleet:buildroadsurfaces ------------------------------------------------------------------------------


def test_surfaces_are_made_by_width_and_kept_apart_by_class(run, make_layer):
    made = run("buildroadsurfaces", ROADS=make_layer("roads", fields=ROAD, features=ROADS))
    assert areas(made["SURFACES"]) == pytest.approx(
        {
            ("slippery", "generated"): 160.0,
            ("asphalt", "generated"): 600.0 - 24,
            ("parking pavement", "generated"): 320.0 - 48,
        }
    )
    assert (made["SURFACE_COUNT"], made["GENERATED_COUNT"], made["FINDING_COUNT"]) == (5, 5, 0)
    assert made["AREA_M2"] == pytest.approx(160 + 576 + 272)


def test_the_order_of_the_classes_is_a_parameter(run, make_layer):
    roads = make_layer("roads", fields=ROAD, features=ROADS)
    made = run("buildroadsurfaces", ROADS=roads, PRECEDENCE="Asphalt, slippery")
    assert areas(made["SURFACES"])["asphalt", "generated"] == pytest.approx(600.0)


def test_what_was_drawn_keeps_its_ground_and_is_copied(run, make_layer):
    drawn = make_layer("hand", "Polygon", AREA, [(BOX.format(40, -10, 60, 10), "sand", "Pit", None)])
    made = run("buildroadsurfaces", ROADS=make_layer("roads", fields=ROAD, features=ROADS), DRAWN=[drawn])
    found = areas(made["SURFACES"])
    assert found["sand", "drawn"] == pytest.approx(400)
    assert found["slippery", "generated"] == pytest.approx(160 - 80)
    assert found["asphalt", "generated"] == pytest.approx(600 - 120)
    assert "Pit" in told(made["SURFACES"], "name")
    # Made once more of its own result, what was generated is no hand's work.
    again = run(
        "buildroadsurfaces",
        ROADS=make_layer("roads", fields=ROAD, features=ROADS),
        DRAWN=[made["SURFACES"]],
        PRECEDENCE="parking pavement",
    )
    assert found["parking pavement", "generated"] == pytest.approx(320 - 48)
    assert areas(again["SURFACES"])["parking pavement", "generated"] == pytest.approx(320)
    assert areas(again["SURFACES"])["sand", "drawn"] == pytest.approx(400)


def test_roads_without_a_width_are_as_wide_as_is_said_and_named(run, make_layer, listener):
    roads = make_layer(
        "roads", fields=ROAD, features=[*ROADS[:1], ("LINESTRING(0 50, 100 50)", None, "asphalt")]
    )
    made = run("buildroadsurfaces", ROADS=roads, DEFAULT_WIDTH=3.0)
    assert areas(made["SURFACES"]) == pytest.approx({("asphalt", "generated"): 900.0})
    (finding,) = made["FINDINGS"].getFeatures()
    assert (finding["feature"], finding.geometry().asWkt()) == (2, "LineString (0 50, 100 50)")
    assert finding["text"] == "The width of this road is not known; 3 m is used."
    assert made["FINDING_COUNT"] == 1
    assert "Layer roads: the width of 1 road is not known; 3 m is used" in listener.warnings


def test_expressions_of_the_roads_and_their_role_are_heard(run, make_layer):
    roads = make_layer("roads", fields=ROAD, features=ROADS[:1])
    keep_setup(roads, LayerSetup("road_centreline", LayerExpressions(width="10", semantics="'gravel'")))
    made = run("buildroadsurfaces", ROADS=roads)
    assert areas(made["SURFACES"]) == pytest.approx({("gravel", "generated"): 1000.0})
    made = run("buildroadsurfaces", ROADS=roads, WIDTH="width_m / 2")
    assert areas(made["SURFACES"]) == pytest.approx({("gravel", "generated"): 300.0})


def test_roads_in_degrees_are_made_in_metres(run, make_layer, project):
    project.setCrs(QgsCoordinateReferenceSystem("EPSG:32633"))
    roads = make_layer(
        "roads", fields=ROAD, features=[("LINESTRING(15 47, 15.001 47)", 6.0, "asphalt")], crs="EPSG:4326"
    )
    made = run("buildroadsurfaces", ROADS=roads)
    assert made["SURFACES"].crs().authid() == "EPSG:32633"
    assert made["AREA_M2"] == pytest.approx(6 * 76.0, abs=2)


def test_a_cancel_leaves_nothing(run, make_layer, listener):
    lines = [(f"LINESTRING({k} 0, {k} 50)", 1.0, "asphalt") for k in range(3000)]
    listener.progressChanged.connect(lambda share: share > 50 and listener.cancel())
    made = run("buildroadsurfaces", ROADS=make_layer("roads", fields=ROAD, features=lines))
    assert "SURFACES" not in made


# --- fleet:surfaceatpoint ---------------------------------------------------------------------------------


@pytest.fixture
def grounds(make_layer):
    features = [
        (BOX.format(0, 0, 100, 100), "asphalt", "Yard", "generated"),
        (BOX.format(10, 10, 20, 20), "slippery", None, "generated"),
        (BOX.format(0, 0, 15, 15), "sand", "Pit", None),
        (BOX.format(200, 0, 210, 10), None, None, None),
    ]
    return make_layer("ground", "Polygon", AREA, features)


PLACES = [(50, 50), (18, 18), (12, 12), (100, 100), (150, 50), (205, 5)]
CLASSES = ["asphalt", "slippery", "sand", "asphalt", None, ""]


def test_points_are_told_their_surfaces(run, make_layer, grounds):
    points = make_layer(
        "points", "Point", "&field=id:int", [(f"POINT({x} {y})", k) for k, (x, y) in enumerate(PLACES)]
    )
    made = run("surfaceatpoint", POINTS=points, SURFACES=[grounds])
    layer = made["OUTPUT"]
    assert told(layer) == CLASSES
    assert told(layer, "id") == list(range(6))
    assert told(layer, "surface_name") == ["Yard", None, "Pit", "Yard", None, None]
    assert told(layer, "surface_origin") == ["generated", "generated", "drawn", "generated", None, "drawn"]
    assert (made["ON_COUNT"], made["OFF_COUNT"], made["WARNING_COUNT"]) == (5, 1, 0)


@pytest.mark.parametrize("crs", ["EPSG:4326", "EPSG:3857", "EPSG:25833"])
def test_points_and_surfaces_may_be_in_any_crs(run, make_layer, crs):
    def moved(wkt, to):
        geometry = QgsGeometry.fromWkt(wkt)
        ends = (QgsCoordinateReferenceSystem(name) for name in ("EPSG:32633", to))
        geometry.transform(QgsCoordinateTransform(*ends, QgsProject.instance()))
        return geometry

    box = BOX.format(500000, 5200000, 500010, 5200010)
    inside, outside = "POINT(500009.9 5200005)", "POINT(500010.1 5200005)"
    other = "EPSG:4326" if crs != "EPSG:4326" else "EPSG:3857"
    ground = make_layer("ground", "Polygon", AREA, [(moved(box, crs), "asphalt", None, None)], crs=crs)
    points = make_layer("points", "Point", "", [(moved(p, other),) for p in (inside, outside)], crs=other)
    assert told(run("surfaceatpoint", POINTS=points, SURFACES=[ground])["OUTPUT"]) == ["asphalt", None]


def test_without_surfaces_it_takes_those_of_the_project(run, make_layer, grounds, project):
    points = make_layer("points", "Point", "", [("POINT(50 50)",)])
    with pytest.raises(QgsProcessingException, match="no layer of the project has the role road surface"):
        run("surfaceatpoint", POINTS=points)
    keep_setup(grounds, LayerSetup("road_surface", LayerExpressions(filter="\"surface\" <> 'asphalt'")))
    project.addMapLayer(grounds)
    assert told(run("surfaceatpoint", POINTS=points)["OUTPUT"]) == [None]
    keep_setup(grounds, LayerSetup("road_surface", LayerExpressions(semantics='upper("surface")')))
    assert told(run("surfaceatpoint", POINTS=points)["OUTPUT"]) == ["ASPHALT"]


def test_points_whose_place_is_not_known_are_refused(run, make_layer, grounds):
    points = make_layer("points", "Point", "", [("POINT(1 1)",)])
    points.setCrs(QgsCoordinateReferenceSystem())
    with pytest.raises(QgsProcessingException, match="The layer points has no CRS, so its place is not"):
        run("surfaceatpoint", POINTS=points, SURFACES=[grounds])


def test_a_field_that_is_there_already_stays(run, make_layer, grounds):
    points = make_layer("points", "Point", "&field=surface:string", [("POINT(50 50)", "mine")])
    layer = run("surfaceatpoint", POINTS=points, SURFACES=[grounds])["OUTPUT"]
    assert [one.attributes() for one in layer.getFeatures()] == [["mine", "asphalt", "Yard", "generated"]]
    assert layer.fields().names()[:2] == ["surface", "surface_2"]


def test_points_without_a_place_and_several_in_one(run, make_layer, grounds, listener):
    features = [(None,), ("MULTIPOINT((50 50), (60 60))",), ("MULTIPOINT((50 50), (18 18))",)]
    made = run("surfaceatpoint", POINTS=make_layer("points", "MultiPoint", "", features), SURFACES=[grounds])
    assert told(made["OUTPUT"]) == [None, "asphalt", None]
    assert listener.warnings == ["Feature 3 has points on several surfaces; none is given for it"]
    assert made["WARNING_COUNT"] == 1


def test_a_table_without_places_is_refused_with_what_to_do(run, grounds):
    table = QgsVectorLayer("NoGeometry?field=x:double&field=y:double", "drive", "memory")
    with pytest.raises(QgsProcessingException, match=r"POINTS drive is a table without places: .*fromtable"):
        run("surfaceatpoint", POINTS=table, SURFACES=[grounds])


def test_a_point_beyond_the_reach_of_a_crs_is_on_no_surface_and_the_others_are(run, make_layer):
    box = BOX.format(500000, 5200000, 500010, 5200010)
    nought = BOX.format(-10, -10, 10, 10)
    features = [(box, "asphalt", None, None), (nought, "where nothing is", None, None)]
    ground = make_layer("ground", "Polygon", AREA, features)
    degrees = QgsCoordinateReferenceSystem("EPSG:4326")
    way = QgsCoordinateTransform(ground.crs(), degrees, QgsProject.instance())
    inside = QgsGeometry.fromPointXY(way.transform(QgsPointXY(500005, 5200005)))
    features = [("POINT(1e5 1e5)",), ("POINT(15 91)",), (inside,)]
    points = make_layer("points", "Point", "", features, crs="EPSG:4326")
    assert told(run("surfaceatpoint", POINTS=points, SURFACES=[ground])["OUTPUT"]) == [None, None, "asphalt"]


def test_many_points_come_out_as_many(run, make_layer, grounds):
    places = np.random.default_rng(1).uniform(-20, 220, (25_000, 2))
    points = make_layer("points", "Point", "", [(f"POINT({x} {y})",) for x, y in places.tolist()])
    made = run("surfaceatpoint", POINTS=points, SURFACES=[grounds])
    inside = ((places >= 0) & (places <= 100)).all(axis=1)
    inside |= (places[:, 0] >= 200) & (places[:, 0] <= 210) & (places[:, 1] >= 0) & (places[:, 1] <= 10)
    assert [one is not None for one in told(made["OUTPUT"])] == inside.tolist()
    assert made["ON_COUNT"] + made["OFF_COUNT"] == 25_000


def test_what_is_broken_is_mended_with_a_warning(run, make_layer, listener):
    bow = "POLYGON((0 0, 10 10, 10 0, 0 10, 0 0))"
    ground = make_layer("ground", "Polygon", AREA, [(bow, "asphalt", None, None), (None, "sand", None, None)])
    points = make_layer("points", "Point", "", [("POINT(9 5)",), ("POINT(5 9)",)])
    assert told(run("surfaceatpoint", POINTS=points, SURFACES=[ground])["OUTPUT"]) == ["asphalt", None]
    assert any("feature 1" in one and "repaired" in one for one in listener.warnings)
    assert any("feature 2: has no geometry" in one for one in listener.warnings)

"""``fleet:conelayout``: standard layouts at a place or along a line, every cone checked."""

from __future__ import annotations

import re
import shlex
from functools import partial

import pytest
from fleet_supervisor.robot_bridge.core.layouts.catalogue import LAYOUTS
from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsFeature,
    QgsGeometry,
    QgsProcessingException,
    QgsProject,
    QgsVectorLayer,
)

UTM = "EPSG:32633"
X, Y = 640500.0, 5193500.0


def layer(kind, *texts, fields="", values=(), name="Given"):
    """Return a layer in memory with the geometries of ``texts``, moved to the site."""
    made = QgsVectorLayer(f"{kind}?crs={UTM}{fields}", name, "memory")
    features = []
    for text in texts:
        feature = QgsFeature(made.fields())
        geometry = QgsGeometry.fromWkt(text)
        geometry.translate(X, Y)
        feature.setGeometry(geometry)
        feature.setAttributes(list(values))
        features.append(feature)
    made.dataProvider().addFeatures(features)
    return made


@pytest.fixture
def place(run_for_cones):
    """Run the algorithm and return its outputs."""
    return partial(run_for_cones, "fleet:conelayout")


def rows(results):
    return {
        f["order"]: (f.geometry().asPoint().x() - X, f.geometry().asPoint().y() - Y, f["heading"])
        for f in results["CONES"].getFeatures()
    }


def test_a_heading_is_clockwise_from_north(place):
    results = place(LAYOUT="slalom", POINT=f"{X},{Y} [{UTM}]", HEADING=90, DIMENSIONS="spacing=10; count=2")
    made = rows(results)
    # Two cones of the gate, then those 6 and 16 m to the east.
    assert made[3] == pytest.approx((6, 0, 90))
    assert made[4] == pytest.approx((16, 0, 90))
    assert results["CONES"].crs().authid() == UTM
    north = rows(place(LAYOUT="slalom", POINT=f"{X},{Y} [{UTM}]"))
    assert north[3] == pytest.approx((0, 6, 0), abs=1e-6)


def test_each_cone_has_its_attributes_and_the_log_has_the_dimensions(place, listener):
    results = place(LAYOUT="fs_acceleration", POINT=f"{X},{Y} [{UTM}]", PREFIX="a")
    features = {f["id"]: f for f in results["CONES"].getFeatures()}
    assert results["CONE_COUNT"] == len(features) == 78 - 1
    first = features["a-1"]
    assert (first["colour"], first["role"], first["layout"]) == (
        "big_orange",
        "start left",
        "fs_acceleration",
    )
    assert "Formula Student acceleration (Formula Student Rules, D 5.1)" in listener.infos
    assert any(info.strip().startswith("length=75 m: From the starting line") for info in listener.infos)


def test_a_place_may_be_in_another_crs(place):
    results = place(LAYOUT="slalom", POINT="16.8411,46.8818 [EPSG:4326]", SITE_CRS=UTM)
    point = next(results["CONES"].getFeatures()).geometry().asPoint()
    assert 640000 < point.x() < 641000 and 5193000 < point.y() < 5194000


def test_along_a_line_cones_follow_it_and_reversed_they_come_back(place):
    line = layer("LineString", "LINESTRING(0 0,100 0,100 100)")
    given = {"LAYOUT": "corridor", "LINE": line, "DIMENSIONS": "length=150;width=4;cone_base=0;spacing=50"}
    made = rows(place(**given, START=20))
    assert made[1] == pytest.approx((20, 2, 90))
    assert made[8] == pytest.approx((102, 70, 0))
    back = rows(place(**given, START=20, REVERSE=True))
    assert back[1] == pytest.approx((102, 80, 180))


def test_a_line_may_have_heights_and_curves(place):
    made = rows(place(LAYOUT="slalom", LINE=layer("LineStringZM", "LINESTRING ZM(0 0 5 1,300 0 9 2)")))
    assert made[3][:2] == (pytest.approx(6), pytest.approx(0))
    bow = layer("CompoundCurve", "COMPOUNDCURVE(CIRCULARSTRING(0 0,200 200,400 0))")
    for x, y, _ in list(rows(place(LAYOUT="slalom", LINE=bow)).values())[2:-2]:
        assert (x - 200) ** 2 + y**2 == pytest.approx(200**2, abs=2 * 200 * 0.02)


@pytest.mark.parametrize(
    ("line", "reason"),
    [
        ("", "has no line with a length and a place in the site's CRS"),
        ("LINESTRING(5 5,5 5)", "has no line with a length and a place in the site's CRS"),
        ("LINESTRING(0 0,nan 5)", "has no line with a length and a place in the site's CRS"),
        ("MULTILINESTRING((0 0,300 0),(0 9,300 9))", "has 2 lines: split it"),
    ],
)
def test_a_feature_that_is_not_one_line_is_refused(place, line, reason):
    with pytest.raises(QgsProcessingException, match=f"The feature 1 of Given {reason}"):
        place(LAYOUT="slalom", LINE=layer("MultiLineString", line))


def test_a_line_whose_place_is_not_known_is_refused(place):
    line = layer("LineString", "LINESTRING(0 0,300 0)")
    line.setCrs(QgsCoordinateReferenceSystem())
    with pytest.raises(QgsProcessingException, match="The layer Given has no CRS, so its place is not known"):
        place(LAYOUT="slalom", LINE=line)


def test_a_line_is_chosen_by_its_id_where_there_are_several(place):
    lines = layer("LineString", "LINESTRING(0 0,300 0)", "LINESTRING(0 50,300 50)")
    assert rows(place(LAYOUT="slalom", LINE=lines, LINE_ID=2))[3][1] == pytest.approx(50)
    with pytest.raises(QgsProcessingException, match="not exactly one feature: choose one line by LINE_ID"):
        place(LAYOUT="slalom", LINE=lines)
    with pytest.raises(QgsProcessingException, match="has no feature 9"):
        place(LAYOUT="slalom", LINE=lines, LINE_ID=9)


def test_each_cone_that_may_not_stand_there_is_a_finding(place, listener):
    asphalt = layer("Polygon", "POLYGON((-5 -5,30 -5,30 5,-5 5,-5 -5))", fields="&field=surface:string")
    for feature in asphalt.getFeatures():
        asphalt.dataProvider().changeAttributeValues({feature.id(): {0: "asphalt"}})
    post = layer("Point", "POINT(16.3 0)", name="Posts")
    given = {
        "LAYOUT": "slalom",
        "DIMENSIONS": "count=3,spacing=10",
        "POINT": f"{X},{Y} [{UTM}]",
        "HEADING": 90,
        "SURFACES": [asphalt],
        "OBSTACLES": [post],
    }
    results = place(**given)
    found = {(f["cone"], f["kind"]): f["text"] for f in results["FINDINGS"].getFeatures()}
    assert set(found) == {("slalom-4", "obstacle"), ("slalom-6", "surface"), ("slalom-7", "surface")}
    assert "0.30 m from Posts, feature 1: keep 0.5 m" in found["slalom-4", "obstacle"]
    assert results["FINDING_COUNT"] == 3
    assert found["slalom-4", "obstacle"] in listener.warnings
    assert place(**given, ALLOWED="asphalt", OBSTACLE_DISTANCE=0.2)["FINDING_COUNT"] == 2
    assert place(**given, ALLOWED="gravel", OBSTACLE_DISTANCE=0)["FINDING_COUNT"] == 7
    assert "No surface is of class gravel: the layers have asphalt." in listener.warnings


def test_an_obstacle_without_a_geometry_is_named(place, listener):
    place(LAYOUT="slalom", POINT=f"{X},{Y}", OBSTACLES=[layer("Point", "", name="Posts")])
    assert "Layer Posts, feature 1: has no geometry; it is left out" in listener.warnings


def test_without_surfaces_it_is_said_that_they_are_not_checked(place, listener):
    assert place(LAYOUT="slalom", POINT=f"{X},{Y} [{UTM}]")["FINDING_COUNT"] == 0
    assert any("whether the cones stand on the road is not checked" in info for info in listener.infos)


@pytest.mark.parametrize(
    ("parameters", "reason"),
    [
        ({}, "Neither POINT nor LINE is given"),
        ({"POINT": "0,0", "DIMENSIONS": "spacing=ten"}, "'spacing=ten', which is not name=value"),
        (
            {"POINT": "0,0", "DIMENSIONS": "width=10"},
            "slalom has no dimension 'width': give cone_base, count",
        ),
    ],
)
def test_what_cannot_be_is_refused_with_what_to_do(place, parameters, reason):
    with pytest.raises(QgsProcessingException, match=reason):
        place(LAYOUT="slalom", **parameters)


@pytest.mark.parametrize(
    ("crs", "reason"),
    [
        ("EPSG:3857", "its metres are not metres"),
        ("EPSG:99999", "SITE_CRS EPSG:99999 is no CRS that QGIS knows"),
    ],
)
def test_a_crs_that_cannot_carry_a_site_is_refused(by_words, tmp_path, crs, reason):
    where = ("POINT=0,0", f"SITE_CRS={crs}", f"CONES={tmp_path / 'cones.gpkg'}")
    done = by_words("run", "fleet:conelayout", "--", "LAYOUT=slalom", *where)
    assert done.status != 0
    assert crs in done.said and reason in done.said
    assert "Traceback" not in done.said


def test_a_line_that_is_too_short_says_how_much_is_missing(place):
    line = layer("LineString", "LINESTRING(0 0,100 0)")
    with pytest.raises(QgsProcessingException, match=r"100\.00 m long and the layout reaches to 156\.00 m"):
        place(LAYOUT="slalom", LINE=line)


def test_cancelling_gives_no_layer(place, listener):
    listener.cancel()
    assert place(LAYOUT="slalom", POINT=f"{X},{Y} [{UTM}]").get("CONES") is None


@pytest.fixture(scope="module")
def guide(root):
    """What the guide says."""
    return (root / "docs" / "cones.md").read_text(encoding="utf-8")


def words_of(guide, algorithm, root, folder):
    """Return the words of the guide's command for ``algorithm``, with the files where they are here."""
    block = re.search(rf"^    qgis_process\.bin (run fleet:{algorithm} (?:.*\\\n)*.*)$", guide, re.MULTILINE)
    words = shlex.split(block[1].replace("\\\n", " "))
    return [
        word.replace("=build/", f"={folder}/").replace("=resources/", f"={root}/resources/") for word in words
    ]


def test_it_is_placed_on_the_sample_site_as_the_guide_says(by_words, guide, root, tmp_path):
    done = by_words(*words_of(guide, "conelayout", root, tmp_path))
    assert done.status == 0, done.said
    assert done.result("CONE_COUNT") == 18
    assert done.result("FINDING_COUNT") == 0
    made = {
        f["order"]: f.geometry().asPoint() for f in QgsVectorLayer(str(tmp_path / "cones.gpkg")).getFeatures()
    }
    # Left cones: 15 + 30 + 25 + 25 + 15 m along; the exit lane is 0.1 times 1.7 m wider on each side.
    assert (made[17].x() - made[1].x(), made[17].y() - made[1].y()) == pytest.approx((110, 0.17), abs=1e-6)


def test_a_table_is_imported_as_the_guide_says(by_words, guide, root, tmp_path):
    (tmp_path / "cones.csv").write_text("x,y,colour\n0,0,blue\n5,0,yellow\n", encoding="utf-8")
    words = words_of(guide, "importconelayout", root, tmp_path)
    done = by_words(*(word.replace("FILE=", f"FILE={tmp_path}/") for word in words))
    assert done.status == 0, done.said
    assert done.result("CONE_COUNT") == 2


def test_the_guide_has_every_dimension_with_its_value_and_a_picture_of_every_layout(guide, root):
    for name, kind in LAYOUTS.items():
        section = re.search(rf"^### .*`{name}`$[\s\S]*?(?=^### |\Z)", guide, re.MULTILINE)[0]
        assert (root / "docs" / "images" / f"cones-{name.replace('_', '-')}.png").is_file()
        for one in kind.dimensions():
            if one.name != "cone_base":
                assert f"| `{one.name}` | {one.standard:g}" in section, f"{name}: {one.name}"
    assert "`cone_base`, 0.285 m" in guide


@pytest.mark.parametrize(("surface", "loaded"), [((0, 200), ["Cones"]), ((0, 50), ["Cones", "Findings"])])
def test_a_layer_of_findings_is_loaded_when_there_are_some(provider, listener, surface, loaded, monkeypatch):
    import processing

    # QGIS 3.44 sorts what it loads into the tree of its window, if there is one.
    monkeypatch.setattr("processing.gui.Postprocessing.iface", None, raising=False)
    west, east = surface
    road = layer("Polygon", f"Polygon(({west} -10, {east} -10, {east} 10, {west} 10, {west} -10))")
    before = set(QgsProject.instance().mapLayers())
    results = processing.runAndLoadResults(
        "fleet:conelayout",
        {
            "LAYOUT": "slalom",
            "POINT": f"{X + 10},{Y} [{UTM}]",
            "HEADING": 90,
            "SURFACES": [road],
            "SITE_CRS": UTM,
            "CONES": "memory:",
            "FINDINGS": "memory:",
        },
        feedback=listener,
    )
    made = [one for key, one in QgsProject.instance().mapLayers().items() if key not in before]
    assert sorted(one.name() for one in made) == loaded
    assert (results["FINDING_COUNT"] == 0) == (loaded == ["Cones"])
    assert any("no findings" in info for info in listener.infos) == (loaded == ["Cones"])
    QgsProject.instance().removeMapLayers([one.id() for one in made])

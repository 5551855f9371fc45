"""``fleet:loadrobotmap``: everything that a robot map says is in the layers, and in its place."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from fleet_supervisor.robot_bridge.core.robotmap.binary import encode
from fleet_supervisor.robot_bridge.core.robotmap.text_format import read_text
from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsLayerTreeRegistryBridge,
    QgsProcessingContext,
    QgsProcessingException,
    QgsProcessingUtils,
    QgsProject,
    QgsRasterLayer,
    QgsVectorLayer,
)
from qgis.PyQt.QtCore import QCoreApplication

LAYERS = ("AREAS", "LINES", "SEGMENTS", "BORDER")
PLACED = "%crs EPSG:32633\n%origin 600000,5100000\n%rotation 0\n"
HOUSE = """\
border;
-10;40;
60;-10;
#
obstacle;
7;1;3;house,A1;src=houses:4,h=est;
#
0;0;
30;0;
12.5;1;brick;n=0,0,1;
#
30;0;
30;20;
8;0;;
#
30;20;
0;0;
12.5;1;;
#
obstacle;
8;2;1;wall;
#
40;0;
50;0;
2;1;;
#
"""


@pytest.fixture
def load(provider, tmp_path, listener):
    """Run the algorithm on a text, bytes or a file, and return its layers and its other outputs."""
    import processing

    project = QgsProject()

    def run(content, **parameters):
        file = content
        if isinstance(content, (str, bytes)):
            file = tmp_path / "given.map"
            file.write_bytes(content if isinstance(content, bytes) else content.encode())
        context = QgsProcessingContext()
        context.setProject(project)
        outputs = dict.fromkeys(LAYERS, "memory:")
        everything = {"MAP": str(file), **outputs, **parameters}
        results = processing.run("fleet:loadrobotmap", everything, context=context, feedback=listener)
        return results

    return run


def rows(layer, *names):
    return [tuple(feature[name] for name in names) for feature in layer.getFeatures()]


def points_of(feature):
    return [(vertex.x(), vertex.y()) for vertex in feature.geometry().vertices()]


def test_closed_obstacles_become_areas_and_the_others_lines_with_all_attributes(load):
    made = load(PLACED + HOUSE)
    assert rows(made["AREAS"], "id", "shape", "semantics", "height_m", "outdoor", "segments", "source") == [
        (7, "closed polygon", "house,A1", 12.5, False, 3, "houses:4")
    ]
    assert json.loads(next(made["AREAS"].getFeatures())["ext"]) == {"src": "houses:4", "h": "est"}
    assert rows(made["LINES"], "id", "shape", "semantics", "height_m") == [(8, "open polygon", "wall", 2.0)]
    assert (made["OBSTACLE_COUNT"], made["SEGMENT_COUNT"], made["WARNING_COUNT"]) == (2, 4, 0)


def test_segments_keep_their_direction_heights_flags_labels_and_extras(load):
    made = load(PLACED + HOUSE)
    names = ("obstacle", "number", "height_m", "outdoor", "semantics", "obstacle_semantics")
    assert rows(made["SEGMENTS"], *names) == [
        (7, 1, 12.5, True, "brick", "house,A1"),
        (7, 2, 8.0, False, "", "house,A1"),
        (7, 3, 12.5, True, "", "house,A1"),
        (8, 1, 2.0, True, "", "wall"),
    ]
    first = next(made["SEGMENTS"].getFeatures())
    assert json.loads(first["ext"]) == {"n": "0,0,1"}
    assert points_of(first) == [(600000, 5100000), (600030, 5100000)]


def test_the_border_comes_with_what_the_map_says_of_itself(load):
    border = next(load(PLACED + HOUSE)["BORDER"].getFeatures())
    assert border["area_m2"] == 3500
    assert json.loads(border["meta"])["crs"] == "EPSG:32633"
    assert set(points_of(border)) == {
        (599990, 5099990),
        (600060, 5099990),
        (600060, 5100040),
        (599990, 5100040),
    }


def test_a_courtyard_is_a_hole_of_its_house(load):
    def ring(id, points):
        pairs = zip(points, [*points[1:], points[0]], strict=True)
        lines = "".join(f"{a[0]};{a[1]};\n{b[0]};{b[1]};\n3;1;;\n#\n" for a, b in pairs)
        return f"obstacle;\n{id};1;4;house;src=h:1;\n#\n{lines}"

    solid = ring(1, [(0, 0), (30, 0), (30, 30), (0, 30)])
    yard = ring(2, [(10, 10), (10, 20), (20, 20), (20, 10)])
    made = load(PLACED + HOUSE.partition("obstacle;")[0] + solid + yard)
    (area,) = made["AREAS"].getFeatures()
    assert area.geometry().area() == pytest.approx(800)
    assert area["courtyards"] == "[2]"


def test_the_maps_frame_places_it_turned_and_moved(load):
    quarter = PLACED.replace("%rotation 0", f"%rotation {np.pi / 2!r}")
    first = next(load(quarter + HOUSE)["SEGMENTS"].getFeatures())
    assert np.allclose(points_of(first), [(600000, 5100000), (600000, 5100030)], atol=1e-6)


def test_parameters_win_over_what_the_map_says(load):
    made = load(PLACED + HOUSE, SITE_CRS="EPSG:25833", ORIGIN="1000,2000", ROTATION=180)
    assert made["SEGMENTS"].crs().authid() == "EPSG:25833"
    assert np.allclose(points_of(next(made["SEGMENTS"].getFeatures())), [(1000, 2000), (970, 2000)])


def test_a_map_of_no_known_place_is_in_local_metres_and_says_so(load, listener):
    made = load(HOUSE)
    crs = made["SEGMENTS"].crs()
    assert crs.isValid() and not crs.isGeographic() and "Site frame" in crs.description()
    assert points_of(next(made["SEGMENTS"].getFeatures())) == [(0, 0), (30, 0)]
    assert any("it names no CRS" in warning and "SITE_CRS" in warning for warning in listener.warnings)
    load("%crs EPSG:999999\n" + HOUSE)
    assert any("'EPSG:999999' that the map names is not known" in warning for warning in listener.warnings)


def test_binary_is_read_as_text_is(load):
    text, binary = load(PLACED + HOUSE), load(encode(PLACED + HOUSE))
    for name in LAYERS:
        assert [f.attributes() for f in text[name].getFeatures()] == [
            f.attributes() for f in binary[name].getFeatures()
        ]


def test_the_papers_sample_is_loaded_and_its_short_obstacle_named(load, listener, fig_2):
    made = load(fig_2)
    assert rows(made["LINES"], "id", "semantics") == [(1, "column,A5"), (110, "wall,A4")]
    assert made["WARNING_COUNT"] == 1
    assert "line 6: obstacle 1 declares 4 segments, and 1 came" in listener.warnings


def test_what_was_exported_comes_back_where_it_was(load, export, make_layer):
    crs = "EPSG:32633"
    shape = "Polygon((640500 5193500, 640530 5193500, 640530 5193520, 640500 5193500))"
    houses = make_layer("houses", "Polygon", crs=crs, features=[(shape, 9.5)])
    exported = export(
        houses, CENTER=f"640515,5193510 [{crs}]", SITE_CRS=crs, ORIGIN=f"640420,5193480 [{crs}]", ROTATION=30
    )
    made = load(exported.file)
    assert made["AREAS"].crs() == QgsCoordinateReferenceSystem(crs)
    (area,) = made["AREAS"].getFeatures()
    (source,) = houses.getFeatures()
    assert area.geometry().symDifference(source.geometry()).area() < 0.01 * 80
    assert (area["height_m"], area["source"]) == (9.5, "houses:1")


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (HOUSE.replace("30;0;\n12.5", "30;zero;\n12.5"), "line 9: in obstacle 7, expected a point"),
        (HOUSE[:120], "it was cut off"),
        (b"RMAP" + bytes(60), "version check"),
        (encode(HOUSE)[:-8], "cannot be read"),
        (b"\xff\xfe\x00", "neither UTF-8 (byte 0) nor in the binary format"),
        ("", "the text ends"),
        ("%origin here\n" + HOUSE, "'%origin here' of the map should hold two numbers"),
        ("%rotation nan\n" + HOUSE, "should hold a number"),
    ],
)
def test_what_is_no_map_is_refused_with_the_place_of_the_fault(load, content, said):
    with pytest.raises(QgsProcessingException) as error:
        load(content)
    assert said in str(error.value)


def test_a_missing_file_and_a_crs_that_carries_no_site_are_refused(load, tmp_path):
    with pytest.raises(QgsProcessingException, match=r"There is no file .*gone\.map"):
        load(tmp_path / "gone.map")
    with pytest.raises(QgsProcessingException, match="its metres are not metres"):
        load(HOUSE, SITE_CRS="EPSG:3857")
    with pytest.raises(QgsProcessingException, match="EPSG:999999"):
        load(HOUSE, SITE_CRS="EPSG:999999")


def test_cancelling_gives_no_result(load, listener):
    listener.cancel()
    assert load(PLACED + HOUSE).get("SEGMENTS") is None


def test_layers_that_are_opened_get_their_style(provider, tmp_path, listener):
    file = tmp_path / "given.map"
    file.write_text(PLACED + HOUSE)
    context, project = QgsProcessingContext(), QgsProject()
    context.setProject(project)
    algorithm = provider.algorithm("loadrobotmap").create()
    parameters = {"MAP": str(file), **{name: f"{tmp_path / name}.gpkg" for name in LAYERS}}
    for name in LAYERS:
        details = QgsProcessingContext.LayerDetails(name, project, name)
        context.addLayerToLoadOnCompletion(f"{tmp_path / name}.gpkg", details)
    results, fine = algorithm.run(parameters, context, listener)
    assert fine
    layer = QgsProcessingUtils.mapLayerFromString(results["SEGMENTS"], context)
    assert layer.renderer().type() == "graduatedSymbol"
    assert layer.renderer().classAttribute() == "height_m"


def test_a_script_makes_a_geopackage(by_words, tmp_path):
    file, target = tmp_path / "given.map", tmp_path / "segments.gpkg"
    file.write_bytes(encode(PLACED + HOUSE))
    done = by_words("run", "fleet:loadrobotmap", "--", f"MAP={file}", f"SEGMENTS={target}")
    assert done.status == 0, done.said
    assert done.result("SEGMENT_COUNT") == read_text(HOUSE).segment_count
    layer = QgsVectorLayer(str(target))
    assert (layer.featureCount(), layer.crs().authid()) == (4, "EPSG:32633")


def test_a_script_hears_what_is_wrong_and_fails(by_words, tmp_path):
    file = tmp_path / "broken.map"
    file.write_text(HOUSE[:120])
    done = by_words("run", "fleet:loadrobotmap", "--", f"MAP={file}", f"SEGMENTS={tmp_path / 's.gpkg'}")
    assert done.status != 0
    assert "it was cut off" in done.said and "Traceback" not in done.said


@pytest.mark.parametrize("name", ["loadrobotmap", "checkrobotmap", "exportrobotmaptiles"])
def test_the_algorithms_have_help_an_icon_and_a_style_for_their_layers(provider, root, name):
    algorithm = provider.algorithm(name)
    assert len(algorithm.shortHelpString()) > 300 and algorithm.shortDescription()
    assert not algorithm.icon().isNull() and Path(algorithm.svgIconPath()).is_file()
    layers = {output.name() for output in algorithm.outputDefinitions()}
    assert algorithm.STYLES and set(algorithm.STYLES) <= layers
    for style in algorithm.STYLES.values():
        kind = "Polygon" if style.split(".")[0].endswith(("areas", "border", "tiles")) else "LineString"
        layer = QgsVectorLayer(f"{kind}?field=height_m:double", "x", "memory")
        said, fine = layer.loadNamedStyle(str(root / "resources" / "styles" / style))
        assert fine, said


@pytest.fixture
def open_project(provider, make_layer, root):
    """The project that is open: roads above buildings above a photo, and the photo is the current layer."""
    project = QgsProject.instance()
    project.clear()
    photo = QgsRasterLayer(str(root / "resources" / "sample_site" / "orthophoto.tif"), "photo")
    buildings = make_layer("buildings", "Polygon", features=[("Polygon((0 0, 9 0, 9 9, 0 0))",)])
    group = project.layerTreeRoot().addGroup("Ground")
    for layer in (make_layer("roads"), buildings, photo):
        project.addMapLayer(layer, False)
    project.layerTreeRoot().insertLayer(0, project.mapLayersByName("roads")[0])
    group.addLayer(buildings)
    group.addLayer(photo)
    bridge = project.layerTreeRegistryBridge()
    bridge.setLayerInsertionPoint(QgsLayerTreeRegistryBridge.InsertionPoint(group, 1))
    yield project
    # The group goes with the project, and layers of later tests must not be put into it.
    root = project.layerTreeRoot()
    bridge.setLayerInsertionPoint(QgsLayerTreeRegistryBridge.InsertionPoint(root, 0))
    project.clear()


TITLES = ["Segments", "Obstacles that are lines", "Obstacles that are areas", "Border of the map"]


@pytest.mark.parametrize("custom", [False, True])
def test_what_is_loaded_lies_above_everything_that_would_cover_it(open_project, tmp_path, custom):
    import processing

    root = open_project.layerTreeRoot()
    if custom:
        root.setHasCustomLayerOrder(True)
        root.setCustomLayerOrder(root.layerOrder())
    (tmp_path / "house.txt").write_text(HOUSE)
    made = dict.fromkeys(LAYERS, "TEMPORARY_OUTPUT")
    processing.runAndLoadResults("fleet:loadrobotmap", {"MAP": str(tmp_path / "house.txt"), **made})
    # What is nowhere in the tree for a moment is taken out of the project with the next events.
    QCoreApplication.processEvents()
    drawn = [layer.name() for layer in root.layerOrder()]
    assert drawn == ["roads", *TITLES, "buildings", "photo"]
    assert [child.name() for child in root.children()] == ["roads", *TITLES, "Ground"]

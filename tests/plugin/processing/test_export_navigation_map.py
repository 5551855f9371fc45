"""``fleet:exportnavigationmap``: from a robot map's file to what other robots and people read."""

from __future__ import annotations

import json
import re
import sqlite3
from pathlib import Path

import numpy as np
import pyogrio
import pytest
import yaml
from fleet_supervisor.plugin.processing.common.navigation_files import FORMAT_WRITERS
from fleet_supervisor.robot_bridge.core.robotmap.binary import encode
from fleet_supervisor.robot_bridge.core.robotmap.exporters.vector_files import write_geopackage
from fleet_supervisor.robot_bridge.core.robotmap.text_format import read_text
from fleet_supervisor.robot_bridge.core.sites.frame import frame_of_map
from PIL import Image
from pyproj import Transformer
from qgis.core import (
    QgsFeatureRequest,
    QgsProcessingContext,
    QgsProcessingException,
    QgsProcessingFeatureSourceDefinition,
    QgsProject,
)
from qgis.PyQt.QtGui import QColor, QImage

MAP = """\
%crs EPSG:32633
%origin 640420.000,5193480.000
%rotation 0.000000000
border;
0;20;
40;0;
#
obstacle;
1;1;4;building,Hall;src=b:1;
#
2;2;
12;2;
6;1;;
#
12;2;
12;8;
6;1;;
#
12;8;
2;8;
6;1;;
#
2;8;
2;2;
6;1;;
#
obstacle;
2;2;1;kerb;
#
20;5;
30;5;
0.05;1;;
#
"""
AREA = "Polygon((640440 5193490, 640450 5193490, 640450 5193495, 640440 5193495, 640440 5193490))"


@pytest.fixture
def robot_map(tmp_path):
    """A map of a hall and a kerb, 40 m x 20 m, its (0, 0) at 640420, 5193480 in EPSG:32633."""
    file = tmp_path / "site.txt"
    file.write_text(MAP)
    return file


@pytest.fixture
def areas(make_layer):
    """A rectangle from (20, 10) to (30, 15) in the site frame, limited to 1.5 m/s, and one without limit."""
    return make_layer("zones", "Polygon", fields="&field=limit:double", features=[(AREA, 1.5), (AREA, None)])


@pytest.fixture
def masked(export, robot_map, areas):
    """Make a keepout and a speed mask of the areas that a filter keeps."""

    def run(text, **layers):
        areas.setCustomProperty("fleet/filter", text)
        both = {"KEEPOUTS": areas, "SPEED_AREAS": areas, "SPEED": "2", "FORMATS": ["keepout", "speed"]}
        return export(robot_map, **{**both, **layers})

    return run


def test_masks_are_of_the_features_that_count(masked):
    def inside_is_as_outside(text):
        results, _, warnings = masked(text)
        assert warnings == []
        files = (results["KEEPOUT"], results["SPEED"])
        return [value_at(file, 25, 12) == value_at(file, 35, 17) for file in files]

    assert inside_is_as_outside('"limit" > 1') == [False, False]
    assert inside_is_as_outside('"limit" < 1') == [True, True]


def test_of_selected_features_those_count_that_the_filter_keeps(masked, areas):
    project = QgsProject()
    project.addMapLayer(areas)
    areas.selectAll()
    chosen = QgsProcessingFeatureSourceDefinition(areas.id(), selectedFeaturesOnly=True)
    for text, everywhere_alike in (('"limit" > 1', False), ('"limit" < 1', True)):
        results, _, _ = masked(text, FORMATS=["keepout"], KEEPOUTS=chosen, project=project)
        file = results["KEEPOUT"]
        assert (value_at(file, 25, 12) == value_at(file, 35, 17)) is everywhere_alike


def test_a_mask_by_a_filter_that_fails_names_the_feature(masked):
    _, _, warnings = masked("to_int('a')", FORMATS=["keepout"])
    assert len(warnings) == 2
    assert warnings[0].startswith("Layer zones, feature 1: the filter expression fails: Cannot convert")


BOW_TIE = "Polygon((640440 5193490, 640450 5193495, 640450 5193490, 640440 5193495, 640440 5193490))"


@pytest.mark.parametrize("setting", ["GeometrySkipInvalid", "GeometryAbortOnInvalid"])
def test_an_area_that_crosses_itself_is_in_the_mask_whatever_processing_is_set_to(
    export, robot_map, make_layer, setting
):
    area = make_layer("ponds", "Polygon", features=[(BOW_TIE, 1.0)])
    check = getattr(QgsFeatureRequest.InvalidGeometryCheck, setting)
    results, _, warnings = export(robot_map, FORMATS=["keepout"], KEEPOUTS=area, check=check)
    assert value_at(results["KEEPOUT"], 21, 12.5) != value_at(results["KEEPOUT"], 35, 17)
    assert len(warnings) == 1 and warnings[0].endswith("Self-intersection; it was repaired")


def test_a_mask_of_a_layer_that_no_exact_transformation_brings_to_the_map_says_so(
    export, robot_map, make_layer
):
    old = make_layer("old", "Polygon", crs="EPSG:4277", features=[(f"Polygon({CORNERS})", 1.0)])
    place = {"SITE_CRS": "EPSG:5514", "ORIGIN": "0,0"}
    _, _, warnings = export(robot_map, FORMATS=["keepout"], KEEPOUTS=old, **place)
    assert any(
        text.startswith("Layer old: its features may lie metres off on the site.") for text in warnings
    )


CORNERS = "(15 50, 15.1 50, 15.1 50.1, 15 50)"


def test_a_mask_by_a_filter_that_is_none_is_refused_and_nothing_is_written(masked, tmp_path):
    with pytest.raises(QgsProcessingException, match=r"The filter expression '1 \+' for the layer zones"):
        masked("1 +")
    assert not (tmp_path / "out").exists()


@pytest.fixture
def export(provider, tmp_path):
    """Run the algorithm; return its results, the folder and what it warned of."""
    import processing

    from tests.plugin.processing.conftest import Listener

    def run(source, feedback=None, project=None, check=None, **parameters):
        listener = feedback or Listener()
        context = QgsProcessingContext()
        context.setProject(project or QgsProject())
        if check is not None:
            context.setInvalidGeometryCheck(check)
        everything = {"MAP": str(source), "OUTPUT": str(tmp_path / "out"), **parameters}
        results = processing.run(
            "fleet:exportnavigationmap",
            everything,
            context=context,
            feedback=listener,
            is_child_algorithm=True,
        )
        return results, Path(everything["OUTPUT"]), listener.warnings

    return run


def value_at(file: str, x: float, y: float) -> int:
    """Return the pixel at a place of the site frame, found as Nav2 finds it."""
    said = yaml.safe_load(Path(file).read_text())
    pixels = np.asarray(Image.open(Path(file).parent / said["image"]))[::-1]
    column, row = ((np.array([x, y]) - said["origin"][:2]) / said["resolution"]).astype(int)
    return int(pixels[row, column])


def test_the_occupancy_grid_is_what_comes_without_further_words(export, robot_map):
    results, folder, warnings = export(robot_map)
    assert {file.name for file in folder.iterdir()} == {"site.pgm", "site.yaml"}
    assert (results["FILE_COUNT"], results["WARNING_COUNT"], warnings) == (2, 0, [])
    assert Image.open(folder / "site.pgm").size == (800, 400)
    grid = results["OCCUPANCY"]
    assert [value_at(grid, x, y) for x, y in ((2, 5), (7, 5), (25, 5), (15, 5))] == [0, 205, 0, 254]


def test_every_format_is_written_and_named_in_the_results(export, robot_map, areas):
    results, folder, _ = export(
        robot_map,
        FORMATS=list(FORMAT_WRITERS),
        KEEPOUTS=areas,
        SPEED_AREAS=areas,
        SPEED="limit",
        NAME="yard",
    )
    assert {file.name for file in folder.iterdir()} == {
        *("yard.pgm", "yard.yaml", "yard.gpkg", "yard.svg", "yard.png"),
        *("yard_keepout.pgm", "yard_keepout.yaml", "yard_keepout_filter.yaml"),
        *("yard_speed.pgm", "yard_speed.yaml", "yard_speed_filter.yaml"),
        *("yard_obstacles.geojson", "yard_segments.geojson"),
    }
    assert results["FILE_COUNT"] == 13
    assert all(Path(results[format.upper()]).is_file() for format in FORMAT_WRITERS)


def test_a_binary_map_gives_the_same_grid(export, robot_map, tmp_path):
    binary = tmp_path / "site.rmap"
    binary.write_bytes(encode(MAP))
    _, folder, _ = export(robot_map)
    text_made = (folder / "site.pgm").read_bytes()
    _, folder, _ = export(binary)
    assert (folder / "site.pgm").read_bytes() == text_made


def test_resolution_inside_and_what_is_driven_over_are_choices(export, robot_map):
    results, folder, _ = export(robot_map, RESOLUTION=0.5, INSIDE="occupied", DRIVES_OVER=0.1)
    assert Image.open(folder / "site.pgm").size == (80, 40)
    grid = results["OCCUPANCY"]
    assert [value_at(grid, x, y) for x, y in ((7, 5), (25, 5.1))] == [0, 254]


def test_layers_in_the_crs_come_into_the_site_frame_of_the_masks(export, robot_map, areas):
    results, folder, warnings = export(
        robot_map, FORMATS=["keepout", "speed"], KEEPOUTS=areas, SPEED_AREAS=areas, SPEED='"limit"'
    )
    assert [value_at(results["KEEPOUT"], x, y) for x, y in ((25, 12), (15, 12), (25, 8))] == [0, 254, 254]
    parameters = yaml.safe_load((folder / "site_speed_filter.yaml").read_text())
    multiplier = parameters["speed_filter_info_server"]["ros__parameters"]["multiplier"]
    mask = round((255 - value_at(results["SPEED"], 25, 12)) / 255 * 100)
    assert mask * multiplier == pytest.approx(1.5)
    assert value_at(results["SPEED"], 15, 12) == 255
    assert warnings == [
        "Layer zones, feature 2: has no speed above 0 m/s, so it sets no limit; it is left out"
    ]


def test_geojson_is_where_the_layer_of_the_same_place_is(export, robot_map):
    _, folder, _ = export(robot_map, FORMATS=["geojson"])
    content = json.loads((folder / "site_obstacles.geojson").read_text())
    corner = Transformer.from_crs(32633, 4326, always_xy=True).transform(640422, 5193482)
    ring = np.array(content["features"][0]["geometry"]["coordinates"][0])
    assert np.abs(ring - corner).sum(axis=1).min() < 2e-8


def test_the_geopackage_holds_the_obstacles_in_the_sites_crs(export, robot_map):
    results, _, _ = export(robot_map, FORMATS=["geopackage"])
    with sqlite3.connect(results["GEOPACKAGE"]) as connection:
        query = "select min_x, min_y, srs_id from gpkg_contents where table_name = 'obstacle_areas'"
        assert connection.execute(query).fetchone() == (640422.0, 5193482.0, 32633)


def test_qgis_writes_the_geopackage_that_the_bridge_writes(export, robot_map, tmp_path):
    parsed = read_text(MAP)
    frame = frame_of_map(parsed.meta)
    write_geopackage(parsed, tmp_path / "bridge.gpkg", frame.crs, frame.to_crs)
    results, _, _ = export(robot_map, FORMATS=["geopackage"])
    for layer in ("obstacle_areas", "obstacle_lines", "segments", "border"):
        ours, theirs = (
            pyogrio.raw.read(file, layer=layer) for file in (results["GEOPACKAGE"], tmp_path / "bridge.gpkg")
        )
        assert ours[0]["fields"].tolist() == theirs[0]["fields"].tolist()
        assert (ours[0]["crs"], ours[0]["geometry_type"]) == (theirs[0]["crs"], theirs[0]["geometry_type"])
        assert [bytes(shape) for shape in ours[2]] == [bytes(shape) for shape in theirs[2]]
        for mine, other in zip(ours[3], theirs[3], strict=True):
            assert (mine.dtype, mine.tolist()) == (other.dtype, other.tolist())


def test_the_png_shows_the_hall_in_its_place(export, robot_map):
    results, _, _ = export(robot_map, FORMATS=["png"])
    image = QImage(results["PNG"])
    assert image.width() > 2000

    def colour(x, y):
        """25 pixels a metre, drawn twice as fine; the map's upper left corner is at (62, 66)."""
        return QColor(image.pixel(round(2 * (62 + 25 * x)), round(2 * (66 + 25 * (20 - y))))).name()

    hall, ground = colour(4, 6), colour(15, 12.5)
    assert hall != ground and colour(11, 3) == hall and colour(35, 17.5) == ground


@pytest.mark.parametrize(
    ("parameters", "words"),
    [
        ({"FORMATS": ["keepout"]}, "FORMATS has keepout, which needs KEEPOUTS"),
        ({"FORMATS": "png,dxf"}, "FORMATS is dxf: choose of occupancy, keepout, speed, geojson, "),
        ({"FORMATS": []}, "FORMATS is empty: choose of occupancy"),
        ({"FORMATS": ["speed"]}, "FORMATS has speed, which needs SPEED_AREAS"),
        ({"RESOLUTION": 0}, "RESOLUTION is 0: give a number of metres above 0"),
        ({"RESOLUTION": "fine"}, "RESOLUTION is fine: give a number of metres"),
        ({"DRIVES_OVER": -1}, "DRIVES_OVER is -1: give a number of metres of 0 or more"),
        ({"RESOLUTION": 0.001}, "40000 x 20000 = 800.0 million cells, the limit is 64 million"),
        ({"NAME": "a/b"}, "NAME 'a/b' is no file's name"),
    ],
)
def test_what_cannot_be_done_is_said_and_writes_nothing(export, robot_map, tmp_path, parameters, words):
    with pytest.raises(QgsProcessingException, match=re.escape(words)):
        export(robot_map, **parameters)
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("content", "words"),
    [
        (MAP[:-60].encode(), "site.txt cannot be read: line .* was cut off"),
        (b"\xff\xfe\x00", "neither UTF-8"),
        (encode(MAP)[:-5], "check"),
        (b"", "site.txt cannot be read: line"),
    ],
)
def test_a_file_that_is_no_map_is_named(export, tmp_path, content, words):
    file = tmp_path / "site.txt"
    file.write_bytes(content)
    with pytest.raises(QgsProcessingException, match=words):
        export(file)


def test_a_missing_file_is_named(export, tmp_path):
    with pytest.raises(QgsProcessingException, match=r"gone\.txt"):
        export(tmp_path / "gone.txt")


def test_a_map_without_a_place_has_no_geojson_and_takes_layers_as_they_are(export, robot_map, make_layer):
    robot_map.write_text("".join(line for line in MAP.splitlines(True) if not line.startswith("%")))
    with pytest.raises(QgsProcessingException, match="GeoJSON needs longitudes and latitudes"):
        export(robot_map, FORMATS=["geojson"])
    local = make_layer("zones", "Polygon", features=[("Polygon((20 10, 30 10, 30 15, 20 15, 20 10))", 1.0)])
    results, _, warnings = export(robot_map, FORMATS=["keepout", "geopackage", "svg"], KEEPOUTS=local)
    assert value_at(results["KEEPOUT"], 25, 12) == 0
    assert len(warnings) == 2 == results["WARNING_COUNT"]
    assert "it names no CRS" in warnings[0] and "taken as the map's own metres" in warnings[1]
    _, _, warnings = export(robot_map, FORMATS=["occupancy", "svg"])
    assert warnings == []


def test_a_map_without_a_place_can_be_given_one(export, robot_map, areas):
    _, folder, _ = export(robot_map, FORMATS=["geojson", "keepout"], KEEPOUTS=areas)
    said = (folder / "site_segments.geojson").read_text().partition('"features"')[2]
    robot_map.write_text("".join(line for line in MAP.splitlines(True) if not line.startswith("%")))
    place = {"SITE_CRS": "EPSG:32633", "ORIGIN": "640420,5193480"}
    given, folder, warnings = export(robot_map, FORMATS=["geojson", "keepout"], KEEPOUTS=areas, **place)
    assert (folder / "site_segments.geojson").read_text().partition('"features"')[2] == said
    assert value_at(given["KEEPOUT"], 25, 12) == 0 and warnings == []


def test_an_expression_that_is_none_is_refused(export, robot_map, areas):
    with pytest.raises(QgsProcessingException, match="SPEED '1 \\+' is no expression"):
        export(robot_map, FORMATS=["speed"], SPEED_AREAS=areas, SPEED="1 +")


def test_warnings_of_the_map_are_passed_on(export, robot_map):
    robot_map.write_text(MAP.replace("2;2;1;kerb", "2;2;9;kerb"))
    _, _, warnings = export(robot_map)
    assert len(warnings) == 1 and "obstacle 2 declares 9 segments, and 1 came" in warnings[0]


def test_a_cancelled_export_writes_nothing(export, robot_map, cancels_at, tmp_path):
    for percent in (1, 45, 90):
        results, folder, _ = export(robot_map, feedback=cancels_at(percent), FORMATS=["occupancy", "svg"])
        assert not folder.exists() and "FILE_COUNT" not in results


def test_an_older_export_is_replaced_and_other_files_stay(export, robot_map, tmp_path):
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "site.yaml").write_text("an older map")
    (tmp_path / "out" / "notes.txt").write_text("mine")
    export(robot_map)
    assert "image: site.pgm" in (tmp_path / "out" / "site.yaml").read_text()
    assert sorted(file.name for file in (tmp_path / "out").iterdir()) == [
        "notes.txt",
        "site.pgm",
        "site.yaml",
    ]


def test_one_file_in_the_way_leaves_all_as_they_were(export, robot_map, tmp_path):
    out = tmp_path / "out"
    export(robot_map, FORMATS=["occupancy"])
    (out / "site.svg").mkdir()
    before = (out / "site.pgm").read_bytes()
    with pytest.raises(
        QgsProcessingException, match=f"{out / 'site.svg'} is a folder, where a file is to be"
    ):
        export(robot_map, FORMATS=["occupancy", "svg"], RESOLUTION=1.0)
    assert (out / "site.pgm").read_bytes() == before
    assert sorted(file.name for file in out.iterdir()) == ["site.pgm", "site.svg", "site.yaml"]


def test_a_folder_that_cannot_be_made_is_named(export, robot_map):
    with pytest.raises(QgsProcessingException, match="The navigation map cannot be written to /proc/maps: "):
        export(robot_map, OUTPUT="/proc/maps")


def test_the_robot_map_itself_is_never_the_output(export, tmp_path):
    file = tmp_path / "site.svg"
    file.write_text(MAP)
    with pytest.raises(QgsProcessingException, match="is the robot map itself: choose another"):
        export(file, FORMATS=["svg"], OUTPUT=str(tmp_path))
    assert file.read_text() == MAP


def test_a_script_exports_for_todays_robots_what_it_exported_as_a_robot_map(by_words, root, tmp_path):
    """The chain of a script: the sample site's layers, a robot map, the files of today's robots."""
    project = root / "resources" / "sample_site" / "sample_site.qgz"
    layers = [f"OBSTACLES={name}" for name in ("Buildings", "Walls", "Stairs", "Ramp")]
    source = tmp_path / "site.txt"
    done = by_words(
        *("run", "fleet:exportrobotmap", f"--PROJECT_PATH={project}", "--", *layers),
        *("CENTER=640520,5193560 [EPSG:32633]", "WIDTH=200", "HEIGHT=160"),
        f"OUTPUT={source}",
    )
    assert done.status == 0, done.said
    done = by_words(
        *("run", "fleet:exportnavigationmap", "--", f"MAP={source}", "RESOLUTION=0.1"),
        *(f"FORMATS={name}" for name in ("occupancy", "geojson", "geopackage", "svg", "png")),
        f"OUTPUT={tmp_path / 'nav'}",
    )
    assert done.status == 0, done.said
    assert done.result("FILE_COUNT") == 7
    grid = tmp_path / "nav" / "site.yaml"
    # The workshop's middle, a place on the road, and the noise barrier.
    assert [value_at(grid, x, y) for x, y in ((98, 100), (60, 60), (145.05, 20))] == [205, 254, 0]


def test_a_refused_export_says_why_and_has_another_exit_status(by_words, tmp_path):
    (tmp_path / "broken.txt").write_text("border;\n0;1;\n")
    done = by_words(
        *("run", "fleet:exportnavigationmap", "--", f"MAP={tmp_path / 'broken.txt'}"),
        f"OUTPUT={tmp_path / 'nav'}",
    )
    assert done.status != 0
    assert "broken.txt cannot be read: line 2" in done.said and "Traceback" not in done.said
    assert not (tmp_path / "nav").exists()

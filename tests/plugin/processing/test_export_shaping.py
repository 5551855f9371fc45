"""What reduces an export, and the compact format, by ``processing.run`` and by ``qgis_process``."""

from __future__ import annotations

import re

import numpy as np
import pyogrio
import pytest
import shapely
from fleet_supervisor.robot_bridge.core.robotmap.binary import decode, decode_text
from fleet_supervisor.robot_bridge.core.robotmap.model import ShapeType
from qgis.core import (
    QgsProcessingContext,
    QgsProcessingException,
    QgsProcessingParameterDefinition,
    QgsProject,
    QgsVectorLayer,
)

HERE = {"CENTER": "20,20", "WIDTH": 80, "HEIGHT": 80}
LEFT = "Polygon((10 10, 20 10, 20 20, 10 20, 10 10))"
RIGHT = "Polygon((20 10, 30 10, 30 20, 20 20, 20 10))"
SHAPING = (
    *("PLANE_LOW", "PLANE_HIGH", "HEIGHT_STEP"),
    *("DISSOLVE", "CHAIN", "TOLERANCE", "SHORTEST"),
)


@pytest.fixture
def houses(make_layer):
    """Two houses with a wall between them."""
    return make_layer("houses", "Polygon", features=[(LEFT, 4.0), (RIGHT, 6.0)])


@pytest.fixture
def lines(make_layer):
    """Return a layer of lines of height 1.5 m, or of the height given after the WKT."""

    def make(*wkts):
        return make_layer("walls", features=[(w, 1.5) if isinstance(w, str) else w for w in wkts])

    return make


def segments(robot_map):
    """Return every segment as (n, 4), in the order of the map."""
    return np.concatenate([np.hstack([o.a, o.b]) for o in robot_map.obstacles]).tolist()


def test_nothing_is_reduced_unless_asked_for(export, houses):
    done = export(houses, **HERE)
    assert done.results["SEGMENT_COUNT"] == 8
    assert "became" not in done.log


@pytest.mark.parametrize("name", ["exportrobotmap", "exportrobotmaptiles"])
def test_each_option_is_advanced_and_explained(provider, name):
    for option in SHAPING:
        definition = provider.algorithm(name).parameterDefinition(option)
        assert definition.flags() & QgsProcessingParameterDefinition.Flag.FlagAdvanced, option
        assert len(definition.help()) > 40, option
        assert not definition.defaultValue(), option


def test_what_ends_below_the_plane_is_left_out_and_said(export, lines):
    kerb, wall = ("LineString(0 5, 50 5)", 0.3), ("LineString(0 8, 50 8)", 0.31)
    done = export(lines(kerb, wall), PLANE_LOW=0.3, PLANE_HIGH=1.0, **HERE)
    assert [obstacle.ext["src"] for obstacle in done.map.obstacles] == ["walls:2"]
    assert "2 obstacles, 2 segments became 1 obstacle, 1 segment" in done.log


@pytest.fixture
def arches(make_layer):
    """Four walls that begin at 0.99 m, 1 m, nowhere said, and where nobody understands it."""
    bases = ("0,99 m", "1.0", None, "high")
    features = [(f"LineString(0 {k}, 50 {k})", 0.5, base) for k, base in enumerate(bases)]
    return make_layer("arches", fields="&field=height:double&field=base:string", features=features)


def test_what_begins_above_the_plane_is_left_out(export, arches):
    plane = {"PLANE_LOW": 0.3, "PLANE_HIGH": 1.0}
    assert export(arches, **plane, **HERE).results["OBSTACLE_COUNT"] == 4
    done = export(arches, **plane, BASE_EXPRESSION='"base"', **HERE)
    assert [obstacle.ext["src"] for obstacle in done.map.obstacles] == ["arches:1", "arches:3", "arches:4"]
    (warning,) = done.warnings
    assert warning.startswith(
        "Layer arches, feature 4: its base 'high' is not a number of metres; it is taken"
    )
    # From its foot at 1 m the wall is 0.5 m high, and so above a robot that is below.
    assert export(arches, PLANE_LOW=1.2, PLANE_HIGH=2, BASE_EXPRESSION="1", **HERE).map.segment_count == 4


def test_a_layer_without_the_field_of_the_base_stands_on_the_ground_and_is_named(export, lines):
    plane = {"PLANE_LOW": 0.3, "PLANE_HIGH": 1.0}
    done = export(lines("LineString(0 5, 50 5)"), **plane, BASE_EXPRESSION='"base"', **HERE)
    assert done.results["OBSTACLE_COUNT"] == 1
    assert done.warnings[0].startswith("Layer walls: it has no field base, which the base expression")


def test_heights_are_rounded_up_in_steps(export, lines):
    layer = lines(("LineString(0 5, 50 5)", 1.5), ("LineString(0 8, 50 8)", 1.51))
    robot_map = export(layer, HEIGHT_STEP=0.5, **HERE).map
    assert [obstacle.height.tolist() for obstacle in robot_map.obstacles] == [[1.5], [2.0]]


def test_the_wall_between_two_houses_is_dissolved_and_each_part_keeps_its_house(export, houses):
    done = export(houses, DISSOLVE=True, **HERE)
    assert not [s for s in segments(done.map) if s[0] == s[2] == 20]
    assert done.results["SEGMENT_COUNT"] == 6
    assert {(o.ext["src"], o.height[0]) for o in done.map.obstacles} == {("houses:1", 4.0), ("houses:2", 6.0)}
    assert {o.shape_type for o in done.map.obstacles} == {ShapeType.OPEN_POLYGON}
    assert "2 obstacles, 8 segments became 2 obstacles, 6 segments" in done.log


def test_lines_that_meet_are_chained(export, lines):
    done = export(lines("LineString(0 5, 9 5)", "LineString(9 5, 9 9)"), CHAIN=True, **HERE)
    (obstacle,) = done.map.obstacles
    assert obstacle.ext["src"] == "walls:1+1"
    assert segments(done.map) == [[0, 5, 9, 5], [9, 5, 9, 9]]
    assert "2 obstacles, 2 segments became 1 obstacle, 2 segments" in done.log


def test_a_known_and_an_estimated_height_are_not_chained_and_a_chain_of_estimates_says_so(export, lines):
    first, second = "LineString(0 5, 9 5)", "LineString(9 5, 9 9)"
    known = export(lines((first, 3.0), (second, None)), CHAIN=True, **HERE)
    assert [obstacle.ext.get("h") for obstacle in known.map.obstacles] == [None, "est"]
    (estimated,) = export(lines((first, None), (second, None)), CHAIN=True, **HERE).map.obstacles
    assert estimated.ext == {"src": "walls:1+1", "h": "est"}


def test_a_tolerance_leaves_out_corners_within_it_only(export, lines):
    layer = lines("LineString(0 5, 10 5.04, 20 5)", "LineString(0 9, 10 9.06, 20 9)")
    assert export(layer, TOLERANCE=0.05, **HERE).results["SEGMENT_COUNT"] == 3


def test_segments_shorter_than_the_shortest_are_left_out(export, lines):
    layer = lines("LineString(0 5, 5 5, 5 5.09, 20 9)", "LineString(0 15, 5 15, 5 15.11, 20 19)")
    assert export(layer, SHORTEST=0.1, **HERE).results["SEGMENT_COUNT"] == 5


def test_fewer_walls_can_be_more_obstacles_and_the_log_says_so(export, make_layer):
    row = [(f"Polygon(({x} 0, {x + 9} 0, {x + 9} 9, {x} 9, {x} 0))", 4.0) for x in (0, 9, 18)]
    done = export(make_layer("houses", "Polygon", features=row), DISSOLVE=True, **HERE)
    assert "3 obstacles, 12 segments became 4 obstacles, 8 segments" in done.log


@pytest.fixture
def street(make_layer):
    """Many houses wall to wall, so that what is done to them takes a while."""
    squares = [
        (f"Polygon(({x} {y}, {x + 9} {y}, {x + 9} {y + 9}, {x} {y + 9}, {x} {y}))", 4.0)
        for x in range(0, 360, 9)
        for y in range(0, 300, 20)
    ]
    return make_layer("houses", "Polygon", features=squares)


EVERYTHING = {"DISSOLVE": True, "CHAIN": True, "TOLERANCE": 0.05, "SHORTEST": 0.1}


def test_the_progress_goes_on_while_obstacles_are_reduced(export, street, listener):
    told = []
    listener.progressChanged.connect(told.append)
    export(street, feedback=listener, EXTENT="0,400,0,300", **EVERYTHING)
    assert told == sorted(told) and told[-1] == 100
    assert len([percent for percent in told if 50 <= percent < 100]) > 10


@pytest.mark.parametrize("percent", [55, 65, 75, 85, 95])
def test_a_cancel_while_obstacles_are_reduced_ends_it_there_and_writes_nothing(
    export, street, cancels_at, tmp_path, percent
):
    feedback, told = cancels_at(percent), []
    feedback.progressChanged.connect(told.append)
    done = export(street, feedback=feedback, EXTENT="0,400,0,300", **EVERYTHING)
    assert done.results == {} and not done.file.exists()
    assert percent <= told[-1] < percent + 10


def test_a_cancel_while_tiles_are_reduced_writes_none(provider, street, cancels_at, tmp_path):
    import processing

    context = QgsProcessingContext()
    context.setProject(QgsProject())
    everything = {"OBSTACLES": [street], "EXTENT": "0,400,0,300", "INDEX": "memory:", **EVERYTHING}
    everything["OUTPUT"] = str(tmp_path / "out")
    results = processing.run(
        "fleet:exportrobotmaptiles",
        everything,
        context=context,
        feedback=cancels_at(35),
        is_child_algorithm=True,
    )
    assert results == {} and not list(tmp_path.glob("out/*"))


@pytest.mark.parametrize("option", [{"DISSOLVE": True}, {"CHAIN": True}, {"TOLERANCE": 1, "SHORTEST": 1}])
def test_where_there_is_nothing_to_reduce_the_map_is_as_without(export, make_layer, lines, option):
    wall = lines("LineString(0 5, 50 5)")
    assert export(wall, **HERE, **option).text == export(wall, **HERE).text
    nothing = export(make_layer("none", features=[]), **HERE, **option)
    assert nothing.results["OBSTACLE_COUNT"] == 0


@pytest.mark.parametrize(
    ("parameters", "words"),
    [
        ({"TOLERANCE": -1}, "TOLERANCE is -1: give a number of metres of 0 or more"),
        ({"SHORTEST": float("nan")}, "SHORTEST is nan: give a number of metres"),
        ({"HEIGHT_STEP": -0.5}, "HEIGHT_STEP is -0.5: give a number of metres"),
        ({"PLANE_LOW": 0.3}, "PLANE_LOW is given and PLANE_HIGH is not: give both"),
        ({"PLANE_HIGH": 1}, "PLANE_HIGH is given and PLANE_LOW is not: give both"),
        ({"BASE_EXPRESSION": "2 +"}, "The base expression '2 +' for the lay"),
        ({"PLANE_LOW": 1, "PLANE_HIGH": 1}, "PLANE_LOW is 1 and PLANE_HIGH 1: give the lower"),
    ],
)
def test_a_value_that_cannot_be_used_is_named_before_the_run(provider, lines, parameters, words):
    everything = {"OBSTACLES": [lines("LineString(0 5, 50 5)")], "OUTPUT": "map.txt", **HERE, **parameters}
    context = QgsProcessingContext()
    context.setProject(QgsProject())
    fine, message = provider.algorithm("exportrobotmap").create().checkParameterValues(everything, context)
    assert not fine and words in message


@pytest.mark.parametrize("strict", [False, True])
def test_compact_holds_the_very_text(export, houses, strict):
    parameters = {**HERE, "STRICT": strict}
    text = export(houses, **parameters).text
    assert export(houses, FORMAT="binary", **parameters).file.read_bytes()[5] == 1
    done = export(houses, FORMAT="compact", **parameters)
    assert done.file.read_bytes()[5] == 2
    assert done.text == text
    assert done.results["BYTES"] == done.file.stat().st_size
    assert f"{done.results['BYTES']} bytes in binary" in done.log
    assert ("src=" in text, "%crs" in text) == (not strict, not strict)


def test_a_format_that_is_none_is_refused(export, houses):
    with pytest.raises(QgsProcessingException, match="FORMAT"):
        export(houses, FORMAT="binary, compact", **HERE)


def test_tiles_know_where_things_begin(provider, arches, listener, tmp_path):
    import processing

    context = QgsProcessingContext()
    context.setProject(QgsProject())
    everything = {"OBSTACLES": [arches], "EXTENT": "0,40,-10,30", "TILE_WIDTH": 40, "TILE_HEIGHT": 40}
    everything |= {"PLANE_LOW": 0.3, "PLANE_HIGH": 1, "BASE_EXPRESSION": '"base"', "OVERLAP": 0}
    everything |= {"OUTPUT": str(tmp_path / "out"), "INDEX": "memory:"}
    results = processing.run("fleet:exportrobotmaptiles", everything, context=context, feedback=listener)
    assert (results["OBSTACLE_COUNT"], results["WARNING_COUNT"]) == (3, 1)


def test_tiles_are_reduced_before_they_are_cut(provider, houses, listener, tmp_path):
    import processing

    context = QgsProcessingContext()
    context.setProject(QgsProject())
    results = processing.run(
        "fleet:exportrobotmaptiles",
        {
            "OBSTACLES": [houses],
            "EXTENT": "0,40,0,40",
            "TILE_WIDTH": 20,
            "TILE_HEIGHT": 40,
            "OVERLAP": 0,
            "DISSOLVE": True,
            "FORMAT": "compact",
            "OUTPUT": str(tmp_path / "out"),
            "INDEX": "memory:",
        },
        context=context,
        feedback=listener,
    )
    files = sorted((tmp_path / "out").iterdir())
    assert [file.suffix for file in files] == [".rmap", ".rmap"]
    assert {file.read_bytes()[5] for file in files} == {2}
    made = [s for file in files for s in segments(decode(file.read_bytes()))]
    assert len(made) == 6 and not [s for s in made if s[0] == s[2] == 20]
    assert results["SEGMENT_COUNT"] == 6
    assert "2 obstacles, 8 segments became 2 obstacles, 6 segments" in listener.infos


@pytest.fixture(scope="module")
def export_campus(data, export_by_words):
    def run(**parameters):
        file = data / "upc_campus_nord" / "upc_campus_nord_local.gpkg"
        layers = [f"{file}|layername={name}" for name in ("buildings", "walls", "furniture")]
        return export_by_words(*layers, CENTER="48,48", WIDTH=104, HEIGHT=104, **parameters)

    return run


def shaped_as_said(said, result):
    """Return how many segments there were before and after, as the log and the outputs say it."""
    told = r"(\d+) obstacles, (\d+) segments became (\d+) obstacles, (\d+) segments"
    counts = re.search(told, said).groups()
    before, obstacles, after = (int(count) for count in counts[1:])
    assert (obstacles, after) == (result("OBSTACLE_COUNT"), result("SEGMENT_COUNT"))
    return before, after


@pytest.fixture(scope="module")
def campus_with_feet(data, tmp_path_factory):
    """The campus with how high above the ground beside it each thing begins."""
    file = data / "upc_campus_nord" / "upc_campus_nord_local.gpkg"
    made = tmp_path_factory.mktemp("feet") / "campus.gpkg"
    _, _, wkb, (ground,) = pyogrio.raw.read(file, "ground_surfaces", columns=["z_mean"])
    surfaces = shapely.STRtree(shapely.from_wkb(wkb))
    for layer, lowest in (("buildings", None), ("walls", "z_min"), ("furniture", "z_min")):
        meta, _, wkb, columns = pyogrio.raw.read(file, layer)
        values = dict(zip(meta["fields"], columns, strict=True))
        level = ground[surfaces.nearest(shapely.centroid(shapely.from_wkb(wkb)))]
        # Buildings are modelled down to the lowest ground around them.
        base = values[lowest] - level if lowest else np.zeros(len(wkb))
        pyogrio.raw.write(
            made,
            wkb,
            [values["height"], base],
            ["height", "base"],
            layer=layer,
            geometry_type=meta["geometry_type"],
            crs="EPSG:32631",
            append=made.exists(),
        )
    return made


def test_the_campus_in_the_robots_plane_is_within_the_papers_three_bytes(campus_with_feet, export):
    layers = [f"{campus_with_feet}|layername={name}" for name in ("buildings", "walls", "furniture")]
    place = {"CENTER": "48,48", "WIDTH": 104, "HEIGHT": 104, "ORIGIN": "0,0", "SITE_CRS": "EPSG:32631"}
    plane = {"PLANE_LOW": 0.3, "PLANE_HIGH": 1, "BASE_EXPRESSION": '"base"'}
    made = export(*layers, **place, **plane, DISSOLVE=True, CHAIN=True)
    assert shaped_as_said(made.log, made.results.get)
    assert made.results["BYTES_PER_M2"] <= 3


@pytest.fixture(scope="module")
def campus_project(qgis_app, data, tmp_path_factory):
    """A project with the layers of the campus, among them its ground."""
    file = data / "upc_campus_nord" / "upc_campus_nord_local.gpkg"
    project = QgsProject()
    for name in ("buildings", "walls", "furniture", "ground_surfaces"):
        project.addMapLayer(QgsVectorLayer(f"{file}|layername={name}", name, "ogr"))
    made = tmp_path_factory.mktemp("project") / "campus.qgz"
    assert project.write(str(made))
    return made


def test_the_profile_of_the_campus_knows_what_hangs_above_the_robots_plane(
    campus_project, by_words, tmp_path
):
    counts = []
    for low, high in ((0.3, 1), (0.3, 1000)):
        words = [f"OBSTACLES={name}" for name in ("buildings", "walls", "furniture")]
        # Of a part: the ground beneath each thing takes a while to find.
        words += ["CENTER=48,48", "WIDTH=30", "HEIGHT=30", "PROFILE=upc_campus_nord"]
        words += [f"PLANE_LOW={low}", f"PLANE_HIGH={high}", f"OUTPUT={tmp_path / 'map.txt'}"]
        done = by_words("run", "fleet:exportrobotmap", f"--PROJECT_PATH={campus_project}", "--", *words)
        assert done.status == 0, done.said
        assert done.result("WARNING_COUNT") == 0
        counts.append(done.result("OBSTACLE_COUNT"))
    assert counts[0] > 100
    assert 5 < counts[1] - counts[0] < 15


def test_the_campus_dissolved_and_chained_is_half_as_large(export_campus):
    done, file = export_campus(DISSOLVE="true", CHAIN="true")
    assert done.status == 0, done.said
    before, after = shaped_as_said(done.said, done.result)
    assert after < 0.65 * before
    assert done.result("BYTES_PER_M2") < 7
    compact, binary = export_campus(DISSOLVE="true", CHAIN="true", FORMAT="compact", output="campus.rmap")
    assert decode_text(binary.read_bytes()) == file.read_text()
    assert compact.result("BYTES_PER_M2") < 0.4

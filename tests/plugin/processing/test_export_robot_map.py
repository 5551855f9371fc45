"""What each parameter of ``fleet:exportrobotmap`` does, inside QGIS."""

from __future__ import annotations

import math

import pytest
from fleet_supervisor.plugin.layers.roles import LayerExpressions, set_expressions, set_role
from fleet_supervisor.robot_bridge.core.robotmap.model import ShapeType
from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsExpressionContextUtils,
    QgsProcessingException,
    QgsProject,
)

SQUARE = "Polygon((10 10, 20 10, 20 20, 10 20, 10 10))"
WALL = "LineString(0 5, 50 5)"


@pytest.fixture
def house(make_layer):
    return make_layer("house", "Polygon", features=[(SQUARE, 4.0)])


@pytest.fixture
def wall(make_layer):
    return make_layer("wall", features=[(WALL, 1.5)])


def lines(obstacle):
    return [(*a, *b) for a, b in zip(obstacle.a.tolist(), obstacle.b.tolist(), strict=True)]


def test_polygons_and_lines_come_out_oriented_grouped_and_measured(export, house, wall):
    done = export(wall, house, CENTER="20,20", WIDTH=80, HEIGHT=60)
    first, second = done.map.obstacles
    assert (first.shape_type, first.semantics, first.ext) == (1, "house", {"src": "house:1"})
    assert lines(first) == [(10, 10, 20, 10), (20, 10, 20, 20), (20, 20, 10, 20), (10, 20, 10, 10)]
    assert (second.shape_type, second.semantics, lines(second)) == (2, "wall", [(0, 5, 50, 5)])
    assert first.height.tolist() == [4.0] * 4 and second.height.tolist() == [1.5]
    assert done.map.border == (-20, -10, 60, 50)
    assert (done.results["OBSTACLE_COUNT"], done.results["SEGMENT_COUNT"]) == (2, 5)
    assert done.results["BYTES"] == len(done.text) == done.file.stat().st_size
    assert done.results["BYTES_PER_M2"] == pytest.approx(len(done.text) / 4800)
    assert (done.results["WARNING_COUNT"], done.warnings) == (0, [])


def test_the_log_says_bytes_and_bytes_per_square_metre_next_to_the_papers(export, house):
    done = export(house, CENTER="20,20", WIDTH=100, HEIGHT=50)
    size = done.results["BYTES"]
    assert f"{size} bytes of text, {size / 5000:.3g} bytes/m² (paper 1: about 3 bytes/m²" in done.log
    assert "Window 100 m x 50 m = 5000 m²" in done.log


def test_an_extent_is_a_window_too_and_cuts_without_inventing_walls(export, house):
    done = export(house, EXTENT="15,40,0,15 [EPSG:32633]")
    assert done.map.border == (15, 0, 40, 15)
    (chain,) = done.map.obstacles
    assert chain.shape_type == ShapeType.OPEN_POLYGON
    assert lines(chain) == [(15, 10, 20, 10), (20, 10, 20, 15)]


def test_a_centre_in_degrees_is_found_in_the_site_frame(export, make_layer):
    layer = make_layer(crs="EPSG:4326", features=[("LineString(15 46, 15.0001 46)", 1.0)])
    done = export(layer, CENTER="15,46 [EPSG:4326]", SITE_CRS="EPSG:32633", WIDTH=20, HEIGHT=20)
    x_min, y_min, x_max, y_max = done.map.border
    assert ((x_min + x_max) / 2, (y_min + y_max) / 2) == pytest.approx((500000, 5094047.49), abs=0.01)
    assert done.results["SEGMENT_COUNT"] == 1
    assert done.map.meta["crs"] == "EPSG:32633"


def test_origin_and_rotation_make_the_site_frame(export, wall):
    done = export(wall, CENTER="0,5", ORIGIN="0,5", ROTATION=90, WIDTH=200, HEIGHT=200)
    (obstacle,) = done.map.obstacles
    assert lines(obstacle) == [(0, 0, 0, -50)]
    assert done.map.meta == {
        "crs": "EPSG:32633",
        "origin": "0.000,5.000",
        "rotation": f"{math.pi / 2:.9f}",
    }


def test_a_project_lends_its_site_frame_unless_another_is_given(export, wall):
    project = QgsProject()
    project.setCrs(QgsCoordinateReferenceSystem("EPSG:32633"))
    for name, value in (("site_crs", "EPSG:32633"), ("origin_x", 10), ("origin_y", 5), ("rotation_deg", 0)):
        QgsExpressionContextUtils.setProjectVariable(project, f"fleet_{name}", value)
    window = {"CENTER": "10,5", "WIDTH": 200, "HEIGHT": 200}
    assert lines(export(wall, project=project, **window).map.obstacles[0]) == [(-10, 0, 40, 0)]
    assert lines(export(wall, project=project, ORIGIN="0,0", **window).map.obstacles[0]) == [(0, 5, 50, 5)]


def test_an_origin_or_a_rotation_alone_leaves_the_projects_other_half(export, wall):
    project = QgsProject()
    project.setCrs(QgsCoordinateReferenceSystem("EPSG:32633"))
    for name, value in (("site_crs", "EPSG:32633"), ("origin_x", 10), ("origin_y", 5), ("rotation_deg", 90)):
        QgsExpressionContextUtils.setProjectVariable(project, f"fleet_{name}", value)
    window = {"CENTER": "10,5", "WIDTH": 200, "HEIGHT": 200, "project": project}
    meta = export(wall, ROTATION=0, **window).map.meta
    assert (meta["origin"], float(meta["rotation"])) == ("10.000,5.000", 0.0)
    meta = export(wall, ORIGIN="0,5", **window).map.meta
    assert (meta["origin"], float(meta["rotation"])) == ("0.000,5.000", pytest.approx(math.pi / 2))


def test_a_rotated_site_gets_the_smallest_window_that_holds_the_extent(export, wall):
    done = export(wall, EXTENT="0,50,0,10 [EPSG:32633]", ROTATION=90)
    assert done.map.border == (0, -50, 10, 0)


def test_labels_whose_letters_cannot_be_read_are_named(export, wall):
    """So QGIS may read a shapefile in another encoding whose .cpg is missing: it depends on its state."""
    done = export(wall, CENTER="0,0", SEMANTICS_EXPRESSION="'caf\ufffd'")
    (warning,) = done.warnings
    assert "its label has letters that cannot be read: set the layer's encoding" in warning


def test_expressions_give_height_label_and_place_and_the_layers_own_win(export, house, wall):
    set_expressions(wall, LayerExpressions(semantics="'wall,brick'"))
    done = export(
        house,
        wall,
        CENTER="20,20",
        HEIGHT_EXPRESSION='"height" + 1',
        SEMANTICS_EXPRESSION="@layer_name || ',' || $id",
        OUTDOOR_EXPRESSION="@layer_name = 'wall'",
    )
    first, second = done.map.obstacles
    assert (first.semantics, first.height[0], first.outdoor[0]) == ("house,1", 5.0, False)
    assert (second.semantics, second.height[0], second.outdoor[0]) == ("wall,brick", 2.5, True)


def test_an_estimated_height_is_marked_in_the_map_and_said_once_for_the_layer(export, make_layer):
    layer = make_layer(features=[(WALL, 1.5), ("LineString(0 8, 50 8)", None)])
    done = export(layer, CENTER="20,20", DEFAULT_HEIGHT=2.2)
    known, estimated = done.map.obstacles
    assert (known.ext, estimated.ext) == ({"src": "walls:1"}, {"src": "walls:2", "h": "est"})
    assert estimated.height.tolist() == [2.2]
    assert done.warnings == ["Layer walls: 1 height is not known and estimated as 2.2 m (feature 2)"]


def test_strict_writes_what_fig_2_has_and_nothing_else(export, wall):
    done = export(wall, CENTER="20,20", WIDTH=20, HEIGHT=40, STRICT=True)
    assert done.text == "border;\n10;40;\n30;0;\n#\nobstacle;\n1;2;1;wall;\n#\n10;5;\n30;5;\n1.5;1;;\n#\n"


@pytest.mark.parametrize("strict", [False, True])
def test_binary_holds_the_very_text(export, house, strict):
    parameters = {"CENTER": "20,20", "STRICT": strict}
    text = export(house, FORMAT="text", **parameters).text
    done = export(house, FORMAT="binary", **parameters)
    assert done.file.read_bytes().startswith(b"RMAP")
    assert done.text == text
    assert done.results["BYTES"] == done.file.stat().st_size
    assert f"{done.results['BYTES']} bytes in binary" in done.log


def test_local_layers_need_no_crs_at_all(export, make_layer):
    done = export(make_layer(crs="", features=[(WALL, 1.0)]), LOCAL=True, CENTER="20,20")
    assert lines(done.map.obstacles[0]) == [(0, 5, 50, 5)]
    assert done.map.meta == {}


def test_a_broken_feature_is_a_warning_with_layer_and_id_and_the_rest_is_exported(export, make_layer):
    bow = "Polygon((0 0, 10 10, 10 0, 0 10, 0 0))"
    flat = "Polygon((1 1, 2 2, 1 1))"
    layer = make_layer("houses", "Polygon", features=[(bow, 1.0), (flat, 1.0), (None, 1.0), (SQUARE, 1.0)])
    done = export(layer, CENTER="10,10")
    assert {obstacle.ext["src"] for obstacle in done.map.obstacles} == {"houses:1", "houses:4"}
    assert [warning.split(":")[0] for warning in done.warnings] == [
        "Layer houses, feature 3",
        "Layer houses, feature 1",
        "Layer houses, feature 2",
    ]
    assert done.results["WARNING_COUNT"] == 3


def test_a_window_with_nothing_in_it_is_a_map_and_a_warning(export, house, make_layer):
    far = "Polygon((60 60, 70 60, 70 70, 60 70, 60 60))"
    done = export(
        house, make_layer("far", "Polygon", features=[(far, 4.0)]), CENTER="40,40", WIDTH=4, HEIGHT=4
    )
    assert done.map.obstacles == ()
    assert done.warnings == ["There is no obstacle in the window: check its place and the site CRS."]
    done = export(house, CENTER="5000,5000")
    assert done.map.obstacles == ()
    (warning,) = done.warnings
    assert "no layer reaches it: the layers lie from (10, 10) to (20, 20) in the site frame" in warning


def test_the_toolbox_finds_help_and_icon(provider):
    algorithm = provider.algorithm("exportrobotmap")
    assert not algorithm.icon().isNull()
    assert "site frame" in algorithm.shortHelpString()
    assert "\n" not in algorithm.shortHelpString(), "QGIS would end a paragraph at each line break"
    assert algorithm.shortDescription()
    described = {definition.name() for definition in algorithm.outputDefinitions()}
    assert described == {
        *("OUTPUT", "OBSTACLE_COUNT", "SEGMENT_COUNT"),
        *("BYTES", "BYTES_PER_M2", "WARNING_COUNT"),
    }


def test_a_profile_says_what_a_layer_is_and_wins_over_what_it_keeps(export, make_layer, tmp_path):
    wall = make_layer("old wall", features=[("LineString(0 5, 50 5)", 1.5)])
    wall.setCustomProperty("fleet/height", "9")
    profile = tmp_path / "mine.toml"
    profile.write_text(
        '[[layers]]\nnames = ["*wall"]\nrole = "obstacle"\n'
        "height = '\"height\" * 2'\nsemantics = \"'wall'\"\n"
    )
    (obstacle,) = export(wall, CENTER="0,0", PROFILE=str(profile)).map.obstacles
    assert (obstacle.semantics, obstacle.height.tolist()) == ("wall", [3.0])
    assert export(wall, CENTER="0,0").map.obstacles[0].height.tolist() == [9.0]


def test_a_profile_that_knows_none_of_the_layers_says_what_it_looks_for(export, house, wall, tmp_path):
    profile = tmp_path / "mine.toml"
    profile.write_text(
        'name = "Mine"\n[[layers]]\nnames = ["roof*", "wall"]\nfields = ["h"]\nrole = "obstacle"\n'
    )
    assert export(house, CENTER="0,0", PROFILE=str(profile)).warnings == [
        "Mine knows none of these layers. It looks for layers that are named, in their source or in the "
        "project: roof*, wall with h."
    ]
    profile.write_text('[[layers]]\nnames = ["wall"]\nrole = "obstacle"\n')
    assert export(house, wall, CENTER="0,0", PROFILE=str(profile)).warnings == []


def test_a_broken_profile_stops_the_export(export, make_layer, tmp_path):
    profile = tmp_path / "mine.toml"
    profile.write_text('[[layers]]\nnames = ["wall"]\nrole = "obstacel"\n')
    with pytest.raises(QgsProcessingException, match=r"mine\.toml: layers\[0\]\.role is 'obstacel'"):
        export(make_layer("wall"), CENTER="0,0", PROFILE=str(profile))


def test_without_layers_those_of_the_project_with_a_role_of_obstacles_are_exported(export, wall, make_layer):
    layer, other = wall, make_layer("trees", "LineString", features=[("LineString(0 0, 5 0)",)])
    set_role(layer, "obstacle")
    project = QgsProject()
    project.setCrs(layer.crs())
    project.addMapLayers([layer.clone(), other])
    done = export(project=project, OBSTACLES=None, CENTER="0,0", WIDTH=100, HEIGHT=100)
    assert len(done.map.obstacles) == 1
    empty = QgsProject()
    empty.setCrs(layer.crs())
    with pytest.raises(QgsProcessingException, match="no layer of the project has a role of obstacles"):
        export(project=empty, OBSTACLES=None, CENTER="0,0", WIDTH=100, HEIGHT=100)


AROUND = "A whole map lies inside of {} and has no wall of it: maps hold walls alone"
PARK = "Polygon((-90 -90, 90 -90, 90 90, -90 90, -90 -90)"


@pytest.mark.parametrize("with_another", [False, True], ids=["alone", "with_another"])
def test_what_the_whole_window_lies_in_is_named(export, make_layer, house, with_another):
    park = make_layer("park", "Polygon", features=[(f"{PARK})", 4.0)])
    done = export(park, *([house] if with_another else []), EXTENT="-20,50,-20,50 [EPSG:32633]")
    assert len(done.map.obstacles) == with_another
    assert len(done.warnings) == done.results["WARNING_COUNT"] == 1
    assert done.warnings[0].startswith(AROUND.format("park:1"))


@pytest.mark.parametrize(
    "hole",
    ["(-50 -50, 60 -50, 60 60, -50 60, -50 -50)", "(0 0, 9 0, 9 9, 0 9, 0 0)"],
    ids=["window_in_a_courtyard", "courtyard_in_the_window"],
)
def test_nothing_is_said_where_a_courtyard_is_around_the_window_or_in_it(export, make_layer, house, hole):
    park = make_layer("park", "Polygon", features=[(f"{PARK}, {hole})", 4.0)])
    done = export(park, house, EXTENT="-20,50,-20,50 [EPSG:32633]")
    assert done.warnings == []


OFF = "Layer old: its features may lie metres off on the site. They come from EPSG:4237 (HD72) to EPSG:27700"


def test_a_layer_that_no_exact_transformation_brings_to_the_site_is_named(export, make_layer):
    old = make_layer("old", crs="EPSG:4237", features=[("LineString(-1 52, -1.0001 52)", 2.0)])
    exact = make_layer(
        "exact", crs="EPSG:27700", features=[("LineString(468000 230000, 468010 230000)", 2.0)]
    )
    done = export(old, exact, SITE_CRS="EPSG:27700", CENTER="-1,52 [EPSG:4237]", WIDTH=90, HEIGHT=90)
    (warning,) = done.warnings
    assert warning.startswith(OFF) and "Ballpark" in warning and "Choose another transformation" in warning


def test_nothing_is_said_of_a_transformation_that_is_exact(export, make_layer):
    layers = [make_layer(crs, crs=crs, features=[("LineString(15 46, 15.0001 46)", 1.0)]) for crs in EXACT]
    done = export(*layers, CENTER="15,46 [EPSG:4326]", SITE_CRS="EPSG:32633", WIDTH=20, HEIGHT=20)
    assert (len(done.map.obstacles), done.warnings) == (2, [])


EXACT = ("EPSG:4326", "EPSG:4258")

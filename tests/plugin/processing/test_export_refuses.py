"""What ``fleet:exportrobotmap`` does not accept, what it says then, and that it harms no file."""

from __future__ import annotations

import pytest
from osgeo import ogr, osr
from qgis.core import QgsCoordinateReferenceSystem, QgsProcessingException, QgsProject, QgsVectorLayer

WALL = "LineString(0 5, 50 5)"


@pytest.fixture
def wall(make_layer):
    return make_layer("wall", features=[(WALL, 1.5)])


@pytest.fixture
def refused(export, tmp_path):
    """Run an export that must fail, and return what it said; an older map must stay as it was."""
    older = tmp_path / "map.txt"

    def run(*layers, **parameters) -> str:
        older.write_text("an older map")
        with pytest.raises(QgsProcessingException) as error:
            export(*layers, **parameters)
        assert older.read_text() == "an older map"
        assert [file.name for file in tmp_path.iterdir() if file.name.startswith(".")] == []
        return str(error.value)

    return run


def test_a_window_must_be_chosen_once(refused, wall):
    assert "Neither CENTER nor EXTENT is given: give the centre" in refused(wall)
    assert "Both CENTER and EXTENT are given" in refused(wall, CENTER="0,0", EXTENT="0,1,0,1")


@pytest.mark.parametrize(("side", "name"), [("WIDTH", "width"), ("HEIGHT", "height")])
@pytest.mark.parametrize("value", [0, -5])
def test_an_empty_window_is_refused(refused, wall, side, name, value):
    said = refused(wall, CENTER="0,0", **{side: value})
    assert f"window: {name} is {value} m, so it encloses nothing; give" in said


@pytest.mark.parametrize("value", [float("nan"), float("inf"), "wide"])
def test_a_window_that_is_no_number_is_refused(refused, wall, value):
    said = refused(wall, CENTER="0,0", WIDTH=value)
    assert f"WIDTH is {value}: give a finite number of metres" in said


def test_an_empty_extent_is_refused(refused, wall):
    assert "encloses nothing" in refused(wall, EXTENT="5,5,0,10")


def test_web_mercator_and_degrees_are_refused_as_a_site_crs(refused, wall):
    said = refused(wall, CENTER="0,0", SITE_CRS="EPSG:3857")
    assert "EPSG:3857" in said and "its metres are not metres" in said and "local UTM zone" in said
    assert "not metres on a plane" in refused(wall, CENTER="0,0", SITE_CRS="EPSG:4326")


def test_web_mercator_is_refused_when_it_is_only_the_projects(refused, wall):
    project = QgsProject()
    project.setCrs(QgsCoordinateReferenceSystem("EPSG:3857"))
    assert "EPSG:3857" in refused(wall, CENTER="0,0", project=project)


def test_an_unknown_site_crs_is_refused(refused, wall):
    assert "EPSG:999999" in refused(wall, CENTER="0,0", SITE_CRS="EPSG:999999")


def test_a_layer_without_a_crs_is_refused_by_name(refused, wall, make_layer):
    said = refused(wall, make_layer("scan", crs="", features=[(WALL, 1.0)]), CENTER="0,0")
    assert "The layer scan has no CRS" in said and "LOCAL=true" in said


@pytest.mark.parametrize("name", ["scan.gpkg", "scan.geojson", "scan.shp"])
@pytest.mark.parametrize("is_there", [False, True])
def test_a_layer_whose_file_is_gone_since_it_was_opened_is_refused_by_name(
    refused, wall, make_layer, save_layer, tmp_path, name, is_there
):
    layer = save_layer(make_layer("scan", features=[(WALL, 1.0)]), name)
    for file in tmp_path.glob("scan.*"):
        file.unlink()
    if is_there:
        (tmp_path / name).write_bytes(b"half of it")
    # QGIS itself sees nothing wrong with it.
    assert layer.isValid() and layer.featureCount() == 1 and list(layer.getFeatures()) == []
    # Whether anything of it would be in the window or not.
    for center in ("0,0", "5000,5000"):
        said = refused(wall, layer, CENTER=center)
        assert "The layer scan cannot be read any more: QGIS gets none of its features" in said, said


@pytest.mark.parametrize("name", ["scan.gpkg", "scan.fgb"])
def test_a_layer_that_is_damaged_in_the_middle_is_no_map_of_half_of_it(
    refused, wall, make_layer, save_layer, tmp_path, name
):
    walls = [(f"LineString({x} 0, {x} 5)", 1.0) for x in range(5000)]
    layer = save_layer(make_layer("scan", features=walls), name)
    file = tmp_path / name
    source, content = layer.source(), bytearray(file.read_bytes())
    del layer
    if file.suffix == ".gpkg":
        middle = len(content) // 2 // 4096 * 4096
        content[middle : middle + 4 * 4096] = b"\xa5" * 4 * 4096
    else:
        # As it is while it is being copied.
        del content[len(content) * 2 // 3 :]
    file.write_bytes(content)
    layer = QgsVectorLayer(source, "scan", "ogr")
    assert layer.isValid() and layer.featureCount() == 5000 > sum(1 for _ in layer.getFeatures())
    said = refused(wall, layer, CENTER="2500,0", WIDTH=6000, HEIGHT=20)
    assert "The layer scan cannot be read to its end (" in said, said


def test_a_layer_that_another_program_emptied_is_none_that_is_gone(export, make_layer, save_layer, wall):
    layer = save_layer(make_layer("scan", features=[(WALL, 1.0)]), "scan.gpkg")
    other = QgsVectorLayer(layer.source(), "other", "ogr")
    assert other.dataProvider().truncate()
    assert layer.featureCount() == 1 and list(layer.getFeatures()) == []
    assert len(export(wall, layer, CENTER="0,0").map.obstacles) == 1


def test_a_layer_that_cannot_be_opened_is_refused_by_name(refused, wall, tmp_path):
    missing = f"{tmp_path / 'gone.gpkg'}|layername=walls"
    assert f"OBSTACLES: the layer {missing} cannot be opened" in refused(wall, missing, CENTER="0,0")


def test_points_are_refused_by_name(refused, make_layer):
    trees = make_layer("trees", "Point", features=[("Point(1 1)", 1.0)])
    assert "The layer trees holds points" in refused(trees, CENTER="0,0")


def test_an_expression_that_is_none_is_refused(refused, wall):
    said = refused(wall, CENTER="0,0", SEMANTICS_EXPRESSION="'wall")
    assert "semantics expression" in said and "for the layer wall is not one" in said


def test_a_negative_default_height_is_refused(refused, wall):
    assert "DEFAULT_HEIGHT is -1.0" in refused(wall, CENTER="0,0", DEFAULT_HEIGHT=-1)


def test_a_folder_that_is_not_there_is_named(export, wall, tmp_path):
    target = tmp_path / "file" / "map.txt"
    (tmp_path / "file").write_text("no folder")
    with pytest.raises(QgsProcessingException, match=f"cannot be written to {target}: there is no folder"):
        export(wall, CENTER="0,0", OUTPUT=str(target))


def test_layers_in_different_crss_are_not_mixed(refused, wall, make_layer):
    other = make_layer("other", crs="EPSG:32634", features=[(WALL, 1.0)])
    said = refused(wall, other, CENTER="0,0")
    assert "The layers are in different CRSs" in said and "EPSG:32634" in said and "give SITE_CRS" in said


def test_a_file_of_several_layers_needs_the_name_of_one(refused, export, tmp_path):
    """QGIS takes the first, and a map without the walls would tell a robot that all is free there."""
    file = tmp_path / "campus.gpkg"
    source = ogr.GetDriverByName("GPKG").CreateDataSource(str(file))
    metres = osr.SpatialReference()
    metres.ImportFromEPSG(32633)
    for name in ("buildings", "walls"):
        source.CreateLayer(name, metres, ogr.wkbLineString)
    source.CreateLayer("notes", None, ogr.wkbNone)
    source = None
    said = refused(str(file), CENTER="0,0")
    assert f"OBSTACLES: the file {file} holds 2 layers (buildings, walls)" in said
    assert f"{file}|layername=buildings" in said
    assert export(f"{file}|layername=walls", CENTER="0,0").results["OBSTACLE_COUNT"] == 0


@pytest.mark.parametrize(
    ("name", "value", "wanted"),
    [
        ("STRICT", "no", "true or false"),
        ("ROTATION", "north", "a number"),
        ("ROTATION", "1_0", "a number"),
        ("PLANE_LOW", "nan", "a number"),
        ("FORMAT", "xml", "one of text, binary, compact"),
        ("CENTER", "here", "'x,y', or"),
        ("ORIGIN", "1", "'x,y', or"),
    ],
)
def test_a_value_that_qgis_would_take_for_another_is_refused(refused, wall, name, value, wanted):
    said = refused(wall, **{"CENTER": "0,0", name: value})
    assert f"{name} is {value}: give {wanted}" in said


def test_an_extent_that_is_none_is_told_how_to_write(refused, wall):
    assert "EXTENT is here: give 'xmin,xmax,ymin,ymax'" in refused(wall, EXTENT="here")


def test_a_parameter_that_there_is_not_is_refused(refused, wall):
    said = refused(wall, CENTER="0,0", PLANE_HI=2)
    assert "There is no parameter PLANE_HI" in said and "PLANE_HIGH" in said


@pytest.mark.parametrize("value", ["true", "False", "1", "0", True, False])
def test_every_spelling_of_a_truth_that_qgis_understands_is_taken(export, wall, value):
    strict = export(wall, CENTER="0,0", STRICT=value).text.startswith("border;")
    assert strict is (str(value).lower() in ("true", "1"))


def test_the_file_of_an_obstacle_layer_is_never_the_output(refused, tmp_path):
    file = tmp_path / "walls.geojson"
    line = '{"type": "LineString", "coordinates": [[15, 46], [15.001, 46]]}'
    file.write_text(f'{{"type": "Feature", "properties": {{}}, "geometry": {line}}}')
    before = file.read_bytes()
    said = refused(str(file), CENTER="15,46", SITE_CRS="EPSG:32633", OUTPUT=str(file))
    assert "is the file of the layer walls: choose another one" in said
    assert file.read_bytes() == before


@pytest.mark.parametrize("percent", [1, 45, 90])
def test_a_cancelled_export_leaves_the_older_map_and_no_part_of_a_new_one(
    export, make_layer, cancels_at, tmp_path, percent
):
    layer = make_layer(features=[(WALL, 1.0)] * 200)
    (tmp_path / "map.txt").write_text("an older map")
    done = export(layer, CENTER="0,0", feedback=cancels_at(percent))
    assert "BYTES" not in done.results
    assert {file.name: file.read_text() for file in tmp_path.iterdir()} == {"map.txt": "an older map"}

"""``fleet:publishsite``: from layers with roles to what a gateway serves, and every way it is refused."""

from __future__ import annotations

import sqlite3
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from fleet_supervisor.plugin.layers.layer_source import obstacle_sources
from fleet_supervisor.plugin.layers.roles import LayerExpressions, LayerSetup, keep_setup
from fleet_supervisor.robot_bridge.core.errors import LayerError
from fleet_supervisor.robot_bridge.core.robotmap.text_format import write_text
from fleet_supervisor.robot_bridge.core.sites.site import read_site
from qgis.core import (
    QgsExpressionContext,
    QgsFeature,
    QgsProcessingContext,
    QgsProcessingException,
    QgsProject,
    QgsVectorLayer,
)

RING = "Polygon((0 0, 20 0, 20 10, 0 10, 0 0), (5 3, 9 3, 9 7, 5 7, 5 3))"
ROAD = "LineString(0 15, 50 15)"
AREA = "Polygon((40 20, 50 20, 50 30, 40 20))"


@dataclass(frozen=True)
class Published:
    """One finished publication: its outputs, its folder, and what it warned of."""

    results: dict
    folder: Path
    warnings: list[str]


@pytest.fixture
def publish(provider, tmp_path, cancels_at):
    """Run the algorithm by ``processing.run``, in an empty project unless given one."""
    import processing

    def run(feedback=None, project=None, **parameters) -> Published:
        listener = feedback or cancels_at(1000)
        context = QgsProcessingContext()
        context.setProject(project or QgsProject())
        folder = tmp_path / "site"
        everything = {"FOLDER": str(folder), "SITE_ID": "yard", "SITE_CRS": "EPSG:32633", **parameters}
        results = processing.run(
            "fleet:publishsite", everything, context=context, feedback=listener, is_child_algorithm=True
        )
        return Published(results, Path(everything["FOLDER"]), listener.warnings)

    return run


@pytest.fixture
def yard(make_layer):
    """The layers of a small site, by the parameters that take them."""
    return {
        "OBSTACLES": [make_layer("house", "Polygon", features=[(RING, 9.5)])],
        "ROAD_CENTRELINES": [
            make_layer(
                "roads",
                fields="&field=width_m:double&field=surface:string",
                features=[(ROAD, 3.5, "asphalt"), (None, 1, ""), ("LineString(0 5, 9 5)", -1.0, "mud")],
            )
        ],
        "ROAD_SURFACES": [
            make_layer("ground", "Polygon", fields="&field=surface:string", features=[(RING, "asphalt")])
        ],
        "KEEPOUTS": [make_layer("ponds", "Polygon", fields="&field=name:string", features=[(AREA, "Pond")])],
    }


def content_of(folder):
    return {file.name: file.read_bytes() for file in folder.iterdir()} if folder.exists() else {}


@pytest.fixture
def refused(publish, tmp_path):
    """Run a publication that must fail, and return what it said; the folder must stay as it was."""

    def run(**parameters) -> str:
        before = content_of(tmp_path / "site")
        with pytest.raises(QgsProcessingException) as error:
            publish(**parameters)
        assert content_of(tmp_path / "site") == before
        return str(error.value)

    return run


def test_surfaces_are_published_with_their_names_and_where_they_come_from(publish, yard, make_layer):
    fields = "&field=surface:string&field=name:string&field=origin:string"
    features = [(AREA, "asphalt", "Yard", "generated"), (RING, "sand", None, None)]
    yard["ROAD_SURFACES"] = [make_layer("ground", "Polygon", fields=fields, features=features)]
    site = read_site(publish(**yard).folder)
    told = [(one.label, one.name, one.origin) for one in site.surfaces]
    assert told == [("asphalt", "Yard", "generated"), ("sand", "", "drawn")]


@pytest.mark.parametrize("role", ["OBSTACLES", "ROAD_CENTRELINES", "ROAD_SURFACES", "KEEPOUTS"])
def test_a_site_is_not_published_without_a_layer_whose_file_is_gone_since_it_was_opened(
    publish, refused, yard, save_layer, tmp_path, role
):
    publish(**yard)
    (layer,) = yard[role]
    yard[role] = [save_layer(layer, f"{layer.name()}.gpkg")]
    (tmp_path / f"{layer.name()}.gpkg").unlink()
    said = refused(**yard)
    assert f"The layer {layer.name()} cannot be read any more" in said


def test_what_a_gateway_maps_is_what_it_would_read_of_the_layers(publish, yard):
    folder = publish(**yard, ORIGIN="-10,-20", ROTATION=33).folder
    mapped = read_site(folder)
    (Path(folder) / "site.cache").unlink()
    read = read_site(folder)
    assert mapped.cache is not None and read.cache is None
    np.testing.assert_allclose(mapped.outlines.coordinates, read.outlines.coordinates, rtol=0, atol=1e-9)
    for name in ("offsets", "shape_type", "courtyard", "height", "outdoor"):
        np.testing.assert_array_equal(getattr(mapped.outlines, name), getattr(read.outlines, name), name)
    for name in ("semantics", "source"):
        assert getattr(mapped.outlines, name) == getattr(read.outlines, name)
    assert write_text(mapped.whole_map()) == write_text(read.whole_map())


def test_what_is_published_is_what_the_layers_hold(publish, yard):
    done = publish(**yard, ORIGIN="-10,-20", ROTATION=90, REACHED_TOLERANCE=0.3, STALE_AFTER=2, LOST_AFTER=5)
    site = read_site(done.folder)
    assert (site.id, site.name, site.version) == ("yard", "yard", 1)
    assert site.frame.origin == (-10.0, -20.0) and site.settings.rotation_deg == 90.0
    assert site.settings.reached_tolerance_m == 0.3
    assert (site.settings.liveness.stale_after_s, site.settings.liveness.lost_after_s) == (2.0, 5.0)
    assert site.outlines.courtyard.tolist() == [False, True]
    assert site.outlines.height.tolist() == [9.5, 9.5]
    # (0, 0) of the CRS is 10 m east and 20 m north of the origin; the site's x axis points north.
    np.testing.assert_allclose(site.outlines.coordinates[0], [20.0, -10.0], atol=1e-6)
    assert [(line.width_m, line.surface) for line in site.centrelines] == [(3.5, "asphalt"), (3.5, "mud")]
    assert [(area.label, len(area.rings)) for area in site.surfaces] == [("asphalt", 2)]
    assert [area.label for area in site.keepouts] == ["Pond"]
    assert all(site.contains(*point) for point in site.outlines.coordinates)
    assert {key: done.results[key] for key in ("ID", "VERSION", "OBSTACLE_COUNT", "CENTRELINE_COUNT")} == {
        "ID": "yard",
        "VERSION": 1,
        "OBSTACLE_COUNT": 2,
        "CENTRELINE_COUNT": 2,
    }
    assert done.warnings == [
        "Layer roads, feature 2: has no geometry; it is left out",
        "Layer roads, feature 3: its width -1.0 is not a number of metres above 0; the default is used",
        "Layer roads: none of its fields direction, oneway, one_way and other_tags is there to tell one-way "
        "roads; all are taken as driven both ways",
        "Layer roads: the width of 1 of its roads is not known and taken as 3.5 m (feature 3 is the first)",
    ]


def test_a_site_without_obstacles_has_a_layer_that_can_be_given_as_obstacles(publish, yard):
    del yard["OBSTACLES"]
    layer = QgsVectorLayer(f"{publish(**yard).folder}/site.gpkg|layername=obstacles", "obstacles", "ogr")
    assert (layer.featureCount(), layer.crs().authid()) == (0, "EPSG:32633")
    obstacle_sources([layer], LayerExpressions(), QgsExpressionContext())


def test_a_published_layer_and_its_index_are_changed_together(publish, yard, make_layer):
    yard["OBSTACLES"] = [make_layer("house", "Polygon", features=[(RING, 9.5), (AREA, 3.0)])]
    folder = publish(**yard).folder
    layer = QgsVectorLayer(f"{folder}/site.gpkg|layername=obstacles", "obstacles", "ogr")
    assert layer.dataProvider().deleteFeatures([1])
    again = QgsFeature(layer.fields())
    again.setGeometry(layer.getFeature(2).geometry())
    assert layer.dataProvider().addFeatures([again])[0]
    assert layer.featureCount() == 2
    with closing(sqlite3.connect(f"{folder}/site.gpkg")) as database:
        boxes = database.execute("SELECT id, minx, maxy FROM rtree_obstacles_geom ORDER BY id").fetchall()
    box = layer.getFeature(2).geometry().boundingBox()
    assert boxes == [(id, pytest.approx(box.xMinimum()), pytest.approx(box.yMaximum())) for id in (2, 3)]


def test_layers_come_from_the_project_by_their_roles(publish, make_layer):
    project = QgsProject()
    house = make_layer("house", "Polygon", features=[(RING, 9.5)])
    stairs = make_layer("up", "MultiLineString", features=[("MultiLineString((0 0, 4 0), (0 1, 4 1))", 0.15)])
    other = make_layer("other", features=[(ROAD, 1.0)])
    project.addMapLayers([house, stairs, other])
    keep_setup(house, LayerSetup("obstacle", LayerExpressions(height="4", semantics="'shed'")))
    keep_setup(stairs, LayerSetup("stairs"))
    site = read_site(publish(project=project).folder)
    assert list(site.outlines.semantics) == ["shed", "shed", "up"]
    assert site.outlines.height.tolist() == [4.0, 4.0, 0.15]
    assert site.outlines.shape_type.tolist() == [1, 1, 5]


def test_feet_filters_and_templates_of_the_layers_are_published(publish, make_layer):
    project = QgsProject()
    fields = "&field=height:double&field=foot:double&field=kind:string"
    signs = make_layer("signs", fields=fields, features=[(ROAD, 1.0, 2.2, "sign"), (ROAD, 1.0, 0.0, "plan")])
    things = make_layer("things", "Point", fields, [("Point(5 5)", 1.0, 0.0, "bench")])
    project.addMapLayers([signs, things])
    keep_setup(signs, LayerSetup("obstacle", LayerExpressions(base='"foot"', filter="\"kind\" = 'sign'")))
    keep_setup(things, LayerSetup("furniture", LayerExpressions(template='"kind"', rotation="90")))
    site = read_site(publish(project=project).folder)
    assert site.outlines.source == ["signs:1", "things:1"]
    assert site.outlines.base.tolist() == [2.2, 0.0]
    assert np.ptp(site.outlines.points(1), axis=0) == pytest.approx([0.6, 1.8])


def test_the_version_goes_up_by_itself(publish, yard):
    assert [publish(**yard).results["VERSION"] for _ in range(3)] == [1, 2, 3]


def test_publishing_again_keeps_what_the_operator_wrote_into_the_settings(publish, yard):
    file = publish(**yard, STALE_AFTER=2).folder / "site.toml"
    text = file.read_text().replace("lost_after_s = 10.0", "lost_after_s = 30.0 # ours")
    file.write_text(
        text.replace("tolerance_m = 0.2", "tolerance_m = 0.5") + "[trajectories]\nkeep_days = 7\n"
    )
    settings = read_site(publish(**yard, STALE_AFTER=4).folder).settings
    assert settings.version == 2 and settings.reached_tolerance_m == 0.5
    assert (settings.liveness.stale_after_s, settings.liveness.lost_after_s) == (4.0, 30.0)
    assert settings.trajectories.keep_days == 7.0


def test_a_limit_in_the_settings_that_is_no_number_is_named(publish, refused, yard):
    file = publish(**yard).folder / "site.toml"
    file.write_text(file.read_text().replace("lost_after_s = 10.0", "lost_after_s = 'long'"))
    assert f"{file}: liveness.lost_after_s = 'long' is no number: correct it there" in refused(**yard)


def test_a_publication_cut_off_between_its_files_does_not_use_a_version_twice(publish, yard, tmp_path):
    folder = publish(**yard).folder
    old = (folder / "site.toml").read_bytes()
    publish(**yard)
    (folder / "site.toml").write_bytes(old)
    with pytest.raises(LayerError, match="publishing was interrupted"):
        read_site(folder)
    assert publish(**yard).results["VERSION"] == 3
    assert read_site(folder).version == 3


def test_another_site_is_replaced_only_when_told(publish, refused, yard):
    folder = publish(**yard).folder
    publish(**yard)
    said = refused(**yard, SITE_ID="field")
    assert f"{folder} holds version 2 of another site, yard" in said and "REPLACE=true" in said
    assert publish(**yard, SITE_ID="field", REPLACE=True).results["VERSION"] == 1
    assert read_site(folder).id == "field"


def test_files_of_that_name_that_are_no_publication_stay(refused, publish, yard, tmp_path):
    (tmp_path / "site").mkdir()
    (tmp_path / "site" / "site.toml").write_text("something else")
    assert "site.toml is there and is no part of a published site" in refused(**yard)
    assert publish(**yard, REPLACE=True).results["VERSION"] == 1


@pytest.mark.parametrize("percent", [1, 60])
def test_a_cancel_leaves_the_publication_that_was_there(publish, yard, make_layer, cancels_at, percent):
    folder = publish(**yard).folder
    before = content_of(folder)
    many = make_layer("many", features=[(f"LineString({k} 0, {k} 1)", 1.0) for k in range(300)])
    assert publish(**{**yard, "OBSTACLES": [many]}, feedback=cancels_at(percent)).results == {}
    assert content_of(folder) == before


def test_a_second_file_that_cannot_be_replaced_gives_back_the_first(publish, yard, tmp_path):
    folder = publish(**yard).folder
    layers = (folder / "site.gpkg").read_bytes()
    # A folder of that name cannot be replaced by a file.
    (folder / "site.toml").unlink()
    (folder / "site.toml" / "in the way").mkdir(parents=True)
    with pytest.raises(QgsProcessingException, match="The site cannot be published in"):
        publish(**yard)
    assert sorted(entry.name for entry in folder.iterdir()) == ["site.cache", "site.gpkg", "site.toml"]
    assert (folder / "site.gpkg").read_bytes() == layers


@pytest.mark.parametrize("folder", ["file", "file/site", "file/site/today"])
def test_a_file_in_place_of_the_folder_is_named_with_what_to_do(refused, yard, tmp_path, folder):
    (tmp_path / "file").write_text("in the way")
    said = refused(**yard, FOLDER=str(tmp_path / folder))
    assert (
        f"cannot be published in {tmp_path / folder}: {tmp_path / 'file'} is a file. Choose a folder" in said
    )
    assert (tmp_path / "file").read_text() == "in the way"


@pytest.mark.parametrize("name", ["OBSTACLES", "ROAD_CENTRELINES", "ROAD_SURFACES", "KEEPOUTS"])
def test_a_wrong_filter_is_named_with_its_layer(refused, yard, name):
    yard[name][0].setCustomProperty("fleet/filter", "1 +")
    assert f"The filter expression '1 +' for the layer {yard[name][0].name()} is not one" in refused(**yard)


def test_obstacles_beyond_the_bounds_are_published_as_far_as_a_robot_sees(publish, make_layer):
    walls = [("LineString(50 0, 50 9)", 1), ("LineString(199 0, 199 9)", 1), ("LineString(201 0, 201 9)", 1)]
    done = publish(OBSTACLES=[make_layer(features=walls)], BOUNDS="0,100,0,50")
    site = read_site(done.folder)
    assert tuple(site.bounds) == (0.0, 0.0, 100.0, 50.0)
    assert list(site.outlines.source) == ["walls:1", "walls:2"]


@pytest.mark.parametrize(
    ("parameters", "said"),
    [
        ({"SITE_ID": ""}, "SITE_ID is empty and the project has no variable fleet_site"),
        ({"SITE_ID": "a b"}, "site.id = 'a b' is not an id"),
        ({"SITE_CRS": "EPSG:3857"}, "its metres are not metres"),
        ({"STALE_AFTER": 20}, "a robot turns stale before it is lost"),
        ({"REACHED_TOLERANCE": 0}, "reached_tolerance_m = 0.0 is not above 0"),
        ({"DEFAULT_WIDTH": 0}, "DEFAULT_WIDTH is 0.0"),
        ({"BOUNDS": "5,5,0,10"}, "has no area"),
        ({"PROFILE": "no_such"}, "The profile no_such is not there"),
        ({"OBSTACLES": ["/no/such.gpkg"]}, "OBSTACLES: the layer /no/such.gpkg cannot be opened"),
    ],
)
def test_a_wrong_parameter_is_named(refused, yard, parameters, said):
    assert said in refused(**{**yard, **parameters})


def test_nothing_to_publish_is_said_before_and_after_reading(refused, make_layer):
    assert "no layer of the project has a role" in refused()
    assert "hold nothing that can be read" in refused(OBSTACLES=[make_layer()])


def test_a_local_crs_is_refused_with_the_way_out(refused, publish, make_layer):
    local = make_layer(crs='wkt:LOCAL_CS["yard",UNIT["metre",1]]', features=[("LineString(0 0, 5 0)", 1.0)])
    said = refused(OBSTACLES=[local], SITE_CRS=None)
    assert "has no code that a gateway knows it by" in said and "LOCAL=true" in said
    site = read_site(publish(OBSTACLES=[local], LOCAL=True, ORIGIN="400000,4500000").folder)
    np.testing.assert_allclose(site.outlines.coordinates, [[0, 0], [5, 0]], atol=1e-6)


def test_what_a_robot_is_told_of_estimated_heights_and_ramps_outlives_publishing(publish, make_layer):
    slope = "PolygonZ((30 0 5, 40 0 5, 40 2 6, 30 2 6, 30 0 5))"
    ramp = make_layer("ramp", "PolygonZ", features=[(slope,)])
    keep_setup(ramp, LayerSetup("ramp"))
    house = make_layer("house", "Polygon", features=[(RING,)])
    wall = make_layer("wall", fields="&field=height:double", features=[("LineString(0 20, 9 20)", 2.0)])
    site = read_site(publish(OBSTACLES=[house, wall, ramp]).folder)
    text = write_text(site.map_around(20.0, 10.0, 3600.0))
    assert text.count("src=house:1,h=est;") == 2
    assert ";wall;src=wall:1;" in text
    assert ";ramp;src=ramp:1,n=0,-0.4472,0.8944;" in text


def test_helsinki_is_published_by_its_profile_with_every_loss_named(publish, data):
    helsinki = data / "osm" / "helsinki_centre_utm35n.gpkg"
    done = publish(
        OBSTACLES=[f"{helsinki}|layername={name}" for name in ("buildings", "barriers")],
        ROAD_CENTRELINES=[f"{helsinki}|layername=roads"],
        PROFILE="openstreetmap",
        SITE_CRS="EPSG:32635",
        ORIGIN="385700,6671500",
    )
    site = read_site(done.folder)
    assert len(site.centrelines) == 2384
    kinds = {label.partition(",")[0] for label in site.outlines.semantics}
    assert {"building", "retaining_wall", "bollard"} <= kinds
    assert any(warning.startswith("Layer buildings, feature ") for warning in done.warnings)
    assert any("heights are not known and estimated as 3 m" in warning for warning in done.warnings)
    estimated = [row.height for row in site.outlines.rows() if row.ext == {"h": "est"}]
    assert len(estimated) > 100 and {3.0, 1.5, 2.0, 12.0, 18.0} <= set(estimated)


def test_the_papers_campus_in_local_metres_is_published_by_its_profile(publish, data):
    campus = data / "upc_campus_nord" / "upc_campus_nord_local.gpkg"
    layers = ("buildings", "walls", "step_edges", "furniture")
    done = publish(
        OBSTACLES=[f"{campus}|layername={name}" for name in layers],
        PROFILE="upc_campus_nord",
        SITE_CRS="EPSG:25831",
        ORIGIN="426000,4582000",
        LOCAL=True,
    )
    site = read_site(done.folder)
    # The model's own metres are the site frame's, whatever place it is published at.
    np.testing.assert_allclose(tuple(site.bounds), (-40, -1, 101, 124))
    labels = [label.partition(",")[0] for label in site.outlines.semantics]
    assert (labels.count("building"), labels.count("wall"), labels.count("stairs")) == (12, 1618, 503)
    furniture = set(labels) - {"building", "wall", "stairs"}
    assert "litter_bin" in furniture and len(furniture) > 4
    pier = (4.50, 12.20)  # of the paper's Fig. 2
    assert np.hypot(*(site.outlines.coordinates - pier).T).min() < 0.05


@pytest.mark.parametrize(("origin", "warned"), [(None, True), ("640000,5190000", False)])
def test_an_origin_of_nought_far_from_the_site_is_warned_of(publish, make_layer, origin, warned):
    far = "Polygon((640000 5190000, 640020 5190000, 640020 5190020, 640000 5190000))"
    layers = [make_layer("house", "Polygon", features=[(far, 9.5)])]
    done = publish(OBSTACLES=layers, **({} if origin is None else {"ORIGIN": origin}))
    told = [
        one for one in done.warnings if "The origin of the site frame is 0,0 of EPSG:32633, 5229 km" in one
    ]
    assert bool(told) is warned


def test_a_keepout_of_parts_that_overlap_has_no_hole_where_they_do(publish, yard, make_layer):
    parts = "((10 10, 20 10, 20 20, 10 20, 10 10)), ((15 15, 25 15, 25 25, 15 25, 15 15))"
    ponds = make_layer("ponds", "MultiPolygon", features=[(f"MultiPolygon({parts})", 1.0)])
    done = publish(**{**yard, "KEEPOUTS": [ponds]})
    keepouts = read_site(done.folder).fences.keepouts
    assert keepouts.near(np.array([(17.0, 17.0), (12.0, 22.0)]), 0.0).tolist() == [[0], [0]]


def test_a_keepout_that_no_exact_transformation_brings_to_the_site_is_named(publish, make_layer):
    area = "Polygon((-1 52, -1.001 52, -1.001 52.001, -1 52))"
    old = make_layer("old", "Polygon", crs="EPSG:4237", features=[(area, 1.0)])
    done = publish(KEEPOUTS=[old], SITE_CRS="EPSG:27700")
    assert any("Layer old: its features may lie metres off on the site." in text for text in done.warnings)

"""The sample project, opened and drawn by QGIS."""

import hashlib
import shutil

import numpy as np
import pytest
from qgis.core import QgsExpression, QgsMapLayer

EXPECTED = {
    "Buildings": "obstacle",
    "Walls": "obstacle",
    "Columns": "obstacle",
    "Litter bins": "furniture",
    "Benches": "furniture",
    "Stairs": "stairs",
    "Ramp": "ramp",
    "Road centrelines": "road_centreline",
    "Road surfaces": "road_surface",
    "Keepouts": "keepout",
    "Orthophoto": "orthophoto",
}


@pytest.fixture
def copy(sample_site, tmp_path):
    """A copy of the sample site elsewhere: its paths must be relative."""
    folder = tmp_path / "elsewhere"
    folder.mkdir()
    for name in ("sample_site.qgz", "sample_site.gpkg", "orthophoto.tif", "site.toml", "site.gpkg"):
        shutil.copy(sample_site / name, folder)
    return folder


def test_the_project_opens_without_a_complaint_wherever_it_lies(copy, opened):
    project, complaints = opened(copy / "sample_site.qgz")
    assert {layer.name(): layer.isValid() for layer in project.mapLayers().values()} == dict.fromkeys(
        EXPECTED, True
    )
    assert all(str(copy) in layer.source() for layer in project.mapLayers().values())
    assert complaints == []


def test_the_project_knows_its_site(copy, opened):
    project, _ = opened(copy / "sample_site.qgz")
    assert project.crs().authid() == "EPSG:32633"
    folder, found = project.readEntry("fleet", "site")
    assert found
    assert (copy / folder / "site.toml").is_file()
    variables = project.customVariables()
    assert (float(variables["fleet_origin_x"]), float(variables["fleet_origin_y"])) == (640420.0, 5193480.0)
    extent = project.viewSettings().defaultViewExtent()
    assert extent.contains(640420.0, 5193480.0)
    assert extent.contains(640620.0, 5193640.0)


def test_every_layer_carries_its_role(copy, opened):
    project, _ = opened(copy / "sample_site.qgz")
    roles = {layer.name(): layer.customProperty("fleet/role") for layer in project.mapLayers().values()}
    assert roles == EXPECTED


def test_the_expressions_of_obstacles_are_valid_and_name_fields_that_exist(copy, opened):
    project, _ = opened(copy / "sample_site.qgz")
    for layer in project.mapLayers().values():
        if layer.customProperty("fleet/role") not in ("obstacle", "furniture", "stairs", "ramp"):
            continue
        for key in ("fleet/height", "fleet/semantics", "fleet/outdoor"):
            expression = QgsExpression(layer.customProperty(key))
            assert not expression.hasParserError(), (layer.name(), key)
            assert expression.referencedColumns() <= set(layer.fields().names()), (layer.name(), key)


def test_surfaces_lie_over_the_photo_and_obstacles_over_the_roads(copy, opened):
    project, _ = opened(copy / "sample_site.qgz")
    order = [layer.name() for layer in project.layerTreeRoot().layerOrder()]
    assert order[-1] == "Orthophoto"
    assert order.index("Buildings") < order.index("Road centrelines") < order.index("Road surfaces")
    assert [group.name() for group in project.layerTreeRoot().findGroups()] == [
        "Rules",
        "Obstacles",
        "Roads",
        "Background",
    ]


def test_the_project_is_drawn_with_every_layer_on_it(copy, opened, drawn):
    project, _ = opened(copy / "sample_site.qgz")
    layers = project.layerTreeRoot().layerOrder()
    whole = drawn(project)
    assert whole.std() > 30, "the picture is not blank"
    for layer in layers:
        without = drawn(project, [other for other in layers if other is not layer])
        assert np.abs(whole - without).max() > 30, f"{layer.name()} leaves no trace"


def test_opening_and_drawing_leaves_the_data_as_it_was(copy, opened, drawn):
    def digests():
        return {f.name: hashlib.sha256(f.read_bytes()).hexdigest() for f in copy.glob("*.gpkg")}

    before = digests()
    project, _ = opened(copy / "sample_site.qgz")
    drawn(project)
    project.clear()
    assert digests() == before


def test_styles_are_kept_for_other_sites(root, copy, opened):
    project, _ = opened(copy / "sample_site.qgz")
    (surfaces,) = project.mapLayersByName("Road surfaces")
    message, loaded = surfaces.loadNamedStyle(str(root / "resources" / "styles" / "road_surfaces.qml"))
    assert loaded, message
    assert {c.value() for c in surfaces.renderer().categories()} >= {
        "asphalt",
        "parking pavement",
        "slippery",
    }
    assert surfaces.customProperty("fleet/role") == "road_surface", "a style does not take the role away"
    assert surfaces.type() == QgsMapLayer.LayerType.VectorLayer


def test_the_sample_site_stays_small(sample_site):
    assert sum(file.stat().st_size for file in sample_site.rglob("*") if file.is_file()) < 6_000_000

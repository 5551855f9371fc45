"""A project that is saved while connected holds nothing that the desk fills, and all that the user made."""

from __future__ import annotations

import zipfile
from xml.etree import ElementTree

import pytest
from fleet_supervisor.plugin.layers.live_layers import MARK, LiveLayers
from qgis.core import QgsExpression, QgsProject, QgsSingleSymbolRenderer, QgsVectorLayer


@pytest.fixture
def saved(at_desk, tmp_path, wait, make_layer):
    """The project's file and its layers' ids: one of the user's, saved while robots are on the map."""
    wait(lambda: at_desk.view.layer.layer.featureCount() == 2, 3)
    project = QgsProject.instance()
    own = make_layer("walls")
    project.addMapLayer(own)
    path = tmp_path / "saved.qgz"
    assert project.write(str(path))
    return path, own, at_desk.view.layer.layer


def content(path):
    with zipfile.ZipFile(path) as archive:
        (name,) = [name for name in archive.namelist() if name.endswith(".qgs")]
        return ElementTree.fromstring(archive.read(name))


def test_the_file_has_no_live_layer_and_no_empty_group(saved):
    path, own, live = saved
    root = content(path)
    assert [one.findtext("id") for one in root.iter("maplayer")] == [own.id()]
    assert [one.get("id") for one in root.iter("layer-tree-layer")] == [own.id()]
    assert [group.get("name") for group in root.iter("layer-tree-group")] == [None]
    assert not [one for one in root.iter("layer-setting") if one.get("id") == live.id()]


def test_nobody_edits_what_the_desk_fills(at_desk, wait):
    layer = at_desk.view.layer.layer
    assert not layer.startEditing()
    wait(lambda: layer.featureCount() == 2, 3)


def test_the_project_goes_on_with_its_robots_and_is_not_dirty(saved, at_desk):
    _, own, live = saved
    assert set(QgsProject.instance().mapLayers()) == {own.id(), live.id()}
    assert live.featureCount() == 2
    assert not QgsProject.instance().isDirty()
    group = QgsProject.instance().layerTreeRoot().findGroup("Fleet")
    assert [child.layerId() for child in group.children()] == [live.id()]


def test_opened_without_a_gateway_the_users_layers_alone_are_there(saved, plugin):
    path, own, _ = saved
    its_id = own.id()
    plugin.unload()
    assert QgsProject.instance().read(str(path))
    assert list(QgsProject.instance().mapLayers()) == [its_id]
    assert [node.name() for node in QgsProject.instance().layerTreeRoot().children()] == ["walls"]


def test_a_group_with_a_layer_of_the_users_stays_with_that(at_desk, tmp_path, wait, make_layer):
    wait(lambda: at_desk.view.layer.layer.featureCount() == 2, 3)
    project = QgsProject.instance()
    own = make_layer("walls")
    project.addMapLayer(own, False)
    project.layerTreeRoot().findGroup("Fleet").addLayer(own)
    path = tmp_path / "grouped.qgz"
    assert project.write(str(path))
    root = content(path)
    assert [group.get("name") for group in root.iter("layer-tree-group")] == [None, "Fleet"]
    assert [one.get("id") for one in root.iter("layer-tree-layer")] == [own.id()]


def test_a_live_layer_that_a_file_brings_along_is_taken_out_and_its_style_kept(qgis_app, tmp_path):
    project = QgsProject.instance()
    project.clear()
    old = QgsVectorLayer("Point?crs=EPSG:32633", "Robots (live)", "memory")
    old.setCustomProperty(MARK, "robots")
    old.setRenderer(QgsSingleSymbolRenderer.defaultRenderer(old.geometryType()))
    project.addMapLayer(old, False)
    project.layerTreeRoot().insertGroup(0, "Fleet").addLayer(old)
    path = str(tmp_path / "old.qgz")
    assert project.write(path)
    keeper = LiveLayers(project)
    try:
        assert project.read(path)
        assert project.mapLayers() == {}
        assert project.layerTreeRoot().children() == []
        assert not project.isDirty()
        assert "singleSymbol" in project.readEntry("fleet_supervisor", "styles/robots")[0]
    finally:
        keeper.remove()
        project.clear()


def test_expressions_follow_the_robots_until_the_plugin_goes(at_desk, gateway, make_robot, plugin, wait):
    wait(lambda: QgsExpression("robot_state('r1') IS NOT NULL").evaluate())
    assert QgsExpression("robot_battery('r1')").evaluate() == 0.8
    gateway.show(make_robot("r1", 53, 44, battery=0.25))
    wait(lambda: QgsExpression("robot_battery('r1')").evaluate() == 0.25)
    apart = "distance_to_robot('r1', make_point(488050, 5190040), 'EPSG:32633')"
    assert QgsExpression(apart).evaluate() == pytest.approx(5.0, abs=1e-6)
    plugin.unload()
    assert not QgsExpression.isFunctionName("robot_state")

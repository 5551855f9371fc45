"""A layer with a feature for each row: only what changed is written."""

from __future__ import annotations

from dataclasses import replace

import pytest
from fleet_supervisor.plugin.desk.live_layers import MARK
from fleet_supervisor.plugin.desk.row_layer import RowLayer
from fleet_supervisor.plugin.sites.fleet_group import GROUP, fleet_group
from qgis.core import QgsProject
from qgis.PyQt.QtWidgets import QApplication

E, N = 488000.0, 5190000.0
TWO = [([(1.0, 2.0)], ["a", 1]), ([(3.0, 4.0)], ["b", None])]


@pytest.fixture
def project(qgis_app):
    return QgsProject()


@pytest.fixture
def points(project):
    return RowLayer(project, "rows", "Rows", "Point", "name:string,number:integer", lambda layer: None)


def features(points):
    """Return place and id of each feature by its name."""
    found = {}
    for feature in points.layer.getFeatures():
        at = feature.geometry().asPoint()
        found[feature["name"]] = (at.x() - E, at.y() - N), feature.id()
    return found


def repaints(points, act):
    """Return how often the layer asked to be painted anew while ``act`` did something."""
    asked = []
    points.layer.repaintRequested.connect(lambda *_: asked.append(True))
    act()
    return len(asked)


def test_nothing_is_made_for_nothing(points, project, site):
    points.show([], site)
    points.show(TWO, None)
    assert points.layer is None and project.mapLayers() == {}


def test_each_row_is_a_feature_where_it_is(points, site):
    points.show(TWO, site)
    assert points.layer.customProperty(MARK) == "rows"
    assert {name: at for name, (at, _) in features(points).items()} == {"a": (1, 2), "b": (3, 4)}


def test_rows_that_are_there_already_are_left_alone_and_nothing_is_painted(points, site):
    points.show(TWO, site)
    before = features(points)
    assert repaints(points, lambda: points.show([TWO[1], TWO[0]], site)) == 0
    assert features(points) == before


def test_only_what_changed_is_written(points, site):
    points.show(TWO, site)
    stays = features(points)["a"]
    assert repaints(points, lambda: points.show([TWO[0], ([(3.0, 4.5)], ["b", None])], site)) == 1
    assert features(points)["a"] == stays and features(points)["b"][0] == (3, 4.5)
    points.show([TWO[0], ([(9.0, 9.0)], ["c", 3])], site)
    assert features(points)["a"] == stays and set(features(points)) == {"a", "c"}


def test_of_two_rows_that_are_alike_each_has_a_feature(points, site):
    points.show([TWO[0], TWO[0]], site)
    assert points.layer.featureCount() == 2
    points.show([TWO[0]], site)
    assert points.layer.featureCount() == 1


def test_a_site_that_is_moved_takes_its_features_along_and_another_crs_is_another_layer(points, site):
    points.show(TWO, site)
    layer = points.layer.id()
    points.show(TWO, replace(site, origin=(E + 100, N)))
    assert {name: at for name, (at, _) in features(points).items()} == {"a": (101, 2), "b": (103, 4)}
    assert points.layer.id() == layer and points.layer.featureCount() == 2
    points.show(TWO, replace(site, crs="EPSG:32634"))
    assert points.layer.crs().authid() == "EPSG:32634" and points.layer.featureCount() == 2


def test_a_layer_that_the_user_took_out_comes_back_whole(points, project, site):
    points.show(TWO, site)
    project.removeMapLayer(points.layer.id())
    points.show(TWO, site)
    assert points.layer.featureCount() == 2


def test_it_comes_again_in_a_new_project(points, project, site, wait):
    points.show(TWO, site)
    project.clear()
    assert points.layer is None
    wait(lambda: points.layer is not None)
    assert set(features(points)) == {"a", "b"}


def test_it_comes_again_in_a_project_that_is_opened_and_not_before_that_is_read(
    points, project, site, tmp_path, make_layer, wait
):
    file = str(tmp_path / "other.qgz")
    other = QgsProject()
    other.addMapLayer(make_layer("walls"))
    assert other.write(file)
    points.show(TWO, site)
    seen = []

    def meanwhile(*_):
        points.show(TWO[:1], site)
        QApplication.processEvents()
        seen.append(points.layer)

    project.readMapLayer.connect(meanwhile)
    assert project.read(file)
    assert seen == [None]
    wait(lambda: points.layer is not None)
    assert set(features(points)) == {"a"}
    assert {layer.name() for layer in project.mapLayers().values()} == {"walls", "Rows"}


def test_removed_it_does_not_come_again(points, project, site):
    points.show(TWO, site)
    points.remove()
    project.clear()
    QApplication.processEvents()
    assert project.mapLayers() == {}


def test_nobody_edits_it(points, site):
    points.show(TWO, site)
    assert not points.layer.startEditing()


def test_lines_are_written_as_lines(project, site):
    lines = RowLayer(project, "ways", "Ways", "LineString", "name:string", lambda layer: None)
    lines.show([(((0.0, 0.0), (10.0, 0.0)), ["way"]), (((0.0, 0.0), (0.0, 5.0), (5.0, 5.0)), ["bend"])], site)
    assert sorted(one.geometry().length() for one in lines.layer.getFeatures()) == [10, 10]
    assert {one["name"]: one.geometry().constGet().numPoints() for one in lines.layer.getFeatures()} == {
        "way": 2,
        "bend": 3,
    }


def test_removed_it_leaves_neither_layer_nor_group_nor_a_changed_project(points, project, site):
    points.show(TWO, site)
    points.remove()
    assert project.mapLayers() == {} and project.layerTreeRoot().findGroup(GROUP) is None
    assert not project.isDirty()


def test_a_group_that_the_user_moved_into_another_is_filled_and_emptied_there(points, project, site):
    root = project.layerTreeRoot()
    points.show(TWO, site)
    group = fleet_group(project)
    root.addGroup("Mine").addChildNode(group.clone())
    root.removeChildNode(group)
    assert fleet_group(project).parent().name() == "Mine"
    points.remove()
    assert root.findGroup(GROUP) is None and root.findGroup("Mine") is not None

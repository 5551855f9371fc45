"""A layer with a feature for each row: only what changed is written."""

from __future__ import annotations

import time
from dataclasses import replace
from itertools import groupby

import pytest
from fleet_supervisor.plugin.layers.live_layers import (
    AT_ONCE,
    GROUP,
    MARK,
    RowLayer,
    fleet_group,
    keep_style,
)
from fleet_supervisor.plugin.ui import scheduling
from qgis.core import QgsExpression, QgsExpressionContext, QgsExpressionContextUtils, QgsProject
from qgis.PyQt.QtCore import QTimer
from qgis.PyQt.QtWidgets import QApplication

from tests.support.patience import START

E, N = 488000.0, 5190000.0
TWO = [([(1.0, 2.0)], ["a", 1]), ([(3.0, 4.0)], ["b", None])]


@pytest.fixture
def project(qgis_app):
    return QgsProject()


@pytest.fixture
def points(project):
    return RowLayer(project, "rows", "Rows", "Point", "name:string,number:integer", lambda layer: None)


def show(points, rows, site):
    """Have the rows shown and written to the last."""
    points.show(rows, site)
    points.finish()


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
    show(points, [], site)
    show(points, TWO, None)
    assert points.layer is None and project.mapLayers() == {}


def test_no_text_of_a_row_is_html_in_the_map_tip(project, points, site):
    """QGIS shows the display name as HTML where a layer has no template, as in older files with its style."""
    for _ in range(2):
        show(points, [([(1.0, 2.0)], ["a & <img src='http://h/x'>", 1])], site)
        layer = points.layer
        (feature,) = layer.getFeatures()
        context = QgsExpressionContext(QgsExpressionContextUtils.globalProjectLayerScopes(layer))
        context.setFeature(feature)
        tip = QgsExpression.replaceExpressionText(layer.mapTipTemplate(), context)
        assert tip == "a &amp; &lt;img src='http://h/x'&gt;"
        layer.setMapTipTemplate("")
        keep_style(project, layer)
        project.removeMapLayer(layer.id())


def test_each_row_is_a_feature_where_it_is(points, site):
    show(points, TWO, site)
    assert points.layer.customProperty(MARK) == "rows"
    assert {name: at for name, (at, _) in features(points).items()} == {"a": (1, 2), "b": (3, 4)}


def test_rows_that_are_there_already_are_left_alone_and_nothing_is_painted(points, site):
    show(points, TWO, site)
    before = features(points)
    assert repaints(points, lambda: show(points, [TWO[1], TWO[0]], site)) == 0
    assert features(points) == before


def test_only_what_changed_is_written(points, site):
    show(points, TWO, site)
    stays = features(points)["a"]
    assert repaints(points, lambda: show(points, [TWO[0], ([(3.0, 4.5)], ["b", None])], site)) == 1
    assert features(points)["a"] == stays and features(points)["b"][0] == (3, 4.5)
    show(points, [TWO[0], ([(9.0, 9.0)], ["c", 3])], site)
    assert features(points)["a"] == stays and set(features(points)) == {"a", "c"}


def test_of_two_rows_that_are_alike_each_has_a_feature(points, site):
    show(points, [TWO[0], TWO[0]], site)
    assert points.layer.featureCount() == 2
    show(points, [TWO[0]], site)
    assert points.layer.featureCount() == 1


def test_a_site_that_is_moved_takes_its_features_along_and_another_crs_is_another_layer(points, site):
    show(points, TWO, site)
    layer = points.layer.id()
    show(points, TWO, replace(site, origin=(E + 100, N)))
    assert {name: at for name, (at, _) in features(points).items()} == {"a": (101, 2), "b": (103, 4)}
    assert points.layer.id() == layer and points.layer.featureCount() == 2
    show(points, TWO, replace(site, crs="EPSG:32634"))
    assert points.layer.crs().authid() == "EPSG:32634" and points.layer.featureCount() == 2


def test_a_layer_that_the_user_took_out_comes_back_whole(points, project, site):
    show(points, TWO, site)
    project.removeMapLayer(points.layer.id())
    show(points, TWO, site)
    assert points.layer.featureCount() == 2


def test_it_comes_again_in_a_new_project(points, project, site, wait):
    show(points, TWO, site)
    project.clear()
    assert points.layer is None
    wait(lambda: points.layer is not None and set(features(points)) == {"a", "b"})


def test_it_comes_again_in_a_project_that_is_opened_and_not_before_that_is_read(
    points, project, site, tmp_path, make_layer, wait
):
    file = str(tmp_path / "other.qgz")
    other = QgsProject()
    other.addMapLayer(make_layer("walls"))
    assert other.write(file)
    show(points, TWO, site)
    seen = []

    def meanwhile(*_):
        points.show(TWO[:1], site)
        points.finish()
        seen.append(points.layer)

    project.readMapLayer.connect(meanwhile)
    assert project.read(file)
    assert seen == [None]
    wait(lambda: points.layer is not None and set(features(points)) == {"a"})
    assert {layer.name() for layer in project.mapLayers().values()} == {"walls", "Rows"}


@pytest.fixture
def one_step(monkeypatch):
    """Slices of one step each."""
    monkeypatch.setattr(scheduling, "SLICE_SECONDS", scheduling.ONE_STEP)


def test_many_are_written_bit_by_bit_after_the_news_and_painted_once(
    points, site, wait, monkeypatch, one_step
):
    written, painted, events = [], [], QTimer()
    rows = [([(float(k), 0.0)], [f"r{k}", k]) for k in range(2 * AT_ONCE + 1)]
    write = RowLayer._write

    def watched(self, some):
        if AT_ONCE not in written:
            self.layer.repaintRequested.connect(lambda *_: painted.append(self.layer.featureCount()))
        write(self, some)
        written.append(self.layer.featureCount())

    monkeypatch.setattr(RowLayer, "_write", watched)
    events.timeout.connect(lambda: written.append("events"))
    events.start(0)
    points.show(rows, site)
    assert points.layer is None
    wait(lambda: painted)
    events.stop()
    told = [what for what, _ in groupby(written[written.index(AT_ONCE) :])]
    assert told[:5] == [AT_ONCE, "events", 2 * AT_ONCE, "events", len(rows)] and painted == [len(rows)]


def half_written(points, site):
    """Let rows be written, and stop where some are and others not: a wait may let all of them be."""
    points.show([([(float(k), 0.0)], [f"old{k}", k]) for k in range(20 * AT_ONCE)], site)
    until = time.monotonic() + START
    while points.layer is None or not points.layer.featureCount():
        assert time.monotonic() < until
        QApplication.processEvents()
    assert points.layer.featureCount() < 20 * AT_ONCE


def test_what_comes_while_it_is_written_is_what_is_shown_in_the_end(points, site, one_step):
    half_written(points, site)
    show(points, TWO, site)
    assert set(features(points)) == {"a", "b"}


def test_taken_out_while_it_is_written_it_comes_back_whole(points, project, site, one_step):
    half_written(points, site)
    project.removeMapLayer(points.layer.id())
    points.finish()
    assert points.layer.featureCount() == 20 * AT_ONCE


def test_removed_it_does_not_come_again(points, project, site):
    show(points, TWO, site)
    points.remove()
    project.clear()
    QApplication.processEvents()
    assert project.mapLayers() == {}


def test_nobody_edits_it(points, site):
    show(points, TWO, site)
    assert not points.layer.startEditing()


def test_lines_are_written_as_lines(project, site):
    lines = RowLayer(project, "ways", "Ways", "LineString", "name:string", lambda layer: None)
    show(
        lines, [(((0.0, 0.0), (10.0, 0.0)), ["way"]), (((0.0, 0.0), (0.0, 5.0), (5.0, 5.0)), ["bend"])], site
    )
    assert sorted(one.geometry().length() for one in lines.layer.getFeatures()) == [10, 10]
    assert {one["name"]: one.geometry().constGet().numPoints() for one in lines.layer.getFeatures()} == {
        "way": 2,
        "bend": 3,
    }


def test_removed_it_leaves_neither_layer_nor_group_nor_a_changed_project(points, project, site):
    show(points, TWO, site)
    points.remove()
    assert project.mapLayers() == {} and project.layerTreeRoot().findGroup(GROUP) is None
    assert not project.isDirty()


@pytest.mark.parametrize("unsaved", [False, True])
def test_it_neither_makes_nor_hides_unsaved_changes(points, project, site, unsaved):
    # As QGIS's layer panel does, at once and again when it has laid out the group.
    for change in (project.layerTreeRoot().addedChildren, project.layerTreeRoot().removedChildren):
        change.connect(lambda *_: project.setDirty(True))
        change.connect(lambda *_: QTimer.singleShot(0, project.setDirty))
    project.setDirty(unsaved)
    show(points, TWO, site)
    QApplication.processEvents()
    assert project.isDirty() is unsaved
    points.remove()
    QApplication.processEvents()
    assert project.isDirty() is unsaved


def test_a_group_that_the_user_moved_into_another_is_filled_and_emptied_there(points, project, site):
    root = project.layerTreeRoot()
    show(points, TWO, site)
    group = fleet_group(project)
    root.addGroup("Mine").addChildNode(group.clone())
    root.removeChildNode(group)
    assert fleet_group(project).parent().name() == "Mine"
    points.remove()
    assert root.findGroup(GROUP) is None and root.findGroup("Mine") is not None

"""The real vector layer beside the live picture: the user's own, and never in anybody's way."""

from __future__ import annotations

import pytest
from fleet_supervisor.plugin.desk.live.robot_layer import AT_ONCE, RobotLayer
from fleet_supervisor.plugin.desk.picture import RobotPicture
from fleet_supervisor.plugin.wire.position_rows import sightings
from qgis.core import QgsProject, QgsSingleSymbolRenderer
from qgis.gui import QgsAttributeTableFilterModel, QgsDualView
from qgis.PyQt.QtWidgets import QDialog


def told(number, x=1.0, **more):
    return {"robot": f"r{number}", "state": "fresh", "age": 0.0, "link": "sql", "x": x, "y": 2.0, **more}


@pytest.fixture
def layer(iface, site):
    made = RobotLayer(QgsProject.instance(), iface.canvas)
    made.show_site(site)
    yield made
    made.remove()


def write_all(layer, picture, now=0.0):
    layer.begin(len(picture))
    rounds = 0
    while layer._waiting:
        layer.go_on(picture, now)
        rounds += 1
    return rounds


def xs(layer):
    return {f["robot"]: f.geometry().asPoint().x() - 488000 for f in layer.layer.getFeatures()}


def test_many_robots_are_written_a_part_at_a_time(layer):
    picture = RobotPicture()
    number = 2 * AT_ONCE + 10
    picture.merge(sightings([told(k, float(k)) for k in range(number)], 0.0))
    assert write_all(layer, picture) == 3
    assert xs(layer) == pytest.approx({f"r{k}": float(k) for k in range(number)})
    assert len(layer) == layer.layer.featureCount() == number


def test_only_what_has_changed_is_written(layer, monkeypatch):
    picture = RobotPicture()
    picture.merge(sightings([told(k) for k in range(5)], 0.0))
    write_all(layer, picture)
    written = []
    monkeypatch.setattr(layer, "_write", lambda views: written.extend(view.name for view in views))
    picture.merge(sightings([told(2, 9.0)], 1.0))
    write_all(layer, picture, 1.0)
    assert written == ["r2"]
    written.clear()
    # Silence changes a robot too: its state, and then its age.
    write_all(layer, picture, 3.5)
    assert written == ["r0", "r1", "r3", "r4"]


def test_a_robot_without_a_pose_has_a_row_and_no_geometry(layer):
    picture = RobotPicture()
    picture.merge(sightings([told(1, None, battery=0.5)], 0.0))
    write_all(layer, picture)
    (feature,) = layer.layer.getFeatures()
    assert not feature.hasGeometry()
    assert feature["battery"] == 0.5


def test_the_users_style_lasts_over_a_project_that_is_saved_and_opened(at_desk, tmp_path, wait):
    wait(lambda: at_desk.view.layer.layer.featureCount() == 2)
    mine = QgsSingleSymbolRenderer.defaultRenderer(at_desk.view.layer.layer.geometryType())
    at_desk.view.layer.layer.setRenderer(mine)
    path = str(tmp_path / "styled.qgz")
    assert QgsProject.instance().write(path)
    assert QgsProject.instance().read(path)
    wait(lambda: at_desk.view.layer.layer is not None and at_desk.view.layer.layer.featureCount() == 2)
    assert at_desk.view.layer.layer.renderer().type() == "singleSymbol"
    assert len(QgsProject.instance().mapLayers()) == 1


def test_a_layer_for_another_site_is_styled_as_the_one_before(layer, site):
    from dataclasses import replace

    layer.layer.setRenderer(QgsSingleSymbolRenderer.defaultRenderer(layer.layer.geometryType()))
    layer.show_site(replace(site, rotation=0.5))
    assert layer.layer.renderer().type() == "singleSymbol"


def test_while_a_project_is_read_its_layers_are_left_alone(at_desk, tmp_path, wait, make_layer):
    path = str(tmp_path / "read.qgz")
    wait(lambda: at_desk.view.layer.layer.featureCount() == 2)
    QgsProject.instance().addMapLayer(make_layer("walls"))
    assert QgsProject.instance().write(path)
    touched = []
    project = QgsProject.instance()

    def in_the_middle(*_):
        # As timers do that run while QGIS shows how far it is.
        at_desk.desk.pulled.emit()
        touched.append(at_desk.view.layer.layer)

    project.layerLoaded.connect(in_the_middle)
    assert project.read(path)
    project.layerLoaded.disconnect(in_the_middle)
    assert touched and set(touched) == {None}
    wait(lambda: at_desk.view.layer.layer is not None and at_desk.view.layer.layer.featureCount() == 2)


def test_a_canvas_that_draws_is_not_made_to_begin_anew(layer, monkeypatch):
    picture = RobotPicture()
    picture.merge(sightings([told(1)], 0.0))
    asked = []
    layer.layer.repaintRequested.connect(asked.append)
    monkeypatch.setattr(type(layer._canvas), "isDrawing", lambda canvas: True)
    write_all(layer, picture)
    monkeypatch.setattr(type(layer._canvas), "isDrawing", lambda canvas: False)
    write_all(layer, picture)
    assert asked == [True, False]


def test_an_open_attribute_table_shows_what_comes_in(layer, iface, wait):
    picture = RobotPicture()
    picture.merge(sightings([told(1, battery=0.5)], 0.0))
    write_all(layer, picture)
    # As QGIS names the window of an attribute table, which only QGIS itself can make.
    window = QDialog(iface)
    window.setObjectName(f"QgsAttributeTableDialog/{layer.layer.id()}")
    table = QgsDualView(window)
    table.init(layer.layer, iface.canvas)
    table.setFilterMode(QgsAttributeTableFilterModel.FilterMode.ShowAll)
    changes = []
    layer.layer.dataChanged.connect(lambda: changes.append(1))
    picture.merge(sightings([told(1, battery=0.25)], 1.0))
    write_all(layer, picture, 1.0)
    assert changes
    model = table.masterModel()
    column = layer.layer.fields().indexOf("battery")
    wait(lambda: model.data(model.index(0, model.fieldCol(column)), 0) == "0.25", what="the new value")
    window.deleteLater()

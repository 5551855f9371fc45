"""The real vector layer beside the live picture: the user's own, and never in anybody's way."""

from __future__ import annotations

import pytest
from fleet_supervisor.plugin.gateway_client.robot_states import RobotStates, RobotTable, table_from_rows
from fleet_supervisor.plugin.map.reported_layers import AT_ONCE, RobotLayer
from qgis.core import NULL, QgsPalLayerSettings, QgsProject, QgsSingleSymbolRenderer
from qgis.gui import QgsAttributeTableFilterModel, QgsDualView


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
    picture = RobotStates()
    number = 2 * AT_ONCE + 10
    picture.merge(table_from_rows([told(k, float(k)) for k in range(number)], 0.0))
    assert write_all(layer, picture) == 3
    assert xs(layer) == pytest.approx({f"r{k}": float(k) for k in range(number)})
    assert len(layer) == layer.layer.featureCount() == number


@pytest.fixture
def writes(layer, monkeypatch):
    """What is written of robots that are in the layer: for each write by robot the fields, and who moved."""
    provider = type(layer.layer.dataProvider())
    change, found = provider.changeFeatures, []
    fields = layer.layer.fields().names()

    def watched(self, attributes, geometries):
        names = {fid: name for name, fid in layer._ids.items()}
        values = {names[fid]: {fields[at] for at in changed} for fid, changed in attributes.items()}
        found.append((values, {names[fid] for fid in geometries}))
        return change(self, attributes, geometries)

    monkeypatch.setattr(provider, "changeFeatures", watched)
    return found


def test_only_what_has_changed_is_written(layer, writes):
    picture = RobotStates()
    picture.merge(table_from_rows([told(k) for k in range(5)], 0.0))
    write_all(layer, picture)
    picture.merge(table_from_rows([told(2, 9.0, battery=0.5), told(3, age=0.7)], 1.0))
    write_all(layer, picture, 1.0)
    # That the others' last messages are a second old now is no reason to write them.
    assert writes == [({"r2": {"battery"}}, {"r2"})]
    assert xs(layer) == pytest.approx({"r0": 1.0, "r1": 1.0, "r2": 9.0, "r3": 1.0, "r4": 1.0})
    writes.clear()
    # Silence changes a robot too: its state, and then its age.
    write_all(layer, picture, 3.5)
    write_all(layer, picture, 3.75)
    silent = ("r0", "r1", "r4")
    assert writes[0] == ({**{name: {"state", "age"} for name in silent}, "r3": {"state", "age"}}, set())
    assert writes[1] == ({name: {"age"} for name in (*silent, "r3")}, set())


def test_one_that_moves_up_and_says_what_the_one_in_its_row_had_said_is_written(layer):
    picture = RobotStates()
    picture.merge(table_from_rows([told(k, float(k), battery=k / 10) for k in range(4)], 0.0))
    write_all(layer, picture)
    gone = picture.merge(RobotTable(removed=["r1"]))
    layer.drop(gone.all_names)
    picture.merge(table_from_rows([told(2, 1.0, battery=0.1), told(1, 8.0, battery=0.8)], 1.0))
    write_all(layer, picture, 1.0)
    assert xs(layer) == pytest.approx({"r0": 0.0, "r1": 8.0, "r2": 1.0, "r3": 3.0})
    batteries = {f["robot"]: f["battery"] for f in layer.layer.getFeatures()}
    assert batteries == pytest.approx({"r0": 0.0, "r1": 0.8, "r2": 0.1, "r3": 0.3})


def test_what_a_robot_does_not_say_any_more_is_in_the_layer_no_more(layer):
    picture = RobotStates()
    picture.merge(table_from_rows([told(1, battery=0.5, status="driving", theta=0.0)], 0.0))
    write_all(layer, picture)
    (feature,) = layer.layer.getFeatures()
    assert (feature["battery"], feature["status"], feature["heading_deg"]) == (0.5, "driving", 90.0)
    picture.merge(table_from_rows([told(1, None)], 1.0))
    write_all(layer, picture, 1.0)
    (feature,) = layer.layer.getFeatures()
    assert [feature[name] for name in ("battery", "status", "theta", "heading_deg")] == [NULL] * 4
    assert not feature.hasGeometry()


def test_a_robot_without_a_pose_has_a_row_and_no_geometry(layer):
    picture = RobotStates()
    picture.merge(table_from_rows([told(1, None, battery=0.5)], 0.0))
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
        at_desk.desk.state.updated.emit()
        touched.append(at_desk.view.layer.layer)

    project.layerLoaded.connect(in_the_middle)
    assert project.read(path)
    project.layerLoaded.disconnect(in_the_middle)
    assert touched and set(touched) == {None}
    wait(lambda: at_desk.view.layer.layer is not None and at_desk.view.layer.layer.featureCount() == 2)


def test_a_canvas_that_draws_is_not_made_to_begin_anew(layer, monkeypatch):
    picture = RobotStates()
    picture.merge(table_from_rows([told(1)], 0.0))
    asked = []
    layer.layer.repaintRequested.connect(asked.append)
    monkeypatch.setattr(type(layer._canvas), "isDrawing", lambda canvas: True)
    write_all(layer, picture)
    monkeypatch.setattr(type(layer._canvas), "isDrawing", lambda canvas: False)
    write_all(layer, picture)
    assert asked == [True, False]


def test_an_open_attribute_table_shows_what_comes_in(layer, iface, wait):
    picture = RobotStates()
    picture.merge(table_from_rows([told(1, battery=0.5)], 0.0))
    write_all(layer, picture)
    # The window around it only QGIS itself can make.
    table = QgsDualView()
    table.init(layer.layer, iface.canvas)
    table.setFilterMode(QgsAttributeTableFilterModel.FilterMode.ShowAll)
    picture.merge(table_from_rows([told(1, battery=0.25)], 1.0))
    write_all(layer, picture, 1.0)
    model = table.masterModel()
    column = layer.layer.fields().indexOf("battery")
    wait(lambda: model.data(model.index(0, model.fieldCol(column)), 0) == "0.25", what="the new value")
    table.deleteLater()


def test_people_read_units_and_expressions_go_by_names(layer):
    shown = {
        field.name(): layer.layer.attributeDisplayName(at) for at, field in enumerate(layer.layer.fields())
    }
    assert shown["v"] == "Speed (m/s)"
    assert shown["heading_deg"] == "Heading (°)"
    assert not {name for name, text in shown.items() if text == name}


def test_labels_are_the_users_to_switch_on_and_lie_beside_what_the_live_map_draws(layer):
    assert not layer.layer.labelsEnabled()
    labels = layer.layer.labeling().settings()
    assert labels.placement == QgsPalLayerSettings.Placement.OverPoint
    assert labels.yOffset > 0
    assert labels.format().buffer().enabled()

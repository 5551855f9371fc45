"""Robots in the table, on the map and in view: one selection, one place."""

from __future__ import annotations

import pytest
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtTest import QTest

from tests.support.fleet_panel import LEFT, table


def test_the_table_tells_what_is_known_of_each_robot(at_desk, gateway, make_robot, wait):
    gateway.show(make_robot("r3", x=None, y=None, theta=None, v=None, battery=None, link="sql"))
    wait(lambda: len(table(at_desk)[1]) == 3)
    first, _, third = table(at_desk)[1]
    assert (first["Robot"], first["State"], first["Speed"], first["Batt."]) == (
        "r1",
        "fresh",
        "0.5 m/s",
        "80%",
    )
    assert first["Link"] == "ws"
    assert (third["Robot"], third["Speed"], third["Batt."], third["Link"]) == ("r3", "", "", "sql")


def test_the_table_sorts_by_number_and_keeps_the_selection(at_desk, gateway, make_robot, wait):
    gateway.show(make_robot("r3", v=10.0), make_robot("r4", v=9.0))
    wait(lambda: len(table(at_desk)[1]) == 4)
    at_desk.desk.selection.select("r4")
    view, rows = table(at_desk)
    view.sortByColumn(list(rows[0]).index("Speed"), Qt.SortOrder.DescendingOrder)
    assert [row["Robot"] for row in table(at_desk)[1]][:2] == ["r3", "r4"]
    assert [index.data() for index in view.selectionModel().selectedRows()] == ["r4"]


def test_a_click_in_the_table_selects_on_the_map_and_in_the_layer(at_desk, wait):
    layer = at_desk.view.layer.layer
    wait(lambda: layer.featureCount() == 2, 3)
    view, _ = table(at_desk)
    wait(lambda: view.model().rowCount() == 2)
    QTest.mouseClick(view.viewport(), LEFT, pos=view.visualRect(view.model().index(1, 0)).center())
    assert at_desk.desk.selection.last == "r2"
    assert [feature["robot"] for feature in layer.selectedFeatures()] == ["r2"]


def test_a_selection_in_the_layer_selects_in_the_table(at_desk, wait):
    layer = at_desk.view.layer.layer
    wait(lambda: layer.featureCount() == 2, 3)
    layer.selectByExpression("robot = 'r2'")
    assert at_desk.desk.selection.last == "r2"
    view, _ = table(at_desk)
    assert [index.data() for index in view.selectionModel().selectedRows()] == ["r2"]


@pytest.mark.parametrize("how", ["double click", Qt.Key.Key_Return, Qt.Key.Key_Enter])
def test_a_double_click_or_enter_in_the_table_goes_to_the_robot(at_desk, iface, wait, how):
    view, _ = table(at_desk)
    wait(lambda: view.model().rowCount() == 2)
    at = view.visualRect(view.model().index(1, 0)).center()
    QTest.mouseClick(view.viewport(), LEFT, pos=at)
    if how == "double click":
        QTest.mouseDClick(view.viewport(), LEFT, pos=at)
    else:
        QTest.keyClick(view, how)
    centre = iface.canvas.center()
    assert (centre.x() - 488000, centre.y() - 5190000) == pytest.approx((80, 60), abs=1)
    assert 60 <= iface.canvas.extent().height() < 110


def test_a_followed_robot_stays_in_view(at_desk, gateway, iface, make_robot, wait):
    at_desk.desk.selection.select("r1")
    at_desk.actions.follow.trigger()
    gateway.show(make_robot("r1", 190, 150))
    wait(lambda: abs(iface.canvas.center().x() - 488190) < 30, 4, "the map to follow")
    at_desk.actions.follow.trigger()
    gateway.show(make_robot("r1", 10, 10))
    QTest.qWait(1300)
    assert abs(iface.canvas.center().x() - 488190) < 30


def test_following_nobody_says_so(at_desk, iface):
    at_desk.actions.follow.trigger()
    assert any("No robot is selected to be followed" in text for text in iface.texts())

"""A desk that is told of the robots in its canvas alone: gateway and robots are real."""

from __future__ import annotations

import pytest
from fleet_supervisor.plugin.control import view_subscription
from fleet_supervisor.plugin.gateway_client import protocol
from qgis.core import NULL, QgsExpression
from qgis.gui import QgsLocatorWidget
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import QLabel, QLineEdit

from tests.support.bridge.bridge_programs import wait_until
from tests.support.operators import ask

SECONDS = 15
CRS = "EPSG:32633"


@pytest.fixture
def iface(iface):
    """A window with QGIS's locator in it."""
    widget = QgsLocatorWidget(iface)
    widget.show()
    iface.locator = widget.locator()
    return iface


@pytest.fixture
def is_large(monkeypatch):
    """Two robots are as many as 5 000."""
    monkeypatch.setattr(protocol, "VIEWS_FROM", 1)
    monkeypatch.setattr(view_subscription, "VIEWS_FROM", 1)
    monkeypatch.setattr(view_subscription, "VIEWS_UNTIL", 0)


def show(operator, x_min, y_min, x_max, y_max):
    e, n = operator.desk.state.site.origin
    operator.show_map((e + x_min, n + y_min, e + x_max, n + y_max), CRS)


def sees(operator, *robots):
    operator.wait(f"seeing {robots}", lambda: set(operator.states()) == set(robots), SECONDS)


def test_the_desk_knows_who_is_on_the_map_searched_for_or_selected_and_stops_all(
    is_large, loop, operator, plugin
):
    loop.start_robot("r1", (20, 8, 0))
    loop.start_robot("van2", (150, 120, 0))
    wait_until(lambda: placed(loop) == {"r1", "van2"})
    operator.connect(f"{loop.address}/desk", "anna")
    operator.wait("the site", lambda: operator.desk.state.site, SECONDS)
    operator.show_site()
    sees(operator, "r1", "van2")
    show(operator, 0, 0, 60, 40)
    sees(operator, "r1")
    dock = plugin.window.dock
    operator.wait("count", lambda: dock.findChild(QLabel, "fleet_robot_count").text() == "1 of 2", SECONDS)
    search = dock.findChild(QLineEdit, "fleet_robot_search")
    search.setText("VAN")
    sees(operator, "r1", "van2")
    operator.desk.selection.select("van2")
    search.setText("")
    show(operator, 0, 0, 61, 41)
    operator.wait("the end of the search", lambda: operator.desk.view._asked.always == ["van2"], SECONDS)
    sees(operator, "r1", "van2")
    operator.desk.selection.select(None)
    sees(operator, "r1")
    operator.desk.emergency_stop()
    operator.wait(
        "a stop of both", lambda: (stop := operator.desk.state.emergency) and stop.robots == 2, SECONDS
    )
    show(operator, 120, 100, 180, 140)
    sees(operator, "van2")


def test_locator_and_expressions_reach_who_is_not_on_the_map(is_large, loop, operator, plugin, iface):
    loop.start_robot("r1", (20, 8, 0))
    loop.start_robot("van2", (150, 120, 0))
    wait_until(lambda: placed(loop) == {"r1", "van2"})
    operator.connect(f"{loop.address}/desk", "anna")
    operator.wait("the site", lambda: operator.desk.state.site, SECONDS)
    show(operator, 0, 0, 60, 40)
    sees(operator, "r1")
    e, n = operator.desk.state.site.origin
    field = iface.findChild(QgsLocatorWidget).findChild(QLineEdit)
    listed = []
    iface.locator.foundResult.connect(lambda result: listed.append(result.displayString))
    field.setFocus()
    QTest.keyClicks(field, "rb VAN")
    operator.wait("the robot in the locator", lambda: listed == ["van2"], SECONDS)
    sees(operator, "r1")
    QTest.keyClick(field, Qt.Key.Key_Return)
    operator.wait("the map there", lambda: abs(iface.canvas.center().x() - e - 150) < 1, SECONDS)
    assert operator.desk.selection.robots == ("van2",)
    operator.desk.selection.select(None)
    sees(operator, "van2")
    far = QgsExpression(f"distance_to_robot('r1', make_point({e}, {n}), '{CRS}')")
    operator.wait("r1 out of what expressions know", lambda: far.evaluate() == NULL, SECONDS)
    operator.wait("its distance", lambda: far.evaluate() != NULL, SECONDS)
    assert far.evaluate() == pytest.approx(21.5, abs=0.5)


def placed(loop):
    (answer,) = ask(loop.address, ("get_positions", {}))
    return {one["robot"] for one in answer["robots"] if "x" in one}

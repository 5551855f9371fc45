"""Routes along the roads, closed roads and conflicts: a real gateway, real robots, real clicks."""

from __future__ import annotations

import math
import re

import pytest
from fleet_supervisor.robot_bridge.core.messages.commands import CommandState
from qgis.core import QgsPointXY, QgsProject
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import (
    QAction,
    QCheckBox,
    QComboBox,
    QLabel,
    QLineEdit,
    QPushButton,
    QTableView,
    QToolButton,
)

from tests.support.inside_qgis.mouse import move_mouse

CRS = "EPSG:32633"
SOUTH = (60.0, 8.0)
"""On the road from (16, 8) to (120, 8)."""


@pytest.fixture
def at_roads(loop, operator):
    """One robot at the beginning of the southern road, selected, and the tool for routes in hand."""
    loop.start_robot("r1", (10, 8, 0), speed=10)
    operator.connect_to(loop, ["r1"])
    operator.show_site()
    operator.select("r1")
    operator.choose("fleet_road_route")
    return operator


def move_to(operator, x, y):
    e, n = operator.desk.state.site.origin
    move_mouse(operator.canvas.viewport(), operator._on_canvas(QgsPointXY(e + x, n + y), CRS))


def preview(operator):
    """The line that follows the mouse, in the site frame; empty while there is none."""
    route = operator.desk.preview.route
    return [] if route is None else route.points


def layer(name):
    found = QgsProject.instance().mapLayersByName(name)
    return found[0] if found else None


def part(operator, kind, name):
    return operator._window.findChild(kind, name)


def close_road(operator, x, y, reason):
    part(operator, QAction, "fleet_close_road").trigger()
    operator.click_site(x, y)
    operator.wait("the dialog", lambda: part(operator, QLineEdit, "fleet_closure_reason"), 5)
    part(operator, QLineEdit, "fleet_closure_reason").setText(reason)
    part(operator, QComboBox, "fleet_closure_time").setCurrentIndex(2)
    QTest.mouseClick(part(operator, QPushButton, "fleet_closure_confirm"), Qt.MouseButton.LeftButton)
    operator.wait("the road closed", lambda: operator.desk.state.closures, 10)


def test_the_way_along_the_roads_follows_the_mouse_and_a_click_takes_it(at_roads):
    operator = at_roads
    move_to(operator, 126.0, 8.0)
    operator.wait("the way to the mouse", lambda: len(preview(operator)) > 50, 10)
    tool = operator.canvas.mapTool()
    assert len(tool._way.line) == len(preview(operator))
    move_to(operator, 138.0, 70.0)
    operator.wait("the other way", lambda: preview(operator) and preview(operator)[-1][1] > 60, 10)
    assert operator.sent_to("r1") == []
    operator.click_site(100.0, 8.0)
    operator.wait_for_draft("the route")
    operator.click_site(126.0, 8.0)
    operator.wait("the second leg", lambda: len(operator.desk.drafts.draft.legs) == 2, 10)
    text = part(operator, QLabel, "fleet_draft_text").text()
    assert "along the roads" in text
    assert "asphalt" in text
    QTest.keyClick(operator.canvas, Qt.Key.Key_Backspace)
    assert len(operator.desk.drafts.draft.legs) == 1
    operator.press("fleet_send")
    command = operator.wait_for_state("r1", "SetPath", CommandState.REACHED)
    assert max(abs(y - 8.0) for _, y in command.params["points"]) < 0.6
    assert command.params["points"][-1] == pytest.approx([100.0, 8.0], abs=0.5)


def test_a_road_is_closed_by_a_click_the_robot_on_it_sent_round_and_opened_again(loop, operator):
    loop.start_robot("r1", (10, 8, 0), speed=0.4)
    operator.connect_to(loop, ["r1"])
    operator.select("r1")
    operator.choose("fleet_road_route")
    operator.click_site(126.0, 8.0)
    operator.wait_for_draft("the route")
    operator.press("fleet_send")
    first = operator.wait_for_state("r1", "SetPath", CommandState.ACKNOWLEDGED)
    close_road(operator, *SOUTH, "tree on the road")
    operator.wait("another way", lambda: len(operator.sent_to("r1")) == 2, 10)
    operator.wait("the layer", lambda: layer("Closed roads"), 10)
    operator.wait("the closed road", lambda: layer("Closed roads").featureCount() == 1, 10)
    (row,) = layer("Closed roads").getFeatures()
    assert (row["reason"], row["closed_by"], row["edges"]) == ("tree on the road", "anna", 1)
    assert row["until"] != ""
    newest = operator.desk.state.commands.get(operator.sent_to("r1")[-1].command)
    assert newest.command != first.command
    box_before = operator.desk.state.closures
    operator.click_site(*SOUTH)
    operator.wait("the question", lambda: part(operator, QPushButton, "fleet_open_road_confirm"), 5)
    assert operator.desk.state.closures == box_before
    QTest.mouseClick(part(operator, QPushButton, "fleet_open_road_confirm"), Qt.MouseButton.LeftButton)
    operator.wait("the road open", lambda: operator.desk.state.closures == (), 10)
    operator.wait("no closed road", lambda: layer("Closed roads").featureCount() == 0, 10)


def test_a_route_keeps_off_the_road_of_another_robot_where_the_operator_wants_it(loop, operator):
    loop.start_robot("r1", (10, 8, 0), speed=1)
    loop.start_robot("r2", (60, 8, 0), speed=0.1)
    operator.connect_to(loop, ["r1", "r2"])
    operator.show_site()
    operator.choose("fleet_road_route")
    operator.select("r2")
    operator.click_site(100.0, 8.0)
    operator.wait_for_draft("the route")
    operator.press("fleet_send")
    operator.wait_for_state("r2", "SetPath", CommandState.ACKNOWLEDGED)
    operator.select("r1")
    operator.click_site(126.0, 8.0)
    operator.wait("the shortest way", lambda: operator.desk.drafts.draft, 10)
    assert max(y for _, y in operator.desk.drafts.draft.points) < 9
    operator.press("fleet_cancel")
    part(operator, QAction, "fleet_way_wishes").trigger()
    operator.wait("the dialog", lambda: part(operator, QCheckBox, "fleet_way_wishes_avoid"), 5)
    part(operator, QCheckBox, "fleet_way_wishes_avoid").setChecked(True)
    QTest.mouseClick(part(operator, QPushButton, "fleet_way_wishes_confirm"), Qt.MouseButton.LeftButton)
    operator.click_site(126.0, 8.0)
    operator.wait("the way round", lambda: operator.desk.drafts.draft, 10)
    assert max(y for _, y in operator.desk.drafts.draft.points) > 20
    assert "off the roads of other robots" in part(operator, QLabel, "fleet_draft_text").text()


def test_a_conflict_is_shown_with_place_and_time_and_one_gives_way(loop, operator):
    # So slow that it has not come to where its ways part, however late the operator is.
    loop.start_robot("r1", (10, 8, 0), speed=0.2)
    loop.start_robot("r2", (119, 8, 3.14), speed=1)
    operator.connect_to(loop, ["r1", "r2"])
    operator.show_site()
    operator.choose("fleet_road_route")
    for robot, goal in (("r1", (126.0, 8.0)), ("r2", (20.0, 8.0))):
        operator.select(robot)
        operator.click_site(*goal)
        operator.wait_for_draft("the route")
        operator.press("fleet_send")
        operator.wait_for_state(robot, "SetPath", CommandState.ACKNOWLEDGED)

    def told():
        """Return how the robots meet; until the second is under way the first meets it standing."""
        rows = list(layer("Conflicts").getFeatures()) if layer("Conflicts") else []
        return [(sorted((row["robot"], row["other"])), row["kind"]) for row in rows]

    operator.wait("the conflict", lambda: told() == [(["r1", "r2"], "head-on")], 15)
    button = part(operator, QToolButton, "fleet_give_way_r1")
    QTest.mouseClick(button, Qt.MouseButton.LeftButton)
    operator.wait("no conflict", lambda: layer("Conflicts").featureCount() == 0, 15)
    points = operator.sent_to("r1")[-1].params["points"]
    assert max(y for x, y in points if 20 < x < 110) == pytest.approx(22.0, abs=1.0)


def test_a_robot_that_stands_in_the_way_is_foretold_and_sent_aside_and_the_other_is_stopped(loop, operator):
    # Half a minute away, for the operator of a busy machine; who is sent aside is quick.
    loop.start_robot("r1", (14, 8, 0), speed=1.5)
    loop.start_robot("r3", (60, 8.6, 0), speed=5)
    operator.connect_to(loop, ["r1", "r3"])
    window = operator.desk.parent()
    window.dock.tabs.setCurrentWidget(window.dock.conflict_panel)
    apart = []
    operator.desk.state.updated.connect(lambda: apart.append(metres_apart(operator, "r1", "r3")))
    operator.select("r1")
    operator.choose("fleet_road_route")
    operator.click_site(66.0, 8.0)
    operator.wait_for_draft("the route")
    operator.press("fleet_send")
    table = part(operator, QTableView, "fleet_alarms").model()

    def alarms():
        return [table.index(row, 1).data() for row in range(table.rowCount())]

    foretold = re.compile(r"r1 will pass r3 at 0\.[67] m \(clearance 1\.2 m\)")
    operator.wait("the alarm", lambda: any(foretold.match(text) for text in alarms()), 15)
    # It comes before they are near.
    assert min(apart) > 1.3
    press(operator, "fleet_stop_r1")
    operator.wait(
        "r1 paused", lambda: operator.desk.state.queues.get("r1") and not operator.report("r1").command, 15
    )
    operator.wait("nobody in the way", lambda: not operator.desk.state.conflicts.conflicts, 15)
    part(operator, QAction, "fleet_continue").trigger()
    operator.wait("a free place", lambda: part(operator, QToolButton, "fleet_aside_r3"), 15)
    operator.wait("its button", lambda: part(operator, QToolButton, "fleet_aside_r3").isEnabled(), 15)
    for name in ("fleet_give_way_r3", "fleet_give_way_r1", "fleet_aside_r1"):
        assert not part(operator, QToolButton, name).isEnabled()
    press(operator, "fleet_aside_r3")
    operator.wait(
        "its route", lambda: operator.desk.drafts.draft and operator.desk.drafts.draft.robot == "r3", 10
    )
    assert operator.sent_to("r3") == []
    operator.press("fleet_send")
    operator.wait_for_state("r3", "SetPath", CommandState.REACHED)
    operator.wait("r1 there", lambda: operator.report("r1").x > 65.5, 60)
    assert min(apart) > 1.1


def press(operator, name):
    QTest.mouseClick(part(operator, QToolButton, name), Qt.MouseButton.LeftButton)


def metres_apart(operator, one, another):
    places = [(report.x, report.y) for report in map(operator.report, (one, another))]
    return math.dist(*places)

"""The table of robots that may take part, as the operator sees it."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import pytest
from fleet_supervisor.plugin.gateway_client.robot_states import RobotStates, table_from_rows
from fleet_supervisor.plugin.planning.forms import SHOWN, RobotsForm
from fleet_supervisor.plugin.planning.plan_settings import PlanSettings
from fleet_supervisor.robot_bridge.core.clock import ManualClock
from fleet_supervisor.robot_bridge.core.messages.base import to_json
from fleet_supervisor.robot_bridge.core.messages.safety import RobotState
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import QLineEdit

CARRIES = 1
NOW = 1000.0


@pytest.fixture
def form(qgis_app):
    form = RobotsForm()
    form.show()
    yield form
    form.close()
    form.deleteLater()


@pytest.fixture
def show(form):
    """Show these robots, heard of this moment."""
    desk = SimpleNamespace(state=SimpleNamespace(robots=RobotStates()), clock=ManualClock(uptime=NOW))

    def shown(*robots):
        desk.state.robots.merge(table_from_rows([to_json(robot) for robot in robots], NOW))
        form.show_robots(desk, PlanSettings())

    return shown


def tip(form, name):
    model = form.model()
    (row,) = [row for row in range(model.rowCount()) if model.index(row, 0).data() == name]
    return model.index(row, 0).data(Qt.ItemDataRole.ToolTipRole)


def test_who_can_take_part_is_seen_from_place_and_state(form, show, make_robot):
    placeless = replace(make_robot("r12"), x=None, y=None, theta=None)
    show(make_robot("r10"), make_robot("r11", state=RobotState.OFFLINE), placeless)
    assert tip(form, "r10") is None
    assert tip(form, "r11") == "r11 is away: it takes no part"
    assert tip(form, "r12") == "r12 is away: it takes no part"


def test_it_is_as_high_as_its_rows_and_no_higher_than_there_is_room_for(form, show, make_robot):
    low = form.height()
    show(*(make_robot(f"r{number}") for number in range(1, SHOWN + 1)))
    high = form.height()
    show(*(make_robot(f"r{number}") for number in range(1, SHOWN + 9)))
    assert low < high == form.height()


def test_what_is_being_typed_stays_while_other_robots_come_and_go(form, show, make_robot, wait):
    show(make_robot("r1"), make_robot("r3"))
    index = form.model().index(0, CARRIES)
    form.setCurrentIndex(index)
    form.edit(index)
    editor = form.findChild(QLineEdit)
    editor.selectAll()
    QTest.keyClicks(editor, "12")
    show(make_robot("r0"), make_robot("r1", state=RobotState.OFFLINE), make_robot("r2"), make_robot("r3"))
    assert form.findChild(QLineEdit) is editor and editor.text() == "12"
    edited = []
    form.edited.connect(lambda name, one: edited.append((name, one.capacity)))
    QTest.keyClick(editor, Qt.Key.Key_Return)
    wait(lambda: edited, 5, "what was typed")
    assert edited == [("r1", 12)]


def test_no_number_is_cut_off(form, show, make_robot):
    show(make_robot("r1"))
    for column, text in enumerate(("24", "24", "0.65", "12500"), CARRIES):
        form.model().setData(form.model().index(0, column), text)
        assert form.columnWidth(column) >= form.sizeHintForColumn(column), text

"""The table of robots that may take part: what is written anew while robots come and go."""

from __future__ import annotations

import pytest
from fleet_supervisor.plugin.desk.picture import RobotView
from fleet_supervisor.plugin.desk.plans.robots_form import RobotsForm
from fleet_supervisor.plugin.desk.plans.wanted_job import PlanSettings
from fleet_supervisor.robot_bridge.messages import RobotState

FRESH, LOST = RobotState.FRESH, RobotState.LOST


@pytest.fixture
def form(qgis_app):
    form = RobotsForm()
    form.show_robots(_views(FRESH, FRESH, FRESH), PlanSettings())
    return form


def _views(*states: RobotState) -> list[RobotView]:
    return [
        RobotView(f"r{number}", {"name": f"r{number}", "x": 1.0, "y": 2.0}, state, 0.1)
        for number, state in enumerate(states, 1)
    ]


def _cells(form: RobotsForm, row: int) -> list[object]:
    return [form.item(row, column) for column in range(form.columnCount())]


def test_a_robot_that_goes_away_leaves_the_others_rows_alone(form):
    first, last = _cells(form, 0), _cells(form, 2)
    form.show_robots(_views(FRESH, LOST, FRESH), PlanSettings())
    assert form.item(1, 0).toolTip() == "r2 is away: it takes no part"
    assert (_cells(form, 0), _cells(form, 2)) == (first, last)


def test_the_rows_are_those_of_the_robots_that_there_are(form):
    form.show_robots(_views(FRESH), PlanSettings())
    assert form.rowCount() == 1
    form.show_robots(_views(FRESH, LOST), PlanSettings())
    assert [form.item(row, 0).text() for row in range(form.rowCount())] == ["r1", "r2"]
    assert form.item(1, 1).text() != ""


def test_what_was_refused_is_shown_as_it_was(form):
    form.item(0, 1).setText("many")
    form.settings(PlanSettings())
    form.show_robots(_views(FRESH, FRESH, FRESH), PlanSettings())
    assert form.item(0, 1).text() != "many"

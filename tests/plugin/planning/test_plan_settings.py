"""The settings of a plan, kept with a project."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from fleet_supervisor.plugin.planning.plan_settings import (
    KEY,
    SCOPE,
    PlanRobotSettings,
    PlanSettings,
    keep_settings,
    read_settings,
)
from qgis.core import QgsProject


@pytest.fixture
def project(qgis_app):
    return QgsProject()


def test_settings_come_back_from_a_saved_project(project, tmp_path):
    wanted = PlanSettings(
        cones="layer-1", objective="distance", finish="store", seconds=3.5, on_roads=False, selected_only=True
    ).with_robot("r 1", PlanRobotSettings(False, 4, 2, 0.8, 500.0))
    keep_settings(project, wanted)
    project.write(str(tmp_path / "p.qgz"))
    read = QgsProject()
    assert read.read(str(tmp_path / "p.qgz"))
    assert read_settings(read) == wanted


def test_a_project_without_settings_has_the_usual_ones(project):
    assert read_settings(project) == PlanSettings()


@pytest.mark.parametrize(
    "text",
    [
        "",
        "no json",
        "[1]",
        "[" * 50_000,
        '{"robots": 3}',
        '{"objective": "fame"}',
        '{"seconds": "long"}',
        '{"odd": 1}',
    ],
)
def test_settings_that_are_none_are_the_usual_ones(project, text):
    project.writeEntry(SCOPE, KEY, text)
    assert read_settings(project) == PlanSettings()


def test_nobody_opens_a_project_that_sends_plans_by_itself(project):
    keep_settings(project, replace(PlanSettings(), by_itself=True))
    assert read_settings(project).by_itself is False


def test_a_robot_never_carries_more_than_it_has_room_for_and_a_range_of_0_does_not_matter():
    robot = PlanRobotSettings(capacity=4, aboard=9).robot("r1", 1.0, 2.0)
    assert robot.aboard == 4 and robot.range_m == math.inf

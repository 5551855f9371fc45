"""Robots beyond the map's border are pointed to."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fleet_supervisor.plugin.map.overlay.scene import SceneTransformer
from fleet_supervisor.plugin.ui.glyphs import STATE_COLOURS, UNSURE_COLOUR
from fleet_supervisor.robot_bridge.core.messages.safety import RobotState

from tests.plugin.map.on_canvas import expected, scene_of, show, spots


@pytest.mark.parametrize("rotation", [0.0, 90.0])
def test_robots_beyond_the_border_are_pointed_to(canvas, site, rotation):
    scene = scene_of((600, 50, 0.0, RobotState.FRESH), (602, 50, 0.0, RobotState.LOST))
    overlay = show(canvas, site, scene, rotation=rotation)
    canvas.grab()
    (hint,) = overlay._painter.hints
    assert sorted(hint.rows.tolist()) == [0, 1]
    away = expected(canvas, site, 600, 50) - (canvas.width() / 2, canvas.height() / 2)
    assert math.cos(hint.turn - math.atan2(away[1], away[0])) > 0.98
    assert overlay.robots_beyond(hint.x, hint.y) == ["r1", "r2"]
    assert 0 < hint.x < canvas.width() and 0 < hint.y < canvas.height()
    red = spots(canvas, STATE_COLOURS[RobotState.LOST])
    assert np.hypot(*(red - (hint.x, hint.y)).T).max() < 14


def test_the_arrow_to_a_robot_that_may_be_elsewhere_is_not_that_of_a_fresh_one(canvas, site):
    show(canvas, site, scene_of((600, 50, 0.0, RobotState.FRESH), doubted=True))
    assert len(spots(canvas, UNSURE_COLOUR)) > 10
    assert len(spots(canvas, STATE_COLOURS[RobotState.FRESH])) == 0


def test_arrows_and_names_are_not_chosen_in_the_same_frame(canvas, site):
    robots = (600, 50, 0.0, RobotState.FRESH), (60, 50, 0.0, RobotState.FRESH)
    overlay = show(canvas, site, scene_of(*robots))
    canvas.grab()
    painter, placed = overlay._painter, overlay._placed
    found, chosen = [], []
    for tenths in range(1, 21):
        before = painter.hints, painter._names._written
        scene = scene_of(*robots, now=100.0 + tenths / 10)
        overlay.show_scene(SceneTransformer().placed(scene, placed.transform))
        canvas.grab()
        if painter.hints is not before[0]:
            found.append(tenths)
        if painter._names._written is not before[1]:
            chosen.append(tenths)
    assert len(found) >= 5 and len(chosen) >= 5 and not set(found) & set(chosen)


def test_names_are_chosen_also_where_every_frame_finds_arrows(canvas, site):
    robots = (600, 50, 0.0, RobotState.FRESH), (60, 50, 0.0, RobotState.FRESH)
    overlay = show(canvas, site, scene_of(*robots))
    canvas.grab()
    painter, placed, chosen = overlay._painter, overlay._placed, 0
    for half_seconds in range(1, 11):
        before = painter._names._written
        scene = scene_of(*robots, now=100.0 + half_seconds / 2)
        overlay.show_scene(SceneTransformer().placed(scene, placed.transform))
        canvas.grab()
        chosen += painter._names._written is not before
    assert chosen >= 4

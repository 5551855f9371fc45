"""Targets, ways and distances are painted where they belong."""

from __future__ import annotations

import dataclasses

import numpy as np
from fleet_supervisor.plugin.map.overlay import robots_painter, task_painter
from fleet_supervisor.plugin.map.overlay.scene import SceneTransformer
from fleet_supervisor.robot_bridge.core.messages.safety import RobotState
from qgis.core import QgsPointXY
from qgis.PyQt.QtWidgets import QApplication

from tests.plugin.map.on_canvas import expected, placement_of, plan, scene_of, show, spots


def test_a_cone_target_stands_on_its_spot(canvas, site):
    from fleet_supervisor.plugin.ui.glyphs import CONE as ORANGE

    show(canvas, site, scene_of(plans=[plan("r1", (40.0, 70.0), cone=True)]))
    foot = expected(canvas, site, 40, 70)
    orange = spots(canvas, ORANGE) - foot
    assert len(orange) > 40
    assert abs(orange[:, 0].mean()) < 1.5
    assert -22 < orange[:, 1].min() < -15
    assert orange[:, 1].max() < 3


def test_the_distance_still_to_go_stands_at_the_target(canvas, site):
    target = plan("r1", (40.0, 70.0))
    scene = scene_of((60, 50, 0.0, RobotState.FRESH), plans=[target])
    without = show(canvas, site, scene)
    before = canvas.grab().toImage()
    canvas.scene().removeItem(without)
    show(canvas, site, dataclasses.replace(scene, remaining={target.command: 28.3}))
    after = canvas.grab().toImage()
    changed = [
        (x, y)
        for x in range(0, after.width(), 2)
        for y in range(0, after.height(), 2)
        if after.pixel(x, y) != before.pixel(x, y)
    ]
    foot = expected(canvas, site, 40, 70)
    assert len(changed) > 20
    assert np.hypot(*(np.array(changed) - foot).T).max() < 40


def test_ways_are_painted_where_they_lead_and_move_with_the_map(canvas, site):
    from fleet_supervisor.plugin.ui.glyphs import ROUTE

    way = plan("r1", (20.0, 20.0), (100.0, 20.0), (100.0, 80.0))
    show(canvas, site, scene_of((20, 20, 0.0, RobotState.FRESH), plans=[way]))
    for _ in range(2):
        found = spots(canvas, ROUTE)
        for x, y in ((60, 20), (100, 50)):
            assert np.hypot(*(found - expected(canvas, site, x, y)).T).min() < 2
        canvas.setCenter(QgsPointXY(site.origin[0] + 70, site.origin[1] + 40))
        QApplication.processEvents()


def test_ways_and_marks_are_drawn_before_they_are_painted(canvas, site, monkeypatch):
    made, mark_atlas, route = [], robots_painter.mark_atlas, task_painter.route
    monkeypatch.setattr(robots_painter, "mark_atlas", lambda *of: (made.append("marks"), mark_atlas(*of))[1])
    monkeypatch.setattr(task_painter, "route", lambda *of: (made.append("way"), route(*of))[1])
    scene = scene_of(plans=[plan("r1", (20.0, 20.0), (100.0, 20.0)), plan("r2", (40.0, 70.0))])
    overlay = show(canvas, site, scene_of())
    made.clear()
    overlay.show_scene(SceneTransformer().placed(scene, placement_of(canvas, site)))
    assert {"marks", "way"} <= set(made)
    made.clear()
    canvas.grab()
    assert made == []

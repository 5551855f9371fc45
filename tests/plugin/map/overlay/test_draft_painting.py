"""What is about to be sent is on the map: small drafts and large, refused ones in red."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from fleet_supervisor.plugin.control.pending_command import (
    CONE,
    ROUTE,
    TARGETS,
    Approach,
    ApproachKind,
    Findings,
    PendingCommand,
)
from fleet_supervisor.plugin.map.overlay.scene import SceneTransformer
from fleet_supervisor.plugin.ui.glyphs import CONE as CONE_COLOUR
from fleet_supervisor.plugin.ui.glyphs import PAPER, REFUSED
from fleet_supervisor.plugin.ui.glyphs import ROUTE as ROUTE_COLOUR
from fleet_supervisor.robot_bridge.core.messages.safety import RobotState
from qgis.PyQt.QtGui import QColor

from tests.plugin.map.on_canvas import expected, placement_of, scene_of, show, spots


def test_a_draft_is_painted_and_a_refused_one_is_red(canvas, site):
    draft = PendingCommand("r1", CONE, ((40.0, 70.0),), Findings(refused=("outside",)))
    show(canvas, site, scene_of((60, 50, 0.0, RobotState.FRESH), draft=draft))
    assert len(spots(canvas, REFUSED)) > 30


@pytest.mark.parametrize(("kind", "is_drawn"), [(ApproachKind.STRAIGHT, True), (ApproachKind.SOUGHT, False)])
def test_no_straight_line_leads_to_a_target_whose_way_is_still_sought(canvas, site, kind, is_drawn):
    draft = PendingCommand("r1", CONE, ((40.0, 70.0),), Findings(refused=("outside",)), way=Approach(kind))
    show(canvas, site, scene_of((60, 50, 0.0, RobotState.FRESH), draft=draft))
    away = spots(canvas, REFUSED) - expected(canvas, site, 50.0, 60.0)
    assert bool((np.hypot(*away.T) < 15.0).any()) is is_drawn


def test_a_draft_of_many_targets_is_painted_where_they_are_and_a_refused_one_is_red(canvas, site):
    places = tuple((10.0 + 10 * (k % 10), 10.0 + 10 * (k // 10)) for k in range(80))
    draft = PendingCommand("r1", TARGETS, places, is_checked=True)
    show(canvas, site, scene_of(draft=draft))
    cones = spots(canvas, CONE_COLOUR)
    for x, y in places:
        away = cones - expected(canvas, site, x, y) - (0.0, -5.0)
        assert np.hypot(*away.T).min() < 4.0
    assert len(spots(canvas, REFUSED)) == 0
    wrong = dataclasses.replace(draft, findings=Findings(overridable=("in the way",)))
    show(canvas, site, scene_of(draft=wrong))
    assert len(spots(canvas, REFUSED)) > 200


def test_a_draft_of_many_points_is_drawn_once_and_anew_when_the_map_or_the_draft_has_changed(
    canvas, site, monkeypatch
):
    from fleet_supervisor.plugin.map.overlay import task_painter as draft_painting

    drawn, draw = [], draft_painting._drawn
    monkeypatch.setattr(draft_painting, "_drawn", lambda *given: drawn.append(1) or draw(*given))
    places = tuple((10.0 + k, 50.0) for k in range(80))
    draft = PendingCommand("r1", ROUTE, places, legs=(1,) * 80, is_checked=True)
    overlay = show(canvas, site, scene_of(draft=draft))
    placer = SceneTransformer()
    for now in (101.0, 102.0, 103.0):
        overlay.show_scene(placer.placed(scene_of(draft=draft, now=now), placement_of(canvas, site)))
        canvas.grab()
    before = len(drawn)
    placement = placement_of(canvas, site)
    for now in (104.0, 105.0, 106.0):
        overlay.show_scene(placer.placed(scene_of(draft=draft, now=now), placement))
        canvas.grab()
    assert len(drawn) == before + 1
    moved = dataclasses.replace(draft, points=(*places[:-1], (90.0, 60.0)))
    overlay.show_scene(placer.placed(scene_of(draft=moved, now=107.0), placement))
    canvas.grab()
    assert len(drawn) == before + 2


@pytest.mark.parametrize(("points", "least", "most"), [(40, 2.0, 5.0), (400, 2.0, 5.0), (4000, 0.5, 1.5)])
def test_a_way_along_the_roads_is_as_wide_as_one_that_was_drawn_unless_that_takes_long(
    canvas, site, points, least, most
):
    along = tuple((20.0 + 80.0 * k / (points - 1), 50.0) for k in range(points))
    show(canvas, site, scene_of(draft=PendingCommand("r1", ROUTE, along, legs=(points,), is_checked=True)))
    (left, y), (right, _) = expected(canvas, site, 20, 50), expected(canvas, site, 100, 50)
    found = spots(canvas, ROUTE_COLOUR, tolerance=40)
    between = found[(found[:, 0] > left + 10) & (found[:, 0] < right - 10)]
    assert np.abs(between[:, 1] - y).max() < 4.0
    assert least <= len(between) / (right - left - 20) <= most


def test_a_ring_is_at_each_click_and_none_on_the_way_along_the_roads(canvas, site):
    # The rings are white, as an empty canvas is.
    canvas.setCanvasColor(QColor("darkgreen"))
    straight, along = ((20.0, 20.0), (20.0, 50.0)), tuple((20.0 + 2 * k, 50.0) for k in range(1, 31))
    show(
        canvas,
        site,
        scene_of(draft=PendingCommand("r1", ROUTE, straight + along, legs=(1, 1, 30), is_checked=True)),
    )
    rings = spots(canvas, PAPER)
    clicks = [expected(canvas, site, *click) for click in (*straight, along[-1])]
    for click in clicks:
        assert np.hypot(*(rings - click).T).min() < 5.0
    off = np.min([np.hypot(*(rings - click).T) for click in clicks], axis=0)
    assert off.max() < 8.0

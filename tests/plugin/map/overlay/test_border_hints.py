"""Robots beyond the map's border are pointed to."""

from __future__ import annotations

import math

import numpy as np
import pytest
from fleet_supervisor.plugin.map.overlay.labels import Labels
from fleet_supervisor.plugin.map.overlay.scene import SceneTransformer
from fleet_supervisor.plugin.ui.glyphs import SELECTED, STATE_COLOURS, UNSURE_COLOUR
from fleet_supervisor.robot_bridge.core.messages.safety import RobotState
from qgis.PyQt.QtCore import QPointF, QSize
from qgis.PyQt.QtGui import QColor, QImage, QPainter

from tests.plugin.map.on_canvas import expected, placement_of, scene_of, show, spots, where


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


AROUND = (600, 50), (-500, 50), (60, 600), (60, -500)
"""Places beyond each border: right, left, top, bottom."""


def test_each_arrow_has_the_colour_of_its_robots_also_after_others_were_drawn(canvas, site):
    states = [RobotState.LOST, RobotState.OFFLINE, RobotState.FRESH, RobotState.STALE]
    overlay = show(canvas, site, scene_of((*AROUND[0], 0.0, RobotState.FRESH)))
    assert len(spots(canvas, STATE_COLOURS[RobotState.FRESH])) > 10
    for turn in range(4):
        around = [(*at, 0.0, states[(k + turn) % 4]) for k, at in enumerate(AROUND)]
        scene = scene_of(*around, chosen=("r3",), now=101.0 + turn)
        overlay.show_scene(SceneTransformer().placed(scene, placement_of(canvas, site)))
        rims = spots(canvas, SELECTED)
        of_row = {int(hint.rows[0]): hint for hint in overlay._painter.hints}
        assert sorted(of_row) == [0, 1, 2, 3]
        for row, (_, _, _, state) in enumerate(around):
            found = spots(canvas, STATE_COLOURS[state])
            away = np.hypot(*(found - (of_row[row].x, of_row[row].y)).T)
            # The blended rims of all arrows are of that grey, too.
            assert (away < 14).sum() > (40 if state is RobotState.OFFLINE else 10)
            assert state is RobotState.OFFLINE or away.max() < 14
        assert len(rims) > 5 and np.hypot(*(rims - (of_row[2].x, of_row[2].y)).T).max() < 16


@pytest.mark.parametrize("ratio", [1.0, 1.5, 2.0])
def test_beside_an_arrow_is_its_robots_name_or_their_number_letter_for_letter(canvas, site, ratio):
    fresh = RobotState.FRESH
    scene = scene_of(*[(*at, 0.0, fresh) for at in AROUND], (601, 50, 0.0, fresh), (61, 600, 0.0, fresh))
    overlay = show(canvas, site, scene)
    pages = [QImage(QSize(600, 500) * ratio, QImage.Format.Format_RGB32) for _ in range(2)]
    for page in pages:
        page.setDevicePixelRatio(ratio)
        page.fill(QColor("#88aa66"))
    painter = QPainter(pages[0])
    overlay.paint(painter)
    painter.end()
    texts = overlay._painter._borders.texts
    assert sorted(text.text for text in texts) == ["2", "2", "r2", "r4"]
    labels = Labels()
    painter = QPainter(pages[1])
    for text in texts:
        picture = labels.picture(text.text, ratio)
        size = picture.width() / ratio, picture.height() / ratio
        assert (text.right - text.left, text.bottom - text.top) == pytest.approx(size)
        assert text.left >= 0 and text.right <= 600 and text.top >= 0 and text.bottom <= 500
        corner = [math.floor(edge * ratio + 0.5) / ratio for edge in (text.left, text.top)]
        painter.drawPixmap(QPointF(*corner), picture)
    painter.end()
    ink = QColor("#101418")
    written, wanted = (where(page, ink, 0).tolist() for page in pages)
    assert len(wanted) > 20 and written == wanted


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

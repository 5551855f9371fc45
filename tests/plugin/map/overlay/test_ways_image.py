"""Ways of many robots are painted over several frames, and are where they lead all the while."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from fleet_supervisor.plugin import plugin as installed
from fleet_supervisor.plugin.gateway_client.robot_states import RobotStates
from fleet_supervisor.plugin.map.overlay import task_painter
from fleet_supervisor.plugin.map.overlay.robots_painter import drawn
from fleet_supervisor.plugin.map.overlay.scene import MapScene, Screen, SiteScene, TaskPath, screen_image
from fleet_supervisor.plugin.map.overlay.task_painter import MANY, PathsImage
from qgis.PyQt.QtGui import QImage, QPainter

WIDTH, HEIGHT = 200, 100
SCREEN = Screen((100.0, -50.0), (100.0, 50.0), (1.0, 0.0), (0.0, -1.0), WIDTH, HEIGHT)
"""Pixel (x, y) is the map's (x, -y)."""
ASIDE = Screen((90.0, -50.0), (100.0, 50.0), (1.0, 0.0), (0.0, -1.0), WIDTH, HEIGHT)
"""The same, all of it ten pixels to the right."""
NOWHERE = np.empty((0, 2))


class Same:
    """A site frame that is the map's CRS."""

    def to_map(self, xy):
        return xy


SAME = Same()


def placed(*heights, placement=SAME):
    """A scene with a way from left to right at each of these pixels from the top."""
    ways = [np.array([(0.0, -y), (WIDTH, -y)]) for y in heights]
    plans = [TaskPath(f"c{k}", f"r{k}", way, False) for k, way in enumerate(ways)]
    scene = SiteScene(RobotStates().arrays(0.0), plans=plans)
    return MapScene(scene, NOWHERE, NOWHERE, ways, NOWHERE, NOWHERE, placement)


def rows(image, scene, screen=SCREEN, column=100):
    """Paint a frame and return the pixels from the top where it has a way."""
    canvas = QImage(WIDTH, HEIGHT, QImage.Format.Format_RGB32)
    canvas.fill(0)
    painter = QPainter(canvas)
    image.prepare(scene, screen)
    image.paint(painter, screen)
    painter.end()
    return [y for y in range(HEIGHT) if canvas.pixelColor(column, y).red() > 200]


@pytest.fixture
def slow(qgis_app, monkeypatch):
    """A frame in which there is time for one way only."""
    monkeypatch.setattr(task_painter, "FILL_SECONDS", 0.0)


def test_few_ways_are_there_at_once(qgis_app, monkeypatch):
    # As on an idle machine, where painting two ways takes a fraction of it.
    monkeypatch.setattr(task_painter, "FILL_SECONDS", 60.0)
    image = PathsImage()
    assert {20, 60} <= set(rows(image, placed(20, 60)))
    assert image.is_whole


def test_many_ways_are_painted_bit_by_bit(slow):
    image, scene = PathsImage(), placed(*range(10, 10 + MANY + 1))
    seen = [len(rows(image, scene)) for _ in range(MANY + 1)]
    assert seen[0] < seen[MANY // 2] < seen[-1]
    assert image.is_whole


def test_what_was_painted_is_shown_until_the_next_is_whole(slow):
    image, before, after = PathsImage(), placed(20), placed(40, 60)
    first = rows(image, before)
    assert rows(image, after) == first and not image.is_whole
    assert not set(rows(image, after)) & set(first) and image.is_whole


def test_a_sheet_is_filled_to_its_end_however_often_the_ways_change(slow):
    image = PathsImage()
    frames = [rows(image, placed(*range(20, 24), 60 + number)) for number in range(5)]
    # The first sheet is as the first frame had it.
    assert {20, 60} <= set(frames[4]) and 64 not in frames[4]


def test_ways_move_along_with_the_view_and_are_painted_anew_for_it(slow):
    image, scene = PathsImage(), placed(20, 60)
    rows(image, scene), rows(image, scene)
    assert rows(image, scene, ASIDE, column=5) == [] and not image.is_whole
    rows(image, scene, ASIDE)
    assert image.is_whole
    assert {20, 60} <= set(rows(image, scene, ASIDE, column=WIDTH - 5))


def test_a_sheet_that_the_view_has_moved_on_from_is_not_the_last(slow):
    image, scene = PathsImage(), placed(20, 60)
    rows(image, scene)
    rows(image, scene, ASIDE)
    assert not image.is_whole, "the sheet is full, and of another view"
    rows(image, scene, ASIDE), rows(image, scene, ASIDE)
    assert image.is_whole


def test_ways_of_another_map_are_not_shown_on_this_one(slow):
    image = PathsImage()
    rows(image, placed(20))
    shown = rows(image, placed(40, 60, placement=Same()))
    assert 20 not in shown and len(shown) > 0


def test_without_ways_nothing_is_kept(qgis_app):
    image, scene = PathsImage(), placed(20)
    rows(image, scene)
    assert rows(image, placed()) == []
    assert image._shown.image is None


def fill(draw):
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(task_painter, "route", lambda painter, *_: draw(painter))
        PathsImage().prepare(placed(20), SCREEN)


@pytest.mark.parametrize(
    "paint", [fill, lambda draw: screen_image(SCREEN, draw), lambda draw: drawn(draw, 32, 1.0)]
)
def test_a_painter_is_ended_where_painting_fails(qgis_app, paint):
    """Kept by the traceback it would outlive its image, for which Qt ends the program."""
    painters = []

    def fail(painter):
        painters.append(painter)
        raise ValueError("no such colour")

    with pytest.raises(ValueError, match="no such colour"):
        paint(fail)
    assert [painter.isActive() for painter in painters] == [False]


def test_every_painter_is_one_that_is_ended():
    folder = Path(installed.__file__).parent
    made = [path.name for path in folder.rglob("*.py") if "QPainter(" in path.read_text("utf-8")]
    assert made == ["glyphs.py"]

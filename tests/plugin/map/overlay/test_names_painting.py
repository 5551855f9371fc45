"""Which robots have their names written beside them, and what else stands there."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from fleet_supervisor.plugin.map.overlay.labels import MOST_LINES, Labels, TextAtlas
from fleet_supervisor.plugin.map.overlay.robots_painter import pixels_of
from fleet_supervisor.plugin.map.overlay.scene import in_view
from fleet_supervisor.robot_bridge.core.messages.safety import RobotState
from qgis.PyQt.QtCore import QPointF, QRectF
from qgis.PyQt.QtGui import QColor, QImage, QPainter

from tests.plugin.map.on_canvas import arrays, scene_of, show


def test_the_names_of_a_crowd_do_not_cover_each_other_and_the_lost_are_named_first(canvas, site):
    from fleet_supervisor.plugin.map.overlay.labels import BESIDE, HEIGHT, NamesPainter

    spread = np.random.default_rng(3).uniform(5, 95, (200, 2)).tolist()
    crowd = [(x, y, 0.0, RobotState.FRESH) for x, y in spread]
    scene = scene_of(*crowd, (51, 51, 0.0, RobotState.LOST), age=75.0)
    overlay = show(canvas, site, scene)
    names = NamesPainter()
    screen = overlay.screen()
    pixels = screen.pixels(overlay._placed.robots)
    chosen = names._chosen(overlay._placed, in_view(overlay._placed, screen), screen)
    assert chosen[0] == 200
    assert 20 < len(chosen) < 200
    boxes = [QRectF(*(pixels[row] + BESIDE), 8 * len(f"r{row + 1}"), HEIGHT - 1) for row in chosen[1:]]
    assert not [1 for k, box in enumerate(boxes) for other in boxes[:k] if box.intersects(other)]


def test_the_age_of_the_last_message_is_written_beside_a_lost_robot(qgis_app):
    from fleet_supervisor.plugin.map.overlay.labels import texts

    known = arrays((0, 0, 0, RobotState.LOST), (1, 1, 0, RobotState.FRESH), age=75.0)
    assert texts(known, 0) == ["r1", "· lost 1 min"]
    assert texts(known, 1) == ["r2"]
    known.doubted[:] = True
    assert texts(known, 0) == ["r1", "· lost 1 min"]
    # How it is shown is looked up once for each moment.
    assert texts(dataclasses.replace(known), 1) == ["r2", "· unsure"]


def written_after(canvas, site, first, second):
    """Return what is written beside robots, painted as ``first`` and then as ``second``."""
    from fleet_supervisor.plugin.map.overlay.labels import NamesPainter

    names = NamesPainter()
    image = QImage(canvas.size(), QImage.Format.Format_ARGB32_Premultiplied)
    for scene in (first, second):
        overlay = show(canvas, site, scene)
        screen = overlay.screen()
        painter = QPainter(image)
        names.paint(painter, overlay._placed, in_view(overlay._placed, screen), screen)
        painter.end()
    return names._written


def test_what_is_written_follows_what_becomes_of_a_robot(canvas, site):
    fresh = scene_of((60, 50, 0.0, RobotState.FRESH))
    lost = (60, 50, 0.0, RobotState.LOST)
    later = scene_of(lost, age=75.0, now=100.3)
    assert written_after(canvas, site, fresh, later) == [["r1", "· lost 1 min"]]


def test_of_two_at_one_place_the_live_one_is_named(canvas, site):
    off, live = (60, 50, 0.0, RobotState.OFFLINE), (60, 50, 0.0, RobotState.FRESH)
    assert written_after(canvas, site, scene_of(off), scene_of(off, live, now=100.3)) == [["r2"]]


def test_what_is_written_beside_a_robot_is_never_that_of_another(canvas, site):
    two = scene_of((60, 50, 0.0, RobotState.FRESH), (20, 20, 0.0, RobotState.FRESH))
    others = scene_of((60, 50, 0.0, RobotState.FRESH), now=100.01)
    assert written_after(canvas, site, two, others) == [["r1"]]
    renamed = dataclasses.replace(two.robots, names=["a", "b"])
    written = written_after(canvas, site, two, dataclasses.replace(two, robots=renamed))
    assert sorted(written) == [["a"], ["b"]]


@pytest.mark.parametrize("ratio", [1.0, 2.0])
def test_names_look_as_if_each_were_painted_by_itself_also_after_there_was_no_room(qgis_app, ratio):
    atlas, labels = TextAtlas(ratio), Labels()
    long = "a robot whose name is far longer than one line of the picture is wide"
    shown = ["robot-1", "· lost 5 min", long]
    for k in range(2 * MOST_LINES):
        atlas.provide([*shown, f"others {k}"], [shown])
    assert all(text in atlas for text in shown) and "others 0" not in atlas
    images = [QImage(round(600 * ratio), round(120 * ratio), QImage.Format.Format_RGB32) for _ in range(2)]
    for image in images:
        image.setDevicePixelRatio(ratio)
        image.fill(QColor("#88AA66"))
    corners = np.array([[10.3, 5.0], [20.0, 30.6], [7.7, 60.2]])
    painter = QPainter(images[0])
    for corner, text in zip(corners.tolist(), shown, strict=True):
        painter.drawPixmap(QPointF(*corner), labels.picture(text, ratio))
    painter.end()
    written = [atlas.written(text).parts for text in shown]
    painter = QPainter(images[1])
    of = np.repeat(np.arange(3), [len(parts) for parts in written])
    atlas.paint(painter, corners[of], np.array([part for parts in written for part in parts], dtype=float))
    painter.end()
    assert len(written[2]) > 1
    first, second = (pixels_of(image).view(np.uint8).astype(int) for image in images)
    differing = np.abs(first - second)
    assert (differing[: round(58 * ratio)] == 0).all()
    # The parts of a long text begin at whole pixels, its letters do not: some are a shade softer.
    assert differing.max() < 60 and (differing > 0).mean() < 0.002

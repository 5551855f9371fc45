"""What the live map keeps has an end, however long it runs and whoever comes and goes."""

from __future__ import annotations

import dataclasses
from types import SimpleNamespace

import pytest
from fleet_supervisor.plugin.gateway_client.robot_states import STATES
from fleet_supervisor.plugin.map.overlay.labels import HEIGHT, MOST, MOST_LINES
from fleet_supervisor.plugin.map.overlay.scene import SceneTransformer
from fleet_supervisor.robot_bridge.core.messages.safety import RobotState
from qgis.core import QgsCoordinateReferenceSystem, QgsProject, QgsRectangle
from qgis.PyQt.QtGui import QImage, QPainter
from qgis.PyQt.QtWidgets import QApplication

from tests.plugin.map.on_canvas import placement_of, plan, scene_of, show


@pytest.fixture
def painted(canvas, site):
    """Return a function that paints a scene and returns the painter with all that it keeps."""
    overlay = show(canvas, site, scene_of((60, 50, 0.0, RobotState.FRESH)))
    image = QImage(canvas.size(), QImage.Format.Format_ARGB32_Premultiplied)
    placer, placement = SceneTransformer(), placement_of(canvas, site)

    def paint(scene):
        overlay.show_scene(placer.placed(scene, placement))
        painter = QPainter(image)
        overlay.paint(painter)
        painter.end()
        return overlay._painter

    return paint


def crowd(first, now, robots=50):
    """Robots of names that nobody had before, some of them stale or lost, some beyond the border."""
    states = [STATES[k % len(STATES)] for k in range(robots)]
    places = [(6.0 * (k % 25), 15.0 + 40.0 * (k // 25)) for k in range(robots)]
    scene = scene_of(
        *((*at, 0.1 * k, state) for k, (at, state) in enumerate(zip(places, states, strict=True)))
    )
    names = [f"robot {first + k}" for k in range(robots)]
    robots = dataclasses.replace(scene.robots, names=names, age=scene.robots.age + first % 3600)
    return dataclasses.replace(scene, robots=robots, now=now, rows={})


def test_pictures_of_names_have_an_end_though_ten_thousand_robots_come_and_go(painted):
    made, heights = [], []
    for number in range(200):
        kept = painted(crowd(50 * number, 100.0 + number))
        atlases = kept._names._atlas, kept._borders._written
        made += [len(atlas._texts) for atlas in atlases]
        heights += [atlas._picture.height() for atlas in atlases]
    assert max(made) <= 2 * MOST_LINES
    assert max(heights) <= MOST_LINES * HEIGHT
    assert "robot 0" not in kept._names._atlas
    assert any(text.startswith("robot 99") for text in kept._names._atlas._texts), "the newest are there"
    assert len(kept._names._parts) < 200 and len(kept._names._waiting) <= 50
    assert len(kept._labels._pictures) <= MOST
    assert 0 < len(kept._borders._drawings) <= 2 * len(STATES)
    assert len(kept._borders._written._texts) > 0


def test_drawings_are_kept_of_one_magnification_only(painted):
    scene = crowd(0, 100.0)
    for step in range(30):
        kept = painted(scene)
        kept.robots.magnification = 0.5 + step / 10
    assert painted(scene) is kept
    assert len(kept.robots._drawings) <= 3 * len(STATES)
    assert len(kept.robots._marks) == 1


def test_plans_and_ways_are_kept_of_what_is_under_way_only(painted):
    for number in range(30):
        ways = [plan(f"r{number}-{k}", (10.0, 10.0 + k), (90.0, 10.0 + k)) for k in range(70)]
        kept = painted(dataclasses.replace(crowd(0, 100.0 + number), plans=ways))
    assert len(kept._plans._ends) == 70
    kept = painted(crowd(0, 200.0))
    assert kept._plans._ways._shown is None and kept._plans._ways._next is None


def test_an_hour_of_updates_takes_no_more_memory(canvas, site):
    from pathlib import Path

    from fleet_supervisor.plugin.control.fleet_controller import FleetController
    from fleet_supervisor.plugin.gateway_client.robot_states import table_from_rows
    from fleet_supervisor.plugin.map.live_view import LiveView

    now = [1000.0]
    canvas.setDestinationCrs(QgsCoordinateReferenceSystem("EPSG:32633"))
    canvas.setExtent(QgsRectangle(*site.origin, site.origin[0] + 120, site.origin[1] + 100))
    desk = FleetController(canvas, QgsProject.instance(), clock=SimpleNamespace(steady=lambda: now[0]))
    view = LiveView(desk)
    desk.state.merge_site(site, "")
    used = []
    for step in range(300):
        now[0] += 12.0
        told = [
            {
                "robot": f"r{k}",
                "state": "fresh",
                "age": 0.1 if k % 9 else 6.0 * step,
                "link": "sql",
                "x": (k * 7 + step) % 120,
                "y": k % 100,
                "theta": step / 9,
                "v": 1.0,
                # Of some: to draw a large circle takes as long as all else of a robot.
                "accuracy": 0.5 + k % 5 if k % 10 == 0 else None,
            }
            for k in range(100)
        ]
        desk.state.robots.merge(table_from_rows(told, now[0]))
        view.show_now()
        canvas.viewport().repaint()
        view.layer.begin(100)
        view.layer.go_on(desk.state.robots, now[0])
        if step % 25 == 24:
            # What QGIS takes to draw the map at all is not to be counted later, when a slow one is finished.
            canvas.refresh()
            QApplication.processEvents()
            canvas.waitWhileRendering()
            QApplication.processEvents()
            used.append(int(Path("/proc/self/statm").read_text().split()[1]) * 4096 / 1e6)
    view.remove()
    desk.shut_down()
    # A quarter of the updates may take a quarter of what an update each three seconds would.
    assert used[-1] - used[3] < 1.5

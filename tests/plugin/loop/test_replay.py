"""A real drive, stored by a real gateway, and played on a map beside the live one."""

from __future__ import annotations

import contextlib
import sqlite3
import time

import numpy as np
import pytest
from fleet_supervisor.plugin.replay.time_controls import ReplayClock
from fleet_supervisor.robot_bridge.core.messages.commands import CommandState
from qgis.core import QgsProject, QgsTemporalNavigationObject
from qgis.gui import QgsMapCanvas, QgsTemporalControllerWidget
from qgis.PyQt.QtCore import QPoint, Qt
from qgis.PyQt.QtTest import QTest

from tests.plugin.loop.conftest import Loop
from tests.support.operators import ask
from tests.support.patience import BUSY
from tests.support.processes import Processes

LAYER = "Trajectories (replay)"


@pytest.fixture
def dock(plugin, iface):
    """The panel, opened as an operator opens it, over a canvas with QGIS's temporal controller."""
    next(action for action in iface.plugins.actions() if action.objectName() == "fleet_replay").trigger()
    return iface.findChild(object, "fleet_replay_dock")


@pytest.fixture(scope="module")
def drive(tmp_path_factory, root):
    """A gateway at which r1 has driven 20 m to a target while r2 stood, and when that began.

    One for all: what is replayed is not changed by that.
    """
    folder = tmp_path_factory.mktemp("drive")
    with Processes(folder / "logs") as processes:
        loop = Loop(processes, root / "resources" / "sample_site", folder)
        loop.start_gateway()
        loop.start_robot("r1", (20, 8, 0))
        loop.start_robot("r2", (20, 84, 0))
        until(lambda: len(asked(loop, "get_positions")["robots"]) == 2)
        # There is something to show a pixel of the time line before the command, too.
        until(lambda: (first := stored(loop, "min", "r1")) and first < time.time() - 2)
        began = time.time()
        cone = {"x": 40.0, "y": 8.0, "cone": True}
        asked(loop, "send", command="first-drive", robot="r1", op="SetPosEnd", params=cone)
        until(lambda: asked(loop, "get_commands", robot="r1")["commands"][0]["state"] == "reached")
        # The gateway stores once a second.
        ended = time.time()
        until(lambda: all((last := stored(loop, "max", name)) and last > ended for name in ("r1", "r2")))
        yield loop, began


def asked(loop, method, **params):
    (answer,) = ask(loop.address, (method, params))
    return answer


def stored(loop, which, robot):
    """When the first (min) or last (max) of the robot's positions in the database came; None without any."""
    with contextlib.closing(sqlite3.connect(loop.file)) as database:
        found = f"select {which}(received_at) from trajectories where robot = ?"
        return database.execute(found, (robot,)).fetchone()[0]


def until(true, seconds=60):
    end = time.monotonic() + BUSY * seconds
    while not true():
        assert time.monotonic() < end
        time.sleep(0.1)


@pytest.fixture
def driven(drive, operator, dock):
    """The desk at the gateway of that drive; r2 is selected. When the drive began."""
    loop, began = drive
    operator.connect_to(loop, ["r1", "r2"])
    operator.wait("the commands", lambda: operator.sent_to("r1"), 15)
    operator.select("r2")
    return began


def click(widget, at=None):
    at = QPoint() if at is None else at
    QTest.mouseClick(widget, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier, at)


def load(dock, operator):
    click(dock.form.load)
    operator.wait("the positions", lambda: not dock.is_busy and len(dock.fetching.history), 10)


def shown(dock, robot):
    """Where the replay's map shows a robot, in metres of the site; None where it shows none."""
    placed = dock.map.overlay._placed
    at = placed.scene.robots.xy[placed.scene.robots.names.index(robot)]
    return None if np.isnan(at).any() else at.tolist()


def go_to(dock, moment):
    """Click a moment on the time line."""
    click(dock.line, QPoint(round(dock.line.pixel(moment)), dock.line.height() // 2))


def step(operator, robot, state):
    (command,) = [c for c in operator.sent_to(robot) if c.op == "SetPosEnd"]
    return next(one.at for one in command.steps if one.state is state)


def test_a_drive_is_played_while_the_live_map_goes_on(driven, dock, operator):
    load(dock, operator)
    sent, reached = (step(operator, "r1", s) for s in (CommandState.QUEUED, CommandState.REACHED))
    # A pixel of the time line is most of a second, a frame a fifth of one.
    coarse = 300 / dock.line.width() + 0.3
    # Not after it: within that time the robot has driven half a metre.
    before = sent - coarse
    go_to(dock, before)
    assert abs(dock.clockwork.moment - before) < coarse
    assert shown(dock, "r1") == pytest.approx([20, 8], abs=0.5)
    go_to(dock, (sent + reached) / 2)
    x, _ = shown(dock, "r1")
    assert 21 < x < 39
    # The target that it was driving to is there, as then.
    assert [plan.robot for plan in dock.map.overlay._placed.scene.plans] == ["r1"]
    go_to(dock, reached + 1.5)
    assert shown(dock, "r1") == pytest.approx([40, 8], abs=0.5)
    assert dock.map.overlay._placed.scene.plans == []
    # The live robot is where it is, and is heard of.
    assert operator.report("r1").x == pytest.approx(40, abs=0.5)
    assert operator.desk.state.link.phase.value == "connected"
    assert "not live" in dock.banner.text()
    # All that was driven is in view, by its pixels.
    placed = dock.map.overlay._placed
    pixels = dock.map.overlay.screen().pixels(placed.robots)
    assert (pixels > 0).all() and (pixels < [dock.map.width(), dock.map.height()]).all()


def test_time_goes_on_by_qgis_controller_and_is_held(driven, dock, operator):
    load(dock, operator)
    go_to(dock, driven)
    controller = dock.clockwork.controller
    click(dock.play)
    before = dock.clockwork.moment
    operator.wait("two seconds", lambda: dock.clockwork.moment > before + 2, 10)
    click(dock.play)
    assert controller.animationState() == QgsTemporalNavigationObject.AnimationState.Idle
    held = dock.clockwork.moment
    QTest.qWait(500)
    assert dock.clockwork.moment == held
    # Who works the controller itself works the replay.
    controller.setCurrentFrameNumber(controller.totalFrameCount() // 2)
    assert dock.clockwork.moment == pytest.approx((dock.clockwork.since + dock.clockwork.until) / 2, abs=1)
    dock.speed.setCurrentIndex(dock.speed.findText("× 10"))
    here = dock.clockwork.moment
    controller.next()
    assert dock.clockwork.moment == pytest.approx(here + 2, abs=2.1)


def test_keys_on_the_time_line(driven, dock, operator):
    load(dock, operator)
    go_to(dock, driven)
    dock.line.setFocus()
    here = dock.clockwork.moment
    QTest.keyClick(dock.line, Qt.Key.Key_Right, Qt.KeyboardModifier.ShiftModifier)
    assert dock.clockwork.moment == pytest.approx(min(here + 10, dock.clockwork.until), abs=0.3)
    QTest.keyClick(dock.line, Qt.Key.Key_Home)
    assert dock.clockwork.moment == dock.clockwork.since
    QTest.keyClick(dock.line, Qt.Key.Key_End)
    assert dock.clockwork.moment == pytest.approx(dock.clockwork.until, abs=0.3)
    QTest.keyClick(dock.line, Qt.Key.Key_Space)
    assert dock.clockwork.is_playing
    QTest.keyClick(dock.line, Qt.Key.Key_Space)
    assert not dock.clockwork.is_playing
    # Elsewhere Space is what it is everywhere: it presses the button that has the keyboard.
    assert dock.play.shortcut().isEmpty()


def test_commands_are_marks_on_the_time_line(driven, dock, operator):
    load(dock, operator)
    states = [mark.state for mark in dock.line.marks]
    assert states == [CommandState.QUEUED, CommandState.REACHED]
    mark = dock.line.mark_at(dock.line.pixel(step(operator, "r1", CommandState.QUEUED)))
    assert mark.text.startswith("r1: cone at ")


def test_the_layer_has_lines_with_times_for_the_controller(driven, dock, operator):
    load(dock, operator)
    (layer,) = QgsProject.instance().mapLayersByName(LAYER)
    assert layer.temporalProperties().isActive()
    lines = [f for f in layer.getFeatures() if f["robot"] == "r1"]
    assert sum(f["length_m"] for f in lines) == pytest.approx(20, abs=1.5)
    # Lines of what was driven up to a moment are chosen as QGIS chooses them for its canvas.
    begins = [f["begin"].toMSecsSinceEpoch() / 1000 for f in lines]
    assert min(begins) < step(operator, "r1", CommandState.QUEUED) + 1
    assert max(f["length_m"] / f["mean_speed"] for f in lines if f["mean_speed"] > 0.1) <= 15.0
    # What is live is not on the replay's map, whatever the live map shows.
    live = QgsProject.instance().mapLayersByName("Robots (live)")
    operator.canvas.setLayers([*live, layer])
    assert len(operator.canvas.layers()) == 2
    assert [one.name() for one in dock.map.layers()] == [LAYER]


def test_the_controller_of_qgis_own_panel_is_used(qgis_app):
    panel, canvas = QgsTemporalControllerWidget(), QgsMapCanvas()
    canvas.setTemporalController(panel.temporalController())
    clockwork = ReplayClock(canvas)
    clockwork.show(1_790_000_000.0, 1_790_000_060.0)
    controller = panel.temporalController()
    assert controller.navigationMode() == QgsTemporalNavigationObject.NavigationMode.Animated
    assert controller.temporalExtents().begin().toMSecsSinceEpoch() == 1_790_000_000_000
    controller.setCurrentFrameNumber(50)
    assert clockwork.moment == 1_790_000_010.0
    clockwork.remove()
    assert controller.navigationMode() == QgsTemporalNavigationObject.NavigationMode.NavigationOff


def test_only_selected_robots(driven, dock, operator):
    click(dock.form.selected)
    load(dock, operator)
    assert dock.fetching.history.names == ["r2"]


def test_what_cannot_be_loaded_is_said(driven, dock, operator):
    said = []
    operator.desk.messages.posted.connect(lambda text, _: said.append(text))
    dock.form.since.setDateTime(dock.form.until.dateTime().addSecs(60))
    click(dock.form.load)
    assert "ends before it begins" in said[-1]
    operator.desk.close_link()
    dock.form.last.setCurrentIndex(0)
    click(dock.form.load)
    assert "was not loaded" in said[-1]


def test_nothing_is_left_after_unload(driven, dock, operator, plugin):
    load(dock, operator)
    click(dock.play)
    plugin.unload()
    assert not QgsProject.instance().mapLayersByName(LAYER)
    QTest.qWait(300)

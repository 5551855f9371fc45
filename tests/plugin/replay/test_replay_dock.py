"""The panel of the replay at a small gateway; a real drive is played in ``loop/test_replay.py``."""

from __future__ import annotations

import itertools
import time
from itertools import groupby, pairwise

import numpy as np
import pytest
from fleet_supervisor.plugin.map.overlay import task_painter
from fleet_supervisor.plugin.replay import replay_map
from fleet_supervisor.plugin.replay.history import History
from fleet_supervisor.plugin.ui import scheduling
from fleet_supervisor.plugin.ui.errors import MapTransformError
from qgis.core import QgsCoordinateReferenceSystem, QgsPointXY, QgsProject
from qgis.gui import QgsLayerTreeMapCanvasBridge
from qgis.PyQt import sip
from qgis.PyQt.QtCore import QTimer
from qgis.PyQt.QtWidgets import QApplication

from tests.support.left_behind import slots_that_hold

LAYER = "Trajectories (replay)"
LOW = 375
"""Pixels that the panel has above QGIS's layers on a screen of 800."""


@pytest.fixture
def loaded(at_desk, gateway, iface, wait):
    """The panel with ten seconds of r1's way."""
    now = time.time()
    gateway._clock = itertools.count(round(now) - 15)
    at_desk.desk.orders.abort("r1")
    wait(lambda: len(at_desk.desk.state.commands), what="the abort")
    places = [["r1", now - 20 + k, 50.0 + k, 40.0, 0.0, 1.0, None, None] for k in range(10)]
    gateway.answers["get_trajectory"] = lambda params: {"result": {"places": places, "next": None}}
    next(action for action in iface.plugins.actions() if action.objectName() == "fleet_replay").trigger()
    dock = iface.findChild(object, "fleet_replay_dock")
    dock.form.load.click()
    wait(lambda: not dock.is_busy and len(dock.fetching.history) == 10, what="the positions")
    wait(lambda: dock.line.marks, what="the mark of the abort")
    return dock


def lines():
    return QgsProject.instance().mapLayersByName(LAYER)


def test_where_the_panel_is_low_and_narrow_the_map_gives_way_to_the_time_line(loaded):
    loaded.setFloating(True)
    loaded.resize(265, LOW)
    QApplication.processEvents()
    assert loaded.height() == LOW
    assert loaded.map.geometry().bottom() < loaded.line.geometry().top()
    assert loaded.line.geometry().bottom() <= loaded.widget().height()


def test_what_was_driven_is_on_the_replays_map_and_not_on_the_live_one(loaded, iface):
    bridge = QgsLayerTreeMapCanvasBridge(QgsProject.instance().layerTreeRoot(), iface.canvas)
    bridge.setCanvasLayers()
    (layer,) = lines()
    assert layer not in iface.canvas.layers()
    assert layer in loaded.map.layers()
    loaded.layer.clear()
    assert loaded.map.layers() == []


def test_the_map_turns_with_the_live_one(loaded, at_desk):
    at_desk.desk.canvas.setRotation(30.0)
    assert loaded.map.rotation() == 30.0


def test_one_robot_without_a_place_on_the_map_does_not_keep_the_others_from_being_shown(loaded, at_desk):
    at_desk.desk.canvas.setDestinationCrs(QgsCoordinateReferenceSystem("EPSG:4326"))
    history = History()
    history.add(
        [[name, k, x + k, 40.0, 0.0, 1.0] for name, x in (("r1", 50), ("far", 1e9)) for k in range(3)]
    )
    loaded.map.show_all(history)
    seen, corner = (
        loaded.map.extent(),
        at_desk.desk.site_to_canvas.transform().to_map(np.array([[51.0, 40.0]])),
    )
    assert seen.contains(QgsPointXY(*corner[0].tolist())) and seen.width() < 0.01
    nowhere = History()
    nowhere.add([["far", 1, 1e9, 40.0, 0.0, 1.0]])
    with pytest.raises(MapTransformError, match="has no place in"):
        loaded.map.show_all(nowhere)


def test_all_that_was_driven_is_shown_on_a_map_that_is_turned(loaded, at_desk):
    history = History()
    history.add([["r1", k, 50.0 + 20 * k, 40.0 + 20 * k, 0.0, 1.0] for k in range(3)])
    at_desk.desk.canvas.setRotation(45.0)
    loaded.map.show_all(history)
    ends = at_desk.desk.site_to_canvas.transform().to_map(np.array([[50.0, 40.0], [90.0, 80.0]]))
    pixels = loaded.map.overlay.screen().pixels(ends)
    assert (pixels >= 0).all() and (pixels <= [loaded.map.width(), loaded.map.height()]).all()


def test_another_gateway_of_the_same_site_is_not_shown_the_history_of_the_one_before(
    loaded, at_desk, gateway, site, make_robot, wait
):
    assert lines()
    other = type(gateway)(site)
    other.start()
    try:
        other.show(make_robot("r1", 20, 20))
        at_desk.desk.open_link(other.url, "anna")
        wait(
            lambda: at_desk.desk.state.robots.arrays(0.0).xy.tolist() == [[20, 20]],
            what="the other gateway's r1",
        )
        assert len(loaded.fetching.history) == 0
        assert not lines()
        assert loaded.line.until == 0.0 and not loaded.line.marks
        assert "Choose a time" in loaded.banner.text()
    finally:
        at_desk.desk.close_link()
        other.stop()


def test_the_same_gateway_again_takes_no_history_away(loaded, at_desk, gateway, wait):
    at_desk.desk.close_link()
    wait(lambda: at_desk.desk.state.link.phase.value == "closed")
    at_desk.desk.open_link(gateway.url, "anna")
    wait(lambda: at_desk.desk.state.link.phase.value == "connected")
    assert len(loaded.fetching.history) == 10 and lines()


def test_what_came_is_shown_part_by_part_and_the_window_looks_for_events_in_between(
    loaded, wait, monkeypatch
):
    told = []
    shows = {loaded.layer: "show", loaded.map: "show_all", loaded.line: "show_marks"}
    for part, show in shows.items():
        done = getattr(part, show)
        monkeypatch.setattr(part, show, lambda *a, done=done, show=show: (told.append(show), done(*a)))
    events = QTimer()
    events.timeout.connect(lambda: told.append("events"))
    events.start(0)
    loaded.fetching.ended.emit("")
    assert told == []
    wait(lambda: "show_marks" in told, what="the marks")
    events.stop()
    parts = [name for name, _ in groupby(told)]
    assert [name for name in parts if name != "events"] == list(shows.values())
    assert all("events" in pair for pair in pairwise(parts))


def test_of_a_history_that_is_fetched_anew_nothing_more_is_shown(loaded, wait):
    assert not loaded.is_busy
    loaded.fetching.ended.emit("")
    assert loaded.is_busy
    loaded.load()
    assert not loaded._showing.is_busy
    wait(lambda: not loaded.is_busy, what="the new one")
    assert len(loaded.fetching.history) == 10 and lines()


def test_what_is_put_in_order_may_be_let_go_of_before_it_is(loaded, wait):
    loaded.fetching._end("")
    assert not slots_that_hold(loaded.fetching._task), "let go of, the task may crash QGIS when it ends"
    loaded.load()
    wait(lambda: not loaded.is_busy, what="the new one")
    assert len(loaded.fetching.history) == 10


def test_while_time_is_held_the_map_goes_on_until_it_is_whole_and_follows_its_view(
    loaded, at_desk, gateway, wait, monkeypatch
):
    """Of many ways some are drawn in each frame; a moment that is held has no other frame."""
    monkeypatch.setattr(task_painter, "FILL_SECONDS", 0.0)
    begun = loaded.clockwork.since
    for k in range(4):
        path = {"points": [[10.0, 20.0 * k], [90.0, 20.0 * k]]}
        steps = [{"state": "queued", "at": begun + 6.0, "by": "anna"}]
        known = {"command": f"p{k}", "robot": f"w{k}", "op": "SetPath", "params": path, "operator": "anna"}
        gateway.tell("command", {**known, "state": "queued", "steps": steps})
    wait(lambda: "p3" in at_desk.desk.state.commands and not loaded.is_busy, what="the commands")
    ways = loaded.map.overlay._painter._plans._ways
    loaded.clockwork.seek(begun + 12.0)
    assert not loaded.map.overlay.is_whole
    wait(lambda: loaded.map.overlay.is_whole, what="all ways")
    loaded.map.zoomByFactor(0.5)
    wait(lambda: ways._shown.screen == loaded.map.overlay.screen(), what="the ways in the new view")
    wait(lambda: loaded.map.overlay.is_whole, what="all ways in the new view")


def test_a_command_that_comes_late_is_shown_while_time_is_held(loaded, gateway, wait):
    begun = loaded.clockwork.since
    loaded.clockwork.seek(begun + 12.0)
    plans = loaded.map._plans
    assert [plan.robot for plan in plans.of(plans._tasks)] == []
    steps = [{"state": "queued", "at": begun, "by": "anna"}]
    known = {"command": "p", "robot": "w", "op": "SetPosEnd", "params": {"x": 9.0, "y": 9.0}}
    gateway.tell("command", {**known, "operator": "anna", "state": "queued", "steps": steps})
    wait(lambda: [plan.robot for plan in loaded.map._plans.of(loaded.map._plans._tasks)] == ["w"])


def test_lines_that_are_shown_no_more_are_given_back_bit_by_bit(loaded, monkeypatch, wait):
    monkeypatch.setattr(replay_map, "AT_ONCE", 1)
    monkeypatch.setattr(scheduling, "SLICE_SECONDS", scheduling.ONE_STEP)
    # Each step is seen by itself, however busy the machine is.
    loaded.layer._freeing._timer.setInterval(1000)
    (layer,) = lines()
    count = layer.featureCount()
    assert count > 1
    loaded.layer.clear()
    assert lines() == [] and layer.featureCount() == count
    wait(lambda: layer.featureCount() < count, what="the first line")
    assert layer.featureCount() == count - 1
    wait(lambda: sip.isdeleted(layer), what="the last line")


def test_of_what_is_removed_nothing_is_left_to_be_done(loaded):
    (layer,) = lines()
    loaded.layer.remove()
    assert lines() == [] and sip.isdeleted(layer)


def test_a_replay_of_selected_robots_has_their_marks_alone(loaded, at_desk, gateway, wait):
    at_desk.desk.orders.abort("r2")
    wait(lambda: {mark.command.robot for mark in loaded.line.marks} == {"r1", "r2"}, what="both aborts")
    at_desk.desk.selection.select("r2")
    loaded.form.selected.setChecked(True)
    loaded.form.load.click()
    wait(lambda: not loaded.is_busy and loaded.line.marks, what="the replay")
    assert {mark.command.robot for mark in loaded.line.marks} == {"r2"}

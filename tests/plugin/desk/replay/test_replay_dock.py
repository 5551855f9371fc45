"""The panel of the replay at a small gateway; a real drive is played in ``loop/test_replay.py``."""

from __future__ import annotations

import itertools
import time
from itertools import groupby, pairwise

import pytest
from fleet_supervisor.plugin.desk.live import ways_image
from qgis.core import QgsProject
from qgis.PyQt.QtCore import QTimer
from qgis.PyQt.QtWidgets import QApplication

LAYER = "Trajectories (replay)"
LOW = 375
"""Pixels that the panel has above QGIS's layers on a screen of 800."""


@pytest.fixture
def loaded(at_desk, gateway, iface, wait):
    """The panel with ten seconds of r1's way."""
    now = time.time()
    gateway._clock = itertools.count(round(now) - 15)
    at_desk.desk.orders.abort("r1")
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


def test_the_map_turns_with_the_live_one(loaded, at_desk):
    at_desk.desk.canvas.setRotation(30.0)
    assert loaded.map.rotation() == 30.0


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
            lambda: at_desk.desk.picture.arrays(0.0).xy.tolist() == [[20, 20]], what="the other gateway's r1"
        )
        assert len(loaded.fetching.history) == 0
        assert not lines()
        assert loaded.line.until == 0.0 and loaded.line.marks == []
        assert "Choose a time" in loaded.banner.text()
    finally:
        at_desk.desk.close_link()
        other.stop()


def test_the_same_gateway_again_takes_no_history_away(loaded, at_desk, gateway, wait):
    at_desk.desk.close_link()
    wait(lambda: at_desk.desk.link.phase.value == "closed")
    at_desk.desk.open_link(gateway.url, "anna")
    wait(lambda: at_desk.desk.link.phase.value == "connected")
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
    assert loaded._left == []
    wait(lambda: not loaded.is_busy, what="the new one")
    assert len(loaded.fetching.history) == 10 and lines()


def test_while_time_is_held_the_map_goes_on_until_it_is_whole_and_follows_its_view(
    loaded, at_desk, gateway, wait, monkeypatch
):
    """Of many ways some are drawn in each frame; a moment that is held has no other frame."""
    monkeypatch.setattr(ways_image, "FILL_SECONDS", 0.0)
    begun = loaded.clockwork.since
    for k in range(4):
        path = {"points": [[10.0, 20.0 * k], [90.0, 20.0 * k]]}
        steps = [{"state": "queued", "at": begun, "by": "anna"}]
        known = {"command": f"p{k}", "robot": f"w{k}", "op": "SetPath", "params": path, "operator": "anna"}
        gateway.tell("command", {**known, "state": "queued", "steps": steps})
    wait(lambda: "p3" in at_desk.desk.book, what="the commands")
    ways = loaded.map.overlay._painter._plans._ways
    loaded.clockwork.seek(begun + 12.0)
    assert not loaded.map.overlay.is_whole
    wait(lambda: loaded.map.overlay.is_whole, what="all ways")
    loaded.map.zoomByFactor(0.5)
    wait(lambda: ways._shown.screen == loaded.map.overlay.screen(), what="the ways in the new view")
    wait(lambda: loaded.map.overlay.is_whole, what="all ways in the new view")

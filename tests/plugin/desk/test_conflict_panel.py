"""The rows of robots that will be in each other's way."""

from __future__ import annotations

import time

import pytest
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import QLabel, QToolButton

LEFT = Qt.MouseButton.LeftButton


def meeting(robot, other, kind="head-on", x=50.0):
    at = time.time() + 20.0
    where = {"x": x, "y": 40.0, "metres": 0.4}
    return {"robot": robot, "other": other, "kind": kind, "begins": at, "nearest_at": at, **where}


@pytest.fixture
def tell(at_desk, gateway, wait):
    """Tell the desk of conflicts and of who waits, and wait until it knows them."""

    def told(*conflicts, waiting=()):
        gateway.tell("conflicts", {"t": time.time(), "conflicts": list(conflicts), "waiting": list(waiting)})
        known = at_desk.desk.roads
        wait(lambda: [one.x for one in known.conflicts.conflicts] == [one["x"] for one in conflicts])

    return told


def texts(window):
    return [label.text() for label in window.dock.conflict_panel.findChildren(QLabel, "fleet_conflict")]


@pytest.mark.parametrize("kind", ["head-on", "crossing", "following", "standing"])
def test_each_kind_is_told_with_place_and_robots(at_desk, tell, kind):
    tell(meeting("r1", "r2", kind))
    (text,) = texts(at_desk)
    assert text.endswith(f"r1 × r2: {kind} at 50, 40 m")


def test_no_row_is_cut_off_in_the_narrowest_panel(at_desk, tell, wait):
    at_desk.dock.resize(at_desk.dock.minimumSizeHint())
    tell(*(meeting("robot-11", f"robot-{k}", "following", 100.0 + k) for k in range(12, 17)))
    labels = at_desk.dock.conflict_panel.findChildren(QLabel, "fleet_conflict")
    assert len(labels) == 3
    wait(lambda: all(label.height() >= label.heightForWidth(label.width()) for label in labels), what="room")
    rest = at_desk.dock.conflict_panel.findChild(QLabel, "fleet_waiting")
    assert rest.text() == "and 2 more: see the layer Conflicts"
    tops = [label.mapTo(at_desk.dock, label.rect().topLeft()).y() for label in (*labels, rest)]
    assert tops == sorted(tops)


def test_the_map_keeps_its_width_whatever_the_panel_has_to_tell(at_desk, tell, gateway, iface, wait):
    """It would move beneath the mouse of who is about to click, and be drawn anew."""
    before = iface.canvas.width()
    names = [f"robot-{k}" for k in range(10, 18)]
    holds = {"until": time.time() + 5.0, "x": 1.0, "y": 2.0, "by": "anna", "command": "c1"}
    tell(
        *(meeting("robot-10", name, "following", 100.0) for name in names[1:]),
        waiting=[{"robot": name, "other": "robot-10", **holds} for name in names[1:]],
    )
    gateway.stand(in_force=True, stop="s1", at=time.time(), by="anna", waiting=names, refused=names)
    wait(lambda: at_desk.dock.banner.isVisible(), what="the banner")
    wait(lambda: at_desk.dock.conflict_panel.isVisible(), what="the conflicts")
    QTest.qWait(100)
    assert iface.canvas.width() == before


def test_a_button_that_is_held_down_outlasts_news_of_the_same_conflict(at_desk, tell, gateway, wait):
    tell(meeting("r1", "r2"))
    button = at_desk.dock.findChild(QToolButton, "fleet_give_way_r2")
    QTest.mousePress(button, LEFT)
    tell(meeting("r1", "r2", x=51.0))
    assert "at 51, 40 m" in texts(at_desk)[0]
    QTest.mouseRelease(button, LEFT)
    wait(lambda: gateway.requests[-1][0] == "resolve_conflict", what="the request")
    assert gateway.requests[-1][1]["robot"] == "r2"


def test_nothing_is_left_of_a_conflict_that_is_over(at_desk, tell):
    tell(meeting("r1", "r2"))
    assert at_desk.dock.conflict_panel.isVisible()
    tell()
    assert not at_desk.dock.conflict_panel.isVisible() and texts(at_desk) == []

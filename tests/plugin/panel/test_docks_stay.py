"""No button of the panels of observations and replay moves, whatever is told and shown in them."""

from __future__ import annotations

import time

import pytest
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtGui import QImage
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import QDockWidget, QPushButton

from tests.support.button_places import Watched

LONG = "a text as long as none that anybody would write here, with a reason, a place and what to do. " * 4
WORD = "an-object-with-a-word-as-long-as-no-robot-would-ever-say-it-of-anything-that-it-has-seen"


@pytest.fixture
def opened(at_desk, iface):
    """Open a panel at the left of the window, as QGIS does."""

    def open_panel(action, name):
        iface.resize(1280, 800)
        next(one for one in iface.plugins.actions() if one.objectName() == action).trigger()
        dock = iface.findChild(QDockWidget, name)
        iface.addDockWidget(Qt.DockWidgetArea.LeftDockWidgetArea, dock)
        QTest.qWait(50)
        return dock, Watched(dock)

    return open_panel


def tell(gateway, number, state="pending", **more):
    facts = {"robot": "r1", "op": "SetObject", "object": "bin", "x": 60.0, "y": 50.0, **more}
    gateway.tell("observation", {"observation": number, "state": state, "received_at": time.time(), **facts})


def test_no_button_of_the_observations_moves(opened, at_desk, gateway, wait):
    dock, watched = opened("fleet_observations", "fleet_observation_dock")
    desk = at_desk.desk
    for number in range(1, 30):
        tell(gateway, number, object=WORD if number % 2 else "bin")
    wait(lambda: dock.model.rowCount() == 29, what="the observations")
    watched.check("there are many")
    for number in (1, 2):
        dock.choose(number)
        watched.check(f"observation {number} is looked at")
    tell(gateway, 1, "accepted", reviewed_by=WORD, semantics=WORD, reason=LONG)
    wait(lambda: desk.state.observations.get(1).state.value == "accepted", what="the review")
    dock.choose(1)
    watched.check("one was reviewed by another desk")
    gateway.refuse["review_observation"] = LONG
    dock.choose(2)
    QTest.mouseClick(dock.findChild(QPushButton, "fleet_observation_accept"), Qt.MouseButton.LeftButton)
    watched.check("a review is on its way")
    wait(lambda: not dock.feed.awaits_answer(2), what="the refusal")
    watched.check("it was refused")
    dock.reviewed.setChecked(True)
    watched.check("reviewed ones are shown, too")
    at_desk.actions.connect.trigger()
    wait(lambda: desk.state.link.phase.value == "closed", what="the end of the link")
    watched.check("the link is ended")


def test_an_observation_with_a_picture_moves_no_button(opened, gateway, wait, tmp_path):
    picture = QImage(640, 480, QImage.Format.Format_RGB32)
    picture.save(str(tmp_path / "picture.png"))
    dock, watched = opened("fleet_observations", "fleet_observation_dock")
    tell(gateway, 1)
    wait(lambda: dock.model.rowCount() == 1, what="the observation")
    dock.choose(1)
    watched.check("one without")
    dock.form.show_picture(str(tmp_path / "picture.png"))
    watched.check("one with a picture")


def test_no_button_of_the_replay_moves(opened, at_desk, gateway, wait):
    now = time.time()
    places = [["r1", now - 20 + k, 50.0 + k, 40.0, 0.0, 1.0, None, None] for k in range(10)]
    results = iter([{"places": [], "next": None}, {"places": places, "next": None}])
    gateway.answers["get_trajectory"] = lambda _: {"result": next(results)}
    dock, watched = opened("fleet_replay", "fleet_replay_dock")
    for what in ("nothing is stored", "a drive"):
        dock.load()
        watched.check(f"it is loading: {what}")
        wait(lambda: not dock.is_busy, what="the end of it")
        watched.check(f"it is loaded: {what}")
    dock.clockwork.play(True)
    watched.check("it plays")
    dock.clockwork.play(False)
    watched.check("it is held")
    gateway.refuse["get_trajectory"] = LONG
    dock.load()
    wait(lambda: not dock.is_busy, what="the refusal")
    watched.check("it was refused, with a long text")
    dock._show_status(LONG)
    watched.check("something long is said")
    dock.form.last.setCurrentIndex(dock.form.last.count() - 1)
    watched.check("another time is chosen")

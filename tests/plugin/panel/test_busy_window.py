"""A gateway that hangs, a window that was blocked, and texts in the message bar."""

from __future__ import annotations

import threading
from itertools import pairwise

from qgis.PyQt.QtCore import QCoreApplication, QEvent, Qt, QTimer
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import QLabel, QPushButton

from tests.support.bridge.bridge_programs import wait_until
from tests.support.fleet_panel import press


class Beat(threading.Thread):
    """Counts 20 ms each, as long as this process is given its time."""

    def __init__(self):
        super().__init__(daemon=True)
        self.count, self._ended = 0, threading.Event()

    def run(self):
        while not self._ended.wait(0.02):
            self.count += 1

    def end(self):
        self._ended.set()
        self.join()


def test_the_window_goes_on_while_a_gateway_hangs(at_desk, gateway, wait):
    release = threading.Event()
    gateway._loop.call_soon_threadsafe(release.wait)
    beat, ticks = Beat(), []
    timer = QTimer()
    timer.timeout.connect(lambda: ticks.append(beat.count))
    beat.start()
    timer.start(20)
    at_desk.desk.selection.select("r1")
    at_desk.actions.abort.trigger()
    press(at_desk, QPushButton, "fleet_abort_all_button")
    at_desk.actions.connect.trigger()
    at_desk.actions.connect.trigger()
    QTest.qWait(4000)
    timer.stop()
    release.set()
    beat.end()
    # Nothing waited for the gateway, which hung all the time: 1.5 s, in which another thread went on.
    assert max(b - a for a, b in pairwise(ticks)) < 75


def newest_in(buffer):
    with buffer._lock:
        robots = buffer._update.robots
        return robots.report(0).x if len(robots) else None


def test_after_a_blocked_window_the_newest_position_is_shown_first(at_desk, gateway, make_robot, wait):
    for x in range(100):
        gateway.show(make_robot("r1", float(x), 40))
    # The connection's thread receives all of them while the window does nothing.
    buffer = at_desk.desk.connection._buffer
    wait_until(lambda: newest_in(buffer) == 99.0, what="all positions")
    shown = []
    at_desk.desk.state.updated.connect(
        lambda: shown.append(at_desk.desk.state.robots.view("r1", 0.0).report.x)
    )
    wait(lambda: shown)
    assert shown[0] == 99.0


def test_what_follows_on_the_news_is_a_piece_of_its_own(at_desk, wait):
    told = []
    at_desk.desk.state._timer.stop()
    QCoreApplication.processEvents()
    at_desk.desk.state.updated.connect(lambda: told.append(True))
    at_desk.desk.state.pull()
    assert told == []
    wait(lambda: told, what="the signal")


def test_the_map_is_drawn_in_a_piece_after_the_one_in_which_lists_look_at_the_news(
    at_desk, wait, monkeypatch
):
    view, told = at_desk.view, []
    at_desk.desk.state._timer.stop()
    QTest.qWait(100)
    monkeypatch.setattr(view, "show_now", lambda: told.append("drawn"))
    # As if there were news, and long since the last frame.
    view.shown, view._last_frame = (-1, -1), 0.0
    at_desk.desk.state.updated.emit()
    assert told == []
    wait(lambda: told == ["drawn"], what="the frame")


def test_a_text_is_not_repeated_while_it_is_shown_and_is_when_it_was_closed(plugin, iface):
    notices = plugin.window.notices
    for _ in range(5):
        notices.error("The bridge is up.")
    assert len(iface.texts()) == 1
    iface.bar.clearWidgets()
    QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
    notices.error("The bridge is up.")
    assert notices.texts() == ["The bridge is up."]


def test_long_texts_are_shown_whole(plugin, iface):
    text = "A long sentence that says what, where and what to do. " * 6
    plugin.window.notices.error(text)
    QTest.qWait(50)
    label = iface.bar.findChild(QLabel, "fleet_notice")
    needed = label.fontMetrics().boundingRect(
        0, 0, label.width(), 1000, Qt.TextFlag.TextWordWrap, label.text()
    )
    assert label.height() >= needed.height()

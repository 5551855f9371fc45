"""The emergency stop at the desk: one click or one key, and on screen what the gateway confirmed."""

from __future__ import annotations

import re
import sys

import pytest
from fleet_supervisor.plugin.panel import emergency
from fleet_supervisor.plugin.panel.emergency import ClearDialog, in_words
from fleet_supervisor.plugin.plugin import FleetPlugin
from fleet_supervisor.plugin.ui.actions import EMERGENCY_KEYS
from fleet_supervisor.plugin.ui.dialogs import ShrinkableScrollArea
from fleet_supervisor.robot_bridge.core.messages.robots import SetPosEnd
from fleet_supervisor.robot_bridge.core.messages.safety import EmergencyReport, StoppedGateways
from qgis.PyQt.QtCore import QEvent, Qt
from qgis.PyQt.QtGui import QKeyEvent
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import (
    QAbstractButton,
    QAction,
    QApplication,
    QDialog,
    QLabel,
    QLineEdit,
    QMessageBox,
    QPushButton,
    QToolButton,
)

LEFT = Qt.MouseButton.LeftButton


def press_stop(window):
    """Click in the middle of the button, as a mouse does."""
    QTest.qWait(10)
    button = window.dock.findChild(QPushButton, "fleet_emergency_stop_button")
    assert button.isVisible()
    QTest.mouseClick(button, LEFT)


def banner(window):
    """Return what stands in the banner, nothing when it is hidden."""
    shown = window.dock.findChild(QLabel, "fleet_emergency_text")
    return shown.text() if shown.isVisible() else ""


def dialog(iface):
    return iface.mainWindow().findChild(ClearDialog)


@pytest.fixture
def stopped(at_desk, wait):
    press_stop(at_desk)
    wait(lambda: "in force" in banner(at_desk), what="the banner")
    return at_desk


def test_where_no_link_is_tried_any_more_the_robots_own_stops_are_named(plugin, gateway, iface, wait):
    gateway.protocol = 2
    plugin.window.desk.open_link(gateway.url, "anna")
    wait(lambda: plugin.window.desk.state.link.phase.value == "failed", what="the end of all attempts")
    press_stop(plugin.window)
    (text,) = (text for text in iface.texts() if "EMERGENCY STOP was NOT sent" in text)
    assert "use the robot's own emergency stop" in text and banner(plugin.window) == ""


def test_who_quits_before_the_gateway_has_answered_is_asked(at_desk, gateway, iface, wait):
    gateway.mute.add("emergency_stop")
    press_stop(at_desk)
    wait(lambda: gateway.requests_of("emergency_stop"), what="the stop")
    iface.close()
    asked = iface.findChild(QDialog, "fleet_quit_dialog")
    assert iface.isVisible() and asked.isVisible()
    assert any("not answered yet: EMERGENCY STOP." in label.text() for label in asked.findChildren(QLabel))
    asked.reject()
    assert iface.isVisible()
    iface.close()
    asked = [one for one in iface.findChildren(QDialog, "fleet_quit_dialog") if one.isVisible()]
    QTest.mouseClick(asked[0].findChild(QPushButton, "fleet_quit_confirm"), LEFT)
    assert not iface.isVisible()


def test_who_quits_when_all_is_answered_is_not_asked(stopped, iface):
    iface.close()
    assert not iface.isVisible() and iface.findChild(QDialog, "fleet_quit_dialog") is None


def test_on_a_low_screen_the_window_does_not_grow_and_what_stops_robots_stays_in_view(stopped, iface, wait):
    body = stopped.dock.widget()
    body.findChild(QToolButton, "fleet_access_button").setChecked(True)
    iface.resize(1280, 520)
    wait(lambda: iface.height() == 520, what="the window being as low as it was made")
    for name in ("fleet_emergency_stop_button", "fleet_abort_all_button", "fleet_clear_emergency_button"):
        button = body.findChild(QAbstractButton, name)
        assert button.visibleRegion().boundingRect() == button.rect(), name
    middle = body.findChild(ShrinkableScrollArea)
    assert middle.verticalScrollBar().maximum() > 0
    widest = middle.widget().minimumSizeHint().width()
    wait(lambda: middle.viewport().width() >= widest, what="room beside the scroll bar")


def test_of_a_window_that_is_broader_than_its_screen_the_stop_is_seen(at_desk):
    """Panels beside one another may ask for more than the screen has: the right end of the last is lost."""
    stop, abort = (
        at_desk.dock.findChild(QPushButton, f"fleet_{name}_button")
        for name in ("emergency_stop", "abort_all")
    )
    assert stop.geometry().right() < abort.geometry().left()


def test_one_click_and_no_question_stops_everything_and_the_banner_says_what_was_confirmed(
    at_desk, gateway, wait
):
    assert banner(at_desk) == ""
    press_stop(at_desk)
    wait(lambda: gateway.requests_of("emergency_stop"), what="the request")
    (asked,) = gateway.requests_of("emergency_stop")
    assert len(asked["command"]) == 36
    wait(lambda: "in force" in banner(at_desk))
    first, counts, waiting = banner(at_desk).splitlines()
    assert first.startswith("EMERGENCY STOP in force since ")
    assert first.endswith(", by anna")
    assert counts == "0 of 2 robots acknowledged, 0 seen to stand"
    assert waiting == "No answer from r1, r2"


def test_no_listener_that_fails_keeps_a_stop_or_an_abort_from_robots_or_from_the_others(
    at_desk, gateway, wait, monkeypatch
):
    desk, raised = at_desk.desk, []

    def fail(*_):
        raise RuntimeError("a listener failed")

    def fail_once(table, merge=desk.state.robots.merge):
        monkeypatch.setattr(desk.state.robots, "merge", merge)
        fail()

    # As QGIS does: without it PyQt ends the program.
    monkeypatch.setattr(sys, "excepthook", lambda kind, error, trace: raised.append(str(error)))
    state, signals = desk.state, []
    for signal in (
        state.emergency_changed,
        state.answered,
        state.merged,
        state.updated,
        state.commands_changed,
    ):
        signals.append((signal, signal.connect(fail)))
    for signal in (desk.emergency_changed, desk.orders.retried, desk.drafts.changed):
        signals.append((signal, signal.connect(fail)))
    desk.selection.select_all(["r1", "r2"])
    desk.abort_selected()
    desk.abort_all()
    press_stop(at_desk)
    wait(lambda: "in force" in banner(at_desk), what="the banner")
    assert [one["robot"] for one in gateway.requests_of("send")] == ["r1", "r2"]
    assert len(gateway.requests_of("abort_all")) == len(gateway.requests_of("emergency_stop")) == 1
    monkeypatch.setattr(state.robots, "merge", fail_once)
    gateway.stand(in_force=False)
    wait(lambda: banner(at_desk) == "", what="what came with a report that failed")
    gateway.stand(in_force=True)
    wait(lambda: "in force" in banner(at_desk), what="the update after it")
    assert set(raised) == {"a listener failed"}
    for signal, connection in signals:
        signal.disconnect(connection)


@pytest.fixture
def dark(at_desk):
    """The window in the colours of QGIS's theme Night Mapping."""
    at_desk.dock.window().setStyleSheet("QWidget { background-color: #323232; color: #eeeeee; }")


def test_the_banner_is_red_in_a_dark_theme_too(dark, at_desk, wait):
    press_stop(at_desk)
    wait(lambda: at_desk.dock.banner.isVisible() and "in force" in banner(at_desk), what="the banner")
    image = at_desk.dock.banner.grab().toImage()
    middle = [image.pixelColor(image.width() // 3, y).name() for y in range(5, image.height() - 5)]
    assert middle.count("#b00020") > len(middle) // 2


@pytest.mark.parametrize("key", [Qt.Key.Key_F10, Qt.Key.Key_Pause])
def test_one_key_does_the_same_wherever_the_focus_is(at_desk, gateway, iface, wait, key):
    for widget in (iface.canvas, at_desk.dock.findChild(QLineEdit, "fleet_url")):
        before = len(gateway.requests_of("emergency_stop"))
        widget.setFocus()
        QTest.keyClick(widget, key)
        wait(lambda before=before: len(gateway.requests_of("emergency_stop")) == before + 1)


def opened_box(window):
    box = QMessageBox(QMessageBox.Icon.Question, "", "Sure?", parent=window)
    box.open()
    return box


def opened_dialog(window):
    dialog = QDialog(window)
    dialog.open()
    return dialog


def dialog_over_a_dialog(window):
    return opened_dialog(opened_dialog(window))


def dialog_that_blocks_all(window):
    dialog = QDialog(window)
    dialog.setWindowModality(Qt.WindowModality.ApplicationModal)
    dialog.show()
    return dialog


@pytest.mark.parametrize("opened", [opened_box, opened_dialog, dialog_over_a_dialog, dialog_that_blocks_all])
def test_the_key_works_over_whatever_blocks_the_window(at_desk, gateway, iface, wait, opened):
    dialog = opened(iface)
    wait(lambda: QApplication.activeWindow() is dialog, what="the dialog")
    QTest.keyClick(dialog, Qt.Key.Key_F10)
    wait(lambda: len(gateway.requests_of("emergency_stop")) == 1, what="the request")
    assert dialog.isVisible()


def test_an_unloaded_plugin_leaves_its_keys_to_others(plugin, iface, wait):
    done = []
    other = QAction("Other", iface, triggered=lambda: done.append("other"))
    other.setShortcut("F10")
    iface.addAction(other)
    plugin.unload()
    QApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
    QTest.keyClick(iface, Qt.Key.Key_F10)
    wait(lambda: done == ["other"], what="the other action")


@pytest.mark.parametrize("key", EMERGENCY_KEYS)
def test_the_key_stops_robots_once_even_if_another_action_has_it(at_desk, gateway, iface, wait, key):
    done = []
    other = QAction("Other", iface, triggered=lambda: done.append("other"))
    other.setShortcut(key)
    iface.addAction(other)
    code = getattr(Qt.Key, f"Key_{key}")
    # To the window as the window system does, and to a widget; held down it comes again and again.
    QTest.keyClick(iface.windowHandle(), code)
    QTest.keyClick(iface.canvas, code, Qt.KeyboardModifier.KeypadModifier)
    none = Qt.KeyboardModifier.NoModifier
    QApplication.sendEvent(iface, QKeyEvent(QEvent.Type.KeyPress, code, none, "", True))
    QTest.keyClick(iface.canvas, code, Qt.KeyboardModifier.ShiftModifier)
    at_desk.desk.orders.abort("r1")
    wait(lambda: gateway.requests_of("send"), what="what was asked last")
    assert len(gateway.requests_of("emergency_stop")) == 2 and done == []


def test_who_has_a_key_of_the_stop_is_named_at_the_start(iface):
    other = QAction("&Other tool", iface)
    other.setShortcut("F10")
    plugin = FleetPlugin(iface)
    plugin.initGui()
    try:
        (text,) = iface.texts()
        assert "F10 is the key of the EMERGENCY STOP and does not perform Other tool." in text
    finally:
        plugin.unload()


def test_each_step_of_the_robots_is_shown(stopped, gateway, wait):
    gateway.stand(acknowledged=1, waiting=["r2"])
    wait(lambda: "1 of 2 robots acknowledged" in banner(stopped))
    assert "No answer from r2" in banner(stopped)
    gateway.stand(acknowledged=1, standing=1, waiting=[], refused=["r2"])
    wait(lambda: "1 seen to stand" in banner(stopped))
    assert "No answer" not in banner(stopped)
    assert "REFUSED by r2" in banner(stopped)


def test_until_the_gateway_answers_it_is_only_asked_for(at_desk, gateway, wait):
    gateway.mute.add("emergency_stop")
    press_stop(at_desk)
    assert "asked for. The gateway has not confirmed it yet" in banner(at_desk)
    assert "in force" not in banner(at_desk)
    assert not at_desk.dock.findChild(QToolButton, "fleet_clear_emergency_button").isEnabled()


def test_a_stop_of_another_operator_is_shown_also_to_who_connects_later(plugin, gateway, at_desk, wait):
    gateway.stand(in_force=True, stop="stop-of-bob", by="bob", at=1.7e9, reason="smoke")
    wait(lambda: "by bob (smoke)" in banner(at_desk))
    at_desk.actions.connect.trigger()
    wait(lambda: "s: robots may move. It said last:" in banner(at_desk))
    at_desk.actions.connect.trigger()
    wait(lambda: "link to the gateway" not in banner(at_desk))
    assert "by bob (smoke)" in banner(at_desk)


def test_a_stop_brings_a_hidden_panel_back(at_desk, gateway, wait):
    at_desk.dock.hide()
    gateway.stand(in_force=True, stop="stop-of-bob", by="bob", at=1.7e9)
    wait(lambda: "by bob" in banner(at_desk))


def test_without_a_link_the_operator_is_told_that_nothing_was_sent(plugin, iface):
    press_stop(plugin.window)
    assert any("EMERGENCY STOP was NOT sent" in text for text in iface.texts())
    assert any("own emergency stop" in text for text in iface.texts())
    assert banner(plugin.window) == ""


def test_a_stop_pressed_while_the_link_is_down_is_sent_when_it_is_back_and_says_so(
    at_desk, gateway, iface, wait
):
    gateway.stop()
    wait(lambda: at_desk.desk.state.link.phase.value == "retrying", what="the loss of the link")
    press_stop(at_desk)
    assert any("EMERGENCY STOP is NOT sent yet: the link is down" in text for text in iface.texts())
    assert "not confirmed it yet" in banner(at_desk)
    gateway.start()
    wait(lambda: "in force" in banner(at_desk), 10)
    assert len(gateway.requests_of("emergency_stop")) == 1
    over = ("NOT sent yet", "The link to the gateway", "Nothing listens")
    wait(lambda: not any(part in text for text in iface.texts() for part in over), what="the end of those")


def test_nothing_says_that_a_stop_is_in_force_once_another_desk_has_cleared_it(stopped, gateway, wait):
    gateway.stand(in_force=False)
    wait(lambda: banner(stopped) == "")
    assert "in force" not in stopped.dock.findChild(QLabel, "fleet_draft_text").text()


def test_it_is_cleared_by_who_confirms_with_a_reason(stopped, gateway, iface, wait):
    QTest.mouseClick(stopped.dock.findChild(QToolButton, "fleet_clear_emergency_button"), LEFT)
    asks = dialog(iface)
    assert any("0 of 2 robots acknowledged" in label.text() for label in asks.findChildren(QLabel))
    QTest.keyClicks(asks.findChild(QLineEdit, "fleet_clear_reason"), "track is free")
    assert gateway.requests_of("clear_emergency_stop") == []
    QTest.mouseClick(asks.findChild(QPushButton, "fleet_clear_confirm"), LEFT)
    wait(lambda: gateway.requests_of("clear_emergency_stop"))
    (asked,) = gateway.requests_of("clear_emergency_stop")
    assert asked == {"reason": "track is free", "stop": gateway.emergency.stop}
    wait(lambda: banner(stopped) == "")


@pytest.mark.parametrize("how", ["button", "escape", "enter"])
def test_who_does_not_confirm_clears_nothing(stopped, gateway, iface, how):
    QTest.mouseClick(stopped.dock.findChild(QToolButton, "fleet_clear_emergency_button"), LEFT)
    asks = dialog(iface)
    if how == "button":
        QTest.mouseClick(asks.findChild(QPushButton, "fleet_clear_keep"), LEFT)
    else:
        key = Qt.Key.Key_Escape if how == "escape" else Qt.Key.Key_Return
        QTest.keyClick(asks.findChild(QLineEdit, "fleet_clear_reason"), key)
    QTest.qWait(200)
    assert gateway.requests_of("clear_emergency_stop") == []
    assert "in force" in banner(stopped)


def test_enter_after_a_reason_keeps_it_and_goes_on_to_the_button_that_clears(stopped, gateway, iface, wait):
    QTest.mouseClick(stopped.dock.findChild(QToolButton, "fleet_clear_emergency_button"), LEFT)
    asks = dialog(iface)
    reason = asks.findChild(QLineEdit, "fleet_clear_reason")
    QTest.keyClicks(reason, "track is free")
    QTest.keyClick(reason, Qt.Key.Key_Return)
    assert asks.isVisible()
    assert reason.text() == "track is free"
    assert asks.focusWidget() is asks.findChild(QPushButton, "fleet_clear_confirm")
    assert gateway.requests_of("clear_emergency_stop") == []
    QTest.keyClick(asks.focusWidget(), Qt.Key.Key_Return)
    wait(lambda: gateway.requests_of("clear_emergency_stop"))
    assert gateway.requests_of("clear_emergency_stop")[0]["reason"] == "track is free"


def test_enter_on_the_button_that_keeps_the_stop_keeps_it_also_after_a_reason(stopped, gateway, iface):
    QTest.mouseClick(stopped.dock.findChild(QToolButton, "fleet_clear_emergency_button"), LEFT)
    asks = dialog(iface)
    QTest.keyClicks(asks.findChild(QLineEdit, "fleet_clear_reason"), "not yet")
    QTest.keyClick(asks.findChild(QLineEdit, "fleet_clear_reason"), Qt.Key.Key_Return)
    keep = asks.findChild(QPushButton, "fleet_clear_keep")
    keep.setFocus()
    QTest.keyClick(keep, Qt.Key.Key_Return)
    assert not asks.isVisible()
    assert gateway.requests_of("clear_emergency_stop") == []


def test_who_may_not_clear_it_is_told_so_and_it_stays(stopped, gateway, iface, wait):
    gateway.refuse["clear_emergency_stop"] = "anna is operator, and this takes a supervisor"
    QTest.mouseClick(stopped.dock.findChild(QToolButton, "fleet_clear_emergency_button"), LEFT)
    QTest.mouseClick(dialog(iface).findChild(QPushButton, "fleet_clear_confirm"), LEFT)
    wait(lambda: any("this takes a supervisor" in text for text in iface.texts()))
    assert "in force" in banner(stopped)


def test_what_the_gateway_refuses_while_it_is_in_force_comes_back_as_a_draft(stopped, gateway, iface, wait):
    gateway.refuse["send"] = "an emergency stop is in force since 12:00:00 UTC, by anna"
    stopped.desk.selection.select("r1")
    stopped.actions.cone.trigger()
    iface.click(30, 30)
    stopped.desk.sending.send()
    wait(lambda: any("emergency stop is in force" in text for text in iface.texts()))
    assert stopped.desk.drafts.draft.message()[0] == SetPosEnd.__name__


def test_a_gateway_that_falls_silent_is_not_taken_at_its_last_word(stopped, gateway, wait, monkeypatch):
    """A link may be dead for half a minute before anybody notices."""
    monkeypatch.setattr(emergency, "SILENT_AFTER", 0.3)
    gateway.stand(robots=2, acknowledged=2, standing=2)
    wait(lambda: "2 seen to stand" in banner(stopped))
    silent = r"The gateway has said nothing for (\d+) s: robots may move. It said last:"
    wait(lambda: re.search(silent, banner(stopped)))
    seconds = int(re.search(silent, banner(stopped))[1])
    wait(lambda: int(re.search(silent, banner(stopped))[1]) > seconds)
    monkeypatch.setattr(emergency, "SILENT_AFTER", 60.0)
    gateway.stand(standing=1)
    wait(lambda: "1 seen to stand" in banner(stopped) and "said nothing" not in banner(stopped))


def test_who_is_about_to_clear_a_stop_sees_that_a_robot_moves(stopped, gateway, iface, wait):
    gateway.stand(robots=2, acknowledged=2, standing=2)
    wait(lambda: "2 seen to stand" in banner(stopped))
    stopped.actions.clear_emergency.trigger()
    wait(lambda: dialog(iface) is not None)
    gateway.stand(standing=1, moving=["r2"])
    wait(lambda: any("MOVING: r2" in label.text() for label in dialog(iface).findChildren(QLabel)))
    dialog(iface).reject()


def test_what_is_not_stored_and_who_is_missing_is_said_in_words():
    report = EmergencyReport(
        True, "stop", None, "eve", robots=9, stored=False, waiting=[f"r{k}" for k in range(9)]
    )
    assert in_words(report, pending=True, silence=7).splitlines() == [
        "EMERGENCY STOP asked for. The gateway has not confirmed it yet: watch the robots, and use their own "
        "emergency stops.",
        "EMERGENCY STOP in force, by eve",
        "The gateway has said nothing for 7 s: robots may move. It said last:",
        "0 of 9 robots acknowledged, 0 seen to stand",
        "No answer from r0, r1, r2, r3, r4, r5, and 3 more",
        "Not stored yet: the gateway cannot write its database, so robots on SQL are not told.",
    ]


@pytest.mark.parametrize(
    ("robots", "acknowledged", "waiting", "refused", "lines"),
    [
        (1001, 0, 50, 0, ["No answer from r0, r1, r2, r3, r4, r5, and 995 more"]),
        (1001, 900, 50, 1, ["No answer from r0, r1, r2, r3, r4, r5, and 94 more", "REFUSED by x0"]),
        (200, 20, 0, 50, ["REFUSED by x0, x1, x2, x3, x4, x5, and 174 more"]),
        (3, 1, 2, 0, ["No answer from r0, r1"]),
    ],
)
def test_of_many_robots_it_counts_all_that_have_not_answered(robots, acknowledged, waiting, refused, lines):
    report = EmergencyReport(
        True,
        "stop",
        by="eve",
        robots=robots,
        acknowledged=acknowledged,
        waiting=[f"r{k}" for k in range(waiting)],
        refused=[f"x{k}" for k in range(refused)],
    )
    assert in_words(report, pending=False, silence=None).splitlines()[2:] == lines


def test_robots_that_move_or_are_not_heard_stand_above_all_but_the_counts():
    report = EmergencyReport(
        True,
        "stop",
        by="eve",
        robots=99,
        acknowledged=99,
        standing=3,
        moving=[f"m{k}" for k in range(50)],
        moving_more=40,
        unheard=["u0", "u1"],
        gateways=StoppedGateways(2, 3, ["east"]),
    )
    assert in_words(report, pending=False, silence=None).splitlines()[1:] == [
        "99 of 99 robots acknowledged, 3 seen to stand",
        "MOVING: m0, m1, m2, m3, m4, m5, and 84 more",
        "Not heard now, may move: u0, u1",
        "In force at 2 of 3 gateways",
        "NOT REACHED: gateways east. Watch their robots",
    ]


def test_of_several_gateways_it_says_at_how_many_it_is_in_force():
    at = StoppedGateways(2, 4, ["east", "west"])
    report = EmergencyReport(True, "stop", by="eve", robots=3, acknowledged=3, gateways=at)
    assert in_words(report, pending=False, silence=None).splitlines()[2:] == [
        "In force at 2 of 4 gateways",
        "NOT REACHED: gateways east, west. Watch their robots",
    ]


def test_the_latency_of_each_link_stands_in_the_table(at_desk, gateway, make_robot, wait):
    table = at_desk.dock.table
    column = [table.model().headerData(c, Qt.Orientation.Horizontal) for c in range(8)].index("Ping")
    gateway.show(make_robot("r1", latency=0.0123), make_robot("r2"))
    wait(lambda: table.model().index(0, column).data() == "12 ms")
    assert table.model().index(1, column).data() == ""


def test_the_banner_is_read_whole_in_the_narrowest_panel(stopped, gateway, wait):
    gateway.stand(reason="smoke in hall 3 " * 6, waiting=[f"robot-{k}" for k in range(20)], robots=20)
    wait(lambda: "and 14 more" in banner(stopped))
    stopped.dock.resize(420, 700)
    QTest.qWait(50)
    label = stopped.dock.findChild(QLabel, "fleet_emergency_text")
    assert label.height() >= label.heightForWidth(label.width())

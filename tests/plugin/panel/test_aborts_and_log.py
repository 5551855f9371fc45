"""Commands that are given up, and what the log says of each."""

from __future__ import annotations

import pytest
from fleet_supervisor.plugin.control import request_tracker
from fleet_supervisor.plugin.ui.language import short_time
from fleet_supervisor.robot_bridge.core.messages.commands import CommandState
from qgis.PyQt.QtWidgets import QApplication, QLabel, QLineEdit, QPushButton, QToolButton, QTreeView

from tests.support.fleet_panel import press


def test_abort_asks_the_selected_robot_only(at_desk, gateway, wait):
    at_desk.desk.selection.select("r2")
    press(at_desk, QToolButton, "fleet_abort_button")
    wait(lambda: gateway.requests_of("send"))
    (params,) = gateway.requests_of("send")
    assert (params["robot"], params["op"], params["params"]) == ("r2", "Abort", {})


def select_many(window, gateway, make_robot, wait):
    names = [f"m{number}" for number in range(20)]
    gateway.show(*(make_robot(name, 10.0 + 3 * number, 80) for number, name in enumerate(names)))
    wait(lambda: len(window.desk.state.robots) == 22, what="the robots")
    window.desk.selection.select_all(names)
    return names


@pytest.mark.parametrize(
    "action, method, words",
    [
        ("abort", "send", "Abort of m0, m1, m2, m3, m4, m5, and 14 more"),
        ("pause", "pause_robot", "Pause of m0, m1, m2, m3, m4, m5, and 14 more"),
        ("send_map", "send_map", "Map for m0, m1, m2, m3, m4, m5, and 14 more"),
    ],
)
def test_what_one_press_is_refused_for_many_robots_is_one_message_until_all_are_asked_again(
    at_desk, gateway, iface, make_robot, wait, action, method, words
):
    names = select_many(at_desk, gateway, make_robot, wait)
    gateway.refuse[method] = "not now"
    getattr(at_desk.actions, action).trigger()
    wait(lambda: len(at_desk.desk.orders) == 0, what="the answers")
    assert len(gateway.requests_of(method)) == 20
    assert iface.texts() == [f"Fleet Supervisor: {words}: not now"]
    gateway.refuse.clear()
    at_desk.desk.selection.select_all(names[1:])
    getattr(at_desk.actions, action).trigger()
    wait(lambda: len(at_desk.desk.orders) == 0, what="the answers")
    assert iface.texts() == [f"Fleet Supervisor: {words}: not now"]
    at_desk.desk.selection.select("m0")
    getattr(at_desk.actions, action).trigger()
    wait(lambda: iface.texts() == [], what="the end of the message")


def test_what_is_not_sent_to_many_robots_or_answered_late_is_one_message(
    at_desk, gateway, iface, make_robot, wait, monkeypatch
):
    monkeypatch.setattr(request_tracker, "SLOW_AFTER", 0.0)
    select_many(at_desk, gateway, make_robot, wait)
    gateway.mute.add("send")
    at_desk.actions.abort.trigger()
    wait(lambda: iface.texts(), what="the message")
    (text,) = iface.texts()
    assert text.startswith(
        "Fleet Supervisor: Abort of m0, m1, m2, m3, m4, m5, and 14 more: the gateway has not"
    )
    at_desk.desk.close_link()
    wait(lambda: at_desk.desk.state.link.phase.value == "closed", what="the end of the link")
    wait(lambda: len(at_desk.desk.orders) == 0, what="the answers")
    # The message bar deletes a message once Qt has time for it.
    wait(lambda: text not in iface.texts(), what="the end of the message")
    (text,) = iface.texts()
    at_desk.actions.pause.trigger()
    told = [one for one in iface.texts() if one != text]
    assert len(told) == 1
    assert told[0].startswith(
        "Fleet Supervisor: Pause of m0, m1, m2, m3, m4, m5, and 14 more was NOT sent: the desk"
    )


def test_abort_without_a_robot_says_so(at_desk, iface, gateway):
    press(at_desk, QToolButton, "fleet_abort_button")
    assert any("none was aborted" in text for text in iface.texts())
    assert gateway.requests_of("send") == []


def test_abort_all_is_one_press_and_no_question(at_desk, gateway, wait):
    press(at_desk, QPushButton, "fleet_abort_all_button")
    assert QApplication.activeModalWidget() is None
    wait(lambda: gateway.requests_of("abort_all"))
    wait(lambda: len(at_desk.desk.state.commands) == 2, what="both aborts")
    assert at_desk.dock.findChild(QLabel, "fleet_draft_text").text() == "ABORT ALL: sent to 2 robots"


def test_abort_all_without_a_link_says_loudly_that_nothing_was_sent(plugin, iface):
    press(plugin.window, QPushButton, "fleet_abort_all_button")
    (text,) = iface.texts()
    assert "ABORT ALL was NOT sent" in text
    assert "emergency stop" in text


def test_abort_all_is_repeated_when_the_link_broke_before_the_answer(at_desk, gateway, wait):
    gateway.mute.add("abort_all")
    press(at_desk, QPushButton, "fleet_abort_all_button")
    wait(lambda: gateway.requests_of("abort_all"))
    gateway.stop()
    gateway.mute.clear()
    wait(lambda: at_desk.desk.state.link.phase.value == "retrying")
    gateway.start()
    wait(lambda: len(gateway.requests_of("abort_all")) == 2, 8)
    first, again = gateway.requests_of("abort_all")
    assert first["command"] == again["command"]
    wait(lambda: len(at_desk.desk.orders) == 0)


def test_an_order_that_is_not_answered_is_told(at_desk, gateway, iface, wait):
    gateway.mute.add("abort_all")
    press(at_desk, QPushButton, "fleet_abort_all_button")
    wait(lambda: any("has not answered for 5 s" in text for text in iface.texts()), 7)
    gateway.mute.clear()
    gateway.stop()
    gateway.start()
    wait(lambda: not any("has not answered for 5 s" in text for text in iface.texts()), 10, "the text going")
    assert len(at_desk.desk.orders) == 0


def test_the_log_shows_each_step_with_time_who_and_how_far_off(at_desk, gateway, iface, wait):
    at_desk.desk.selection.select("r1")
    at_desk.actions.cone.trigger()
    iface.click(70, 55)
    press(at_desk, QToolButton, "fleet_send_button")
    wait(lambda: gateway.commands)
    (command,) = gateway.commands
    gateway.step(command, CommandState.DELIVERED, "gateway")
    gateway.step(command, CommandState.ACKNOWLEDGED, "r1")
    gateway.step(command, CommandState.REACHED, "r1", deviation=0.073)
    model = at_desk.dock.findChild(QTreeView, "fleet_command_log").model()
    wait(lambda: model.rowCount() == 1 and model.index(0, 2).data() == "reached")
    top = model.index(0, 0)
    assert model.index(0, 1).data().startswith("r1 · cone at ")
    assert model.index(0, 3).data() == "0.07 m off"
    steps = [
        [model.index(row, column, top).data() for column in (1, 2, 3)] for row in range(model.rowCount(top))
    ]
    assert steps == [
        ["by anna", "queued", ""],
        ["by gateway", "delivered", ""],
        ["by r1", "acknowledged", ""],
        ["by r1", "reached", "0.07 m off"],
    ]
    times = [model.index(row, 0, top).data() for row in range(4)]
    assert times == [short_time(step.at) for step in gateway.commands[command].steps]


def test_the_line_below_the_robots_follows_the_command_that_was_sent_last(at_desk, gateway, iface, wait):
    line = at_desk.dock.findChild(QLabel, "fleet_draft_text")
    at_desk.desk.selection.select("r1")
    at_desk.actions.cone.trigger()
    iface.click(70, 55)
    words = at_desk.desk.drafts.draft.in_words()
    press(at_desk, QToolButton, "fleet_send_button")
    wait(lambda: line.text() == f"Queued. {words}.", what="the command being kept")
    (command,) = gateway.commands
    gateway.step(command, CommandState.ACKNOWLEDGED, "r1")
    wait(lambda: line.text() == f"Acknowledged. {words}.", what="the line going on")
    gateway.step(command, CommandState.FAILED, "r1", reason="the cone holder is jammed")
    wait(lambda: line.text() == f"Failed: the cone holder is jammed. {words}.", what="the end of it")


def test_the_line_says_of_an_abort_that_it_is_done(at_desk, gateway, wait):
    line = at_desk.dock.findChild(QLabel, "fleet_draft_text")
    at_desk.desk.selection.select("r1")
    press(at_desk, QToolButton, "fleet_abort_button")
    wait(lambda: line.text() == "Queued. Abort of r1.", what="the abort being kept")
    (command,) = gateway.commands
    gateway.step(command, CommandState.REACHED, "r1")
    wait(lambda: line.text() == "Done. Abort of r1.", what="the abort being done")


def test_the_line_leaves_a_command_for_what_happens_after_it(at_desk, gateway, wait):
    line = at_desk.dock.findChild(QLabel, "fleet_draft_text")
    at_desk.desk.selection.select("r1")
    press(at_desk, QToolButton, "fleet_abort_button")
    wait(lambda: line.text() == "Queued. Abort of r1.", what="the abort being kept")
    at_desk.desk.hint.emit("3 commands written")
    (command,) = gateway.commands
    gateway.step(command, CommandState.REACHED, "r1")
    wait(lambda: at_desk.desk.state.commands.get(command).state is CommandState.REACHED)
    assert line.text() == "3 commands written"


def test_the_log_is_filled_with_what_was_asked_before_this_desk_came(plugin, gateway, make_robot, wait):
    gateway.show(make_robot("r1"))
    gateway._queue("command-1", "r1", "SetPosEnd", {"x": 1.0, "y": 2.0, "cone": True})
    gateway._queue("command-2", "r1", "Abort", {})
    window = plugin.window
    window.dock.findChild(QLineEdit, "fleet_url").setText(gateway.url)
    window.actions.connect.trigger()
    model = window.dock.findChild(QTreeView, "fleet_command_log").model()
    wait(lambda: model.rowCount() == 2)
    assert [model.index(row, 1).data() for row in range(2)] == ["r1 · abort", "r1 · cone at 1.00, 2.00"]

"""The log of commands on real widgets: filter, jump, export, older ones, why something failed."""

import csv
import re
import time
from types import SimpleNamespace

import pytest
from fleet_supervisor.plugin.gateway_client.command_cache import CommandCache
from fleet_supervisor.plugin.panel.command_log import COMMAND_CHOICES
from fleet_supervisor.plugin.panel.command_log_model import CommandChoice, summary
from fleet_supervisor.robot_bridge.core.messages.commands import CommandReport, CommandState, CommandStep
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import QComboBox, QLabel, QToolButton, QTreeView

LEFT = Qt.MouseButton.LeftButton


@pytest.fixture
def log(at_desk, gateway, wait):
    """r1 reached a cone, r2 failed on a route, r1 aborted, r2 has an open target."""
    gateway._queue("command-1", "r1", "SetPosEnd", {"x": 70.0, "y": 55.0, "cone": True})
    gateway.step("command-1", CommandState.DELIVERED, "gateway")
    gateway.step("command-1", CommandState.ACKNOWLEDGED, "r1")
    gateway.step("command-1", CommandState.REACHED, "r1", deviation=0.073)
    gateway._queue("command-2", "r2", "SetPath", {"points": [[80.0, 60.0], [90.0, 65.0]]})
    gateway.step("command-2", CommandState.FAILED, "r2", reason="the way is blocked")
    gateway._queue("command-3", "r1", "Abort", {})
    gateway.step("command-3", CommandState.DELIVERED, "gateway")
    gateway._queue("command-4", "r2", "SetPosEnd", {"x": 20.0, "y": 30.0})
    gateway.step("command-4", CommandState.DELIVERED, "gateway")
    log = at_desk.dock.log
    wait(lambda: log.view.model().rowCount() == 4)
    return log


def rows(log, columns=(1, 2)):
    model = log.view.model()
    return [tuple(model.index(row, c).data() for c in columns) for row in range(model.rowCount())]


def choose(log, name, text):
    box = log.findChild(QComboBox, name)
    box.setCurrentIndex(box.findText(text))
    assert box.currentText() == text


def double_click(log, row):
    view = log.view
    index = view.model().index(row, 1)
    view.scrollTo(index)
    spot = view.visualRect(index).center()
    QTest.mouseClick(view.viewport(), LEFT, pos=spot)
    QTest.mouseDClick(view.viewport(), LEFT, pos=spot)


# --- what is listed ---


def test_the_newest_is_on_top_and_lies_open(log):
    assert rows(log) == [
        ("r2 · target at 20.00, 30.00", "delivered"),
        ("r1 · abort", "delivered"),
        ("r2 · route of 2 points", "failed"),
        ("r1 · cone at 70.00, 55.00", "reached"),
    ]
    view = log.view
    assert [view.isExpanded(view.model().index(row, 0)) for row in range(4)] == [True, False, False, False]


def test_what_failed_says_why_at_once_and_in_its_step(log):
    model = log.view.model()
    failed = model.index(2, 0)
    assert model.index(2, 3).data() == "the way is blocked"
    assert model.rowCount(failed) == 2
    step = [model.index(1, column, failed).data() for column in (1, 2, 3)]
    assert step == ["by r2", "failed", "the way is blocked"]
    assert model.parent(model.index(1, 2, failed)) == failed


def test_open_commands_at_a_glance(log, gateway, wait):
    said = log.findChild(QLabel, "fleet_log_summary")
    assert said.text() == "2 open: 2 delivered"
    gateway.step("command-4", CommandState.ACKNOWLEDGED, "r2")
    wait(lambda: said.text() == "2 open: 1 delivered, 1 acknowledged")
    gateway.step("command-4", CommandState.REACHED, "r2", deviation=0.1)
    gateway.step("command-3", CommandState.ACKNOWLEDGED, "r1")
    gateway.step("command-3", CommandState.REACHED, "r1")
    wait(lambda: said.text() == "None open")
    assert summary([]) == "None open"


def test_filters_by_robot_and_by_how_it_went(log):
    for whose, which, commands in (
        ("r1", CommandChoice.ALL, ["r1 · abort", "r1 · cone at 70.00, 55.00"]),
        ("r2", CommandChoice.OPEN, ["r2 · target at 20.00, 30.00"]),
        ("r2", CommandChoice.FAILED, ["r2 · route of 2 points"]),
        ("All robots", CommandChoice.FAILED, ["r2 · route of 2 points"]),
        ("r1", CommandChoice.FAILED, []),
    ):
        choose(log, "fleet_log_robot", whose)
        choose(log, "fleet_log_filter", COMMAND_CHOICES[which])
        assert [what for what, _ in rows(log)] == commands, (whose, which)


def test_the_selected_robots_commands_follow_the_selection(log, at_desk):
    choose(log, "fleet_log_robot", "Selected robots")
    assert rows(log) == []
    at_desk.desk.selection.select("r1")
    assert [what for what, _ in rows(log)] == ["r1 · abort", "r1 · cone at 70.00, 55.00"]
    at_desk.desk.selection.select_all(["r1", "r2"])
    assert len(rows(log)) == 4


def test_what_ends_leaves_the_list_of_open_ones_and_what_comes_is_listed(log, gateway, wait):
    choose(log, "fleet_log_filter", COMMAND_CHOICES[CommandChoice.OPEN])
    assert [what for what, _ in rows(log)] == ["r2 · target at 20.00, 30.00", "r1 · abort"]
    gateway.step("command-4", CommandState.ABORTED, "bert", reason="wrong place")
    wait(lambda: [what for what, _ in rows(log)] == ["r1 · abort"])
    gateway._queue("command-5", "r1", "SetPosEnd", {"x": 1.0, "y": 1.0})
    gateway.step("command-5", CommandState.DELIVERED, "gateway")
    wait(lambda: [what for what, _ in rows(log)] == ["r1 · target at 1.00, 1.00", "r1 · abort"])
    choose(log, "fleet_log_filter", COMMAND_CHOICES[CommandChoice.ALL])
    assert len(rows(log)) == 5


def test_new_steps_appear_beneath_an_open_row_while_it_is_looked_at(log, gateway, wait):
    view, model = log.view, log.view.model()
    oldest = model.index(3, 0)
    view.expand(oldest)
    gateway._queue("command-5", "r1", "SetPosEnd", {"x": 1.0, "y": 1.0})
    gateway.step("command-5", CommandState.DELIVERED, "gateway")
    wait(lambda: model.rowCount() == 5)
    assert view.isExpanded(model.index(4, 0)) and view.isExpanded(model.index(0, 0))
    gateway.step("command-5", CommandState.ACKNOWLEDGED, "r1")
    wait(lambda: model.rowCount(model.index(0, 0)) == 3)
    assert model.index(2, 2, model.index(0, 0)).data() == "acknowledged"


# --- the place on the map ---


def press_enter(log, row):
    log.view.setCurrentIndex(log.view.model().index(row, 1))
    QTest.keyClick(log.view, Qt.Key.Key_Return)


@pytest.mark.parametrize("go", [double_click, press_enter])
def test_a_double_click_or_enter_goes_to_the_place(log, iface, go):
    for row, place in ((3, (70, 55)), (2, (90, 65)), (0, (20, 30))):
        iface.look_at(0, 0, 120, 100)
        go(log, row)
        centre = iface.canvas.extent().center()
        assert (centre.x() - 488000, centre.y() - 5190000) == pytest.approx(place, abs=0.5)
        assert iface.canvas.extent().height() < 80


def test_the_button_goes_there_from_a_step_too_and_is_grey_without_a_place(log, iface):
    button = log.findChild(QToolButton, "fleet_log_go")
    model, view = log.view.model(), log.view
    view.setCurrentIndex(model.index(1, 0))
    assert not button.isEnabled()
    view.setCurrentIndex(model.index(0, 1, model.index(2, 0)))
    assert button.isEnabled()
    QTest.mouseClick(button, LEFT)
    centre = iface.canvas.extent().center()
    assert (centre.x() - 488000, centre.y() - 5190000) == pytest.approx((90, 65), abs=0.5)


def test_a_double_click_on_an_abort_says_that_it_leads_nowhere(log, iface):
    double_click(log, 1)
    assert any("leads to no place" in text for text in iface.texts())


# --- files ---


def test_the_export_has_every_step_of_what_is_listed(log, tmp_path):
    choose(log, "fleet_log_robot", "r1")
    target = tmp_path / "commands.csv"
    log.export(str(target))
    found = list(csv.DictReader(target.open(encoding="utf-8-sig")))
    assert [(row["command"], row["step"], row["state"]) for row in found] == [
        ("command-3", "1", "queued"),
        ("command-3", "2", "delivered"),
        ("command-1", "1", "queued"),
        ("command-1", "2", "delivered"),
        ("command-1", "3", "acknowledged"),
        ("command-1", "4", "reached"),
    ]
    last = found[-1]
    assert (last["by"], last["asked_by"], last["deviation_m"]) == ("r1", "anna", "0.073")
    assert (last["target_x"], last["target_y"], last["what"]) == ("70.0", "55.0", "cone at 70.00, 55.00")
    assert last["time"].startswith("2023-11-1") and "+" in last["time"]


def test_an_export_that_fails_says_why_and_leaves_the_older_file(log, tmp_path, iface):
    target = tmp_path / "no" / "commands.csv"
    log.export(str(target))
    assert any("was not written" in text for text in iface.texts())


def test_a_text_that_a_spreadsheet_would_run_is_made_harmless(log, gateway, tmp_path, wait):
    gateway.step("command-4", CommandState.FAILED, "r2", reason="=cmd()")
    wait(lambda: rows(log)[0][1] == "failed")
    target = tmp_path / "commands.csv"
    log.export(str(target))
    reasons = {row["reason"] for row in csv.DictReader(target.open(encoding="utf-8-sig"))}
    assert "'=cmd()" in reasons and "=cmd()" not in reasons


# --- what was before ---


def test_older_commands_are_asked_for_and_sorted_in(log, gateway, wait):
    choose(log, "fleet_log_robot", "r1")
    steps = [CommandStep(CommandState.QUEUED, 1_600_000_000.0, "bert")]
    place = {"x": 3.0, "y": 4.0}
    old = CommandReport("command-0", "r1", "SetPosEnd", place, "bert", CommandState.EXPIRED, steps)
    gateway.commands = {"command-0": old, **gateway.commands}
    QTest.mouseClick(log.findChild(QToolButton, "fleet_log_older"), LEFT)
    wait(lambda: len(rows(log)) == 3)
    assert {"robot": "r1", "limit": 1000} in gateway.requests_of("get_commands")
    assert rows(log)[-1] == ("r1 · target at 3.00, 4.00", "expired")


def test_older_commands_of_each_selected_robot_are_asked_for(log, at_desk, gateway, wait):
    def asked(count):
        before = len(gateway.requests_of("get_commands"))
        QTest.mouseClick(log.findChild(QToolButton, "fleet_log_older"), LEFT)
        wait(lambda: len(gateway.requests_of("get_commands")) == before + count)
        return [question.get("robot") for question in gateway.requests_of("get_commands")[before:]]

    choose(log, "fleet_log_robot", "Selected robots")
    at_desk.desk.selection.select_all(["r2", "r1"])
    assert asked(2) == ["r1", "r2"]
    at_desk.desk.selection.select(None)
    assert asked(1) == [None]
    choose(log, "fleet_log_robot", "All robots")
    assert asked(1) == [None]


def test_a_command_of_another_day_tells_its_date_and_has_room_for_it(at_desk, gateway, wait):
    log = at_desk.dock.log

    def listed(name, at):
        steps = [CommandStep(CommandState.EXPIRED, at, "bert")]
        report = CommandReport(name, "r1", "Abort", {}, "bert", CommandState.EXPIRED, steps)
        gateway.commands = {name: report, **gateway.commands}
        QTest.mouseClick(log.findChild(QToolButton, "fleet_log_older"), LEFT)
        wait(lambda: len(rows(log)) == len(gateway.commands))
        return log.view.model().index(len(gateway.commands) - 1, 0)

    narrow = log.view.columnWidth(0)
    assert re.fullmatch(r"\d\d:\d\d:\d\d", listed("command-2", time.time()).data())
    assert log.view.columnWidth(0) == narrow
    old = listed("command-1", 1_600_000_000.0)
    assert re.fullmatch(r"09-1\d \d\d:\d\d", old.data())
    assert re.fullmatch(r"2020-09-1\d \d\d:\d\d:\d\d", old.data(Qt.ItemDataRole.ToolTipRole))
    assert log.view.columnWidth(0) > narrow
    assert log.view.visualRect(old).width() > log.view.fontMetrics().horizontalAdvance(old.data())
    choose(log, "fleet_log_filter", COMMAND_CHOICES[CommandChoice.OPEN])
    assert log.view.columnWidth(0) == narrow


def notes(at_desk):
    told = []
    at_desk.desk.info.connect(told.append)
    return told


def press_older(log):
    QTest.mouseClick(log.findChild(QToolButton, "fleet_log_older"), LEFT)


def long_ago(number):
    steps = [CommandStep(CommandState.EXPIRED, 1_600_000_000.0 + number, "bert")]
    return CommandReport(f"old-{number}", "r1", "Abort", {}, "bert", CommandState.EXPIRED, steps)


def test_it_is_told_how_many_older_commands_came_and_that_there_are_no_others(
    log, at_desk, gateway, iface, wait
):
    told = notes(at_desk)
    gateway.commands = {"old-0": long_ago(0), "old-1": long_ago(1), **gateway.commands}
    press_older(log)
    wait(lambda: len(told) == 1, what="what came of it")
    press_older(log)
    wait(lambda: len(told) == 2, what="what came of it")
    assert any("No older commands came." in text for text in iface.texts())
    assert told == [
        "2 older commands came. The gateway knows no others.",
        "No older commands came. The gateway knows no others.",
    ]


def test_of_several_robots_it_is_told_once(log, at_desk, gateway, wait):
    told = notes(at_desk)
    choose(log, "fleet_log_robot", "Selected robots")
    at_desk.desk.selection.select_all(["r2", "r1"])
    press_older(log)
    press_older(log)
    wait(lambda: len(gateway.requests_of("get_commands")) == 5 and len(told) == 2, what="what came of it")


def test_it_is_told_where_the_log_reaches_no_further_back(log, at_desk, gateway, wait, monkeypatch):
    told = notes(at_desk)
    monkeypatch.setattr("fleet_supervisor.plugin.panel.command_log.OLDER", 5)
    gateway.commands = {"old-0": long_ago(0), **gateway.commands}
    press_older(log)
    wait(lambda: len(told) == 1, what="what came of it")
    assert told[0].startswith("1 older command came. The log reaches no further back: the newest 5 of each")
    assert "2000 kept" in told[0]


def test_it_is_told_that_a_full_log_keeps_no_older_commands(log, at_desk, gateway, wait, monkeypatch):
    told = notes(at_desk)
    monkeypatch.setattr("fleet_supervisor.plugin.gateway_client.command_cache.MOST_COMMANDS", 4)
    gateway.commands = {"old-0": long_ago(0), **gateway.commands}
    press_older(log)
    wait(lambda: len(told) == 1, what="what came of it")
    assert told[0].startswith("No older commands came. The log reaches no further back: ")
    assert "4 kept" in told[0]


def test_refused_older_commands_are_said(log, at_desk, gateway, iface, wait):
    told = notes(at_desk)
    gateway.refuse["get_commands"] = "the database is away"
    QTest.mouseClick(log.findChild(QToolButton, "fleet_log_older"), LEFT)
    wait(lambda: any("the database is away" in text for text in iface.texts()))
    assert told == []


@pytest.fixture
def complaints(at_desk):
    told = []
    at_desk.desk.warning.connect(told.append)
    return told


@pytest.fixture
def later(at_desk, monkeypatch):
    """Let that many seconds pass at the desk."""

    def pass_by(seconds):
        now = at_desk.desk.clock
        monkeypatch.setattr(at_desk.desk, "clock", SimpleNamespace(steady=lambda: now.steady() + seconds))

    return pass_by


NO_ANSWER = "Older commands: the gateway has not answered for 5 s. Press Older to ask once more."


def test_a_gateway_that_does_not_answer_is_told_once_and_can_be_asked_again(
    log, at_desk, gateway, wait, complaints, later
):
    told = notes(at_desk)
    choose(log, "fleet_log_robot", "Selected robots")
    at_desk.desk.selection.select_all(["r2", "r1"])
    gateway.mute.add("get_commands")
    press_older(log)
    QTest.qWait(300)
    assert complaints == [] and told == []
    later(6)
    wait(lambda: complaints == [NO_ANSWER], what="that nothing was answered")
    gateway.mute.clear()
    press_older(log)
    wait(lambda: len(told) == 1, what="what came of it")
    QTest.qWait(300)
    assert complaints == [NO_ANSWER]


def test_what_a_lost_link_kept_back_is_told_and_comes_when_it_is_there_again(
    log, at_desk, gateway, wait, complaints, later
):
    told = notes(at_desk)
    later(-40)
    gateway.mute.add("get_commands")
    press_older(log)
    wait(lambda: len(gateway.requests_of("get_commands")) == 2, what="the question")
    gateway.stop()
    later(46)
    wait(lambda: NO_ANSWER in complaints, what="that nothing was answered")
    gateway.mute.clear()
    gateway.commands = {"old-0": long_ago(0), **gateway.commands}
    gateway.start()
    wait(lambda: told == ["1 older command came. The gateway knows no others."], what="what came of it")
    assert [text for text in complaints if text.startswith("Older")] == [NO_ANSWER]


def test_one_answer_of_several_that_are_refused_is_told(log, at_desk, gateway, wait, complaints):
    choose(log, "fleet_log_robot", "Selected robots")
    at_desk.desk.selection.select_all(["r2", "r1"])
    gateway.refuse["get_commands"] = "the database is away"
    press_older(log)
    wait(lambda: len(gateway.requests_of("get_commands")) == 3 and complaints, what="the refusal")
    QTest.qWait(300)
    assert complaints == ["Older commands: the database is away"]


def report(number, at, state=CommandState.ACKNOWLEDGED, robot="r1"):
    steps = [CommandStep(CommandState.QUEUED, at, "anna")]
    return CommandReport(f"command-{number}", robot, "SetPosEnd", {"x": 1.0, "y": 2.0}, "anna", state, steps)


def test_history_that_comes_late_does_not_become_what_a_robot_does():
    book = CommandCache()
    book.merge([report(5, 500.0)])
    done = CommandState.REACHED
    book.merge([report(2, 200.0), report(3, 300.0, done), report(1, 100.0, done)])
    assert book.task_of("r1").command == "command-5"
    assert book.reached_by("r1").command == "command-3"
    assert [known.command for known in book.of("r1", 3)] == ["command-5", "command-3", "command-2"]


def test_a_full_book_lets_go_of_what_is_over_first():
    from fleet_supervisor.plugin.gateway_client.command_cache import MOST_COMMANDS

    book = CommandCache()
    book.merge([report(0, 1.0)])
    book.merge(report(n, float(n + 1), CommandState.REACHED, "r2") for n in range(1, MOST_COMMANDS + 50))
    assert len(book) == MOST_COMMANDS
    assert book.task_of("r1").command == "command-0"
    assert book.get("command-1") is None


def test_a_full_log_lets_go_of_the_oldest_and_leaves_what_is_chosen(log, gateway, wait, monkeypatch):
    monkeypatch.setattr("fleet_supervisor.plugin.gateway_client.command_cache.MOST_COMMANDS", 4)
    log.view.setCurrentIndex(log.view.model().index(2, 0))
    gateway._queue("command-5", "r1", "SetPosEnd", {"x": 1.0, "y": 2.0})
    gateway.step("command-5", CommandState.DELIVERED, "gateway")
    wait(lambda: rows(log)[0] == ("r1 · target at 1.00, 2.00", "delivered"), what="the newest")
    assert [what for what, _ in rows(log)][1:] == [
        "r2 · target at 20.00, 30.00",
        "r1 · abort",
        "r2 · route of 2 points",
    ]
    assert log.view.currentIndex().siblingAtColumn(1).data() == "r2 · route of 2 points"


def test_the_tree_is_what_qt_expects_of_a_model(log, gateway, wait):
    from qgis.PyQt.QtTest import QAbstractItemModelTester

    tester = QAbstractItemModelTester(log.view.model(), QAbstractItemModelTester.FailureReportingMode.Fatal)
    for whose in ("r1", "Selected robots", "All robots"):
        choose(log, "fleet_log_robot", whose)
    gateway._queue("command-5", "r1", "SetPosEnd", {"x": 1.0, "y": 1.0})
    gateway.step("command-5", CommandState.DELIVERED, "gateway")
    gateway.step("command-5", CommandState.ABORTED, "anna")
    wait(lambda: rows(log)[0][1] == "aborted")
    choose(log, "fleet_log_filter", COMMAND_CHOICES[CommandChoice.OPEN])
    gateway.step("command-4", CommandState.ABORTED, "anna")
    wait(lambda: len(rows(log)) == 1)
    assert isinstance(log.findChild(QTreeView, "fleet_command_log"), QTreeView)
    del tester


def test_the_reason_of_a_failure_has_room_in_the_row(log):
    view = log.view
    log.resize(1000, 400)
    view.resize(1000, 300)
    (reason,) = (text for (text,) in rows(log, (3,)) if "blocked" in text)
    assert view.columnWidth(3) > view.fontMetrics().horizontalAdvance(reason) + 12

"""What robots were doing at a moment, and the marks of what was sent."""

from __future__ import annotations

import numpy as np
import pytest
from fleet_supervisor.plugin.gateway_client.command_cache import CommandCache
from fleet_supervisor.plugin.replay.history import AT_ONCE, CommandSorter, sort_commands
from fleet_supervisor.plugin.ui.scheduling import run_to_end
from fleet_supervisor.robot_bridge.core.messages.commands import CommandReport, CommandState, CommandStep

T0 = 1_790_000_000.0


def command(name, robot, *steps, op="SetPosEnd"):
    states = [CommandStep(CommandState(state), T0 + at, "anna") for state, at in steps]
    return CommandReport(name, robot, op, {"x": 1.0, "y": 2.0}, "anna", states[-1].state, states)


def test_commands_are_under_way_from_sending_to_their_end():
    one = command("a", "r1", ("queued", 0), ("delivered", 1), ("acknowledged", 2), ("reached", 10))
    newer = command("b", "r1", ("queued", 5), ("delivered", 6), ("aborted", 20))
    other = command("c", "r2", ("queued", 8))
    abort = command("d", "r1", ("queued", 15), op="Abort")
    told = [newer, other, abort, one]

    def at(seconds):
        return {report.command for report in run_to_end(sort_commands(told)).under_way_at(T0 + seconds)}

    assert (at(-1), at(3), at(6), at(12), at(30)) == (set(), {"a"}, {"b"}, {"b", "c"}, {"c"})


def test_marks_are_what_was_sent_and_how_it_ended():
    one = command("a", "r1", ("queued", 0), ("delivered", 1), ("acknowledged", 2), ("reached", 10))
    two = command("b", "r2", ("queued", 4), ("failed", 5))
    commands = run_to_end(sort_commands([two, one]))
    found = commands.marks(T0, T0 + 6)
    told = [(mark.at - T0, mark.state.value) for mark in found]
    assert told == [(0, "queued"), (4, "queued"), (5, "failed")]
    assert found[0].text == "r1: target at 1.00, 2.00 · queued by anna"
    assert [mark.at - T0 for mark in commands.marks(T0, T0 + 60, ["r1"])] == [0, 10]


def test_of_marks_as_of_a_list_some_are_taken_and_there_are_none_of_nobody():
    commands = run_to_end(sort_commands([command("a", "r1", ("queued", 0), ("reached", 10))]))
    found = commands.marks(T0, T0 + 60)
    assert [mark.state.value for mark in found] == ["queued", "reached"] and found[-1].at == T0 + 10
    assert found.of(CommandState.REACHED).tolist() == [T0 + 10] and not len(found.of(CommandState.FAILED))
    assert not commands.marks(T0, T0 + 60, ["r2"]) and not run_to_end(sort_commands([])).marks(T0, T0 + 60)


def test_of_hundreds_of_commands_the_same_are_under_way_as_one_by_one():
    random = np.random.default_rng(4)
    ends = ["reached", "failed", "aborted", "superseded", "expired", None]
    reports = []
    for number in range(3 * AT_ONCE):
        asked, took = random.uniform(0.0, 100.0), random.exponential(20.0)
        end = random.choice(ends)
        steps = [("queued", asked), ("delivered", asked + took / 3), *([(end, asked + took)] if end else [])]
        reports.append(command(f"c{number}", f"r{random.integers(20)}", *steps))
    commands = run_to_end(sort_commands(reports))
    for seconds in random.uniform(-5.0, 130.0, 50).tolist():
        newest = {}
        for report in sorted(reports, key=lambda report: report.steps[0].at):
            so_far = [step.state for step in report.steps if step.at <= T0 + seconds]
            if so_far and so_far[-1].is_open:
                newest[report.robot] = report
        told = commands.under_way_at(T0 + seconds)
        assert {report.robot: report for report in told} == newest and len(told) == len(newest)


@pytest.fixture
def book():
    made = CommandCache()
    made.merge([command("a", "r1", ("queued", 0))])
    return made


def test_a_book_is_looked_through_beside_the_window_and_again_for_news_meanwhile(qgis_app, book, wait):
    arranging, done = CommandSorter(book), []
    arranging.done.connect(lambda before: done.append((before, arranging.commands)))
    arranging.renew()
    none = arranging.commands
    assert none.under_way_at(T0) == [] and arranging.is_busy
    book.merge([command("b", "r2", ("queued", 1))])
    arranging.renew()
    arranging.renew()
    wait(lambda: not arranging.is_busy, what="the commands")
    assert [report.command for report in arranging.commands.under_way_at(T0 + 2)] == ["a", "b"]
    (first_before, first), (second_before, second) = done
    assert first_before is none and second_before is first and second is arranging.commands


def test_what_is_forgotten_does_not_come(qgis_app, book, wait):
    arranging = CommandSorter(book)
    arranging.renew()
    arranging.forget()
    assert not arranging.is_busy
    arranging.renew()
    wait(lambda: not arranging.is_busy)
    arranging.forget()
    assert arranging.commands.under_way_at(T0) == []

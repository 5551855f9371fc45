"""The log as a tree: a view is told of the newest commands, and of older ones when it asks, in order."""

from __future__ import annotations

import random
from dataclasses import replace

import pytest
from fleet_supervisor.plugin.panel.command_log_model import (
    COMMAND_ROLE,
    PAGE,
    CommandChoice,
    CommandFilter,
    LogModel,
    cells,
    step_cells,
)
from fleet_supervisor.plugin.panel.robot_details import command_rows
from fleet_supervisor.robot_bridge.core.messages.commands import CommandReport, CommandState, CommandStep
from qgis.PyQt.QtCore import QModelIndex, QPersistentModelIndex
from qgis.PyQt.QtTest import QAbstractItemModelTester

ROOT = QModelIndex()
QUEUED, REACHED = CommandState.QUEUED, CommandState.REACHED


def report(number, state=QUEUED, at=None):
    steps = [CommandStep(QUEUED, float(number if at is None else at), "anna")]
    steps += [CommandStep(state, steps[0].at + 0.5, "gateway")] if state is not QUEUED else []
    return CommandReport(f"c{number}", "r1", "Abort", {}, "anna", state, steps)


@pytest.fixture
def model(qgis_app):
    return LogModel()


@pytest.fixture
def held_to_qt(model):
    """The model, held against what Qt expects of one; who does that asks for all rows, in the midst of
    changes as well, so that it can be done to less than a page."""
    tester = QAbstractItemModelTester(model, QAbstractItemModelTester.FailureReportingMode.Fatal)
    yield model
    del tester


def told(model):
    """Return the commands that a view is told of."""
    return [model.index(row, 0).data(COMMAND_ROLE) for row in range(model.rowCount())]


def names(numbers):
    return [f"c{number}" for number in numbers]


def fetch_all(model):
    while model.canFetchMore(ROOT):
        model.fetchMore(ROOT)


@pytest.mark.parametrize(("op", "word"), [("Abort", "done"), ("SetPosEnd", "reached")])
def test_an_abort_leads_nowhere_and_is_done(op, word):
    """Neither its row nor its step says that it was reached."""
    target = {"x": 1.0, "y": 2.0} if op == "SetPosEnd" else {}
    one = replace(report(1, REACHED), op=op, params=target)
    assert cells(one)[2] == word
    assert [step_cells(step, one)[2] for step in one.steps] == ["queued", word]
    assert command_rows([one])[0][1].endswith(f": {word}, by anna")


def test_a_view_is_told_of_the_newest_and_of_the_others_when_it_asks(model):
    count = 2 * PAGE + 50
    model.show_all([report(n) for n in range(count)], CommandFilter())
    newest_first = names(reversed(range(count)))
    assert told(model) == newest_first[:PAGE] and len(model.shown) == count
    model.fetchMore(ROOT)
    assert told(model) == newest_first[: 2 * PAGE]
    fetch_all(model)
    assert told(model) == newest_first and not model.canFetchMore(ROOT)
    assert not model.canFetchMore(model.index(0, 0))


def test_many_new_ones_come_in_one_piece(held_to_qt):
    held_to_qt.show_all([report(n) for n in range(3)], CommandFilter())
    inserted = []
    held_to_qt.rowsInserted.connect(lambda _parent, first, last: inserted.append((first, last)))
    assert sorted(held_to_qt.merge([report(n) for n in range(3, 103)])) == sorted(names(range(3, 103)))
    assert inserted == [(0, 99)]
    assert told(held_to_qt) == names(reversed(range(103)))


def test_whatever_order_they_come_in_they_are_listed_by_their_time(model):
    numbers = list(range(PAGE + 100))
    random.Random(6).shuffle(numbers)
    model.show_all([report(n) for n in numbers[:PAGE]], CommandFilter())
    for begin in range(PAGE, len(numbers), 20):
        model.merge([report(n) for n in numbers[begin : begin + 20]])
    fetch_all(model)
    assert told(model) == names(reversed(range(PAGE + 100)))
    assert [model.row_of(f"c{n}") for n in range(3)] == [PAGE + 99, PAGE + 98, PAGE + 97]


def test_of_one_time_those_that_were_told_last_are_on_top(held_to_qt):
    held_to_qt.show_all([report(1, at=5.0)], CommandFilter())
    held_to_qt.merge([report(2, at=5.0), report(3, at=5.0)])
    held_to_qt.merge([report(4, at=5.0)])
    assert told(held_to_qt) == names([4, 3, 2, 1])


def test_what_happens_to_commands_that_no_view_was_told_of_is_there_when_it_asks(model):
    model.show_all([report(n) for n in range(PAGE + 20)], CommandFilter(which=CommandChoice.OPEN))
    tops, inserted = [], []
    model.rowsInserted.connect(lambda *rows: inserted.append(rows))
    model.dataChanged.connect(lambda first, _last, _roles=(): tops.append(first.row()))
    gone = [report(3, REACHED), report(4, REACHED), report(PAGE, REACHED)]
    model.merge([*gone, report(5), report(-1)])
    assert tops == inserted == [], "none of those that a view knows has changed"
    fetch_all(model)
    left = [n for n in range(-1, PAGE + 20) if n not in (3, 4, PAGE)]
    assert told(model) == names(reversed(left))


def test_many_that_are_not_listed_any_more_go(held_to_qt):
    held_to_qt.show_all([report(n) for n in range(60)], CommandFilter(which=CommandChoice.OPEN))
    held_to_qt.merge([report(n, REACHED) for n in (*range(30, 60, 2), *range(28, -2, -2))])
    assert told(held_to_qt) == names(reversed(range(1, 60, 2)))


def test_a_step_that_comes_is_a_row_beneath_its_command(held_to_qt):
    held_to_qt.show_all([report(1), report(2)], CommandFilter())
    top = held_to_qt.index(1, 0)
    assert held_to_qt.rowCount(top) == 1
    held_to_qt.merge([report(1, REACHED)])
    assert held_to_qt.rowCount(top) == 2
    step = held_to_qt.index(1, 0, top)
    assert held_to_qt.parent(step) == top and held_to_qt.report_at(step).state is REACHED
    held_to_qt.merge([report(3)])
    assert held_to_qt.parent(step).row() == 2, "a step keeps to its command when that moves down"


def test_what_is_kept_no_more_goes_and_the_others_stay_as_they_are(held_to_qt):
    model = held_to_qt
    model.show_all([report(n, REACHED) for n in range(6)], CommandFilter())
    opened = QPersistentModelIndex(model.index(1, 0, model.index(2, 0)))
    resets = []
    model.modelReset.connect(lambda: resets.append(True))
    model.keep({"c1", "c2", "c3", "c5"})
    assert told(model) == ["c5", "c3", "c2", "c1"] and not resets
    assert model.report_at(QModelIndex(opened)).command == "c3"
    model.keep({"c5"})
    assert told(model) == ["c5"] and not opened.isValid()
    assert list(model._by_number.values()) == list(model._numbers) and "c3" not in model._numbers


def test_a_view_is_made_short_again_only_when_it_was_told_of_much(model):
    model.show_all([report(n) for n in range(3 * PAGE)], CommandFilter())
    model.fetchMore(ROOT)
    model.shorten()
    assert model.rowCount() == 2 * PAGE
    model.merge([report(3 * PAGE)])
    model.shorten()
    assert told(model) == names(reversed(range(2 * PAGE + 1, 3 * PAGE + 1)))
    assert len(model.shown) == 3 * PAGE + 1 and model.canFetchMore(ROOT)

"""Table SA in a database in memory: what waits for a robot, in the order in which it reads it."""

from __future__ import annotations

import pytest
from sqlalchemy import event, select

from robot_bridge.messages import Abort, SetMap, SetPosEnd, Start
from robot_bridge.store import answers
from robot_bridge.store.answers import AnswerRow
from robot_bridge.store.schema import sa

TARGET = SetPosEnd(1.0, 2.0)
TEXT = '{"x": 1.0, "y": 2.0, "cone": false}'


def robots(connection):
    return list(connection.scalars(select(sa.c.robot).order_by(sa.c.id)))


def ids(rows):
    return [row.id for row in rows]


def test_an_answer_has_the_number_of_its_row_and_reads_as_it_was_written(connection):
    first = answers.add(connection, "r1", TARGET)
    second = answers.add(connection, "r2", Start())
    assert (first, second) == (1, 2)
    assert answers.read(connection, "r1") == [AnswerRow(1, "SetPosEnd", TEXT, None, False)]
    assert answers.read(connection, "r2") == [AnswerRow(2, "Start", "{}", None, False)]
    assert answers.read(connection, "r3") == []


def test_the_bytes_of_a_map_are_its_payload(connection):
    answers.add(connection, "r1", SetMap(b"\x00map"))
    (row,) = answers.read(connection, "r1")
    assert (row.op, row.payload) == ("SetMap", b"\x00map")


def test_only_the_abort_of_an_emergency_stop_is_urgent_and_overtakes_what_is_older(connection):
    for answer in (TARGET, Abort(), Abort(emergency=True), TARGET, Abort(emergency=True)):
        answers.add(connection, "r1", answer)
    rows = answers.read(connection, "r1")
    assert ids(rows) == [3, 5, 1, 2, 4]
    assert [row.urgent for row in rows] == [True, True, False, False, False]
    assert all(type(row.urgent) is bool for row in rows)


def test_an_urgent_one_is_read_though_it_is_the_first_of_all(connection):
    answers.add(connection, "r1", Abort(emergency=True))
    assert ids(answers.read(connection, "r1")) == [1]


@pytest.mark.parametrize(
    ("after", "after_urgent", "left"),
    [(0, 0, [3, 4, 1, 2]), (1, 0, [3, 4, 2]), (2, 3, [4]), (0, 4, [1, 2]), (4, 4, [])],
)
def test_what_was_sent_before_is_not_read_again_of_each_kind(connection, after, after_urgent, left):
    for answer in (TARGET, TARGET, Abort(emergency=True), Abort(emergency=True)):
        answers.add(connection, "r1", answer)
    assert ids(answers.read(connection, "r1", after, after_urgent)) == left


def test_many_are_written_each_for_its_robot(connection):
    answers.add_all(connection, [("r1", TARGET), ("r2", Abort(emergency=True))])
    answers.add_all(connection, [])
    assert robots(connection) == ["r1", "r2"]
    assert answers.read(connection, "r1") == [AnswerRow(1, "SetPosEnd", TEXT, None, False)]
    assert [row.urgent for row in answers.read(connection, "r2")] == [True]


def test_many_are_numbered_in_the_order_in_which_they_came(connection):
    assert answers.add_numbered(connection, []) == []
    assert answers.add_numbered(connection, [("r2", TARGET), ("r1", Start()), ("r2", Abort())]) == [1, 2, 3]
    assert robots(connection) == ["r2", "r1", "r2"]
    assert [row.op for row in answers.read(connection, "r2")] == ["SetPosEnd", "Abort"]


def test_what_was_delivered_is_removed_and_nothing_else(connection):
    answers.add_numbered(connection, [("r1", TARGET)] * 3)
    answers.remove(connection, [])
    answers.remove(connection, [1, 3, 9])
    assert ids(answers.read(connection, "r1")) == [2]


def test_a_robot_removes_only_its_own(connection):
    answers.add_numbered(connection, [("r1", TARGET), ("r1", TARGET), ("r2", TARGET)])
    answers.remove_own(connection, "r1", 3)
    answers.remove_own(connection, "r1", 1)
    assert (ids(answers.read(connection, "r1")), ids(answers.read(connection, "r2"))) == ([2], [3])


def test_of_those_taken_back_it_is_told_which_were_still_there(connection):
    answers.add_numbered(connection, [("r1", TARGET)] * 3)
    assert answers.take_back(connection, [1, 3, 9]) == {1, 3}
    assert answers.take_back(connection, [1, 2]) == {2}
    assert answers.take_back(connection, []) == set()


def test_kinds_are_removed_for_one_robot_or_for_all(connection):
    answers.add_numbered(
        connection, [(robot, one) for robot in ("r1", "r2") for one in (TARGET, Start(), Abort())]
    )
    answers.remove_kinds(connection, "r1", ("SetPosEnd", "Start"))
    assert [row.op for row in answers.read(connection, "r1")] == ["Abort"]
    assert [row.op for row in answers.read(connection, "r2")] == ["SetPosEnd", "Start", "Abort"]
    answers.remove_everywhere(connection, ("SetPosEnd", "Abort"))
    assert answers.read(connection, "r1") == []
    assert [row.op for row in answers.read(connection, "r2")] == ["Start"]


@pytest.mark.parametrize("count", [0, 1, answers.TOGETHER, answers.TOGETHER + 1, 2 * answers.TOGETHER + 1])
def test_kinds_are_removed_for_many_robots_in_groups(connection, count):
    fleet = [f"r{number}" for number in range(count)]
    answers.add_all(connection, [(robot, one) for robot in [*fleet, "other"] for one in (TARGET, Abort())])
    asked = []
    event.listen(connection, "before_cursor_execute", lambda *call: asked.append(call[2].partition(" ")[0]))
    answers.remove_unlocked(connection, fleet, ("SetPosEnd", "SetPath"))
    assert asked.count("SELECT") == -(-count // answers.TOGETHER)
    assert robots(connection) == [*fleet, "other", "other"]
    assert [row.op for robot in fleet for row in answers.read(connection, robot)] == ["Abort"] * count


def test_which_still_wait_is_told(connection):
    answers.add_numbered(connection, [("r1", TARGET)] * 2)
    assert answers.waiting(connection, [2, 9]) == {2}
    assert answers.waiting(connection, []) == set()

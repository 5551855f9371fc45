"""Table SA in a database in memory: what waits for a robot, in the order in which it reads it."""

from __future__ import annotations

import pytest
from sqlalchemy import event, insert, select

from robot_bridge.core.messages.robots import Abort, SetMap, SetPosEnd, Start
from robot_bridge.gateway.storage.repositories import requests
from robot_bridge.gateway.storage.repositories.requests import AnswerRow
from robot_bridge.gateway.storage.rows import TOGETHER
from robot_bridge.gateway.storage.schema import sa

TARGET = SetPosEnd(1.0, 2.0)
TEXT = '{"x": 1.0, "y": 2.0, "cone": false}'


def robots(connection):
    return list(connection.scalars(select(sa.c.robot).order_by(sa.c.id)))


def ids(rows):
    return [row.id for row in rows]


def test_an_answer_has_the_number_of_its_row_and_reads_as_it_was_written(connection):
    first = requests.add(connection, "r1", TARGET)
    second = requests.add(connection, "r2", Start())
    assert (first, second) == (1, 2)
    assert requests.read_answers(connection, "r1") == [AnswerRow(1, "SetPosEnd", TEXT, None, False)]
    assert requests.read_answers(connection, "r2") == [AnswerRow(2, "Start", "{}", None, False)]
    assert requests.read_answers(connection, "r3") == []


def test_the_bytes_of_a_map_are_its_payload(connection):
    requests.add(connection, "r1", SetMap(b"\x00map"))
    (row,) = requests.read_answers(connection, "r1")
    assert (row.op, row.payload) == ("SetMap", b"\x00map")


def test_only_the_abort_of_an_emergency_stop_is_urgent_and_overtakes_what_is_older(connection):
    for answer in (TARGET, Abort(), Abort(emergency=True), TARGET, Abort(emergency=True)):
        requests.add(connection, "r1", answer)
    rows = requests.read_answers(connection, "r1")
    assert ids(rows) == [3, 5, 1, 2, 4]
    assert [row.urgent for row in rows] == [True, True, False, False, False]
    assert all(type(row.urgent) is bool for row in rows)


def test_an_urgent_one_is_read_though_it_is_the_first_of_all(connection):
    requests.add(connection, "r1", Abort(emergency=True))
    assert ids(requests.read_answers(connection, "r1")) == [1]


@pytest.mark.parametrize(
    ("after", "after_urgent", "left"),
    [(0, 0, [3, 4, 1, 2]), (1, 0, [3, 4, 2]), (2, 3, [4]), (0, 4, [1, 2]), (4, 4, [])],
)
def test_what_was_sent_before_is_not_read_again_of_each_kind(connection, after, after_urgent, left):
    for answer in (TARGET, TARGET, Abort(emergency=True), Abort(emergency=True)):
        requests.add(connection, "r1", answer)
    assert ids(requests.read_answers(connection, "r1", after, after_urgent)) == left


MARKS = [("r1", 0, 0), ("r2", 1, 0), ("r3", 6, 0), ("r1", 1, 9), ("nobody", 0, 0), ("r2", 5, 8)]


@pytest.mark.parametrize("count", range(len(MARKS) + 1))
def test_many_outboxes_are_read_at_once_as_each_by_itself(connection, count):
    for answer in (TARGET, Abort(emergency=True), SetMap(b"map")):
        requests.add_answers(connection, [(robot, answer) for robot in ("r1", "r2", "r3")])
    asked = []
    event.listen(connection, "before_cursor_execute", lambda *call: asked.append(call[3]))
    found = requests.read_outbox.do_all(connection, MARKS[:count])
    assert len(asked) <= 2
    # Of what nobody is to read the payload, which may be megabytes, is not fetched.
    assert count < 2 or set(asked[1]) == {id for rows in found for id in ids(rows)}
    assert found == [requests.read_answers(connection, *mark) for mark in MARKS[:count]]
    assert count < 4 or [len(rows) for rows in found[:4]] == [3, 3, 2, 1]


def test_of_many_acknowledged_only_those_of_the_robot_itself_are_removed(connection):
    requests.add_answers(connection, [("r1", TARGET), ("r2", TARGET), ("r1", Start()), ("r2", Start())])
    requests.remove_own(connection, [("r1", 1), ("r1", 2), ("r2", 4), ("r2", 9), ("nobody", 3)])
    assert ids(requests.read_answers(connection, "r1")) == [3]
    assert ids(requests.read_answers(connection, "r2")) == [2]
    requests.remove_own(connection, [])
    requests.remove_own(connection, [("r2", 3), ("r1", 3)])
    assert ids(requests.read_answers(connection, "r1")) == []


def test_void_answers_of_many_are_removed_but_for_a_map_that_an_order_waits_behind(connection):
    waiting = [SetMap(b"1"), TARGET, Start(), SetMap(b"2"), Abort()]
    requests.add_answers(connection, [(robot, one) for robot in ("r1", "r2", "r3", "r4") for one in waiting])
    requests.remove_void(connection, {"r1": {"SetMap"}, "r2": {"SetMap", "Start"}, "r3": {"Start"}, "r4": ()})

    def left(robot):
        return [row.op for row in requests.read_answers(connection, robot)]

    assert left("r1") == ["SetMap", "SetPosEnd", "Start", "Abort"]
    assert left("r2") == ["SetMap", "SetPosEnd", "Abort"]
    assert left("r3") == ["SetMap", "SetPosEnd", "SetMap", "Abort"]
    assert left("r4") == ["SetMap", "SetPosEnd", "Start", "SetMap", "Abort"]


def test_many_are_written_each_for_its_robot(connection):
    requests.add_answers(connection, [("r1", TARGET), ("r2", Abort(emergency=True))])
    requests.add_answers(connection, [])
    assert robots(connection) == ["r1", "r2"]
    assert requests.read_answers(connection, "r1") == [AnswerRow(1, "SetPosEnd", TEXT, None, False)]
    assert [row.urgent for row in requests.read_answers(connection, "r2")] == [True]


def test_many_are_numbered_in_the_order_in_which_they_came(connection):
    assert requests.add_numbered(connection, []) == []
    assert requests.add_numbered(connection, [("r2", TARGET), ("r1", Start()), ("r2", Abort())]) == [1, 2, 3]
    assert robots(connection) == ["r2", "r1", "r2"]
    assert [row.op for row in requests.read_answers(connection, "r2")] == ["SetPosEnd", "Abort"]


def test_what_was_delivered_is_removed_and_nothing_else(connection):
    requests.add_numbered(connection, [("r1", TARGET)] * 3)
    requests.remove_answers(connection, [])
    requests.remove_answers(connection, [1, 3, 9])
    assert ids(requests.read_answers(connection, "r1")) == [2]


def test_a_robot_removes_only_its_own(connection):
    requests.add_numbered(connection, [("r1", TARGET), ("r1", TARGET), ("r2", TARGET)])
    requests.remove_own(connection, [("r1", 3)])
    requests.remove_own(connection, [("r1", 1)])
    assert (ids(requests.read_answers(connection, "r1")), ids(requests.read_answers(connection, "r2"))) == (
        [2],
        [3],
    )


def test_of_those_taken_back_it_is_told_which_were_still_there(connection):
    requests.add_numbered(connection, [("r1", TARGET)] * 3)
    assert requests.withdraw_unread(connection, [1, 3, 9]) == {1, 3}
    assert requests.withdraw_unread(connection, [1, 2]) == {2}
    assert requests.withdraw_unread(connection, []) == set()


def test_kinds_are_removed_for_one_robot_or_for_all(connection):
    requests.add_numbered(
        connection, [(robot, one) for robot in ("r1", "r2") for one in (TARGET, Start(), Abort())]
    )
    requests.remove_kinds(connection, ["r1"], ("SetPosEnd", "Start"))
    assert [row.op for row in requests.read_answers(connection, "r1")] == ["Abort"]
    assert [row.op for row in requests.read_answers(connection, "r2")] == ["SetPosEnd", "Start", "Abort"]
    requests.remove_everywhere(connection, ("SetPosEnd", "Abort"))
    assert requests.read_answers(connection, "r1") == []
    assert [row.op for row in requests.read_answers(connection, "r2")] == ["Start"]


@pytest.mark.parametrize("remove", [requests.remove_unlocked, requests.remove_kinds])
@pytest.mark.parametrize("count", [0, 1, TOGETHER, TOGETHER + 1, 2 * TOGETHER + 1])
def test_kinds_are_removed_for_many_robots_in_groups(connection, count, remove):
    fleet = [f"r{number}" for number in range(count)]
    requests.add_answers(
        connection, [(robot, one) for robot in [*fleet, "other"] for one in (TARGET, Abort())]
    )
    asked = []
    event.listen(connection, "before_cursor_execute", lambda *call: asked.append(call[2].partition(" ")[0]))
    remove(connection, fleet, ("SetPosEnd", "SetPath"))
    assert asked.count("SELECT") == -(-count // TOGETHER)
    assert robots(connection) == [*fleet, "other", "other"]
    assert [row.op for robot in fleet for row in requests.read_answers(connection, robot)] == [
        "Abort"
    ] * count


def test_which_still_wait_is_told(connection):
    requests.add_numbered(connection, [("r1", TARGET)] * 2)
    assert requests.waiting(connection, [2, 9]) == {2}
    assert requests.waiting(connection, []) == set()


def test_what_a_robot_asked_reads_as_it_was_written_with_its_payload_in_bytes(connection):
    rows = [("r1", "SendImage", '{"object": "o"}', b"\x89PNG\x00"), ("r2", "Alive", "{}", None)]
    requests.add_requests(connection, rows)
    first, second = requests.read_requests(connection)
    assert (first.robot, first.op, first.params) == rows[0][:3]
    assert (second.robot, second.op, second.params) == rows[1][:3]
    sizes = []
    assert requests.payload(connection, first.id, sizes.append) == b"\x89PNG\x00"
    assert requests.payload(connection, second.id, sizes.append) is None
    assert sizes == [5]


def test_a_payload_that_is_too_large_is_not_read(connection):
    def refuse(size):
        raise ValueError(size)

    requests.add_requests(connection, [("r1", "SendImage", "{}", b"x" * 9)])
    read = []
    event.listen(connection.engine, "before_cursor_execute", lambda *told: read.append(told[2]))
    with pytest.raises(ValueError, match="9"):
        requests.payload(connection, 1, refuse)
    assert len(read) == 1


def test_maps_that_say_only_that_they_are_the_whole_site_are_filled_and_no_others(connection):
    whole = insert(sa).values(op="SetMap", params="{}", payload=None, urgent=0)
    for robot in ("r1", "r1", "r2"):
        connection.execute(whole.values(robot=robot))
    requests.add(connection, "r1", SetMap(b"a window"))
    requests.add(connection, "r1", TARGET)
    requests.fill_maps(connection, "r1", b"all of it")
    told = [row.payload for row in requests.read_answers(connection, "r1")]
    assert told == [b"all of it", b"all of it", b"a window", None]
    assert [row.payload for row in requests.read_answers(connection, "r2")] == [None]

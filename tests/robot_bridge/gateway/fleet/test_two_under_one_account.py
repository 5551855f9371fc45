"""Two robots under one account of a database: what the one says that was not let in counts for nothing."""

from __future__ import annotations

import json

import pytest

from robot_bridge.core.messages.robots import Alive, GetPath, OpAck, Ready, SendPos, Stopped

A, B = 11, 22


async def say(yard, *requests):
    for request in requests:
        yard.ask("r1", request)
    await yard.link.poll()


def refusals(yard):
    rows = [json.loads(p) for op, p in yard.sql("select op, params from sa") if op == "OpAck"]
    return [row["reason"] for row in rows if not row["ok"]]


def place(yard):
    pose = yard.fleet.robots.get("r1").pose
    return pose.x, pose.y


@pytest.fixture
async def two(yard):
    """Robot A was let in and says its number with what it says; B was refused."""
    await say(yard, Ready(A), SendPos(20.0, 8.0, 0.0, 0.0, magic=A))
    await say(yard, Ready(B))
    assert "another robot runs as 'r1'" in refusals(yard)[0]
    yard.sql("delete from sa")
    return yard


@pytest.mark.parametrize("magic", [B, None], ids=["with its number", "without"])
async def test_its_positions_do_not_move_the_other(two, magic):
    await say(two, SendPos(60.0, 40.0, 0.0, 0.0, magic=magic))
    assert place(two) == (20.0, 8.0)
    assert two.waiting() == [], "it waits for no answer, and finds none"
    assert two.fleet.counters.refused["sql"] == 1
    await say(two, SendPos(21.0, 8.0, 0.0, 0.0, magic=A))
    assert place(two) == (21.0, 8.0)


async def test_it_keeps_no_silent_robot_alive(two):
    two.now += 5
    await say(two, Alive(magic=B), Alive())
    two.fleet.age()
    assert two.fleet.robots.get("r1").state.value == "stale"


async def test_its_stopped_does_not_let_it_in(two):
    await say(two, Stopped(magic=B), Ready(B))
    assert len(refusals(two)) == 2
    assert two.fleet.robots.get("r1").magic == A


async def test_it_takes_on_no_task_of_the_other(two):
    await two.send("a")
    ((id,),) = two.sql("select id from sa where op = 'SetPosEnd'")
    await say(two, OpAck(id=id, magic=B), OpAck(id=id), GetPath(magic=B))
    assert "acknowledged" not in (await two.states())["a"]
    assert two.waiting() == ["SetPosEnd", "OpAck"]
    await say(two, OpAck(id=id, magic=A))
    assert (await two.states())["a"] == "acknowledged"


async def test_it_is_let_in_when_the_other_is_gone(two):
    two.now += 5
    await say(two, Ready(B), SendPos(60.0, 40.0, 0.0, 0.0, magic=B))
    assert place(two) == (60.0, 40.0)
    await say(two, SendPos(20.0, 8.0, 0.0, 0.0, magic=A))
    assert place(two) == (60.0, 40.0)


async def test_a_robot_that_never_says_its_number_is_believed(yard):
    await say(yard, Ready(A), SendPos(20.0, 8.0, 0.0, 0.0), Ready(B), SendPos(60.0, 40.0, 0.0, 0.0))
    assert place(yard) == (60.0, 40.0)

"""Who may say Ready: the robot that comes back, and not a second one under its account."""

from __future__ import annotations

import uuid

import pytest

from robot_bridge.core.messages.robots import Ready, Start, Stopped


class Held:
    """A connection whose robot answers, or does not."""

    def __init__(self, there):
        self.there = there

    async def answers(self):
        return self.there


async def say_ready(yard, magic, link):
    outcome = await yard.fleet.receive("r1", link, Ready(magic), 5)
    await yard.fleet.outboxes.finish([outcome], [], acks=False)
    return outcome


@pytest.mark.parametrize("link", ["sql", "websocket"])
async def test_a_second_robot_is_refused_while_the_first_is_there(yard, link):
    await say_ready(yard, 1, link)
    yard.fleet.reception.holds.claim("r1", Held(True))
    yard.now += 2.9
    outcome = await say_ready(yard, 2, link)
    assert (outcome.ack.ok, outcome.ack.id, outcome.ack.magic) == (False, 5, 2)
    assert outcome.ack.reason.startswith("another robot runs as 'r1' (magic 1, heard 2.9 s ago); give each")
    assert (outcome.answer, outcome.admitted) == (None, False)
    assert yard.fleet.robots.get("r1").magic == 1
    assert (await say_ready(yard, 1, link)).admitted, "the first one may say Ready again"


@pytest.mark.parametrize("link", ["sql", "websocket"])
async def test_a_refused_robot_does_not_keep_the_silent_one_alive(yard, link):
    await say_ready(yard, 1, link)
    yard.fleet.reception.holds.claim("r1", Held(True))
    for _ in range(2):
        yard.now += 1.4
        assert not (await say_ready(yard, 2, link)).admitted
    yard.now += 0.3
    assert (await say_ready(yard, 2, link)).admitted


async def test_on_sql_one_that_said_stopped_is_followed_at_once(yard):
    await say_ready(yard, 1, "sql")
    await yard.fleet.receive("r1", "sql", Stopped(), 6)
    assert (await say_ready(yard, 2, "sql")).admitted


@pytest.mark.parametrize("held", [None, Held(False)], ids=["closed", "does not answer"])
async def test_on_websocket_one_whose_connection_is_gone_is_followed_at_once(yard, held):
    await say_ready(yard, 1, "websocket")
    if held is not None:
        yard.fleet.reception.holds.claim("r1", held)
    assert (await say_ready(yard, 2, "websocket")).admitted


async def test_a_robot_on_one_link_keeps_its_name_from_the_other(yard):
    await say_ready(yard, 1, "websocket")
    yard.fleet.reception.holds.claim("r1", Held(True))
    assert not (await say_ready(yard, 2, "sql")).admitted
    assert yard.fleet.robots.get("r1").link == "websocket"
    await yard.ready("r2", link="sql")
    outcome = await yard.fleet.receive("r2", "websocket", Ready(9), 1)
    assert not outcome.admitted


async def test_a_refusal_throws_away_nothing_that_waits_for_the_first(yard):
    await say_ready(yard, 1, "sql")
    await yard.send("a")
    before = yard.waiting()
    outcome = await yard.fleet.receive("r1", "sql", Ready(2), 5)
    await yard.fleet.outboxes.finish([outcome], [], acks=True)
    assert yard.waiting() == [*before, "OpAck"]


async def test_a_hold_is_freed_by_who_has_it_only(yard):
    first, second = Held(True), Held(True)
    yard.fleet.reception.holds.claim("r1", first)
    yard.fleet.reception.holds.claim("r1", second)
    yard.fleet.reception.holds.free("r1", first)
    assert await yard.fleet.reception.holds.answers("r1")
    yard.fleet.reception.holds.free("r1", second)
    assert not await yard.fleet.reception.holds.answers("r1")


async def test_start_and_the_answer_to_ready_name_the_database_also_after_a_restart(yard):
    ack = (await say_ready(yard, 1, "sql")).ack
    assert uuid.UUID(ack.database)
    assert yard.fleet.reception.greeting() == Start(ack.database)
    await yard.restart()
    assert yard.fleet.reception.greeting() == Start(ack.database)
    assert yard.sql("select params from sa where op = 'Start'") == [(f'{{"database": "{ack.database}"}}',)]

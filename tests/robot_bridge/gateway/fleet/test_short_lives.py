"""A gateway that is killed again and again soon after its start reads what stood in RR all the same.

Robots on SQL leave everything until their Ready is answered, and every start of a gateway asks for another.
"""

from __future__ import annotations

import contextlib

import pytest

from robot_bridge.core.messages.robots import OpAck, Ready, SendPos, SetMap
from robot_bridge.gateway.api.robot_sql import SqlInterface
from robot_bridge.gateway.fleet.robot_outboxes import RequestOutcome, answer_rows
from robot_bridge.gateway.fleet.service import Fleet
from robot_bridge.gateway.trajectories import recording
from tests.support.bridge.mortal_database import Death, Killed, MortalDatabase

ROBOTS = [f"r{number}" for number in range(1, 9)]
SHORT = 6
"""transactions for which a short life lasts after the start: fewer than there are robots."""
PAUSE = 20.0
"""seconds from one start to the next."""


class Robots:
    """Robots on SQL that read nothing but Start until the gateway has taken their Ready."""

    def __init__(self, yard):
        self._yard = yard
        self._are_in = dict.fromkeys(ROBOTS, False)

    def turn(self):
        """Let each read what waits for it, and say where it is."""
        for robot in ROBOTS:
            rows = self._yard.sql("select id, op, params from sa where robot = ? order by id", robot)
            for id, op, params in rows:
                self._read(robot, id, op, params)
            self._yard.ask(robot, SendPos(20.0, 40.0, 0.0, 0.0))

    def _read(self, robot, id, op, params):
        if op == "Start":
            self._are_in[robot] = False
            self._yard.ask(robot, Ready(1))
        elif op == "OpAck" and "magic" in params:
            self._are_in[robot] = True
        elif not self._are_in[robot]:
            return
        self._yard.sql("delete from sa where id = ?", id)
        if self._are_in[robot] and op != "OpAck":
            self._yard.ask(robot, OpAck(id=id))


@pytest.fixture
async def robots(yard):
    """The robots of the yard, plugged in."""
    robots = Robots(yard)
    for robot in ROBOTS:
        yard.ask(robot, Ready(1))
    for _ in range(3):
        await yard.link.poll()
        robots.turn()
    return robots


async def live(yard, robots, transactions):
    """Let a gateway start in place of the one before, do so many ``transactions`` then, and be killed."""
    await yard.database.close()
    yard.now += PAUSE
    death = Death()
    yard.database = MortalDatabase(yard.url, death)
    await yard.database.open()
    yard.fleet = Fleet(yard.site, yard.database, clock=yard.clock)
    await yard.fleet.start()
    robots.turn()
    death.at = death.count + 1 + transactions
    with contextlib.suppress(Killed):
        await yard.fleet.save()
        for _ in range(3):
            await SqlInterface(yard.fleet, yard.database).poll()
            robots.turn()


async def test_a_command_is_fetched_although_each_gateway_dies_after_a_few_transactions(yard, robots):
    await yard.restart()
    robots.turn()
    await yard.send("a", robot=ROBOTS[-1])
    # The first ones come to nothing; by then each robot has said Ready again and again.
    for transactions in [0, 0, 0, *[SHORT] * 15]:
        await live(yard, robots, transactions)
    await yard.restart()
    await yard.link.poll()
    assert await yard.steps("a") == ["queued", "delivered", "acknowledged"]


@pytest.mark.parametrize("link", ["sql", "websocket"])
async def test_a_robot_that_says_ready_is_stored_before_it_is_answered(yard, lose, link):
    outcome = await yard.fleet.receive("r1", link, Ready(1), 5)
    lose(yard, recording._write, done=False)
    with pytest.raises(Exception, match="the connection was lost"):
        await yard.fleet.outboxes.finish([outcome], [], acks=True)
    assert yard.waiting() == []
    await yard.fleet.outboxes.finish([outcome], [], acks=True)
    assert yard.waiting() == ["OpAck", "SetMap"]
    assert yard.sql("select name, magic, link from robots") == [("r1", 1, link)]


async def test_a_robot_that_started_anew_is_told_once_more_once_though_the_gateway_dies_before_it_answers(
    yard,
):
    await yard.ready()
    await yard.send("a")
    await yard.acknowledge_all()
    await yard.fleet.receive("r1", "websocket", Ready(2), 5)
    await yard.restart()
    await yard.ready(magic=2)
    assert await yard.steps("a") == ["queued", "delivered", "acknowledged", "acknowledged"]


# --- what robots are answered that said Ready more than once before it was read ---


def ready(id, robot="r1"):
    ack = OpAck(id=id, magic=7, robot=robot)
    return RequestOutcome(robot, ack, SetMap(b"map"), void=("Start", "OpAck"))


def told(*outcomes, acks=True):
    return [
        (robot, type(answer).__name__, getattr(answer, "id", None))
        for robot, answer in answer_rows(outcomes, acks=acks)
    ]


def test_a_robot_that_said_ready_many_times_is_answered_as_if_it_had_said_it_last_alone():
    seen = RequestOutcome("r1", OpAck(id=2))
    assert told(ready(1), seen, ready(3)) == [("r1", "OpAck", 3), ("r1", "SetMap", None)]
    assert told(ready(1), ready(2), acks=False) == [("r1", "SetMap", None)]


def test_what_it_said_afterwards_is_answered_in_its_place():
    later = [RequestOutcome("r1", OpAck(id=2)), RequestOutcome("r1", OpAck(id=3), SetMap(b"part"))]
    assert told(ready(1), *later)[2:] == [("r1", "OpAck", 2), ("r1", "OpAck", 3), ("r1", "SetMap", None)]


def test_ready_of_one_robot_takes_nothing_from_another():
    assert told(ready(1), ready(2, "r2")) == [
        ("r1", "OpAck", 1),
        ("r1", "SetMap", None),
        ("r2", "OpAck", 2),
        ("r2", "SetMap", None),
    ]


def test_a_ready_that_is_refused_takes_nothing_away():
    refused = RequestOutcome("r1", OpAck(id=2, ok=False, reason="another robot runs", magic=8))
    assert told(ready(1), refused) == [("r1", "OpAck", 1), ("r1", "SetMap", None), ("r1", "OpAck", 2)]

"""Requests of robots that another gateway has, as the one that has them begins with them; on PostgreSQL."""

from __future__ import annotations

import asyncio
import contextlib
import math
import time
from dataclasses import fields, replace
from types import SimpleNamespace

import pytest
from sqlalchemy import text

from robot_bridge.core.clock import steady_time
from robot_bridge.core.errors import BridgeError, RefusedError, StoreError
from robot_bridge.core.messages.base import DESK_REQUESTS, Role
from robot_bridge.core.messages.commands import AbortAll, AbortTask, Send
from robot_bridge.core.messages.queues import PauseRobot, TakeOver
from robot_bridge.gateway.cluster import request_relay
from robot_bridge.gateway.cluster.bus import STOP
from robot_bridge.gateway.cluster.messages import Codec, Exchange, NotedAbort
from robot_bridge.gateway.cluster.request_relay import RequestRelay
from robot_bridge.gateway.model.robots import Robots
from robot_bridge.gateway.storage.database import Database, read_address
from robot_bridge.gateway.storage.repositories import gateways
from robot_bridge.gateway.storage.repositories.gateways import Member, NewRequest, TakenRequest
from robot_bridge.gateway.storage.repositories.robots import FencedError
from tests.support.patience import BUSY

HAS_OWNER = text("insert into robot_owners (robot, gw, run, fence) values ('r1', 'a', 'run', 1)")


class Handlers:
    """What answers requests of robots of this gateway."""

    def __init__(self):
        self.asked = []

    async def answer(self, request, _operator):
        self.asked.append(request.command)
        return {}


async def test_aborts_of_a_large_fleet_wait_for_no_look(fleet_url, monkeypatch):
    monkeypatch.setattr(request_relay, "MOST_AT_ONCE", 10)
    monkeypatch.setattr(request_relay, "LOOK_S", 3600.0)
    database = Database(read_address(fleet_url))
    await database.open()
    await database.run(lambda connection: connection.execute(HAS_OWNER))
    ids = [f"abort-{number:04}" for number in range(35)]
    requests = [NewRequest.of("r1", AbortTask(id, "r1", None, None)) for id in ids]
    await database.run(gateways.add_requests, requests[1:], "Ada", "b")
    # An hour ago, by the clock of who asked.
    await database.run(gateways.add_requests, requests[:1], "Ada", "b", time.time() - 3600.0)
    handlers, fleet = Handlers(), SimpleNamespace(me=Member("a", "run"), name="a")
    relay = RequestRelay(
        handlers, Robots(), fleet, Exchange("a", b"k" * 32, []), database, Notes(), own := Own()
    )
    running = asyncio.create_task(relay.run())
    try:
        async with asyncio.timeout(10 * BUSY):
            while len(handlers.asked) < len(ids):
                await asyncio.sleep(0.005)
    finally:
        running.cancel()
        await asyncio.gather(running, return_exceptions=True)
        await database.close()
    assert sorted(handlers.asked) == ids
    assert own.oldest == pytest.approx(steady_time() - 3600.0, abs=1800.0)


class Own:
    """The open commands of this gateway, of robots that do something else first."""

    def robot_of(self, command):
        return "r2" if command == "second-01" else None

    oldest = math.inf

    def asking(self, _request, at):
        self.oldest = min(self.oldest, at)
        return contextlib.nullcontext()

    def note_stop(self, _robots):
        """Have motions that are checked end."""


class Notes:
    """What is noted for the gateways that have the robots."""

    def __init__(self):
        self.noted, self.withdrawn = [], []

    def note_aborts(self, aborts):
        self.noted += aborts

    def withdraw_pauses(self, robots):
        of = set(robots)
        self.withdrawn += [
            one.command
            for one in self.noted
            if one.robot in of and one.of_pause and one.command not in self.withdrawn
        ]


class Away:
    """A database that is away for the next ``times``, and has the ``answer`` of another gateway then."""

    def __init__(self, times):
        self.times, self.answer = times, '{"result": {}}'

    async def run(self, work, *_arguments):
        if self.times:
            self.times -= 1
            raise StoreError("away")
        if work is gateways.collect_answers:
            return {} if self.answer is None else {1: self.answer}
        return [1]


ABORTS = {
    "abort": AbortTask("abort-0001", "r1", None, "smoke"),
    "abort of a command": AbortTask("abort-0001", None, "target-01", "smoke"),
    "send": Send("abort-0001", "r1", "Abort", reason="smoke", expires_in=60.0),
    "pause": PauseRobot("r1", "smoke"),
}


@pytest.fixture
def known():
    robots = Robots()
    robots.ready("r1", 1, "websocket", 0.0)
    robots.let_go("r1", "a")
    robots.doing = {"target-01": "r1"}.get
    return robots


def relay_by(robots, notes, database, *buses):
    fleet = SimpleNamespace(me=Member("b", "run"), name="b", database_time=lambda: 5000.0)
    return RequestRelay(Handlers(), robots, fleet, Exchange("b", b"k" * 32, buses), database, notes, Own())


@pytest.mark.parametrize("asked", sorted(ABORTS))
async def test_an_abort_of_a_robot_elsewhere_that_cannot_be_stored_is_noted_for_its_gateway(known, asked):
    relay, request = relay_by(known, notes := Notes(), Away(1)), ABORTS[asked]
    with pytest.raises(StoreError, match=r"sent to no robot; it is stored and sent as soon as the database"):
        await relay.answer(request, "Ada")
    (noted,) = notes.noted
    how = {
        "abort": (noted.command, "smoke", None, None),
        "abort of a command": (noted.command, "smoke", "target-01", None),
        "send": (noted.command, "smoke", None, 60.0),
        "pause": (noted.command, "paused: smoke", None, None),
    }[asked]
    assert noted == NotedAbort(how[0], "r1", "Ada", 5000.0, *how[1:], of_pause=asked == "pause")
    assert asked == "pause" or noted.command == "abort-0001"
    # A pause that is asked for again keeps the task, which that Abort would end.
    await relay.answer(request, "Ada")
    assert notes.noted == [noted]
    assert notes.withdrawn == ([noted.command] if asked == "pause" else [])


async def test_what_a_pause_has_left_stays_noted_until_another_one_has_succeeded(known):
    database = Away(1)
    relay, request = relay_by(known, notes := Notes(), database), ABORTS["pause"]
    with pytest.raises(StoreError):
        await relay.answer(request, "Ada")
    database.answer = '{"error": {"kind": "RefusedError", "text": "asked too long ago"}}'
    with pytest.raises(RefusedError, match=r"^asked too long ago$"):
        await relay.answer(request, "Ada")
    assert (len(notes.noted), notes.withdrawn) == (1, [])
    database.times = 1
    with pytest.raises(StoreError):
        await relay.answer(request, "Ada")
    first, second = [one.command for one in notes.noted]
    assert notes.withdrawn == [first]
    database.answer = '{"result": {}}'
    await relay.answer(request, "Ada")
    assert notes.withdrawn == [first, second]


@pytest.mark.parametrize("asked", sorted(ABORTS))
async def test_an_abort_or_a_pause_that_nobody_answers_stays_noted_and_who_asked_hears_that(
    known, monkeypatch, asked
):
    monkeypatch.setattr(request_relay, "ANSWER_WITHIN_S", 0.0)
    database = Away(0)
    database.answer = None
    relay = relay_by(known, notes := Notes(), database)
    with pytest.raises(RefusedError) as caught:
        await relay.answer(ABORTS[asked], "Ada")
    what = "pause may not be stored; an Abort" if asked == "pause" else "Abort may not be stored; it"
    assert str(caught.value) == (
        f"gateway a (r1) has not answered within 0 s. The {what} was sent to no robot; it stays noted, and "
        "is stored and sent by whichever gateway has the robot or gets it: look whether they stand"
    )
    assert [(one.robot, one.by) for one in notes.noted] == [("r1", "Ada")] and notes.withdrawn == []


async def test_what_a_robot_that_goes_elsewhere_was_asked_keeps_its_time(known, monkeypatch):
    """It is older there than a stop that came meanwhile."""
    known.ready("r2", 1, "websocket", 0.0)
    relay, now, written = relay_by(known, Notes(), database := Away(0)), [5000.0], []

    async def answer(_request, _operator):
        now[0] += 3.0
        raise StoreError("r2: connected to another gateway by now") from FencedError("r2")

    async def run(work, *arguments):
        if work is gateways.add_requests:
            written.append(arguments[1:])
        return await away(work, *arguments)

    away, database.run = database.run, run
    monkeypatch.setattr(relay._handlers, "answer", answer)
    monkeypatch.setattr(relay._membership, "database_time", lambda: now[0])
    assert await relay.answer(Send("target-01", "r2", "SetPosEnd", {"x": 1.0, "y": 2.0}), "Ada") == {}
    assert written == [("Ada", "b", 5000.0)]


async def test_a_robot_that_comes_here_is_loaded_before_anything_but_an_abort_is_done(known, monkeypatch):
    monkeypatch.setattr(request_relay, "TAKEN_UP_LOOK_S", 0.0)
    relay = relay_by(known, Notes(), Away(0))
    target = Send("target-01", "r1", "SetPosEnd", {"x": 1.0, "y": 2.0})
    for_target = asyncio.create_task(relay._answer_to(taken(target), 0.0))
    assert await relay._answer_to(taken(ABORTS["abort"]), 0.0) == {"result": {}}
    assert relay._handlers.asked == ["abort-0001"]
    known.restore(replace(known.get("r1"), gateway=None), 0.0)
    assert await for_target == {"result": {}}
    assert relay._handlers.asked == ["abort-0001", "target-01"]
    # One that has gone on is not done here.
    known.let_go("r1", "c")
    monkeypatch.setattr(request_relay, "TAKEN_UP_WITHIN_S", 0.0)
    answer = await relay._answer_to(taken(target), 0.0)
    assert answer == {
        "error": {
            "kind": "StoreError",
            "text": "robot 'r1' goes from one gateway to another; ask again in a moment",
        }
    }


def taken(request):
    return TakenRequest(1, *NewRequest.of("r1", request), "Ada", "a", 0.0, None)


class Unread:
    """A database that finds no command, or is away, or hangs."""

    def __init__(self, state):
        self.state = state

    async def read(self, _work, command):
        assert command == "target-02"
        if self.state == "hangs":
            await asyncio.Event().wait()
        if self.state == "away":
            raise StoreError("away")


@pytest.mark.parametrize(
    ("state", "reason"), [("away", "away"), ("hangs", "the database has not answered within 0 s")]
)
async def test_an_abort_of_a_command_that_cannot_be_looked_up_is_not_called_needless(
    known, monkeypatch, state, reason
):
    monkeypatch.setattr(request_relay, "STORED_WITHIN_S", 0.0)
    relay = relay_by(known, notes := Notes(), Unread(state))
    with pytest.raises(StoreError) as caught:
        await relay.answer(AbortTask("abort-0001", None, "target-02", None), "Ada")
    assert str(caught.value) == (
        f"which robot has command target-02 cannot be looked up: {reason}. This has aborted nothing: abort "
        "the robot by its name, or all robots"
    )
    assert relay._handlers.asked == notes.noted == []
    # What this gateway knows by itself needs no database.
    await relay.answer(AbortTask("abort-0002", None, "second-01", None), "Ada")
    assert relay._handlers.asked == ["abort-0002"]


async def test_an_abort_of_a_command_that_there_never_was_is_answered_here(known):
    relay = relay_by(known, Notes(), Unread("works"))
    await relay.answer(AbortTask("abort-0001", None, "target-02", None), "Ada")
    assert relay._handlers.asked == ["abort-0001"]


class SlowOwner:
    """The bus to a gateway, and the database in which it refuses what it was asked once it has an Abort."""

    name, connected = "slow", True

    def __init__(self, text):
        self.has_abort, self.answer = (
            asyncio.Event(),
            f'{{"error": {{"kind": "RefusedError", "text": "{text}"}}}}',
        )

    def publish(self, subject, _content):
        if subject == STOP:
            self.has_abort.set()
        return True

    async def run(self, work, *_arguments):
        if work is gateways.add_requests:
            return [1]
        await self.has_abort.wait()
        return {1: self.answer}


SENT = "r1 had been sent an Abort by then: look where it stands, then send it on, or abort it"


@pytest.mark.parametrize("text", ["ended", f"ended. {SENT}"])
async def test_who_is_refused_there_hears_once_that_the_robot_was_sent_an_abort(known, monkeypatch, text):
    monkeypatch.setattr(request_relay, "STORED_WITHIN_S", 0.0)
    owner = SlowOwner(text)
    relay = relay_by(known, Notes(), owner, owner)
    with pytest.raises(RefusedError) as caught:
        await relay.answer(ABORTS["abort"], "Ada")
    assert str(caught.value) == f"ended. {SENT}"


class Parts:
    """The bus to gateways a and c, and the database: a answers at once there, c once it has an Abort."""

    name, connected = "parts", True

    def __init__(self, answers, late=()):
        self.answers, self.late, self.aborted, self.robots = answers, dict(late), [], {}

    def publish(self, subject, content):
        if subject == STOP:
            self.aborted.append(Codec(b"k" * 32).decode(content).robot)
        return True

    async def run(self, work, *arguments):
        if work is gateways.add_requests:
            self.robots = dict(enumerate([request.robot for request in arguments[0]], 1))
            return list(self.robots)
        if work is gateways.withdraw_requests:
            return set(arguments[0])
        answers = {**self.answers, **(self.late if self.aborted else {})}
        # Who has them has deleted them.
        self.answers, self.late = {}, ({} if self.aborted else self.late)
        return {id: answers[robot] for id in arguments[0] if (robot := self.robots[id]) in answers}


def answered(robot):
    return f'{{"result": {{"command": "abort-of-{robot}", "robot": "{robot}"}}}}'


REFUSED = '{"error": {"kind": "RefusedError", "text": "robot \'r2\' is not known"}}'


@pytest.fixture
def fleet(monkeypatch):
    """Robot r0 here, r1 and r2 at gateway a, r3 at c; they wait for nothing."""
    robots = Robots()
    for robot, gateway in (("r0", None), ("r1", "a"), ("r2", "a"), ("r3", "c")):
        robots.ready(robot, 1, "websocket", 0.0)
        if gateway is not None:
            robots.let_go(robot, gateway)
    monkeypatch.setattr(request_relay, "STORED_WITHIN_S", 0.0)
    monkeypatch.setattr(request_relay, "LOOK_S", 0.001)
    return robots


class OwnAborts(Handlers):
    """Aborts robot r0, or says that the database is away."""

    def __init__(self, works=True):
        super().__init__()
        self.works = works

    async def answer(self, request, operator):
        if not self.works:
            raise StoreError("away. The Abort is not stored; it was sent to r0 all the same")
        await super().answer(request, operator)
        return {"commands": [{"command": "abort-of-r0", "robot": "r0"}]}


@pytest.mark.parametrize("works", [True, False])
async def test_of_aborts_of_all_robots_each_is_answered_by_itself(fleet, monkeypatch, works):
    monkeypatch.setattr(request_relay, "ANSWER_WITHIN_S", 0.0)
    parts = Parts({"r1": answered("r1"), "r2": REFUSED})
    relay = relay_by(fleet, notes := Notes(), parts, parts)
    relay._handlers = OwnAborts(works)
    with pytest.raises(RefusedError if works else StoreError) as caught:
        await relay.answer(AbortAll("abort-all-1"), "Ada")
    here = (
        "r0, r1" if works else "r1; not for r0: away. The Abort is not stored; it was sent to r0 all the same"
    )
    assert str(caught.value) == (
        f"Aborts are stored for {here}; not for r2: robot 'r2' is not known; not for r3: gateway c (r3) has "
        "not answered within 0 s. The Abort may not be stored; it was sent over the bus to the gateways of "
        "r3; it stays noted, and is stored and sent by whichever gateway has the robot or gets it: look "
        "whether they stand"
    )
    # What is stored, or refused, is not sent once more: the robot may be sent on by then.
    assert (parts.aborted, [one.robot for one in notes.noted]) == (["r3"], ["r3"])


async def test_of_aborts_of_all_robots_those_alone_that_are_not_stored_in_time_are_sent_twice(fleet):
    parts = Parts({"r1": answered("r1"), "r2": answered("r2")}, {"r3": answered("r3")})
    relay = relay_by(fleet, notes := Notes(), parts, parts)
    relay._handlers = OwnAborts()
    found = await relay.answer(AbortAll("abort-all-1"), "Ada")
    assert [command["robot"] for command in found["commands"]] == ["r0", "r1", "r2", "r3"]
    assert (parts.aborted, [one.robot for one in notes.noted]) == (["r3"], ["r3"])


def test_reasons_why_robots_are_not_aborted_are_few():
    failed = {f"r{n}": RefusedError(f"r{n} is gone") for n in range(6)}
    assert str(request_relay._partly_aborted([], failed)) == (
        "Aborts are stored for none; not for r0: r0 is gone; not for r1: r1 is gone; not for r2: r2 is gone; "
        "and not for r3, r4, r5"
    )
    # One reason for all needs no list.
    away = StoreError("away")
    assert request_relay._partly_aborted([], {"r0": away, "r1": away}) is away


def test_what_is_asked_of_one_robot_is_done_by_the_gateway_that_has_it():
    """A question may be answered by any gateway, and TakeOver is: it writes the queues of several robots."""
    of_a_robot = {
        request
        for request in DESK_REQUESTS.values()
        if request.least_role is not Role.VIEWER and "robot" in [one.name for one in fields(request)]
    }
    missing = of_a_robot - set(request_relay.RELAYED) - {TakeOver}
    assert not missing, f"{sorted(one.method for one in missing)}: add them to RELAYED of request_relay.py"


@pytest.mark.parametrize("answer", ["{", "[]", '{"error": {"kind": "ForbiddenError", "text": "no"}}'])
def test_an_answer_that_cannot_be_read_is_an_outcome_of_its_robot_alone(answer):
    assert isinstance(request_relay._outcome_in(answer, []), BridgeError)

"""In which order requests are dealt with, without a socket: a pause stops a robot, and waits for nothing."""

from __future__ import annotations

import asyncio

import pytest

from robot_bridge.core.errors import BusyError, RefusedError
from robot_bridge.core.messages.commands import AbortAll, AbortTask, Send, SetPositions, TargetPosition
from robot_bridge.core.messages.queues import GetQueue, PauseRobot, ResumeQueue, Share, TakeOver
from robot_bridge.core.messages.records import GetImage
from robot_bridge.core.messages.roads import GetRoute, ResolveConflict
from robot_bridge.core.messages.safety import ClearEmergencyStop, EmergencyStop
from robot_bridge.gateway.api import operator_server
from robot_bridge.gateway.api.operator_server import (
    MOST_ASIDE,
    MOST_BYTES,
    MOST_STOPPING,
    MOST_WAITING,
    RequestScheduler,
    ScheduledRequest,
)
from robot_bridge.protocol import jsonrpc
from tests.support.patience import BUSY

QUESTION = GetQueue()
SLOWLY = (GetQueue, GetRoute, GetImage)
"""What this operator's gateway deals with only when it is let."""
TOO_MANY = "too many requests of this connection wait to be answered; wait for answers, then ask again"


def asked(request, size=10):
    return ScheduledRequest(jsonrpc.Call(request.method, {}, 1), request, size)


class Operator:
    """Asks; what is begun, done and refused is listed. What is of ``held`` waits until it is let."""

    def __init__(self, held=SLOWLY):
        self.held = held
        self.begun, self.done, self.refused = [], [], []
        self.may = asyncio.Event()
        self.lanes = RequestScheduler(self.settle)

    async def settle(self, asked, refusal):
        assert isinstance(asked, ScheduledRequest)
        if refusal is not None:
            self.refused.append((asked.request, refusal))
            return
        self.begun.append(asked.request)
        if isinstance(asked.request, self.held):
            await self.may.wait()
        self.done.append(asked.request)

    async def ask(self, *requests, size=10):
        """Ask one after the other; each is begun that can be."""
        for request in requests:
            async with asyncio.timeout(BUSY * 5):
                await self.lanes.submit(asked(request, size))
                await rest()

    def refusals(self):
        return [str(error) for _, error in self.refused]


async def rest():
    """Let everything happen that can happen by now."""
    for _ in range(5):
        await asyncio.sleep(0)


async def test_a_pause_overtakes_what_waits_and_only_what_would_set_its_robot_in_motion():
    operator = Operator()
    mine, other = ResumeQueue("r1", 0), ResumeQueue("r2", 0)
    await operator.ask(QUESTION, mine, other, PauseRobot("r1"))
    assert operator.begun == [QUESTION, PauseRobot("r1")]
    ((refused, error),) = operator.refused
    assert refused == mine and type(error) is RefusedError
    assert str(error) == (
        "resume_queue: pause_robot came after it and before it was begun, so that it was not done; "
        "ask again if it is to be done all the same"
    )
    operator.may.set()
    await rest()
    assert operator.begun[-1] == other


STOPS = [EmergencyStop("stop-0001"), AbortAll(), AbortTask("abort-01", "r1"), PauseRobot("r1")]
STOPS += [Send("command-1", "r1", "Abort")]


@pytest.mark.parametrize("stop", STOPS, ids=lambda stop: stop.method)
async def test_what_stops_robots_is_begun_while_everything_else_waits(stop):
    operator = Operator()
    await operator.ask(
        QUESTION, GetImage(1), Send("command-2", "r1", "SetPosEnd", {"x": 1.0, "y": 2.0}), stop
    )
    assert operator.begun == [QUESTION, GetImage(1), stop]
    assert [type(request) for request, _ in operator.refused] == [Send]


async def test_a_target_sent_by_hand_waits_its_turn():
    operator = Operator()
    target = Send("command-1", "r1", "SetPosEnd", {"x": 1.0, "y": 2.0})
    await operator.ask(QUESTION, target)
    assert operator.begun == [QUESTION]
    operator.may.set()
    await rest()
    assert operator.done == [QUESTION, target]


ONE, OTHER = AbortTask("abort-01", "r1"), AbortTask("abort-02", "r2")
BY_COMMAND = AbortTask("abort-03", aborts="command-1")


@pytest.mark.parametrize(
    ("waiting", "stop", "is_overtaken"),
    [
        (ResumeQueue("r1", 0), ONE, True),
        (ResumeQueue("r1", 0), OTHER, False),
        (ResumeQueue("r1", 0), BY_COMMAND, True),
        (ResumeQueue("r1", 0), EmergencyStop("stop-0001"), True),
        (ResumeQueue("r1", 0), AbortAll(), True),
        (SetPositions([TargetPosition("r2", 1.0, 2.0)]), ONE, True),
        (ResolveConflict("r1", "r2", "waiting"), ONE, True),
        (ResolveConflict("r1", "r2", "waiting"), OTHER, True),
        (TakeOver("r2", 0, [Share("r3", 0, [])]), ONE, True),
        (GetQueue("r1"), ONE, False),
        (GetQueue("r1"), EmergencyStop("stop-0001"), False),
    ],
)
async def test_a_stop_overtakes_what_may_set_its_robot_in_motion(waiting, stop, is_overtaken):
    operator = Operator()
    await operator.ask(QUESTION, waiting, stop)
    assert [request for request, _ in operator.refused] == [waiting] * is_overtaken
    operator.may.set()
    await rest()
    assert (waiting in operator.done) is not is_overtaken


# --- too much of it -----------------------------------------------------------------------------------------


async def test_what_a_stop_overtakes_is_not_begun_before_that_has_its_turn():
    operator, clear = Operator(), ClearEmergencyStop()
    await operator.ask(QUESTION, clear, QUESTION)
    stop = EmergencyStop("stop-number-1")
    operator.lanes.overtake(stop)
    operator.may.set()
    await rest()
    assert operator.done == [QUESTION, QUESTION] and not operator.refused
    await operator.ask(stop)
    assert [request for request, _ in operator.refused] == [clear] and stop in operator.done


async def test_an_emergency_stop_is_never_one_too_many_and_any_other_stop_is():
    operator = Operator(held=(PauseRobot,))
    await operator.ask(*[PauseRobot("r1")] * MOST_STOPPING)
    assert len(operator.begun) == MOST_STOPPING and operator.refused == []
    await operator.ask(PauseRobot("one-too-many"))
    ((refused, error),) = operator.refused
    assert refused == PauseRobot("one-too-many") and type(error) is BusyError
    assert str(error) == f"pause_robot: {TOO_MANY}"
    stop = EmergencyStop("stop-0001")
    await operator.ask(stop)
    assert operator.done == [stop]
    assert len(operator.refused) == 1


async def test_of_emergency_stops_that_are_not_done_so_many_are_begun_and_then_the_connection_waits(
    monkeypatch,
):
    monkeypatch.setattr(operator_server, "MOST_STOPPING", 2)
    monkeypatch.setattr(operator_server, "MOST_EMERGENCIES", 3)
    operator = Operator(held=(EmergencyStop,))
    stops = [EmergencyStop(f"stop-{k:04}") for k in range(5)]
    await operator.ask(*stops[:4])
    last = asyncio.ensure_future(operator.lanes.submit(asked(stops[4])))
    await rest()
    assert operator.begun == stops and not last.done()
    operator.may.set()
    async with asyncio.timeout(BUSY * 5):
        await last
    assert operator.done == stops and operator.refused == []


async def test_the_connection_goes_on_as_soon_as_one_of_them_is_done(monkeypatch):
    monkeypatch.setattr(operator_server, "MOST_STOPPING", 0)
    monkeypatch.setattr(operator_server, "MOST_EMERGENCIES", 2)
    gates = {f"stop-{k:04}": asyncio.Event() for k in range(2)}

    async def settle(asked, _refusal):
        await gates[asked.request.command].wait()

    lanes = RequestScheduler(settle)
    first, second = (asked(EmergencyStop(id)) for id in gates)
    async with asyncio.timeout(BUSY * 5):
        await lanes.submit(first)
        last = asyncio.ensure_future(lanes.submit(second))
        await rest()
        assert not last.done()
        gates["stop-0000"].set()
        await last


async def test_a_pause_beside_many_stops_holds_no_connection_up(monkeypatch):
    monkeypatch.setattr(operator_server, "MOST_EMERGENCIES", -MOST_STOPPING)
    operator = Operator(held=(PauseRobot,))
    await operator.ask(PauseRobot("r1"), PauseRobot("r1"))
    assert operator.begun == [PauseRobot("r1")] * 2


async def test_so_many_requests_wait_their_turn_and_the_next_is_refused():
    operator = Operator()
    await operator.ask(*[QUESTION] * (MOST_WAITING + 1))
    assert operator.refused == []
    await operator.ask(GetQueue("r1"))
    ((refused, error),) = operator.refused
    assert refused == GetQueue("r1") and type(error) is BusyError
    assert str(error) == f"get_queue: {TOO_MANY}"
    operator.may.set()
    async with asyncio.timeout(BUSY * 5):
        while len(operator.done) <= MOST_WAITING:
            await asyncio.sleep(0)
    assert GetQueue("r1") not in operator.done


async def test_so_many_bytes_wait_their_turn_and_one_request_of_any_length():
    operator = Operator()
    await operator.ask(QUESTION, size=10 * MOST_BYTES)
    await operator.ask(GetQueue("long"), size=2 * MOST_BYTES)
    await operator.ask(GetQueue("r1"))
    assert [request for request, _ in operator.refused] == [GetQueue("r1")]
    operator.may.set()
    await rest()
    operator.may.clear()
    await operator.ask(QUESTION)
    await operator.ask(GetQueue("half"), size=MOST_BYTES // 2)
    await operator.ask(GetQueue("second"), size=MOST_BYTES // 2)
    await operator.ask(GetQueue("byte"), size=1)
    assert [request for request, _ in operator.refused] == [GetQueue("r1"), GetQueue("byte")]


async def test_so_many_slow_questions_wait_aside_and_hold_up_nothing_else():
    operator = Operator(held=(GetImage,))
    images = [GetImage(k) for k in range(MOST_ASIDE + 1)]
    await operator.ask(*images)
    assert operator.begun == images[:1] and operator.refused == []
    await operator.ask(GetImage(1000), QUESTION)
    assert operator.refusals() == [f"get_image: {TOO_MANY}"]
    assert [request for request, _ in operator.refused] == [GetImage(1000)]
    assert operator.done == [QUESTION]
    operator.may.set()
    async with asyncio.timeout(BUSY * 5):
        while len(operator.done) < MOST_ASIDE + 2:
            await asyncio.sleep(0)
    assert operator.done[1:] == images


async def test_a_way_that_is_asked_for_again_before_it_was_begun_is_looked_for_once():
    operator = Operator()
    ways = [GetRoute(float(k), 0.0, robot="r1") for k in range(3)]
    others = [GetRoute(9.0, 0.0, robot="r2"), GetRoute(9.0, 0.0, start=(1.0, 1.0))]
    await operator.ask(GetImage(1), *ways, *others)
    assert [request for request, _ in operator.refused] == ways[:2]
    assert all(type(error) is RefusedError for _, error in operator.refused)
    assert operator.refusals() == ["get_route: it was asked again before this was begun"] * 2
    operator.may.set()
    await rest()
    assert operator.done == [GetImage(1), ways[2], *others]


# --- the operator goes away ---------------------------------------------------------------------------------


async def test_who_goes_away_leaves_what_was_begun_and_every_stop_to_its_end_and_nothing_else():
    operator = Operator(held=(*SLOWLY, PauseRobot))
    await operator.ask(QUESTION, GetQueue("waits"), GetImage(1), GetImage(2), PauseRobot("r1"))
    finishing = asyncio.ensure_future(operator.lanes.finish())
    await rest()
    assert not finishing.done()
    operator.may.set()
    async with asyncio.timeout(BUSY * 5):
        await finishing
    assert sorted(operator.done, key=repr) == [QUESTION, PauseRobot("r1")]
    await rest()
    assert operator.begun == [QUESTION, GetImage(1), PauseRobot("r1")]


@pytest.mark.parametrize("held", [GetQueue, PauseRobot])
async def test_who_goes_away_is_waited_for_until_each_of_them_is_done(held):
    operator = Operator(held=(held,))
    await operator.ask(QUESTION, PauseRobot("r1"))
    finishing = asyncio.ensure_future(operator.lanes.finish())
    await rest()
    assert not finishing.done()
    operator.may.set()
    async with asyncio.timeout(BUSY * 5):
        await finishing
    assert len(operator.done) == 2


async def test_one_stop_that_goes_wrong_keeps_no_other_from_being_waited_for():
    free, done = asyncio.Event(), []

    async def settle(asked, _refusal):
        if asked.request == PauseRobot("broken"):
            raise RuntimeError("the connection is gone")
        await free.wait()
        done.append(asked.request)

    lanes = RequestScheduler(settle)
    for request in (PauseRobot("r1"), PauseRobot("broken")):
        await lanes.submit(asked(request))
    finishing = asyncio.ensure_future(lanes.finish())
    await rest()
    assert not finishing.done()
    free.set()
    async with asyncio.timeout(BUSY * 5):
        await finishing
    assert done == [PauseRobot("r1")]


async def test_who_asked_nothing_is_not_waited_for():
    async with asyncio.timeout(BUSY * 5):
        await Operator().lanes.finish()

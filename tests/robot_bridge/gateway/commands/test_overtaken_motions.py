"""An Abort or a pause stops a robot for good: no motion that was asked before it is stored behind it."""

from __future__ import annotations

import asyncio
import threading
from types import SimpleNamespace

import pytest

from robot_bridge.core.errors import RefusedError
from robot_bridge.core.json_decoder import decode_json
from robot_bridge.core.messages.commands import AbortAll, AbortTask, Send, SetPositions, TargetPosition
from robot_bridge.core.messages.queues import PauseRobot
from robot_bridge.core.messages.robots import Abort, SetPosEnd
from robot_bridge.core.messages.safety import ClearEmergencyStop, EmergencyStop
from robot_bridge.gateway.cluster import request_relay
from robot_bridge.gateway.cluster.bus import STOP
from robot_bridge.gateway.cluster.messages import AbortCall, Exchange
from robot_bridge.gateway.cluster.request_relay import RequestRelay
from robot_bridge.gateway.commands import requests as order_module
from robot_bridge.gateway.commands.active_command import CommandOrder, KeptAbort
from robot_bridge.gateway.commands.validation import StopTimes
from robot_bridge.gateway.model.events import RequestHandlers
from robot_bridge.gateway.storage.repositories import gateways
from robot_bridge.gateway.storage.repositories.gateways import NewRequest, TakenRequest
from tests.support.bridge.queue_line import Line, task
from tests.support.patience import until

KEY = b"k" * 32
WGS84 = "EPSG:4326"
REFUSED = "robot 'r1': an Abort or a pause came while this was checked; ask again if it is still wanted"


@pytest.fixture
async def two(two):
    for robot in ("r1", "r2"):
        await two.at(20.0, 40.0, robot=robot)
    return two


class Transformation:
    """A transformation of places that lasts until it is released."""

    def __init__(self):
        self.begun, self.released = 0, threading.Event()

    def to_site(self, points, _crs):
        self.begun += 1
        assert self.released.wait(60)
        return [(50.0, 40.0) for _ in points]


@pytest.fixture
def places(two, monkeypatch):
    transformation = Transformation()
    monkeypatch.setattr(two.fleet.orders._site, "to_site", transformation.to_site)
    yield transformation
    transformation.released.set()


def target(id="command-a", robot="r1", **more):
    return Send(id, robot, "SetPosEnd", {"x": 16.0, "y": 48.0, **more})


async def emergency(fleet):
    await fleet.emergency.stop(EmergencyStop("stop-0001"), "Ada")
    await fleet.emergency.clear(ClearEmergencyStop("stop-0001"), "Bob")


async def left_elsewhere(fleet):
    order = CommandOrder("abort-0001", "r1", Abort(), "Ada")
    fleet._commands.keep_left([KeptAbort(order, fleet._clock.time(), is_left=True)])


async def left_for_its_gateway(fleet):
    order = CommandOrder("abort-0001", "r1", Abort(), "Ada")
    fleet._commands._unstored.keep_left([KeptAbort(order, fleet._clock.time(), is_left=True)])
    fleet._commands.keep_left_for(["r1"])


def relay_of(fleet, database=None):
    """Return what relays requests to this gateway, and its end of the bus."""
    exchange, me = Exchange("b", KEY, []), SimpleNamespace(me=None)
    handlers, own = RequestHandlers(fleet.orders), fleet._commands.drafting
    return RequestRelay(handlers, fleet.robots, me, exchange, database, None, own), exchange


async def over_the_bus(fleet):
    """As an Abort or a pause comes from another gateway whose database does not answer."""
    here, there = relay_of(fleet)[1], Exchange("a", KEY, [])
    there._buses = [SimpleNamespace(publish=lambda *message: here.receive(*message) or True)]
    assert there.send(STOP, AbortCall("a", "r1", "abort-0001"))


STOPS = {
    "abort": lambda fleet: fleet.orders.abort(AbortTask("abort-0001", "r1"), "Ada"),
    "abort_all": lambda fleet: fleet.orders.abort_all(AbortAll("abort-0001"), "Ada"),
    "send": lambda fleet: fleet.orders.send(Send("abort-0001", "r1", "Abort", {}), "Ada"),
    "pause": lambda fleet: fleet.pauses.pause(PauseRobot("r1"), "Ada"),
    "emergency": emergency,
    "elsewhere": left_elsewhere,
    "over the bus": over_the_bus,
    "left for its gateway": left_for_its_gateway,
}


@pytest.mark.parametrize("stop", STOPS.values(), ids=STOPS)
async def test_a_motion_whose_places_are_being_transformed_is_not_sent_after_a_stop(two, places, stop):
    asked = asyncio.create_task(two.fleet.orders.send(target(crs=WGS84), "Ada"))
    await until(lambda: places.begun)
    await stop(two.fleet)
    places.released.set()
    with pytest.raises(RefusedError) as refused:
        await asked
    assert str(refused.value) == REFUSED
    assert "SetPosEnd" not in two.waiting("r1")


async def test_of_several_robots_none_is_sent_on_when_one_was_aborted_meanwhile(two, places):
    positions = [TargetPosition(robot, 16.0, 48.0, crs=WGS84) for robot in ("r2", "r1")]
    asked = asyncio.create_task(two.fleet.orders.set_positions(SetPositions(positions), "Ada"))
    await until(lambda: places.begun)
    await STOPS["abort"](two.fleet)
    places.released.set()
    with pytest.raises(RefusedError, match="robot 'r1': an Abort or a pause came"):
        await asked
    assert (two.waiting("r1"), two.waiting("r2")) == (["Abort"], [])


@pytest.fixture
def check(two, monkeypatch):
    """Have slow checks of motions wait until ``released``; ``begun`` is set when one waits."""
    check, rules = (
        SimpleNamespace(begun=asyncio.Event(), released=asyncio.Event()),
        two.fleet._commands.drafting._rules,
    )
    prepare = rules.prepare

    async def prepare_late(message):
        if not isinstance(message, Abort):
            check.begun.set()
            await check.released.wait()
        await prepare(message)

    monkeypatch.setattr(rules, "prepare", prepare_late)
    monkeypatch.setattr(order_module, "STORED_WITHIN", 0.01)
    return check


async def stop_while_checked(two, check, stop="abort"):
    """Stop r1 while its next motion is checked, for longer than an Abort waits to be stored."""
    sent = []
    two.fleet.orders.reach(lambda robot, _call_id: sent.append(robot) or True)
    await until(check.begun.is_set)
    stopping = asyncio.create_task(STOPS[stop](two.fleet))
    await until(lambda: sent)
    check.released.set()
    return await stopping


async def test_a_motion_whose_check_takes_longer_than_an_abort_waits_is_not_sent_after_it(two, check):
    asked = asyncio.create_task(two.fleet.orders.send(target(), "Ada"))
    assert (await stop_while_checked(two, check)).command == "abort-0001"
    with pytest.raises(RefusedError) as refused:
        await asked
    assert str(refused.value) == REFUSED
    assert two.waiting("r1") == ["Abort"]


async def test_a_robot_that_is_paused_keeps_what_it_does_and_not_what_is_still_checked(two, check):
    check.released.set()
    await two.send("a")
    await two.acknowledge_all("r1")
    check.released.clear()
    check.begun.clear()
    asked = asyncio.create_task(two.fleet.orders.send(target("command-b"), "Ada"))
    report = await stop_while_checked(two, check, "pause")
    with pytest.raises(RefusedError, match="a pause came"):
        await asked
    assert (report.state.value, [(one.x, one.y) for one in report.tasks]) == ("paused", [(50.0, 40.0)])
    assert two.waiting("r1") == ["Abort"]


async def test_a_task_of_a_queue_that_is_checked_is_not_sent_after_an_abort_which_pauses_it(two, check):
    line = Line(two)
    asked = asyncio.create_task(line.set(task("a")))
    await stop_while_checked(two, check)
    await asked
    assert two.waiting("r1") == ["Abort"]
    report = await line.report()
    assert (report.state.value, report.reason) == ("paused", "aborted by Ada")


async def test_what_is_repeated_meanwhile_is_as_old_as_at_first_and_may_be_asked_once_more(two, places):
    send, request = two.fleet.orders.send, target(crs=WGS84)
    first = asyncio.create_task(send(request, "Ada"))
    await until(lambda: places.begun == 1)
    await STOPS["abort"](two.fleet)
    repeated = asyncio.create_task(send(request, "Ada"))
    await until(lambda: places.begun == 2)
    places.released.set()
    outcomes = await asyncio.gather(first, repeated, return_exceptions=True)
    assert [str(outcome) for outcome in outcomes] == [REFUSED] * 2
    assert (await send(request, "Ada")).state.value == "queued"


async def test_other_robots_are_sent_on_and_a_beginning_is_no_motion(two, places):
    send = two.fleet.orders.send
    beginning = Send("command-b", "r1", "SetPosIni", {"x": 16.0, "y": 48.0, "crs": WGS84})
    asked = [asyncio.create_task(send(one, "Ada")) for one in (target(robot="r2", crs=WGS84), beginning)]
    await until(lambda: places.begun == 2)
    await STOPS["abort"](two.fleet)
    places.released.set()
    assert [report.state.value for report in await asyncio.gather(*asked)] == ["queued", "queued"]


async def test_a_command_that_is_stored_is_answered_as_it_stands_after_an_abort(two, places):
    places.released.set()
    await two.fleet.orders.send(target(crs=WGS84), "Ada")
    places.released.clear()
    again = asyncio.create_task(two.fleet.orders.send(target(crs=WGS84), "Ada"))
    await until(lambda: places.begun == 2)
    await STOPS["abort"](two.fleet)
    places.released.set()
    assert (await again).state.value == "aborted"


def test_of_robots_and_commands_that_are_gone_no_times_are_kept():
    times = StopTimes()
    times.add(["r1", "r2"])
    times.forget("r1")
    with times.asking("command-a") as asked:
        pass
    assert (times._newest.keys(), times._asked) == ({"r2"}, {})
    times.check(CommandOrder("command-a", "r2", SetPosEnd(1.0, 2.0), "Ada", asked=asked))


class Relayed:
    """The database with a request of another gateway that was asked ``age`` seconds ago."""

    def __init__(self, request, age):
        self.request, self.age, self.answer = request, age, None

    async def read(self, _work, *_arguments):
        return True

    async def run(self, work, *arguments):
        if work is gateways.begin_requests:
            return [TakenRequest(1, *NewRequest.of("r1", self.request), "Ada", "a", self.age, None)]
        self.answer = decode_json(arguments[1])


RELAYED = {
    "send": target(),
    "positions": SetPositions([TargetPosition("r1", 16.0, 48.0)]),
}


@pytest.mark.parametrize("request_", RELAYED.values(), ids=RELAYED)
@pytest.mark.parametrize(("age", "is_late"), [(60.0 * 60.0, False), (0.0, True)])
async def test_a_motion_asked_at_another_gateway_before_a_stop_is_not_sent_after_it(
    two, monkeypatch, request_, age, is_late
):
    monkeypatch.setattr(request_relay, "TOO_OLD_S", 2 * age)
    relay, _ = relay_of(two.fleet, database := Relayed(request_, age))
    await STOPS["abort"](two.fleet)
    await relay.begin_waiting()
    await until(lambda: database.answer)
    if is_late:
        assert "result" in database.answer and two.waiting("r1") == ["Abort", "SetPosEnd"]
    else:
        assert database.answer == {"error": {"kind": "RefusedError", "text": REFUSED}}
        assert two.waiting("r1") == ["Abort"]


async def test_a_stop_that_comes_while_what_another_gateway_asks_is_read_came_after_it(two):
    relay, _ = relay_of(two.fleet, database := Relayed(target(), 0.0))
    run = database.run

    async def run_and_stop(work, *arguments):
        if work is gateways.begin_requests:
            await STOPS["abort"](two.fleet)
        return await run(work, *arguments)

    database.run = run_and_stop
    await relay.begin_waiting()
    await until(lambda: database.answer)
    assert database.answer["error"]["text"] == REFUSED

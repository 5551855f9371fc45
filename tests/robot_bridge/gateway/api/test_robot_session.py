"""What goes wrong in the gateway while a robot speaks: the log is told all of it, the robot a number."""

from __future__ import annotations

import asyncio
import contextlib
import json
import re
from types import SimpleNamespace

import pytest

from robot_bridge.core.errors import DataRefusedError, RefusedError, StoreError
from robot_bridge.core.logs import IN_FULL, RepeatedLines
from robot_bridge.core.messages.robots import OpAck, Ready
from robot_bridge.core.sites.settings_tables import LimitSettings
from robot_bridge.gateway.api import robot_websockets
from robot_bridge.gateway.api.robot_session import MOST_DUE, RobotConnection, RobotSessions
from robot_bridge.gateway.api.robot_websockets import LinkConnection, WebSocketInterface
from robot_bridge.gateway.api.shared_connection import LinkedRobotChannel
from robot_bridge.gateway.fleet.link_supervision import ConnectionClaims
from robot_bridge.gateway.fleet.robot_outboxes import RequestOutcome
from robot_bridge.gateway.model.events import EventBus
from robot_bridge.gateway.monitoring import Counters
from robot_bridge.gateway.storage.repositories.robots import FencedError
from robot_bridge.links.base.linked_robots import frame_of
from robot_bridge.protocol import jsonrpc
from tests.support.patience import BUSY

POSITION = json.dumps(
    {"jsonrpc": "2.0", "method": "SendPos", "params": {"x": 1.0, "y": 2.0, "theta": 0.0, "v": 0.0}}
).encode()
NUMBER = re.compile(r"internal error ([0-9a-f]{8})")


class Connection:
    """Keeps what the robot is sent."""

    def __init__(self):
        self.sent = []
        self.is_sending = False

    def write_at_once(self, frame):
        if not self.is_sending:
            self.sent.append(json.loads(frame))
        return not self.is_sending

    is_busy = False

    async def cut_if_busy(self):
        self.sent.append("cut if busy")
        return False

    async def send(self, frame):
        self.sent.append(json.loads(frame))


def fail(*_arguments, **_more):
    raise RuntimeError("the secret")


async def fail_later(*_arguments, **_more):
    fail()


@pytest.fixture
def connection():
    return Connection()


@pytest.fixture
def own(connection):
    """A robot that has said Ready to a gateway in which everything fails."""
    fleet = SimpleNamespace(
        accept_pose=fail,
        receive=fail_later,
        acknowledge=fail,
        emergency=SimpleNamespace(answered=fail),
        counters=Counters(),
        repeated=RepeatedLines(),
    )
    own = RobotConnection(fleet, connection, "r1", RobotSessions(ConnectionClaims()))
    own.session._admitted = True
    return own


def logged(caplog):
    """Return the number under which the log tells everything."""
    assert "RuntimeError: the secret" in caplog.text
    (number,) = set(NUMBER.findall(caplog.text))
    return number


@pytest.mark.parametrize("at_once", [True, False])
async def test_a_position_in_which_something_goes_wrong_is_answered_with_the_number_in_the_log(
    own, connection, caplog, at_once
):
    if at_once:
        assert own._take_at_once(POSITION)
    else:
        await own._receive(POSITION)
    await own.session._due.wait()
    (told,) = connection.sent
    assert told["error"]["code"] == jsonrpc.INTERNAL_ERROR
    assert NUMBER.match(told["error"]["message"])[1] == logged(caplog)
    assert "the secret" not in str(told)


@pytest.mark.parametrize("id", [7, "emergency-1"])
async def test_an_acknowledgement_in_which_something_goes_wrong_is_in_the_log_and_ends_no_connection(
    own, connection, caplog, id
):
    await own._receive(json.dumps({"jsonrpc": "2.0", "id": id, "result": {}}))
    await own.session._due.wait()
    assert logged(caplog)
    assert f"robot 'r1', acknowledgement {id}" in caplog.text
    assert connection.sent == []


@pytest.mark.parametrize(("error", "again"), [(DataRefusedError("refused"), []), (StoreError("away"), [1])])
async def test_what_a_robot_said_is_asked_for_again_unless_the_database_refuses_it_as_data(
    own, monkeypatch, error, again
):
    async def acknowledge(*_):
        raise error

    begun = []
    own.session._fleet.acknowledge = acknowledge
    monkeypatch.setattr(own.session._delivery, "begin", lambda: begun.append("at once"))
    monkeypatch.setattr(own.session._delivery, "begin_later", lambda: begun.append(1))
    await own._receive(json.dumps({"jsonrpc": "2.0", "id": 7, "error": {"code": 1, "message": "no"}}))
    await own.session._due.wait()
    assert begun == again


async def test_a_full_disk_is_told_to_the_log_of_all_that_a_robot_says_together(own, caplog):
    async def receive(*_):
        raise StoreError("the disk is full")

    own.session._fleet.receive = own.session._fleet.acknowledge = receive
    place = {"x": 1.0, "y": 2.0}
    for method, params in (
        ("SetObject", place | {"object": "cone"}),
        ("GetMap", place | {"width": 9.0, "height": 9.0}),
    ):
        for id in range(9):
            await own._receive(json.dumps({"jsonrpc": "2.0", "id": id, "method": method, "params": params}))
            await own._receive(json.dumps({"jsonrpc": "2.0", "id": id, "result": {}}))
    await own.session._due.wait()
    assert caplog.text.count("the disk is full") == IN_FULL


async def test_nothing_is_sent_again_over_a_connection_that_has_ended(own, monkeypatch):
    """What waits for the robot is its next connection's by then."""

    async def acknowledge(*_):
        raise StoreError("away")

    own.session._fleet.acknowledge = acknowledge
    begun = []
    monkeypatch.setattr(own.session._delivery, "begin_later", lambda: begun.append(1))
    await own._receive(json.dumps({"jsonrpc": "2.0", "id": 7, "result": {}}))
    own.session.end()
    await own.session._due.wait()
    assert begun == []


async def test_a_robot_that_acknowledges_ever_more_waits_for_what_is_being_stored(own):
    free, begun = asyncio.Event(), []

    async def acknowledge(_robot, _link, ack):
        begun.append(ack.id)
        await free.wait()

    own.session._fleet.acknowledge = acknowledge
    own.session._fleet.accept_pose = lambda *_: None

    async def say(count):
        for id in range(count):
            await own._receive(json.dumps({"jsonrpc": "2.0", "id": id, "result": {}}))

    await say(10)
    assert own._take_at_once(POSITION)
    talking = asyncio.create_task(say(MOST_DUE))
    await asyncio.sleep(0.01)
    assert len(begun) == MOST_DUE and not talking.done() and not own._take_at_once(POSITION)
    free.set()
    await talking
    await own.session._due.wait()
    assert len(begun) == MOST_DUE + 10 and own._take_at_once(POSITION)


async def test_a_robot_that_another_gateway_got_while_it_was_let_in_is_refused_and_says_ready_again(
    own, connection, monkeypatch
):
    """It would stay connected to a gateway that has it no more; as it was lost it was not in yet."""
    lost = [FencedError("robot r1: another gateway has got it meanwhile; say Ready again")]

    async def receive(robot, _link, ready, id):
        return RequestOutcome(robot, OpAck(id=id, magic=ready.magic))

    async def finish(*_, **__):
        pass

    def check_owned(_robot):
        if lost:
            raise lost.pop()

    begun = []
    own.session._admitted = False
    own.session._fleet.__dict__.update(
        receive=receive,
        check_owned=check_owned,
        reception=SimpleNamespace(holds=ConnectionClaims()),
        outboxes=SimpleNamespace(finish=finish),
        gateway_urls=lambda _endpoint: None,
    )
    own.session._delivery.begin = lambda: begun.append(1)
    ready = json.dumps({"jsonrpc": "2.0", "method": "Ready", "params": {"magic": 1}, "id": 1})
    await own._receive(ready)
    assert "another gateway has got it" in connection.sent[-1]["error"]["message"]
    assert (own.session._admitted, list(own.session._sessions), begun) == (False, [], [])
    # Behind the map of another robot the result waits, and an Abort must not.
    monkeypatch.setattr(own.session._delivery, "send_result", connection.send)
    monkeypatch.setattr(connection, "send", fail_later)
    await own._receive(ready)
    assert connection.sent[-1]["result"]["ok"]
    assert (own.session._admitted, list(own.session._sessions), begun) == (True, [own.session], [1])


def test_a_connection_that_fails_keeps_no_stop_from_the_others(caplog):
    told = []
    reached = SimpleNamespace(reach=lambda _link: None)
    reception = SimpleNamespace(holds=None)
    link = WebSocketInterface(
        SimpleNamespace(emergency=reached, orders=reached, reception=reception, events=EventBus())
    )
    good = [SimpleNamespace(robot=f"r{n}", stop_now=told.append) for n in range(3)]
    bad = [SimpleNamespace(robot=f"b{n}", stop_now=fail) for n in range(3)]
    # In the order in which they are kept, which nobody knows: some of the good ones come behind a bad one.
    link._sessions = [bad[0], good[0], bad[1], good[1], bad[2], good[2]]
    links = [SimpleNamespace(name=f"l{n}", stop_all=told.append if n % 2 else fail) for n in range(4)]
    link._links = links
    link._stop_all("emergency-stop-0001")
    assert told == ["emergency-stop-0001"] * 5
    assert "telling link l2 of an emergency stop failed" in caplog.text
    assert "telling robot 'b2' of an emergency stop failed" in caplog.text


@pytest.fixture
def link(connection):
    """A link that may speak for all robots, at a gateway in which everything fails."""
    connection.identity = SimpleNamespace(name="agvs")
    fleet = SimpleNamespace(
        accept_poses=fail, links=SimpleNamespace(introduce=fail), repeated=RepeatedLines()
    )
    gate = SimpleNamespace(robots_of_link=lambda _visitor: ("*",), limits=None)
    return LinkConnection(fleet, connection, gate, RobotSessions(ConnectionClaims()))


async def test_what_goes_wrong_over_a_link_has_a_number_and_ends_no_connection(link, connection, caplog):
    hello = {"jsonrpc": "2.0", "id": 3, "method": "hello", "params": {"protocol": 1, "kind": "t"}}
    await link._receive(json.dumps(hello))
    await link._receive(frame_of([]))
    assert [frame["error"]["code"] for frame in connection.sent] == [jsonrpc.INTERNAL_ERROR] * 2
    assert NUMBER.match(connection.sent[0]["error"]["message"])[1] in NUMBER.findall(caplog.text)


async def test_a_link_is_busy_while_a_message_has_the_turn_that_others_wait_for(link):
    assert not link.is_busy
    async with link.lane(urgent=False, large=False):
        assert link.is_busy
    link._connection.is_busy = True
    assert link.is_busy


@pytest.mark.parametrize(("after", "longest", "waited"), [(0.2, 60.0, 0.2), (60.0, 0.1, 0.0)])
async def test_a_link_that_was_cut_for_a_stop_gets_large_messages_after_its_last_robot(
    link, monkeypatch, after, longest, waited
):
    """Each robot's Abort is sent when it has said Ready: behind a map it would cut the link again."""
    monkeypatch.setattr(robot_websockets, "AFTER_CUT_S", after)
    monkeypatch.setattr(robot_websockets, "LONGEST_DELAY_S", longest)
    monkeypatch.setattr(robot_websockets, "LinkedRobotChannel", lambda *_: None)
    link.kind, link._gate.limits = "slow", SimpleNamespace(robots=10)
    loop = asyncio.get_running_loop()
    link.delay_large()
    await asyncio.sleep(0.15)
    robot_came = loop.time()
    link._new_place("r1", admits=True)
    async with asyncio.timeout(BUSY * 5), link.lane(urgent=False, large=True):
        assert loop.time() - robot_came >= waited


async def test_a_stop_of_a_link_outdates_what_each_of_its_robots_was_to_be_sent(link, connection):
    outdated = []
    for name in ("r1", "r2"):
        session = SimpleNamespace(outdate=lambda name=name: outdated.append(name))
        link._places[name] = SimpleNamespace(session=session)
    stop = {"call": "emergency-stop-0001", "emergency": True}
    link.stop_all("emergency-stop-0001")
    # Without a turn of the loop.
    assert outdated == ["r1", "r2"] and [frame["params"] for frame in connection.sent] == [stop]
    # While another message is being sent in pieces it comes after that.
    connection.is_sending = True
    link.stop_all("emergency-stop-0001")
    assert len(connection.sent) == 1
    await link._tasks.wait()
    before, cut, after = connection.sent
    assert cut == "cut if busy" and [before["params"], after["params"]] == [stop, stop]


async def test_what_stops_a_linked_robot_waits_for_no_turn_and_all_else_does(link):
    async def enter(**how):
        async with link.lane(**how):
            pass

    async with link.lane(urgent=False, large=True):
        await asyncio.wait_for(enter(urgent=True, large=True), 20)
        others = [asyncio.create_task(enter(urgent=False, large=large)) for large in (False, True)]
        for _ in range(5):
            await asyncio.sleep(0)
        assert not any(one.done() for one in others)
    await asyncio.wait_for(asyncio.gather(*others), 20)


async def test_one_message_of_a_linked_robot_that_goes_wrong_keeps_the_next_from_nothing(connection, caplog):
    place = LinkedRobotChannel(
        SimpleNamespace(),
        SimpleNamespace(name="agvs"),
        "r1",
        LimitSettings(),
        RobotSessions(ConnectionClaims()),
    )
    done = asyncio.Event()

    async def work():
        done.set()

    place.add(fail_later())
    place.add(work())
    await asyncio.wait_for(done.wait(), 20)
    assert "link agvs: what robot 'r1' said failed" in caplog.text


ENDS = {"away": StoreError("away"), "taken": RefusedError("taken"), "fenced": FencedError("elsewhere")}


@pytest.mark.parametrize(
    ("end", "waits"),
    [("stored", False), ("refused", False), ("away", True), ("taken", False), ("fenced", False)],
)
async def test_a_robot_whose_ready_could_not_be_stored_is_sent_aborts_until_it_is_let_in_or_refused(
    own, end, waits
):
    sessions = own.session._sessions

    async def receive(_robot, _link, _ready, _id):
        assert sessions.applicant("r1") is own.session
        if end in ENDS:
            raise ENDS[end]
        return RequestOutcome("r1", OpAck(ok=end == "stored", magic=1))

    own._fleet.receive, own._fleet.check_owned = receive, lambda _robot: None
    own._fleet.reception = SimpleNamespace(holds=sessions._claims)
    with contextlib.suppress(StoreError, RefusedError):
        await own.session._ask(Ready(1), None)
    assert (sessions.applicant("r1") is own.session) == waits
    sessions.release(own.session)
    assert sessions.applicant("r1") is sessions.get("r1") is None

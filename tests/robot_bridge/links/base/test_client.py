"""A link's connection, at a gateway that says what no gateway of today does."""

from __future__ import annotations

import asyncio
import json
from types import SimpleNamespace

import pytest
from websockets.asyncio.server import serve
from websockets.frames import CloseCode

from robot_bridge.core.clock import ManualClock, StandstillWatch
from robot_bridge.core.messages.links import LINK_PROTOCOL
from robot_bridge.core.messages.robots import SetPosEnd
from robot_bridge.links.base import client, link_websocket
from robot_bridge.links.base.client import LinkClient
from robot_bridge.links.base.errors import CommandRefusedError
from robot_bridge.links.base.link_websocket import LinkWebSocket
from robot_bridge.links.base.linked_robots import OVERTAKEN, Commanding
from robot_bridge.links.base.memory import CompletedCall, LinkMemory
from robot_bridge.protocol import jsonrpc
from tests.support.bridge.adapter_on_the_line import LinkOnTheLine, ObedientAdapter
from tests.support.patience import until

SITE = {
    "id": "s",
    "name": "s",
    "version": 1,
    "crs": "EPSG:25831",
    "origin": [400000.0, 4600000.0],
    "rotation": 0.0,
    "bounds": [0.0, 0.0, 100.0, 100.0],
    "reached_tolerance": 0.5,
    "stale_after": 2.0,
    "lost_after": 10.0,
}
WELCOME = {
    "protocol": LINK_PROTOCOL,
    "link": "test",
    "robots": ["*"],
    "database": "d",
    "site": SITE,
    "largest_image_bytes": 0,
}


class NewerGateway:
    """Lets a link and its robots in, then sends ``calls``; ``replies`` are what the link answers to them."""

    def __init__(self, calls: list[str]) -> None:
        self._calls = calls
        self.replies: list[dict] = []
        self.answered = asyncio.Event()

    async def speak(self, connection) -> None:
        await connection.send(jsonrpc.call("Start", {"database": "d"}))
        async for frame in connection:
            message = json.loads(frame)
            if message.get("method") == "hello":
                await connection.send(jsonrpc.result(message["id"], WELCOME))
            elif message.get("method") == "Ready":
                await connection.send(jsonrpc.result(message["id"], {"ok": True}))
                for call in self._calls:
                    await connection.send(call)
            elif "method" not in message:
                self.replies.append(message)
                if len(self.replies) == len(self._calls):
                    self.answered.set()


async def test_an_unforeseen_error_of_what_sends_ends_the_connection(caplog):
    class Link:
        is_connected = True

        def news(self):
            raise RuntimeError("not foreseen")

        def lose(self):
            lost.set()

    async def speak(connection):
        await connection.wait_closed()

    lost = asyncio.Event()
    async with serve(speak, "127.0.0.1", 0) as server:
        port = server.sockets[0].getsockname()[1]
        gateway = SimpleNamespace(url=f"ws://127.0.0.1:{port}/link", token_file=None, ca=None)
        settings = SimpleNamespace(name="test", folder=None, file=None, gateway=gateway)
        link = LinkWebSocket(settings)
        link.write_soon()
        running = asyncio.create_task(link.run(Link()))
        async with asyncio.timeout(20):
            await lost.wait()
        running.cancel()
    assert "link test: sending failed; the connection is ended" in caplog.text


class ReplacedGateway:
    """Has another database, or site, on each connection; ``said`` is what the link said on the last one."""

    def __init__(self, *welcomes: dict) -> None:
        self._welcomes = list(welcomes)
        self.said: list[str] = []
        self.frames: list[dict] = []
        self.connection = None
        self.let_in = asyncio.Event()

    async def speak(self, connection) -> None:
        welcome = self._welcomes.pop(0) if len(self._welcomes) > 1 else self._welcomes[0]
        self.connection, self.said = connection, []
        await connection.send(jsonrpc.call("Start", {"database": welcome["database"]}))
        async for frame in connection:
            message = json.loads(frame)
            self.said.append(message.get("method"))
            self.frames.append(message)
            if message.get("method") == "hello":
                await connection.send(jsonrpc.result(message["id"], welcome))
            elif message.get("method") == "Ready":
                await connection.send(jsonrpc.result(message["id"], {"ok": True}))
                self.let_in.set()


async def test_what_a_robot_gave_up_is_told_to_no_gateway_with_another_database(tmp_path):
    gateway = ReplacedGateway(WELCOME, {**WELCOME, "database": "e"})
    async with serve(gateway.speak, "127.0.0.1", 0) as server:
        port = server.sockets[0].getsockname()[1]
        link = LinkOnTheLine(SimpleNamespace(address=f"ws://127.0.0.1:{port}"), tmp_path)
        try:
            await asyncio.to_thread(link.do, "add", "r1", ("targets",))
            await asyncio.wait_for(gateway.let_in.wait(), 20)
            await gateway.connection.close()
            while link.client.is_connected:
                await asyncio.sleep(0.01)
            link.client._memory._note("r1", 5, CompletedCall())
            # Message 5 is another one there, and maybe on its way to the robot.
            await asyncio.to_thread(link.do, "give_up", "r1", 5, "no path")
            gateway.let_in.clear()
            await asyncio.wait_for(gateway.let_in.wait(), 20)
            await asyncio.to_thread(link.do, "stopped", "r1")
            async with asyncio.timeout(20):
                while "Stopped" not in gateway.said:
                    await asyncio.sleep(0.01)
        finally:
            await asyncio.to_thread(link.end)
    assert "OpAck" not in gateway.said


async def test_a_message_that_the_link_does_not_know_is_refused_and_the_next_is_done(tmp_path):
    calls = [
        jsonrpc.call("Dance", {"robot": "r1", "steps": 3}, "r1/7"),
        jsonrpc.call("SetPosEnd", {"robot": "r1", "x": "east", "y": 2.0}, "r1/8"),
        jsonrpc.call("SetPosEnd", {"robot": "r1", "x": 1.0, "y": 2.0}, "r1/9"),
    ]
    gateway = NewerGateway(calls)
    async with serve(gateway.speak, "127.0.0.1", 0) as server:
        port = server.sockets[0].getsockname()[1]
        link = LinkOnTheLine(SimpleNamespace(address=f"ws://127.0.0.1:{port}"), tmp_path)
        try:
            await asyncio.to_thread(link.do, "add", "r1", ("targets",))
            await asyncio.wait_for(gateway.answered.wait(), 40)
        finally:
            await asyncio.to_thread(link.end)
    refused = {reply["id"]: reply["error"]["message"] for reply in gateway.replies if "error" in reply}
    assert sorted(refused) == ["r1/7", "r1/8"]
    assert "does not know it" in refused["r1/7"] and "Dance" in refused["r1/7"]
    assert [command.id for command in link.adapter.commands] == [9]


async def test_a_frame_beyond_the_limit_ends_the_connection_and_the_link_comes_back(tmp_path, monkeypatch):
    monkeypatch.setattr(link_websocket, "LARGEST_FRAME", 20_000)
    gateway, came = NewerGateway([" " * 20_001]), []

    async def speak(connection):
        came.append(connection)
        await gateway.speak(connection)

    async with serve(speak, "127.0.0.1", 0) as server:
        port = server.sockets[0].getsockname()[1]
        link = LinkOnTheLine(SimpleNamespace(address=f"ws://127.0.0.1:{port}"), tmp_path)
        try:
            await asyncio.to_thread(link.do, "add", "r1", ("targets",))
            async with asyncio.timeout(40):
                while len(came) < 2:
                    await asyncio.sleep(0.01)
        finally:
            await asyncio.to_thread(link.end)
    assert came[0].close_code == CloseCode.MESSAGE_TOO_BIG


async def test_what_goes_wrong_with_one_robot_keeps_a_stop_from_no_other(tmp_path, monkeypatch, caplog):
    calls = [jsonrpc.call("SetPosEnd", {"robot": "r1", "x": 1.0, "y": 2.0}, "r1/7")]
    calls.append(jsonrpc.call("Abort", {"call": "emergency-1", "emergency": True}))
    gateway = NewerGateway(calls)
    stop, enqueue = Commanding.stop, Commanding.enqueue

    def fail_for_the_first(self, robot, *arguments, **options):
        if robot == "r1":
            raise ZeroDivisionError("nobody foresaw it")
        (stop if options else enqueue)(self, robot, *arguments, **options)

    monkeypatch.setattr(Commanding, "stop", fail_for_the_first)
    monkeypatch.setattr(Commanding, "enqueue", fail_for_the_first)
    async with serve(gateway.speak, "127.0.0.1", 0) as server:
        port = server.sockets[0].getsockname()[1]
        link = LinkOnTheLine(SimpleNamespace(address=f"ws://127.0.0.1:{port}"), tmp_path)
        try:
            for name in ("r1", "r2"):
                await asyncio.to_thread(link.do, "add", name, ("targets",))
            async with asyncio.timeout(40):
                while ("r2", True) not in link.adapter.stops or not link.adapter.stops_of_unannounced:
                    await asyncio.sleep(0.01)
        finally:
            await asyncio.to_thread(link.end)
    assert "what the gateway said failed" in caplog.text and "stopping robot 'r1' failed" in caplog.text


async def test_what_waits_behind_a_command_is_never_done_once_its_robot_is_told_to_stop(tmp_path):
    calls = [jsonrpc.call("SetPosEnd", {"robot": "r1", "x": float(x), "y": 2.0}, f"r1/{x}") for x in (7, 8)]
    gateway = NewerGateway([*calls, jsonrpc.call("Abort", {"robot": "r1"}, "r1/9")])
    async with serve(gateway.speak, "127.0.0.1", 0) as server:
        port = server.sockets[0].getsockname()[1]
        link = LinkOnTheLine(SimpleNamespace(address=f"ws://127.0.0.1:{port}"), tmp_path)
        link.adapter.during = lambda _command: asyncio.sleep(3600)
        try:
            await asyncio.to_thread(link.do, "add", "r1", ("targets",))
            await asyncio.wait_for(gateway.answered.wait(), 40)
        finally:
            await asyncio.to_thread(link.end)
    assert 8 not in [command.id for command in link.adapter.commands]
    assert link.adapter.stops == [("r1", False)]
    refused = {reply["id"]: reply["error"]["message"] for reply in gateway.replies if "error" in reply}
    assert refused["r1/8"] == OVERTAKEN and "r1/9" not in refused


async def test_what_came_of_a_stop_is_told_before_all_else_that_waits(tmp_path):
    sent, two = [], asyncio.Event()

    async def send(frame):
        sent.append(frame)
        if len(sent) == 2:
            two.set()

    link = LinkOnTheLine(SimpleNamespace(address="ws://127.0.0.1:1"), tmp_path)
    await asyncio.to_thread(link.kill)
    connection = LinkWebSocket(link._settings)
    connection.post("a position")
    connection.post("the stop is done", urgent=True)
    writing = asyncio.create_task(connection._write(SimpleNamespace(send=send), link.client))
    try:
        await asyncio.wait_for(two.wait(), 20)
    finally:
        writing.cancel()
        link.end()
    assert sent == ["the stop is done", "a position"]


async def test_of_what_waited_while_a_link_stood_still_only_an_abort_is_handled(tmp_path):
    link = LinkOnTheLine(SimpleNamespace(address="ws://127.0.0.1:1"), tmp_path)
    await asyncio.to_thread(link.end)
    handled, clock = [], ManualClock()
    connection = LinkWebSocket(link._settings)
    connection._standstill = StandstillWatch(0.5, clock)
    other = SimpleNamespace(is_connected=True, handle=lambda call: handled.append(call.method))
    frames = [
        jsonrpc.call(method, {"robot": "r1"}, f"r1/{n}") for n, method in enumerate(("SetPosEnd", "Abort"))
    ]
    for frame in frames:
        connection._receive(frame, other)
    clock.advance(0.6)
    for frame in frames:
        connection._receive(frame, other)
    assert handled == ["SetPosEnd", "Abort", "Abort"]


async def test_an_emergency_stop_is_told_as_one_and_what_is_only_seen_answers_by_itself(tmp_path):
    calls = [jsonrpc.call("Abort", {"robot": "phone"}, "phone/3")]
    calls.append(jsonrpc.call("Abort", {"robot": "r1", "emergency": True}, "r1/9"))
    gateway = NewerGateway(calls)
    async with serve(gateway.speak, "127.0.0.1", 0) as server:
        port = server.sockets[0].getsockname()[1]
        link = LinkOnTheLine(SimpleNamespace(address=f"ws://127.0.0.1:{port}"), tmp_path)
        try:
            for name, can in (("phone", ()), ("r1", ("stop",))):
                await asyncio.to_thread(link.do, "add", name, can)
            async with asyncio.timeout(20):
                while {"phone/3", "r1/9"} - {reply["id"] for reply in gateway.replies if "result" in reply}:
                    await asyncio.sleep(0.01)
        finally:
            await asyncio.to_thread(link.end)
    assert set(link.adapter.stops) == {("r1", True)}


class Desk:
    """Commands of one adapter, whose robots have ``answer_within`` seconds; ``said`` is what came of them."""

    def __init__(self, adapter, folder, answer_within=0.05):
        self.said = []
        self._came = asyncio.Event()
        self.memory = LinkMemory(folder / "link.state")
        self.memory.use_database("d")
        self.memory.magic("r1")
        self.commanding = Commanding(adapter, self.memory, answer_within, self._post)

    def _post(self, frame, *, urgent=False):
        message = json.loads(frame)
        self.said.append((message["id"], message.get("error", {}).get("message"), urgent))
        self._came.set()

    async def until(self, count):
        async with asyncio.timeout(30):
            while len(self.said) < count:
                self._came.clear()
                await self._came.wait()


class Stubborn(ObedientAdapter):
    """A robot that stops as the test says."""

    def __init__(self, ending):
        super().__init__()
        self.ending = ending

    async def stop(self, robot, *, emergency):
        await super().stop(robot, emergency=emergency)
        if isinstance(self.ending, Exception):
            raise self.ending
        await asyncio.sleep(self.ending)


@pytest.mark.parametrize("emergency", [False, True])
@pytest.mark.parametrize(
    ("ending", "told"),
    [
        (0.0, None),
        (CommandRefusedError("its server does not answer"), "its server does not answer"),
        (3600.0, "no answer within 0.05 s"),
        (ZeroDivisionError("nobody foresaw it"), "the link failed; its log says more"),
    ],
)
async def test_what_comes_of_a_stop_is_told_whatever_it_is(tmp_path, ending, told, emergency):
    adapter = Stubborn(ending)
    desk = Desk(adapter, tmp_path)
    desk.commanding.stop("r1", "r1/9", emergency=emergency)
    await desk.until(1)
    assert desk.said == [("r1/9", told, True)] and adapter.stops == [("r1", emergency)]


async def test_a_command_is_waited_for_as_long_as_its_adapter_holds_one_and_done_once(tmp_path):
    adapter = ObedientAdapter()
    adapter.holds_s, adapter.during = 3600.0, lambda _command: asyncio.sleep(0.2)
    desk = Desk(adapter, tmp_path)
    for count in (1, 2):
        desk.commanding.enqueue("r1", "r1/7", SetPosEnd(1.0, 2.0))
        await desk.until(count)
    adapter.holds_s, adapter.during = 0.0, lambda _command: asyncio.sleep(3600)
    desk.commanding.enqueue("r1", "r1/8", SetPosEnd(1.0, 2.0))
    await desk.until(3)
    done, late = ("r1/7", None, False), ("r1/8", "the robot did not take it on within 0.05 s", False)
    assert desk.said == [done, done, late]
    assert [command.id for command in adapter.commands] == [7, 8]


async def let_in(gateway, link):
    gateway.let_in.clear()
    await asyncio.to_thread(link.do, "add", "r1", ("targets",))
    await asyncio.wait_for(gateway.let_in.wait(), 20)


@pytest.mark.parametrize("other", [{"database": "e"}, {"site": {**SITE, "rotation": 1.0}}])
async def test_a_link_that_is_killed_before_its_robots_stand_stops_them_next_time(tmp_path, other):
    gateway = ReplacedGateway({**WELCOME, "database": "d"}, {**WELCOME, **other})
    async with serve(gateway.speak, "127.0.0.1", 0) as server:
        port = server.sockets[0].getsockname()[1]
        link = LinkOnTheLine(SimpleNamespace(address=f"ws://127.0.0.1:{port}"), tmp_path)
        try:
            await let_in(gateway, link)
            call = jsonrpc.call("SetPosEnd", {"robot": "r1", "x": 1.0, "y": 2.0}, "r1/7")
            await gateway.connection.send(call)
            async with asyncio.timeout(20):
                while 7 not in link.client._memory.taken_on("r1"):
                    await asyncio.sleep(0.01)
            await asyncio.to_thread(link.kill)
            gateway.let_in.clear()
            for ending in (3600.0, 0.0):
                link.adapter = Stubborn(ending)
                link.start()
                await asyncio.to_thread(link.do, "add", "r1", ("targets",))
                async with asyncio.timeout(20):
                    while not link.adapter.stops:
                        await asyncio.sleep(0.01)
                if ending:
                    await asyncio.to_thread(link.kill)
            await asyncio.wait_for(gateway.let_in.wait(), 20)
            assert not link.client._memory.is_adrift("r1")
        finally:
            await asyncio.to_thread(link.end)


async def test_of_a_stop_that_was_not_confirmed_it_is_not_said_that_the_robot_was_stopped(tmp_path):
    gateway = ReplacedGateway(WELCOME, {**WELCOME, "site": {**SITE, "rotation": 1.0}})
    async with serve(gateway.speak, "127.0.0.1", 0) as server:
        port = server.sockets[0].getsockname()[1]
        link = LinkOnTheLine(SimpleNamespace(address=f"ws://127.0.0.1:{port}"), tmp_path)
        try:
            await let_in(gateway, link)
            call = jsonrpc.call("SetPosEnd", {"robot": "r1", "x": 1.0, "y": 2.0}, "r1/7")
            await gateway.connection.send(call)
            async with asyncio.timeout(20):
                while 7 not in link.client._memory.taken_on("r1"):
                    await asyncio.sleep(0.01)
            await asyncio.to_thread(link.kill)
            link.adapter = Stubborn(CommandRefusedError("its server does not answer"))
            link.start()
            await asyncio.to_thread(link.do, "add", "r1", ("targets",))
            async with asyncio.timeout(20):
                # On whichever connection.
                while not any(frame.get("method") == "OpAck" for frame in gateway.frames):
                    await asyncio.sleep(0.01)
        finally:
            await asyncio.to_thread(link.end)
    (ended,) = [frame["params"] for frame in gateway.frames if frame.get("method") == "OpAck"]
    assert (ended["id"], ended["ok"]) == (7, False)
    assert "not confirmed" in ended["reason"] and "its server does not answer" in ended["reason"]


async def test_a_memory_that_fails_without_foresight_is_written_again_later(tmp_path, monkeypatch, caplog):
    monkeypatch.setattr(client, "MEMORY_EVERY", 0.01)
    link = LinkOnTheLine(SimpleNamespace(address="ws://127.0.0.1:1"), tmp_path)
    await asyncio.to_thread(link.kill)
    attempts, memory = [], LinkMemory(link._settings.memory_file)

    async def recover():
        attempts.append(1)
        1 / (len(attempts) - 1)

    monkeypatch.setattr(memory, "recover", recover)
    running = asyncio.create_task(LinkClient(link._settings, link.adapter, memory).run())
    await until(lambda: len(attempts) > 1)
    running.cancel()
    assert "writing the link's memory again failed" in caplog.text

"""A link's connection, at a gateway that says what no gateway of today does."""

from __future__ import annotations

import asyncio
import json
from types import SimpleNamespace

from websockets.asyncio.server import serve

from robot_bridge.core.messages.links import LINK_PROTOCOL
from robot_bridge.links.base.client import LinkClient
from robot_bridge.links.base.linked_robots import OVERTAKEN, Commanding
from robot_bridge.links.base.memory import LinkMemory
from robot_bridge.protocol import jsonrpc
from tests.support.bridge.adapter_on_the_line import LinkOnTheLine

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
                while ("r2", True) not in link.adapter.stops:
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
    client = LinkClient(link._settings, link.adapter, LinkMemory(link._settings.memory_file))
    client._post("a position")
    client._post("the stop is done", urgent=True)
    writing = asyncio.create_task(client._write(SimpleNamespace(send=send)))
    try:
        await asyncio.wait_for(two.wait(), 20)
    finally:
        writing.cancel()
        link.end()
    assert sent == ["the stop is done", "a position"]

"""In which order the reference robot's links carry what it says, and what they say again."""

from __future__ import annotations

import asyncio
import json
import threading
import time

import pytest
from websockets.asyncio.server import serve
from websockets.exceptions import ConnectionClosed
from websockets.sync.server import serve as serve_in_a_thread

from robot_bridge.core.errors import StoreError
from robot_bridge.core.messages.robots import Abort, OpAck, Ready, SetObject, SetPosEnd
from robot_bridge.gateway.storage.database import Database
from robot_bridge.gateway.storage.repositories import requests
from robot_bridge.gateway.storage.repositories import requests as answers
from robot_bridge.reference_robot.agent import Agent, AgentSettings
from robot_bridge.reference_robot.body import BodyLimits
from robot_bridge.reference_robot.sql_link import RobotSqlLink
from robot_bridge.reference_robot.websocket_link import RobotWebSocketLink

ADMITTED = {"id": 1, "ok": True, "magic": 42, "robot": "r1", "database": "first"}


def agent_on(link) -> Agent:
    return Agent(AgentSettings(magic=42, pose=(0.0, 0.0, 0.0), limits=BodyLimits()), link)


@pytest.fixture
async def database(tmp_path):
    database = Database(f"sqlite:///{tmp_path}/fleet.db")
    await database.open()
    yield database
    await database.close()


async def said(database, count):
    """Return the operations in RR, and the parameters of OpAck, once there are ``count`` of them."""
    async with asyncio.timeout(30):
        while len(rows := await database.read(requests.read_requests)) < count:
            await asyncio.sleep(0.02)
    return [(row.op, json.loads(row.params).get("id") if row.op == "OpAck" else None) for row in rows]


async def test_on_sql_what_stands_before_the_answer_to_ready_is_done_before_what_stands_behind(
    database, tmp_path
):
    link = RobotSqlLink(f"sqlite:///{tmp_path}/fleet.db", "r1")
    running = asyncio.create_task(link.run(agent_on(link)))
    await said(database, 1)
    welcome = OpAck(ok=True, magic=42, robot="r1", database="first")
    messages = [Abort(), welcome, SetPosEnd(5.0, 0.0)]
    await database.run(answers.add_answers, [("r1", message) for message in messages])
    async with asyncio.timeout(30):
        while [one for one in await said(database, 2) if one[0] == "OpAck"] != [("OpAck", 1), ("OpAck", 3)]:
            await asyncio.sleep(0.02)
    running.cancel()
    await asyncio.gather(running, return_exceptions=True)


@pytest.fixture
async def on_sql(database, tmp_path):
    """A robot on SQL that was let in, with RR empty."""
    link = RobotSqlLink(f"sqlite:///{tmp_path}/fleet.db", "r1")
    running = asyncio.create_task(link.run(agent_on(link)))
    await said(database, 1)
    await database.run(answers.add, "r1", OpAck(ok=True, magic=42, robot="r1", database="first"))
    async with asyncio.timeout(30):
        while await database.read(answers.read_answers, "r1"):
            await asyncio.sleep(0.02)
    await database.run(
        requests.remove_requests, [row.id for row in await database.read(requests.read_requests)]
    )
    yield link
    running.cancel()
    await asyncio.gather(running, return_exceptions=True)


async def test_on_sql_it_goes_on_with_the_file_that_has_taken_the_place_of_its_database(
    database, on_sql, tmp_path
):
    other = Database(f"sqlite:///{tmp_path}/other.db")
    await other.open()
    await other.run(answers.add_answers, [("r1", SetPosEnd(5.0, 0.0)), ("r1", Abort())])
    await other.close()
    for end in ("-wal", "-shm"):
        (tmp_path / f"fleet.db{end}").unlink(missing_ok=True)
    (tmp_path / "other.db").replace(tmp_path / "fleet.db")
    here = Database(f"sqlite:///{tmp_path}/fleet.db")
    try:
        async with asyncio.timeout(30):
            while [one for one in await said(here, 3) if one[0] == "OpAck"] != [("OpAck", 1), ("OpAck", 2)]:
                await asyncio.sleep(0.02)
        assert "Ready" in [name for name, _ in await said(here, 3)]
        assert await here.read(answers.read_answers, "r1") == []
    finally:
        await here.close()


async def test_on_sql_it_says_where_it_is_before_it_acknowledges_an_abort(database, on_sql):
    await database.run(answers.add, "r1", SetPosEnd(5.0, 0.0))
    id = await database.run(answers.add, "r1", Abort())
    told = [one for one in await said(database, 3) if one[0] in ("SendPos", "OpAck")]
    assert told[-2:] == [("SendPos", None), ("OpAck", id)]


async def test_what_could_not_be_written_is_said_again_once_and_in_that_order(database, on_sql, monkeypatch):
    write_relaxed, failed = on_sql._database.write_relaxed, []

    async def lost(*arguments):
        if len(failed) < 3:
            failed.append(arguments)
            raise StoreError("the database is away")
        return await write_relaxed(*arguments)

    monkeypatch.setattr(on_sql._database, "write_relaxed", lost)
    monkeypatch.setattr("robot_bridge.reference_robot.sql_link.RETRY_AFTER", 0.05)
    for _ in range(2):
        on_sql.say(Ready(42))
    on_sql.say(SetObject(1.0, 2.0, "cone-7", source="1"))
    id = await database.run(answers.add, "r1", Abort())
    told = await said(database, 4)
    assert len(failed) == 3
    assert [told.count(one) for one in (("Ready", None), ("SetObject", None))] == [1, 1]
    assert told[told.index(("OpAck", id)) - 1] == ("SendPos", None)


async def test_on_a_websocket_it_says_where_it_is_before_it_acknowledges_an_abort():
    heard = asyncio.Queue()

    async def gateway(connection):
        await connection.send(
            json.dumps({"jsonrpc": "2.0", "method": "Start", "params": {"database": "first"}})
        )
        ready = json.loads(await connection.recv())
        await connection.send(json.dumps({"jsonrpc": "2.0", "id": ready["id"], "result": ADMITTED}))
        await connection.send(json.dumps({"jsonrpc": "2.0", "id": 7, "method": "Abort", "params": {}}))
        async for frame in connection:
            heard.put_nowait(json.loads(frame))

    async with serve(gateway, "127.0.0.1", 0) as server:
        port = server.sockets[0].getsockname()[1]
        link = RobotWebSocketLink(f"ws://127.0.0.1:{port}/robot", "r1")
        running = asyncio.create_task(link.run(agent_on(link)))
        async with asyncio.timeout(30):
            first, second = await heard.get(), await heard.get()
        running.cancel()
        await asyncio.gather(running, return_exceptions=True)
    assert (first["method"], second["id"], "result" in second) == ("SendPos", 7, True)


PAUSE = 0.4
"""seconds for which the robot may be busy before it counts as having stood still."""


class PatientGateway:
    """A gateway in threads of its own: it tells ``late`` once, while the robot's loop stands."""

    def __init__(self, late):
        self._late = late
        self._server = serve_in_a_thread(self._carry, "127.0.0.1", 0)
        self._thread = threading.Thread(target=self._server.serve_forever, daemon=True)
        self._thread.start()
        self.url = f"ws://127.0.0.1:{self._server.socket.getsockname()[1]}/robot"
        self.is_told, self.has_told = threading.Event(), threading.Event()
        self.greeted = 0
        self.replies = []

    def _carry(self, connection):
        connection.send(json.dumps({"jsonrpc": "2.0", "method": "Start", "params": {"database": "first"}}))
        try:
            for text in connection:
                self._take(connection, json.loads(text))
        except ConnectionClosed:
            return

    def _take(self, connection, frame):
        if frame.get("method") == "Ready":
            connection.send(json.dumps({"jsonrpc": "2.0", "id": frame["id"], "result": ADMITTED}))
            self.greeted += 1
            if self.greeted == 1:
                self.is_told.wait(30)
                for id, (method, params) in enumerate(self._late, 7):
                    call = {"jsonrpc": "2.0", "id": id, "method": method, "params": params}
                    connection.send(json.dumps(call))
                self.has_told.set()
        elif "method" not in frame:
            self.replies.append(frame["id"])

    def end(self):
        self._server.shutdown()
        self._thread.join(10)


@pytest.mark.parametrize("aborted", [False, True], ids=["a target", "a target and an Abort"])
async def test_a_robot_that_stood_still_does_nothing_that_lay_on_its_connection_but_an_abort(aborted):
    late = [("SetPosEnd", {"x": 5.0, "y": 0.0}), *([("Abort", {})] if aborted else [])]
    gateway = PatientGateway(late)
    link = RobotWebSocketLink(gateway.url, "r1", longest_pause_s=PAUSE)
    agent = agent_on(link)
    running = asyncio.create_task(link.run(agent))
    async with asyncio.timeout(30):
        while gateway.greeted == 0:
            await asyncio.sleep(0.02)
        await asyncio.sleep(0.1)
        # From here on the robot's loop stands, as a program that is held.
        gateway.is_told.set()
        assert gateway.has_told.wait(10)
        # Longer than the robot may stand still and do what it has received.
        time.sleep(2 * PAUSE)
        while gateway.greeted < 2:
            await asyncio.sleep(0.02)
            agent.step(0.05)
    assert agent.pose[:2] == (0.0, 0.0)
    assert gateway.replies == ([8] if aborted else [])
    running.cancel()
    await asyncio.gather(running, return_exceptions=True)
    gateway.end()

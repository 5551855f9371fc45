"""A hostile server: what is wrong is named, and what is right goes on."""

from __future__ import annotations

import asyncio
import json
import ssl
from types import SimpleNamespace

import cbor2
import pytest
from websockets.asyncio.server import serve

from robot_bridge.core.errors import AccessError
from robot_bridge.core.reconnection import ClientCredentials
from robot_bridge.gateway.auth import certificates
from robot_bridge.links.base.errors import LinkError
from robot_bridge.links.rosbridge.adapter import load
from robot_bridge.links.rosbridge.connection import RosbridgeConnection, Subscription
from robot_bridge.links.rosbridge.decoding import LARGEST_FRAME
from robot_bridge.links.rosbridge.graph import GraphWatch
from robot_bridge.links.rosbridge.settings import Server

GOOD = json.dumps({"op": "publish", "topic": "/r1/battery", "msg": {"percentage": 0.5}})
BATTERY = Subscription("sensor_msgs/msg/BatteryState")


class HostileServer:
    """Says ``frames`` to whoever has subscribed, and keeps what it was told; for wss:// with ``tls``."""

    def __init__(self, *frames, tls=None):
        self.frames, self.tls = frames, tls
        self.told, self.headers = [], []

    async def __aenter__(self):
        self.server = await serve(self._lie, "127.0.0.1", 0, ssl=self.tls, max_size=None)
        port = self.server.sockets[0].getsockname()[1]
        self.url = f"{'wss' if self.tls else 'ws'}://127.0.0.1:{port}"
        return self

    async def __aexit__(self, *_):
        self.server.close()
        await self.server.wait_closed()

    async def _lie(self, connection):
        self.headers.append(connection.request.headers)
        async for frame in connection:
            told = json.loads(frame)
            self.told.append(told)
            if told["op"] == "subscribe":
                for lie in self.frames:
                    await connection.send(lie)


class Client:
    """A connection with one subscription, while the block lasts."""

    def __init__(self, url, **options):
        self.connection = RosbridgeConnection(Server(url, ClientCredentials(**options)))
        self.inbox = self.connection.subscribe("/r1/battery", BATTERY)

    async def __aenter__(self):
        self.running = asyncio.create_task(self.connection.run())
        return self

    async def __aexit__(self, *_):
        self.running.cancel()
        await asyncio.gather(self.running, return_exceptions=True)

    async def until(self, found):
        """Return the first of ``found()`` that is something."""
        async with asyncio.timeout(30):
            while not (result := found()):
                await asyncio.sleep(0.01)
        return result


@pytest.mark.parametrize(
    ("lie", "words"),
    [
        (
            '{"op":"publish","topic":"/r1/battery","msg":' + "[" * 100_000,
            "/r1/battery cannot be used: it",
        ),
        ('{"op":"publish","topic":"/r1/battery","msg":{"percentage":NaN}}', "/r1/battery cannot be used"),
        ('{"op":"publish","topic":"/r1/battery","msg":"' + "x" * (5 << 20) + '"}', "/r1/battery has 52"),
        (cbor2.dumps({"op": "publish", "topic": "/r1/battery", "msg": [1]}), "Expected `object`"),
        (b"\x9b\x00\x00\x00\xff\xff\xff\xff\xff", "no CBOR that is taken"),
        (b"\x81" * 1_000_000, "nesting depth"),
        ("[]", "Expected `object`"),
        ('{"op":"status","level":"error","msg":"who are you"}', "the server said 'who are you'"),
    ],
)
async def test_a_lie_is_named_and_what_comes_after_it_is_read(lie, words):
    async with HostileServer(lie, GOOD) as server, Client(server.url) as client:
        (message,) = await client.until(client.inbox.drain)
        assert message == {"percentage": 0.5}
        assert any(words in fault for fault in client.connection.faults), client.connection.faults


async def test_a_frame_beyond_all_bounds_ends_the_connection_which_comes_back():
    async with HostileServer("x" * (LARGEST_FRAME + 1)) as server, Client(server.url) as client:

        def subscriptions():
            return [told for told in server.told if told["op"] == "subscribe"]

        await client.until(lambda: client.connection.session >= 2 and len(subscriptions()) >= 2)
        assert subscriptions()[0] == subscriptions()[1]


async def test_answers_that_nobody_asked_for_are_passed_over():
    forged = [
        '{"op":"service_response","id":"call:7","values":{"success":true},"result":true}',
        '{"op":"action_result","id":"goal:r1:00","status":4,"values":{},"result":true}',
        '{"op":"publish","topic":"/r2/battery","msg":{}}',
    ]
    async with HostileServer(*forged, GOOD) as server, Client(server.url) as client:
        assert await client.until(client.inbox.drain) == [{"percentage": 0.5}]
        assert client.connection.faults == []


async def test_a_flood_keeps_the_newest_messages_of_a_topic():
    flood = [json.dumps({"op": "publish", "topic": "/r1/battery", "msg": {"n": n}}) for n in range(500)]
    async with HostileServer(*flood) as server, Client(server.url) as client:
        await client.until(lambda: client.inbox.waiting and client.inbox.waiting[-1] == {"n": 499})
        assert [one["n"] for one in client.inbox.drain()] == list(range(436, 500))


async def test_a_rosapi_that_lies_is_named():
    async def lie(connection):
        async for frame in connection:
            said = {"op": "service_response", "id": json.loads(frame).get("id"), "values": {"topics": "all"}}
            await connection.send(json.dumps(said))

    async with serve(lie, "127.0.0.1", 0) as liar:
        port = liar.sockets[0].getsockname()[1]
        async with Client(f"ws://127.0.0.1:{port}") as client:
            watch = GraphWatch(client.connection, SimpleNamespace(written_topics=[], watched_topics=[]))
            await client.until(lambda: client.connection.session)
            watching = asyncio.create_task(watch.run())
            await client.until(lambda: watch.fault)
            watching.cancel()
    assert watch.fault == "/rosapi/topics: Expected `array`, got `str` - at `$.topics`"


async def test_wss_is_trusted_by_its_authority_alone_and_shown_a_token(tmp_path):
    files = certificates.create(tmp_path / "tls", ["localhost"], ["127.0.0.1"])
    token = tmp_path / "rosbridge.token"
    token.write_text("a-token-of-the-proxy", encoding="utf-8")
    token.chmod(0o600)
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    context.load_cert_chain(files.certificate, files.key)
    async with HostileServer(GOOD, tls=context) as server:
        async with Client(server.url, token_file=token, ca=files.ca) as client:
            await client.until(client.inbox.drain)
        assert server.headers[0]["Authorization"] == "Bearer a-token-of-the-proxy"
        async with Client(server.url) as stranger:
            await stranger.until(lambda: "certificate" in (stranger.connection.away or "").lower())
        assert len(server.headers) == 1
    with pytest.raises(AccessError, match="without TLS everybody on the way reads"):
        Server("ws://robots.example:9090", ClientCredentials(token)).options()
    shown = Server("wss://robots.example", ClientCredentials(), "fleet", token).options()[
        "additional_headers"
    ]
    assert shown == {"Authorization": "Basic ZmxlZXQ6YS10b2tlbi1vZi10aGUtcHJveHk="}


@pytest.mark.parametrize(
    ("lines", "words"),
    [
        ('url = "http://robots:9090"', "rosbridge.url = 'http://robots:9090': write it as ws://"),
        ('user = "fleet"', "rosbridge.user and rosbridge.password_file belong together"),
        ("throttle_ms = -1", "rosbridge.throttle_ms = -1: give milliseconds"),
        ("queue_length = 1000", "rosbridge.queue_length = 1000: give 0 to 100"),
        ('compression = "png"', "rosbridge.compression"),
        ('distribution = "melodic"', "rosbridge.distribution = 'melodic': give one of foxy"),
        ('topics = { position = "/odom" }', "rosbridge.topics.position = '/odom': write '{robot}'"),
        ('token_file = "nowhere.token"', "nowhere.token cannot be read"),
        ("port = 9090", "rosbridge.port is not a setting"),
    ],
)
def test_settings_that_cannot_be_used_name_file_and_key(tmp_path, lines, words):
    file = tmp_path / "far.toml"
    file.write_text(f"[rosbridge]\n{lines}\n", encoding="utf-8")
    with pytest.raises(LinkError) as caught:
        load(file)
    assert words in str(caught.value) and str(file) in str(caught.value)

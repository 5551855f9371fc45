"""Nonsense for a gateway, from nearly right to none at all, and what a gateway has to make of it."""

from __future__ import annotations

import contextlib
import json
import re
import select
import socket
import time
from collections.abc import Callable
from typing import Any

from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

from robot_bridge.core.messages.base import DESK_REQUESTS
from robot_bridge.core.messages.robots import REQUESTS
from tests.support.patience import BUSY

LEAKS = ("Traceback", 'File "', "site-packages", ".py")

numbers = st.integers() | st.floats(allow_nan=False) | st.sampled_from([10**30, -1, 2**63, 1e308])
scalars = st.none() | st.booleans() | numbers | st.text(max_size=20)
values = st.recursive(
    scalars,
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=6), inner, max_size=3),
    max_leaves=8,
)
NAMES = ["magic", "x", "y", "theta", "v", "t", "battery", "status", "area", "id", "ok", "reason", "rate"]
NAMES += ["operator", "protocol", "positions", "command", "robot", "op", "params", "limit", "points", "cone"]
NAMES += ["lat", "lon", "heading", "image", "media_type", "label", "observation", "accept", "session", "who"]
NAMES += ["since", "before", "aborts", "expires_in", "bounds", "until"]
params = st.none() | values | st.dictionaries(st.sampled_from(NAMES), scalars | values, max_size=6)
replies = st.fixed_dictionaries(
    {"jsonrpc": st.just("2.0"), "id": scalars}, optional={"result": values, "error": values}
)


def frames(methods: Any) -> Any:
    """Return frames from nearly right to nonsense, as text or bytes."""
    method = st.sampled_from(sorted(methods)) | st.text(max_size=8)
    calls = st.fixed_dictionaries(
        {"jsonrpc": st.just("2.0"), "method": method}, optional={"params": params, "id": scalars}
    )
    text = (calls | calls | replies | values).map(json.dumps)
    return text | st.text(max_size=60) | st.binary(max_size=60)


robot_frames = frames(REQUESTS)
desk_frames = frames(DESK_REQUESTS)

_headers = st.sampled_from(
    [
        "Host: gateway",
        "Upgrade: websocket",
        "Connection: Upgrade",
        "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==",
        "Sec-WebSocket-Version: 13",
        "Sec-WebSocket-Version: 99",
        "Sec-WebSocket-Extensions: permessage-deflate",
        "Sec-WebSocket-Protocol: fleet",
        "Origin: https://evil.example.org",
        "Origin: null",
        "Authorization: Bearer",
        "Authorization: Bearer fleet_op_x",
        "Authorization: Basic QTpi",
        "Content-Length: 5",
        "Content-Length: -1",
        "Transfer-Encoding: chunked",
        "Cookie: a=b",
        " folded",
        "no colon",
        "X: " + "y" * 9000,
    ]
)
_paths = st.sampled_from(
    [
        "/desk",
        "/robot",
        "/robot?robot=r1",
        "/robot?robot=..%2f..",
        "/link",
        "/link?link=agvs",
        "/link?link=%00",
        "/",
        "*",
        "/healthz",
        "/metrics",
        "//desk",
        "//[",
        "/desk?robot=%ff",
    ]
)
_lines = st.builds(
    lambda method, path, version: f"{method} {path} {version}",
    st.sampled_from(["GET", "GET", "GET", "POST", "get", "PRI", ""]),
    _paths | st.text(max_size=30),
    st.sampled_from(["HTTP/1.1", "HTTP/1.1", "HTTP/1.0", "HTTP/2", "x"]),
)
_requests = st.builds(
    lambda line, headers, end: "\r\n".join([line, *headers]).encode("utf-8", "surrogatepass") + end,
    _lines,
    st.lists(_headers | st.text(max_size=40), max_size=9),
    st.sampled_from([b"\r\n\r\n", b"\r\n\r\n", b"\r\n", b"\n\n", b"\r\n\r\n\x81\x80\0\0\0\0", b""]),
)
_RIGHT = ["Host: x", "Upgrade: websocket", "Connection: Upgrade"]
_RIGHT += ["Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==", "Sec-WebSocket-Version: 13"]
_tokens = st.text(max_size=30) | st.sampled_from(["fleet_op_", "' or 1=1 --", "A" * 5000, "\x00"])
_authorizations = st.builds(
    lambda scheme, token: f"Authorization: {scheme} {token}", st.sampled_from(["Bearer", "Basic"]), _tokens
)
_right_but_for_the_token = st.builds(
    lambda path, more: "\r\n".join([f"GET {path} HTTP/1.1", *_RIGHT, *more, "", ""]).encode(
        "utf-8", "surrogatepass"
    ),
    st.sampled_from(
        [
            "/desk",
            "/robot",
            "/robot?robot=r1",
            "/link",
            "/link?link=agvs",
            "/desk?token=fleet_op_x",
            "/desk#x",
        ]
    ),
    st.lists(_authorizations, max_size=2),
)
handshakes = (
    _right_but_for_the_token
    | _requests
    | st.binary(max_size=200)
    | st.binary(max_size=40).map(lambda b: b"\x16\x03\x01" + b)
)
"""What somebody may send to the port instead of a WebSocket's request."""

rr_rows = st.tuples(
    st.text(max_size=10) | st.binary(max_size=8) | st.integers().map(lambda number: number % 2**63),
    st.sampled_from(sorted(REQUESTS)) | st.text(max_size=8) | st.binary(max_size=8),
    params.map(json.dumps) | st.text(max_size=30) | st.binary(max_size=30) | st.none(),
    st.none() | st.binary(max_size=30),
)
"""Rows of table rr: robot, op, params, payload."""


class Conversation:
    """One connection that sends nonsense and a right question after each; every answer must be to it."""

    def __init__(self, connection: Any, name: str, method: str, params: dict[str, Any]) -> None:
        self._connection = connection
        self._name = name
        self._method, self._params = method, params
        self._count = 0
        self._asked: list[Any] = [None]
        """The ids of what was asked so far: an answer may come after that to what was asked later."""

    def say(self, frame: str | bytes) -> None:
        """Send a frame, then ask something right; raise AssertionError for what must not come back."""
        self._count += 1
        mine = f"{self._name} {self._count}"
        self._connection.send(frame)
        right = {"jsonrpc": "2.0", "id": mine, "method": self._method, "params": self._params}
        self._connection.send(json.dumps(right))
        self._asked += [_id_of(frame), mine]
        until = time.monotonic() + BUSY * 10
        while True:
            text = self._connection.recv(max(0.01, until - time.monotonic()))
            check_text(text)
            answer = json.loads(text)
            if "method" in answer:
                continue
            assert answer.get("id") in self._asked, f"the answer to somebody else's question: {text[:200]}"
            if answer.get("id") == mine and answer.get("result") is not None:
                return


def knock(host: str, port: int, request: bytes, patience: float = 0.05) -> bytes:
    """Send what should be a request and return what is answered; raises AssertionError for a leak.

    What is not answered within ``patience`` seconds is taken for unfinished, and nothing more is sent.
    """
    answer = b""
    with socket.create_connection((host, port), 5) as raw, contextlib.suppress(ConnectionError):
        raw.sendall(request)
        if not select.select([raw], [], [], patience)[0]:
            raw.shutdown(socket.SHUT_WR)
        while len(answer) < 65536 and (part := raw.recv(65536)):
            answer += part
    head = answer.partition(b"\r\n\r\n")[0]
    assert answer == b"" or head.startswith(b"HTTP/1.1 "), answer[:200]
    check_text(answer.decode("utf-8", "replace"))
    return answer


def check_text(text: str) -> None:
    """Raise AssertionError when ``text`` tells of the gateway's inside."""
    for leak in LEAKS:
        # What somebody sent may be quoted back; nobody here sends these.
        assert leak not in text, text[:500]


def try_cases(count: int, strategy: Any, attempt: Callable[[Any], None]) -> None:
    """Make ``count`` attempts with what ``strategy`` draws; raise what the first one raises that goes wrong.

    Nothing is made simpler then: a gateway that was harmed once says nothing about a simpler case.
    """
    checks = list(HealthCheck)
    phases = [Phase.generate]

    @settings(max_examples=count, deadline=None, database=None, phases=phases, suppress_health_check=checks)
    @given(strategy)
    def run(case: Any) -> None:
        attempt(case)

    run()


def _id_of(frame: str | bytes) -> Any:
    try:
        value = json.loads(frame)
    except (ValueError, RecursionError):
        return None
    id = value.get("id") if isinstance(value, dict) else None
    # The gateway hears what no database stores as a replacement character.
    return re.sub("[\0\ud800-\udfff]", "\N{REPLACEMENT CHARACTER}", id) if isinstance(id, str) else id

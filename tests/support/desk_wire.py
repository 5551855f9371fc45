"""Asks the gateway itself, over the wire and past the window, what became of the commands and the robots."""

from __future__ import annotations

import itertools
import json
import time
from collections.abc import Mapping
from typing import Any

from websockets.sync.client import ClientConnection, connect

from tests.support.errors import StageError

TIMEOUT_S = 5.0
HELLO = {"operator": "demo check"}


def ask(address: str, *questions: tuple[str, Mapping[str, Any]], token: str = "") -> list[dict[str, Any]]:
    """Say hello to the gateway at ``address`` as an operator and return its answer to each question.

    :param token: the operator's, where the gateway has accounts.
    :raises StageError: when it refuses one.
    """
    with _wire(address, token) as wire:
        numbers = itertools.count(1)
        _answer(wire, next(numbers), "hello", HELLO)
        return [_answer(wire, next(numbers), method, params) for method, params in questions]


def watch(address: str, seconds: float, rate: float = 20.0) -> list[dict[str, Any]]:
    """Return what an operator is told of robots' positions within ``seconds``: each snapshot's params."""
    with _wire(address, "") as wire:
        _answer(wire, 1, "hello", HELLO)
        _answer(wire, 2, "subscribe", {"rate": rate})
        told = []
        until = time.monotonic() + seconds
        while (left := until - time.monotonic()) > 0:
            try:
                message = json.loads(wire.recv(left))
            except TimeoutError:
                break
            if message.get("method") == "positions":
                told.append(dict(message["params"]))
        return told


def greet(address: str, token: str = "") -> dict[str, Any]:
    """Return how the gateway at ``address`` answers an operator's hello: site, role, emergency stop."""
    with _wire(address, token) as wire:
        return _answer(wire, 1, "hello", HELLO)


def _wire(address: str, token: str) -> ClientConnection:
    headers = {"Authorization": f"Bearer {token}"} if token else {}
    return connect(
        f"{address}/desk", open_timeout=TIMEOUT_S, close_timeout=TIMEOUT_S, additional_headers=headers
    )


def _answer(wire: Any, number: int, method: str, params: Mapping[str, Any]) -> dict[str, Any]:
    wire.send(json.dumps({"jsonrpc": "2.0", "id": number, "method": method, "params": params}))
    while True:
        message = json.loads(wire.recv(TIMEOUT_S))
        if message.get("id") == number:
            break
    if "error" in message:
        raise StageError(f"the gateway refused {method}: {message['error']['message']}")
    return dict(message["result"])

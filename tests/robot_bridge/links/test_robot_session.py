"""What goes wrong in the gateway while a robot speaks: the log is told all of it, the robot a number."""

from __future__ import annotations

import json
import re
from types import SimpleNamespace

import pytest

from robot_bridge import jsonrpc
from robot_bridge.links.robot_session import RobotSession
from robot_bridge.monitoring.tally import Tally

POSITION = json.dumps(
    {"jsonrpc": "2.0", "method": "SendPos", "params": {"x": 1.0, "y": 2.0, "theta": 0.0, "v": 0.0}}
).encode()
NUMBER = re.compile(r"internal error ([0-9a-f]{8})")


class Connection:
    """Keeps what the robot is sent."""

    def __init__(self):
        self.sent = []

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
def session(connection):
    """A robot that has said Ready to a gateway in which everything fails."""
    fleet = SimpleNamespace(
        take_pose=fail, receive=fail_later, emergency=SimpleNamespace(answered=fail), tally=Tally()
    )
    session = RobotSession(fleet, connection, "r1", lambda _session: None)
    session._admitted = True
    return session


def logged(caplog):
    """Return the number under which the log tells everything."""
    assert "RuntimeError: the secret" in caplog.text
    (number,) = set(NUMBER.findall(caplog.text))
    return number


@pytest.mark.parametrize("at_once", [True, False])
async def test_a_position_in_which_something_goes_wrong_is_answered_with_the_number_in_the_log(
    session, connection, caplog, at_once
):
    if at_once:
        assert session._take_at_once(POSITION)
        await session._due
    else:
        await session._receive(POSITION)
    (told,) = connection.sent
    assert told["error"]["code"] == jsonrpc.INTERNAL_ERROR
    assert NUMBER.match(told["error"]["message"])[1] == logged(caplog)
    assert "the secret" not in str(told)


@pytest.mark.parametrize("id", [7, "emergency-1"])
async def test_an_acknowledgement_in_which_something_goes_wrong_is_in_the_log_and_ends_no_connection(
    session, connection, caplog, id
):
    await session._receive(json.dumps({"jsonrpc": "2.0", "id": id, "result": {}}))
    assert logged(caplog)
    assert f"robot 'r1', acknowledgement {id}" in caplog.text
    assert connection.sent == []

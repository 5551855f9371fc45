"""The network between the adapter and its broker is cut for ten seconds, under TLS: nothing lost or twice."""

from __future__ import annotations

import time

import pytest

from robot_bridge.gateway.auth import certificates
from tests.robot_bridge.links.vda5050.driving import (
    SLOW,
    begin,
    orders_of,
    send,
    steps,
    wait_for_standing,
    wait_under_way,
)
from tests.robot_bridge.links.vda5050.peers import Yard
from tests.support.bridge.cut_line import CutLine
from tests.support.processes import Processes, free_port

CUT_S = 10.0


@pytest.fixture
def cut_yard(bridge, modules, tmp_path):
    """A yard whose vehicles are beside the broker, and whose adapter reaches it by TLS over a line."""
    tls = certificates.create(tmp_path / "tls", ["localhost"], ["127.0.0.1"])
    port = free_port()
    line = CutLine(port)
    with Processes(tmp_path / "logs") as processes:
        yard = Yard(processes, tmp_path, modules)
        encrypted = [f"listener {port} 127.0.0.1", f"certfile {tls.certificate}", f"keyfile {tls.key}"]
        yard.broker_options += encrypted
        yard.start_broker()
        broker = f'broker = "mqtts://{line.address.removeprefix("ws://")}"'
        yard.start_adapter(bridge.address, "unanswered_after_s = 2.0", broker, f'ca = "{tls.ca}"')
        yield yard, line
        yard.end()
        line.close()
        assert "Traceback" not in yard.output("adapter"), yard.output("adapter")


LATE = pytest.param(False, id="bytes come late", marks=pytest.mark.again("bytes are lost"))


@pytest.mark.parametrize("reset", [LATE, pytest.param(True, id="bytes are lost")])
def test_a_cut_of_ten_seconds_loses_nothing_and_does_nothing_twice(cut_yard, desk, reset):
    """One vehicle is on its way, another is sent off meanwhile: that is refused, and stays so."""
    yard, line = cut_yard
    driving, standing = (begin(yard, desk, y=y, speed=SLOW) for y in (8.0, 12.0))
    command = send(desk, driving, x=60.0, y=8.0)
    wait_under_way(desk, driving)
    line.cut()
    until = time.monotonic() + CUT_S
    refused = send(desk, standing, x=40.0, y=12.0)
    desk.wait_for_step(refused, "failed")
    desk.until(lambda: desk.robots[driving]["state"] == "lost")
    desk.listen(until - time.monotonic())
    line.mend(reset=reset)
    desk.wait_for_step(command, "reached", 60)
    assert steps(desk, command) == ["queued", "delivered", "acknowledged", "reached"]
    assert orders_of(yard, driving) == {"accepted as new": 1}

    # The order may come out of the line yet: what takes it back comes right behind it.
    assert wait_for_standing(desk, standing) < 21.0
    assert desk.commands[refused]["state"] == "failed"
    again = send(desk, standing, x=24.0, y=12.0)
    desk.wait_for_step(again, "reached", 60)

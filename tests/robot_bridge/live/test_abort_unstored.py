"""An Abort goes out over an open connection though the database takes nothing; whoever asked is told."""

from __future__ import annotations

import contextlib
import sqlite3

import pytest

from tests.support.bridge.bridge_wires import RefusedError


@pytest.fixture
def bridge(start_bridge, sample_site):
    bridge = start_bridge(sample_site)
    yield bridge
    bridge.end()


@contextlib.contextmanager
def locked(bridge):
    """Hold the lock of the database's writer, as a backup or a tool may that hangs."""
    with contextlib.closing(sqlite3.connect(bridge.file, isolation_level=None)) as connection:
        connection.execute("begin immediate")
        yield
        connection.execute("rollback")


@pytest.mark.parametrize("asked", ["abort", "send", "abort_all"])
def test_an_abort_that_cannot_be_stored_is_sent_and_refused_visibly(bridge, asked):
    robot, other, desk = bridge.robot("r1"), bridge.robot("r2"), bridge.desk()
    robot.plug_in(1)
    other.plug_in(2)
    desk.send("target-it-1", "r1", "SetPosEnd", x=50.0, y=40.0)
    robot.say(robot.wait_for("SetPosEnd")["id"])
    desk.wait_for_step("target-it-1", "acknowledged")
    params = {
        "abort": {"command": "abort-it-1", "robot": "r1"},
        "send": {"command": "abort-it-1", "robot": "r1", "op": "Abort"},
        "abort_all": {"command": "abort-it-1"},
    }[asked]
    with locked(bridge):
        with pytest.raises(RefusedError, match="The Abort is not stored; it was sent to r1") as refused:
            desk.ask(asked, params, 30.0)
        heard = robot.wait_for("Abort")
    assert heard["id"].startswith("abort-") and heard["params"] == {"emergency": False}
    if asked == "abort_all":
        assert other.wait_for("Abort")["params"] == {"emergency": False}
        assert "r2" in str(refused.value)
    robot.say(heard["id"])
    robot.say(robot.wait_for("Abort", 30.0)["id"])
    assert desk.wait_for_step("target-it-1", "aborted")

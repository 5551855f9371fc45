"""An emergency stop reaches every robot at once, whatever another robot or a name holds; real programs."""

from __future__ import annotations

import contextlib
import threading
import time
from concurrent.futures import ThreadPoolExecutor

import pytest

from tests.support.bridge.bridge_programs import wait_until
from tests.support.bridge.bridge_wires import RefusedError
from tests.support.databases.database_client import DatabaseClient
from tests.support.patience import BUSY

WITHIN = 1.0
"""seconds of an idle machine until every other robot has its Abort."""
NONSENSE = (
    "[" * 2000,
    '{"id":' * 2000,
    '{"id": true}',
    '{"id": 1e400}',
    '{"id": 1, "reason": "\\u0000\\ud800"}',
)
END_SESSIONS = """select pg_terminate_backend(pid) from pg_stat_activity
    where datname = current_database() and pid <> pg_backend_pid()"""
NAMED = "insert into rr (robot, op, params) values (?, ?, ?)"


@pytest.fixture
def bridge(start_bridge, sample_site, url):
    bridge = start_bridge(sample_site, url)
    yield bridge
    bridge.end()


def write_nonsense(url, times=1):
    client = DatabaseClient(url)
    for params in NONSENSE * times:
        client.sql(NAMED, "mean", "OpAck", params)
    client.close()


class Writer(threading.Thread):
    """Writes nonsense all the time."""

    def __init__(self, url):
        super().__init__(daemon=True)
        self.url, self.over = url, threading.Event()

    def run(self):
        while not self.over.is_set():
            write_nonsense(self.url)

    def __enter__(self):
        self.start()
        return self

    def __exit__(self, *_):
        self.over.set()
        self.join()


def outbox(bridge, robot="sq"):
    query = "select op from sa where robot = ? order by urgent desc, id"
    return [op for (op,) in bridge.sql(query, robot)]


def plug_in_over_sql(bridge, robot):
    bridge.sql(NAMED, robot, "Ready", '{"magic": 1}')
    wait_until(lambda: "SetMap" in outbox(bridge, robot))
    bridge.sql("delete from sa where robot = ?", robot)


def connect(bridge):
    sockets = [bridge.robot(f"ws{number}") for number in range(3)]
    for socket in sockets:
        socket.plug_in(1)
    return sockets


def stop(desk, bridge, sockets, id):
    """Make a stop; return the seconds until every robot has its Abort."""
    began = time.monotonic()
    desk.tell("emergency_stop", {"command": id, "reason": "smoke\0"})
    for socket in sockets:
        call = socket.wait_for("Abort")
        assert call["id"] == f"emergency-{id}"
    wait_until(lambda: "Abort" in outbox(bridge))
    took = time.monotonic() - began
    assert outbox(bridge)[0] == "Abort"
    assert "SetPosEnd" not in outbox(bridge)
    return took


def test_rows_that_wait_or_come_all_the_time_keep_a_stop_from_nobody_over_restarts(bridge):
    desk = bridge.desk("Ada\0\ud800 of the yard")
    assert desk.hello["operator"] == "Ada\ufffd\ufffd of the yard"
    sockets = connect(bridge)
    for robot in ("sq", "mean"):
        plug_in_over_sql(bridge, robot)
        desk.send(f"target-{robot}", robot, "SetPosEnd", x=50.0, y=40.0)
    bridge.kill_gateway()
    write_nonsense(bridge.database, times=100)
    bridge.start_gateway()
    desk, sockets = bridge.desk("Ada\0"), connect(bridge)
    with Writer(bridge.database):
        assert stop(desk, bridge, sockets, "stop-0001") < BUSY * WITHIN
        desk.until(lambda: desk.emergency["stored"])
        bridge.kill_gateway()
        bridge.start_gateway()
    desk = bridge.desk("Eve\0")
    assert (desk.emergency["in_force"], desk.emergency["stored"]) == (True, True)
    assert bridge.robot("ws0").wait_for("Abort")["id"] == "emergency-stop-0001"
    assert outbox(bridge)[0] == "Abort"
    cleared = desk.ask("clear_emergency_stop", {"reason": "fine"})
    assert (cleared["in_force"], cleared["stored"]) == (False, True)
    wait_until(lambda: bridge.sql("select count(*) from rr") == [(0,)])


def test_a_refusal_that_no_database_stores_is_stored_and_nothing_is_sent_again(bridge):
    robot, desk = bridge.robot("ws"), bridge.desk()
    robot.ask("Ready", {"magic": 1})
    robot.say(robot.wait_for("SetMap")["id"], error="no\0 map")
    robot.tell("SendPos", {"x": 20.0, "y": 20.0, "theta": 0.0, "v": 0.0, "status": "a\0b"})
    desk.send("target-1", "ws", "SetPosEnd", x=50.0, y=40.0)
    robot.say(robot.wait_for("SetPosEnd")["id"], error="no\0 way\n\ud800" + "!" * 10_000)
    failed = desk.wait_for_step("target-1", "failed")
    assert failed["steps"][-1]["reason"].startswith("no\ufffd way \ufffd!!!")
    assert bridge.sql("select op from sa where robot = 'ws'") == []
    robot.listen(0.5)
    assert robot.calls[1:] == []
    assert "will be asked again" not in bridge.output()


@contextlib.contextmanager
def taking_nothing(url):
    """A database that lets everybody read and nobody write: refused at once, or held up."""
    client = DatabaseClient(url)
    name = client.url.database
    begin, end = {
        "sqlite": (["begin immediate"], ["rollback"]),
        "postgresql": (
            [f"alter database {name} set default_transaction_read_only = on", END_SESSIONS],
            [f"alter database {name} reset default_transaction_read_only", END_SESSIONS],
        ),
        "mariadb": (["lock tables sa read, commands read, emergency_stops read"], ["unlock tables"]),
    }[client.kind]
    for statement in begin:
        client.sql(statement)
    try:
        yield
    finally:
        for statement in end:
            client.sql(statement)
        client.close()


def test_a_database_that_takes_nothing_keeps_neither_abort_nor_stop_from_anybody_connected(bridge):
    desk, sockets = bridge.desk(), connect(bridge)
    plug_in_over_sql(bridge, "sq")
    for robot, socket in zip(("ws0", "ws1"), sockets, strict=False):
        desk.send(f"target-{robot}", robot, "SetPosEnd", x=50.0, y=40.0)
        socket.say(socket.wait_for("SetPosEnd")["id"])
        desk.wait_for_step(f"target-{robot}", "acknowledged")
    desk.send("target-sq", "sq", "SetPosEnd", x=50.0, y=40.0)
    with ThreadPoolExecutor() as threads, taking_nothing(bridge.database):
        aborting = threads.submit(bridge.desk().ask, "abort", {"command": "abort-ws0", "robot": "ws0"}, 60.0)
        call = sockets[0].wait_for("Abort")
        assert call["id"] == "abort-abort-ws0"
        began = time.monotonic()
        state = desk.ask("emergency_stop", {"command": "stop-0001", "reason": "smoke"})
        for socket in sockets:
            socket.until(lambda socket=socket: "emergency-stop-0001" in [c.get("id") for c in socket.calls])
        assert time.monotonic() - began < BUSY * WITHIN
        assert (state["in_force"], state["stored"]) == (True, False)
        with pytest.raises(RefusedError, match="The Abort is not stored; it was sent to ws0"):
            aborting.result()
    desk.until(lambda: desk.emergency["stored"], 60.0)
    wait_until(lambda: outbox(bridge)[:1] == ["Abort"])
    assert "SetPosEnd" not in outbox(bridge)

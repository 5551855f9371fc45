"""What operators, the log and the next gateway learn of an emergency stop; what a clear must not clear."""

from __future__ import annotations

import asyncio
import json
import os
import threading

import pytest

from robot_bridge.core.errors import RefusedError
from robot_bridge.core.messages.safety import ClearEmergencyStop, EmergencyReport, EmergencyStop
from robot_bridge.gateway.fleet import emergency_stop
from robot_bridge.gateway.fleet.emergency_persistence import StopJournal
from robot_bridge.gateway.fleet.service import Fleet
from robot_bridge.gateway.storage.database import Database
from tests.support.patience import BUSY


@pytest.fixture
def database_url(sqlite_url):
    return sqlite_url


@pytest.fixture(autouse=True)
def patience(monkeypatch):
    # What is said of a disk that takes its time has a test elsewhere.
    monkeypatch.setattr(emergency_stop, "STORED_WITHIN", 60.0)


class Listener:
    """An operator who keeps what is reported."""

    def __init__(self):
        self.reported = []
        self.comes = asyncio.Event()

    def notify(self, method, key, params):
        if method == "emergency":
            self.reported.append((key, params))
            self.comes.set()


@pytest.fixture
async def two(yard):
    """A yard with r1 and r2, which have taken their maps."""
    for robot in ("r1", "r2"):
        await yard.ready(robot)
        await yard.acknowledge_all(robot)
    return yard


@pytest.fixture
def emergency(two):
    return two.fleet.emergency


@pytest.fixture
def operator(two):
    listener = Listener()
    two.fleet.listeners.add(listener)
    return listener


def logged(caplog):
    return [record.getMessage() for record in caplog.records if record.name == emergency_stop.log.name]


WAITED_FOR = {"robots": 2, "waiting": ["r1", "r2"]}


async def test_the_report_tells_all_of_a_stop_and_of_its_clearing(two, emergency, operator):
    assert emergency.report() == EmergencyReport()
    report = await emergency.stop(EmergencyStop("stop-0001", "smoke"), "Ada")
    made = {"stop": "stop-0001", "at": 1000.0, "by": "Ada", "reason": "smoke"}
    assert report == EmergencyReport(in_force=True, stored=True, **made, **WAITED_FOR)
    two.now = 1007.0
    report = await emergency.clear(ClearEmergencyStop("the smoke is gone"), "Eve")
    cleared = {"cleared_at": 1007.0, "cleared_by": "Eve", "clear_reason": "the smoke is gone"}
    assert report == EmergencyReport(in_force=False, stored=True, **made, **cleared, **WAITED_FOR)
    assert [key for key, _ in operator.reported] == ["emergency"] * 3
    assert operator.reported[-1][1]["clear_reason"] == "the smoke is gone"


async def test_a_robot_that_is_removed_is_waited_for_no_more(emergency, operator):
    await emergency.stop(EmergencyStop("stop-0001"), "Ada")
    before = len(operator.reported)
    emergency.forget("nobody")
    operator.comes.clear()
    emergency.forget("r2")
    await asyncio.wait_for(operator.comes.wait(), 30)
    assert [params["waiting"] for _, params in operator.reported[before:]] == [["r1"]]
    await emergency.clear(ClearEmergencyStop("free"), "Eve")
    before = len(operator.reported)
    emergency.forget("r1")
    await asyncio.sleep(2 * emergency_stop.ANSWERS_TOGETHER)
    assert len(operator.reported) == before


async def test_what_many_robots_answer_at_once_is_said_in_one_report(yard, emergency, operator):
    """To count all robots at each answer of one takes the gateway's time when it is most needed."""
    crowd = [f"robot{number}" for number in range(20)]
    for robot in crowd:
        await yard.ready(robot)
    await emergency.stop(EmergencyStop("stop-0001"), "Ada")
    before = len(operator.reported)
    operator.comes.clear()
    for robot in crowd:
        emergency.answered(robot, emergency.call_id, refused=False)
    await asyncio.wait_for(operator.comes.wait(), 30)
    assert [params["acknowledged"] for _, params in operator.reported[before:]] == [20]


async def test_a_disk_that_fails_after_the_stop_was_stored_is_named_and_the_stop_goes_on(
    two, emergency, operator, caplog
):
    noted = []

    class Disk:
        def write(self, listed):
            if noted:
                raise OSError("no space left")
            noted.append(list(listed))

    emergency._journal = Disk()
    report = await emergency.stop(EmergencyStop("stop-0001"), "Ada")
    assert report.stored and [stop.id for stop in noted[0]] == ["stop-0001"]
    assert "noting that an emergency stop is stored" in [
        text.partition(" failed")[0] for text in logged(caplog)
    ]
    assert operator.reported[-1][1]["stored"]


# --- what a clear must not clear ----------------------------------------------------------------------------


async def test_a_clear_does_not_clear_a_stop_that_came_while_it_waited(two, emergency, operator):
    await emergency.stop(EmergencyStop("stop-of-ada"), "Ada")
    thawed = threading.Event()
    frozen = asyncio.ensure_future(two.database.run(lambda _connection: thawed.wait(60)))
    clears = [
        asyncio.ensure_future(emergency.clear(ClearEmergencyStop("free"), who)) for who in ("Max", "Eve")
    ]
    await asyncio.sleep(0.05)
    two.now = 1005.0
    stopping = asyncio.ensure_future(emergency.stop(EmergencyStop("stop-of-bob", "child"), "Bob"))
    async with asyncio.timeout(BUSY * 10):
        while emergency.report().stop != "stop-of-bob":
            await asyncio.sleep(0)
        thawed.set()
        await frozen
        _, late = await asyncio.gather(*clears, return_exceptions=True)
        await stopping
    assert type(late) is RefusedError
    assert str(late) == (
        "Bob made another emergency stop at 00:16:45 UTC (child); look at that one first, then clear it"
    )
    assert (emergency.report().in_force, emergency.report().by) == (True, "Bob")
    await two.restart()
    report = two.fleet.emergency.report()
    assert (report.in_force, report.by) == (True, "Bob")


@pytest.mark.parametrize("name", ["", " ", "\n"])
async def test_an_operator_without_a_name_is_an_operator(emergency, name):
    assert (await emergency.stop(EmergencyStop("stop-0001"), name)).by == "an operator"


async def test_a_stop_without_a_reason_is_named_without_one(emergency):
    await emergency.stop(EmergencyStop("stop-of-ada"), "Ada")
    await emergency.stop(EmergencyStop("stop-of-bob"), "Bob")
    with pytest.raises(RefusedError) as caught:
        await emergency.clear(ClearEmergencyStop("free", "stop-of-ada"), "Eve")
    assert str(caught.value) == (
        "Bob made another emergency stop at 00:16:40 UTC; look at that one first, then clear it"
    )


async def test_where_nothing_is_in_force_nothing_is_cleared(emergency):
    for stop in (None, "stop-0001"):
        with pytest.raises(RefusedError) as caught:
            await emergency.clear(ClearEmergencyStop("free", stop), "Eve")
        assert str(caught.value) == "no emergency stop is in force; there is nothing to clear"


# --- noted before it is stored ------------------------------------------------------------------------------


class Noted:
    """A gateway's fleet that notes its stops in ``file``, in place of the yard's."""

    def __init__(self, yard, file):
        self.yard, self.file = yard, file

    async def start(self):
        self.database = Database(self.yard.url)
        await self.database.open()
        self.fleet = Fleet(self.yard.site, self.database, self.yard.clock, stops=StopJournal(self.file))
        self.listener = Listener()
        self.fleet.listeners.add(self.listener)
        self.called = []
        self.fleet.emergency.reach(self.called.append)
        await self.fleet.start()

    async def end(self):
        await self.database.close()

    def noted(self):
        try:
            return [stop["id"] for stop in json.loads(self.file.read_text())]
        except FileNotFoundError:
            return []

    async def until(self, noted):
        async with asyncio.timeout(BUSY * 10):
            while self.noted() != noted:
                await asyncio.sleep(0.001)


@pytest.fixture
async def gateway(two, tmp_path):
    gateway = Noted(two, tmp_path / "fleet.db.stop")
    await two.database.close()
    await gateway.start()
    yield gateway
    await gateway.end()


async def test_a_stop_is_noted_until_it_is_stored_and_over(two, gateway, caplog):
    two.client.break_table("emergency_stops")
    emergency = gateway.fleet.emergency
    report = await emergency.stop(EmergencyStop("stop-0001", "smoke"), "Ada")
    assert (report.in_force, report.stored) == (True, False)
    # A stop waits for its note no longer than a disk may take: on a busy machine it comes a moment later.
    await gateway.until(["stop-0001"])
    first, second = logged(caplog)
    assert first == "emergency stop by Ada (smoke)"
    assert second.startswith("the emergency stop is in force and not stored yet: ")
    assert "emergency_stops" in second or "database" in second
    two.client.mend_table("emergency_stops")
    await emergency.store()
    assert emergency.report().stored
    await gateway.until(["stop-0001"])
    await emergency.clear(ClearEmergencyStop("free"), "Eve")
    await gateway.until([])


async def test_a_stop_is_in_force_still_where_an_older_state_of_the_database_was_put_back(
    two, gateway, caplog
):
    await gateway.fleet.emergency.stop(EmergencyStop("stop-0001", "smoke"), "Ada")
    await gateway.until(["stop-0001"])
    await gateway.end()
    # Twice: the gateway between them has the stop from the database.
    await gateway.start()
    await gateway.end()
    for table in ("emergency_stops", "commands", "sa"):
        two.sql(f"delete from {table}")
    caplog.clear()
    await gateway.start()
    report = gateway.fleet.emergency.report()
    assert (report.in_force, report.stored, report.stop, report.waiting) == (
        True,
        True,
        "stop-0001",
        ["r1", "r2"],
    )
    assert logged(caplog) == ["emergency stop by Ada (smoke), from before the restart"]
    assert [two.waiting(robot) for robot in ("r1", "r2")] == [["Abort"]] * 2


async def test_a_stop_is_in_force_whatever_goes_wrong_as_it_is_stored(two, gateway, caplog, monkeypatch):
    async def write(*_):
        raise RuntimeError("unforeseen")

    emergency = gateway.fleet.emergency
    monkeypatch.setattr(emergency._writer, "write", write)
    report = await emergency.stop(EmergencyStop("stop-0001"), "Ada")
    assert (report.in_force, report.stored) == (True, False)
    assert logged(caplog) == ["emergency stop by Ada", "the emergency stop is in force and not stored yet"]
    assert "RuntimeError: unforeseen" in caplog.text


async def test_a_noted_stop_is_in_force_at_the_next_gateway_which_stores_it(two, gateway, caplog):
    two.client.break_table("emergency_stops")
    await gateway.fleet.emergency.stop(EmergencyStop("stop-0001", "smoke"), "Ada")
    await gateway.fleet.emergency.stop(EmergencyStop("stop-0002"), "Bob")
    await gateway.until(["stop-0001", "stop-0002"])
    await gateway.end()
    two.client.mend_table("emergency_stops")
    caplog.clear()
    two.now = 2000.0
    await gateway.start()
    report = gateway.fleet.emergency.report()
    assert (report.in_force, report.stored, report.stop, report.at) == (True, True, "stop-0002", 1000.0)
    assert (report.robots, report.waiting) == (2, ["r1", "r2"])
    assert logged(caplog) == [
        "emergency stop by Ada (smoke), from before the restart",
        "emergency stop by Bob, from before the restart",
    ]
    assert two.sql("select id from emergency_stops order by id") == [("stop-0001",), ("stop-0002",)]
    await gateway.until(["stop-0002"])
    assert two.waiting("r1") == ["Abort"] * 2


async def test_a_noted_stop_that_was_stored_and_cleared_is_not_made_again(two, gateway, caplog):
    emergency = gateway.fleet.emergency
    await emergency.stop(EmergencyStop("stop-0001"), "Ada")
    await emergency.clear(ClearEmergencyStop("free"), "Eve")
    await gateway.until([])
    await gateway.end()
    # As after a power cut that undid only the file's end.
    gateway.file.write_text('[{"id": "stop-0001", "at": 1000.0, "by": "Ada", "reason": null}]')
    caplog.clear()
    await gateway.start()
    assert gateway.fleet.emergency.report().in_force is False
    assert logged(caplog) == []
    await gateway.until([])


async def test_a_disk_that_hangs_holds_no_stop_up(gateway):
    # Who opens a pipe for writing waits until somebody reads.
    pipe = gateway.file.with_name(f".{gateway.file.name}.new")
    os.mkfifo(pipe)
    stopping = asyncio.ensure_future(gateway.fleet.emergency.stop(EmergencyStop("stop-0001"), "Ada"))
    reader = None
    try:
        async with asyncio.timeout(BUSY * 5):
            while not gateway.called:
                await asyncio.sleep(0.01)
    finally:
        reader = os.open(pipe, os.O_RDONLY | os.O_NONBLOCK)
        await stopping
        # What is noted later would wait for another reader, and this process for its thread.
        pipe.unlink()
        os.close(reader)
    assert gateway.called == ["emergency-stop-0001"]


async def test_a_stop_is_noted_before_operators_and_robots_hear_of_it(gateway, monkeypatch):
    """Nobody relies on a stop that dies with its gateway."""
    # The disk of a busy machine may need longer than robots wait for it.
    monkeypatch.setattr(emergency_stop, "NOTED_WITHIN", 10.0)
    noted = []
    monkeypatch.setattr(gateway.listener, "notify", lambda *_: noted.append(gateway.noted()))
    gateway.fleet.emergency.reach(lambda _call: noted.append(gateway.noted()))
    gateway.fleet.emergency.begin(EmergencyStop("stop-0001"), "Ada")
    assert len(noted) >= 2 and noted == [["stop-0001"]] * len(noted)

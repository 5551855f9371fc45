"""What operators' orders become: under which id, with which reason, and why they are refused."""

from __future__ import annotations

import asyncio
import uuid

import pytest

from robot_bridge.core.errors import RefusedError, StoreError
from robot_bridge.core.messages.base import MessageError
from robot_bridge.core.messages.commands import AbortAll, AbortTask, Send, SetPositions, TargetPosition
from robot_bridge.core.messages.robots import Abort, SetPath, SetPosEnd, SetPosIni
from robot_bridge.core.messages.safety import EmergencyStop
from robot_bridge.gateway.commands import requests as order_module
from robot_bridge.gateway.commands.active_command import NOTHING, CommandOrder

BASIN = (66.0, 32.0)
"""In a keepout of the sample site."""
EMERGENCY = EmergencyStop("stop-0001")
TARGET = {"x": 50.0, "y": 40.0}


@pytest.fixture
async def two(two):
    for robot in ("r1", "r2"):
        await two.at(20.0, 40.0, robot=robot)
    return two


@pytest.fixture
def orders(two):
    return two.fleet.orders


async def refusal(asked, error=RefusedError):
    with pytest.raises(error) as caught:
        await asked
    return str(caught.value)


@pytest.mark.parametrize(
    ("override", "reason", "told"),
    [
        (None, None, None),
        (None, "cones", "cones"),
        ("drained", None, "override: drained"),
        ("drained", "cones", "override: drained; cones"),
    ],
)
async def test_the_log_tells_why_and_what_was_overridden(orders, override, reason, told):
    report = await orders.send(
        Send("command-a", "r1", "SetPosEnd", TARGET, override=override, reason=reason), "Ada"
    )
    assert (report.operator, report.steps[0].reason) == ("Ada", told)


async def test_a_target_in_a_keepout_is_refused_of_send_and_of_set_positions(two, orders):
    x, y = BASIN
    said = await refusal(orders.send(Send("command-a", "r1", "SetPosEnd", {"x": x, "y": y}), "Ada"))
    assert "lies in the keepout 'Water basin'" in said
    positions = [TargetPosition("r1", 50.0, 40.0), TargetPosition("r2", x, y)]
    assert "Water basin" in await refusal(orders.set_positions(SetPositions(positions), "Ada"))
    assert two.waiting("r1") == two.waiting("r2") == []


async def test_robots_that_are_named_twice_are_named(orders):
    positions = [TargetPosition(name, 50.0, 40.0) for name in ("r2", "r1", "r2", "r1", "r3")]
    assert await refusal(orders.set_positions(SetPositions(positions), "Ada")) == (
        "positions: r1, r2 is named more than once; give each robot one target"
    )


async def test_what_is_no_order_is_refused_with_what_is(orders):
    said = await refusal(orders.send(Send("command-a", "r1", "SetMap", {}), "Ada"), MessageError)
    assert said.startswith("op 'SetMap' cannot be sent to a robot; choose one of ")
    assert set(said.rpartition("choose one of ")[2].split(", ")) == {
        "Abort",
        "SetPath",
        "SetPosEnd",
        "SetPosIni",
    }
    said = await refusal(
        orders.send(Send("command-a", "r1", "Abort", {"emergency": True}), "Ada"), MessageError
    )
    assert said == "Abort: emergency is for every robot; ask for emergency_stop"


async def test_an_abort_is_asked_under_its_own_id_of_one_robot_or_of_one_command(two, orders):
    await two.send("driving")
    await two.acknowledge_all("r1")
    report = await orders.abort(AbortTask("abort-0001", aborts="command-driving", reason="smoke"), "Bob")
    assert (report.command, report.robot, report.op, report.operator) == ("abort-0001", "r1", "Abort", "Bob")
    assert report.steps[0].reason == "smoke"
    report = await orders.abort(AbortTask("abort-0002", robot="r2"), "Bob")
    assert (report.robot, report.steps[0].reason) == ("r2", None)
    assert await refusal(orders.abort(AbortTask("abort-0003", aborts="command-gone"), "Bob")) == (
        "command command-gone has ended or was never issued, so there is nothing to abort"
    )
    # Asked again it is answered as it stands, although there is nothing to abort by now.
    await two.acknowledge_all("r1")
    again = await orders.abort(AbortTask("abort-0001", aborts="command-driving"), "Bob")
    assert again.state.value == "acknowledged"


async def test_a_command_that_is_no_longer_the_robot_s_task_is_not_aborted(two):
    await two.send("a")
    await two.send("b")
    order = CommandOrder("abort-0001", "r1", Abort(), "Bob", aborts="command-a")
    assert await refusal(two.fleet._commands.issue([order])) == (
        "command command-a is no longer what robot 'r1' is doing; look at the log, "
        "and abort the robot if it is to stop all the same"
    )
    assert two.waiting("r1") == ["SetPosEnd"]


async def test_all_are_aborted_under_ids_made_from_one(two, orders):
    reports = (await orders.abort_all(AbortAll("abort-all-0001", "smoke"), "Ada")).commands
    made = {name: str(uuid.uuid5(uuid.NAMESPACE_OID, f"abort-all-0001 {name}")) for name in ("r1", "r2")}
    assert {report.robot: report.command for report in reports} == made
    assert {report.steps[0].reason for report in reports} == {"smoke"}
    told = [(await orders.abort_all(AbortAll(), "Ada")).commands for _ in range(2)]
    first, second = [{one.command for one in commands} for commands in told]
    assert not first & second


# --- orders that hold only as long as something else does ---------------------------------------------------


def instead(id, task, message=None, robot="r1"):
    return CommandOrder(id, robot, message or SetPosEnd(50.0, 40.0), "Ada", instead_of=task)


OTHERWISE = "robot 'r1' has another command by now"


@pytest.mark.parametrize(
    ("beside", "is_open"),
    [(None, True), ("SetPosIni", True), ("SetPosEnd", False), ("Abort", False)],
)
async def test_what_is_for_a_robot_that_does_nothing_is_refused_by_one_that_does(two, beside, is_open):
    if beside is not None:
        await two.send("beside", beside, **({} if beside == "Abort" else TARGET))
    issue = two.fleet._commands.issue([instead("new-0001", NOTHING)])
    if is_open:
        (report,) = await issue
        assert report.state.value == "queued"
    else:
        assert await refusal(issue) == OTHERWISE


async def test_what_is_instead_of_a_task_is_refused_when_that_is_another_or_is_being_aborted(two):
    await two.send("a")
    await two.acknowledge_all("r1")
    assert await refusal(two.fleet._commands.issue([instead("new-0001", "command-b")])) == OTHERWISE
    await two.fleet._commands.issue([instead("new-0002", "command-a")])
    await two.acknowledge_all("r1")
    await two.send("x", "Abort")
    assert await refusal(two.fleet._commands.issue([instead("new-0003", "new-0002")])) == OTHERWISE


async def test_a_way_to_a_task_is_told_only_as_long_as_that_is_the_task(two):
    book, written = two.fleet._commands, []
    way = SetPath([(20.0, 40.0), (50.0, 40.0)])
    await two.send("a")
    await two.acknowledge_all("r1")
    await book.lead("r1", "command-a", way, written.append)
    assert len(written) == 1
    assert await refusal(book.lead("r1", "command-b", way, written.append)) == OTHERWISE
    await two.fleet.emergency.stop(EMERGENCY, "Ada")
    assert "emergency stop is in force" in await refusal(book.lead("r1", "command-a", way, written.append))
    assert len(written) == 1


async def test_a_beginning_is_sent_while_a_target_is_driven_and_ends_it_not(two):
    await two.send("a")
    await two.acknowledge_all("r1")
    (report,) = await two.fleet._commands.issue(
        [CommandOrder("new-0001", "r1", SetPosIni(20.0, 40.0), "Ada")]
    )
    assert report.state.value == "queued"
    assert (await two.states())["a"] == "acknowledged"


async def test_a_path_with_a_cone_goes_only_to_a_robot_that_declared_it(two, orders):
    path = {"points": [[21.0, 40.0], [30.0, 40.0]], "cone": True}
    await two.ready("r2", magic=2, path_cones=True)
    assert await refusal(orders.send(Send("command-a", "r1", "SetPath", path), "Ada")) == (
        "SetPath: robot 'r1' has not declared in Ready that it takes cones with a path (path_cones), so it "
        "would not do what is to be done at the end: take it for a SetPosEnd, or give it a task with a path"
    )
    report = await orders.send(Send("command-b", "r2", "SetPath", path), "Ada")
    assert report.params["cone"] is True


class Connections:
    """Robots' open connections; what they were sent is listed."""

    def __init__(self, *robots):
        self.robots, self.sent = robots, []

    def abort(self, robot, call_id):
        self.sent.append((robot, call_id))
        return robot in self.robots


async def test_an_abort_that_is_stored_is_sent_by_the_outbox_alone(two, orders):
    connections = Connections("r1")
    orders.reach(connections.abort)
    await orders.abort(AbortTask("abort-0001", "r1"), "Ada")
    with pytest.raises(RefusedError):
        await orders.abort(AbortTask("abort-0002", aborts="command-gone"), "Ada")
    assert connections.sent == [] and two.waiting("r1") == ["Abort"]


@pytest.mark.parametrize(
    ("connected", "whom"),
    [(["r1"], "sent to r1 all the same"), ([], "sent to no robot")],
)
async def test_an_abort_that_no_database_takes_is_sent_over_open_connections(
    orders, monkeypatch, connected, whom
):
    async def issue(_orders):
        raise StoreError("the database is away")

    monkeypatch.setattr(orders._commands, "issue", issue)
    connections = Connections(*connected)
    orders.reach(connections.abort)
    assert await refusal(orders.abort(AbortTask("abort-0001", "r1"), "Ada"), StoreError) == (
        f"the database is away. The Abort is not stored; it was {whom}; it is stored and sent as soon "
        "as the database takes it"
    )
    assert connections.sent == [("r1", "abort-abort-0001")]


async def test_an_abort_that_is_sent_by_its_op_goes_over_open_connections_too_and_nothing_else_does(
    orders, monkeypatch
):
    async def issue(_orders):
        raise StoreError("the database is away")

    monkeypatch.setattr(orders._commands, "issue", issue)
    connections, others = Connections("r1"), Connections()
    orders.reach(connections.abort)
    orders.reach(others.abort)
    asked = orders.send(Send("command-a", "r1", "SetPosEnd", TARGET), "Ada")
    assert await refusal(asked, StoreError) == "the database is away"
    asked = orders.send(Send("abort-0001", "r1", "Abort", {}), "Ada")
    assert "sent to r1 all the same" in await refusal(asked, StoreError)
    assert connections.sent == others.sent == [("r1", "abort-abort-0001")]


async def test_an_abort_waits_a_second_for_a_database_that_hangs(two, orders, monkeypatch):
    monkeypatch.setattr(order_module, "STORED_WITHIN", 0.01)
    issue, sent = orders._commands.issue, asyncio.Event()

    async def issue_late(given):
        await sent.wait()
        return await issue(given)

    def broken(_robot, _call_id):
        raise RuntimeError("unforeseen")

    def abort(_robot, _call_id):
        sent.set()
        return True

    monkeypatch.setattr(orders._commands, "issue", issue_late)
    orders.reach(broken)
    orders.reach(abort)
    report = await orders.abort(AbortTask("abort-0001", "r1"), "Ada")
    assert report.command == "abort-0001" and two.waiting("r1") == ["Abort"]


async def test_an_abort_that_is_stored_in_the_end_is_written_once(two, orders, monkeypatch):
    await two.ready("s1", magic=3, link="sql")
    monkeypatch.setattr(order_module, "STORED_WITHIN", 0.01)
    issue, run_aside = orders._commands.issue, two.database.run_aside
    waits, stored = asyncio.Event(), asyncio.Event()

    async def issue_late(given):
        await waits.wait()
        try:
            return await issue(given)
        finally:
            asyncio.get_running_loop().call_soon(stored.set)

    async def run_late(work, *arguments):
        waits.set()
        await stored.wait()
        return await run_aside(work, *arguments)

    monkeypatch.setattr(orders._commands, "issue", issue_late)
    monkeypatch.setattr(two.database, "run_aside", run_late)
    async with asyncio.timeout(60):
        await orders.abort(AbortTask("abort-0001", "s1"), "Ada")
    assert two.waiting("s1").count("Abort") == 1


async def test_a_robot_that_leaves_keeps_no_abort_from_the_others(two, orders, monkeypatch):
    for number, robot in enumerate(("s1", "s2"), 3):
        await two.ready(robot, magic=number, link="sql")

    async def issue(_orders):
        two.fleet.robots.remove("s1")
        raise StoreError("the table is locked")

    monkeypatch.setattr(orders._commands, "issue", issue)
    asked = orders.abort_all(AbortAll("abort-all-1"), "Ada")
    assert "sent to s2 all the same" in await refusal(asked, StoreError)
    assert two.waiting("s2").count("Abort") == 1

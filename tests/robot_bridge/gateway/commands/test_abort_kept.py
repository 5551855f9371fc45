"""An Abort that the database did not take is stored when it does, before its robot is told anything else."""

from __future__ import annotations

import asyncio
from types import SimpleNamespace

import pytest

from robot_bridge.core.errors import DataRefusedError, RefusedError, StoreError, UncertainError
from robot_bridge.core.messages.base import MessageError
from robot_bridge.core.messages.commands import AbortTask
from robot_bridge.core.messages.robots import Abort, SetPath
from robot_bridge.core.messages.safety import EmergencyStop
from robot_bridge.gateway.commands import requests
from robot_bridge.gateway.commands.active_command import SENT_ON_S, YOUNG_S, CommandOrder, KeptAbort
from robot_bridge.gateway.commands.persistence import insert_commands
from robot_bridge.gateway.fleet.robot_outboxes import RequestOutcome

LOST = pytest.mark.parametrize(
    ("error", "done"),
    [(StoreError, False), (UncertainError, False), (UncertainError, True)],
    ids=["refused", "in doubt", "in doubt and done"],
)


@pytest.fixture
async def driving(two):
    """A yard whose robots r1 and r2 drive to a target each."""
    for robot in ("r1", "r2"):
        await two.at(20.0, 40.0, robot=robot)
        await two.send(f"far-{robot}", robot=robot)
        await two.acknowledge_all(robot)
    return two


async def abort_in_vain(yard, lose, error=StoreError, done=False, **what):
    lose(yard, insert_commands, done, error)
    request = AbortTask("command-abort", **(what or {"robot": "r1"}))
    with pytest.raises(StoreError) as caught:
        await yard.fleet.orders.abort(request, "Ada")
    return str(caught.value)


@LOST
async def test_it_ends_what_the_robot_does(driving, lose, error, done):
    told = await abort_in_vain(driving, lose, error, done)
    assert told.endswith("it was sent to no robot; it is stored and sent as soon as the database takes it")
    await driving.fleet.save()
    assert driving.waiting("r1") == ["Abort"]
    await driving.acknowledge_all()
    assert await driving.states() == {
        "far-r1": "aborted", "abort": "acknowledged", "far-r2": "acknowledged"
    }  # fmt: skip
    before = await driving.steps("abort")
    await driving.fleet.save()
    assert await driving.steps("abort") == before and driving.waiting("r1") == []


@LOST
async def test_what_the_robot_is_told_afterwards_comes_behind_it(driving, lose, error, done):
    await abort_in_vain(driving, lose, error, done)
    await driving.send("next")
    assert driving.waiting("r1") == ["Abort", "SetPosEnd"]
    await driving.fleet.save()
    assert driving.waiting("r1") == ["Abort", "SetPosEnd"]
    await driving.acknowledge_all()
    assert await driving.states() == {
        "far-r1": "superseded", "abort": "acknowledged", "next": "acknowledged", "far-r2": "acknowledged"
    }  # fmt: skip


async def test_what_was_not_fetched_is_taken_back(driving, lose):
    await driving.send("next")
    assert driving.waiting("r1") == ["SetPosEnd"]
    await abort_in_vain(driving, lose)
    await driving.fleet.save()
    assert driving.waiting("r1") == ["Abort"]


async def test_what_waits_to_be_sent_is_ended_by_it_and_not_sent_behind_it(driving, lose):
    """Over an open connection the robot has the Abort already, and would drive off again."""
    await driving.send("next")
    (target,) = await driving.fleet.outboxes.outbox("r1", 0)
    await abort_in_vain(driving, lose)
    assert await driving.fleet.outboxes.mark_sending("r1", target.id) is False
    assert driving.waiting("r1") == ["Abort"]
    assert (await driving.states())["next"] == "aborted"


async def test_a_robot_that_restarts_is_not_sent_again_what_it_ends(driving, lose):
    """A robot on SQL reads what is written for it at once, before the Abort is stored otherwise."""
    await abort_in_vain(driving, lose)
    await driving.ready(magic=2, link="sql")
    assert driving.waiting("r1") == ["OpAck", "SetMap", "Abort"]
    assert (await driving.states())["far-r1"] == "aborted"


async def test_asked_for_again_it_is_one(driving, lose):
    await abort_in_vain(driving, lose)
    report = await driving.fleet.orders.abort(AbortTask("command-abort", robot="r1"), "Ada")
    await driving.fleet.save()
    assert report.state == "queued" and driving.waiting("r1") == ["Abort"]


async def test_one_of_a_command_that_has_ended_by_then_is_forgotten(driving, lose, caplog):
    await abort_in_vain(driving, lose, aborts="command-far-r1")
    await driving.at(50.0, 40.0)
    assert (await driving.states())["far-r1"] == "reached"
    await driving.fleet.save()
    assert (
        "Abort command-abort of robot 'r1': command command-far-r1 is no longer what robot 'r1' is doing"
        in [record.getMessage().split(";")[0] for record in caplog.records]
    )
    await driving.send("next")
    assert driving.waiting("r1") == ["SetPosEnd"]


async def test_no_path_for_what_the_robot_does_is_sent_behind_it(driving, lose):
    path = SetPath([(20.0, 40.0), (60.0, 40.0)])
    await driving.fleet.outboxes.finish([RequestOutcome("r1", answer=path)], [], acks=False)
    ((sent,),) = driving.sql("select id from sa where robot = 'r1' and op = 'SetPath'")
    await abort_in_vain(driving, lose)
    lose(driving, insert_commands, False, StoreError)
    with pytest.raises(StoreError):
        await driving.fleet.outboxes.mark_sending("r1", sent)
    assert not await driving.fleet.outboxes.mark_sending("r1", sent)
    assert driving.waiting("r1") == ["Abort"]


async def test_no_other_way_is_led_to_what_it_ends(driving, lose):
    await abort_in_vain(driving, lose)
    path, written = SetPath([(20.0, 40.0), (60.0, 40.0)]), []
    with pytest.raises(RefusedError):
        await driving.fleet._commands.lead("r1", "command-far-r1", path, written.append)
    assert written == [] and driving.waiting("r1") == ["Abort"]


async def test_it_is_kept_for_as_long_as_the_database_takes_nothing(driving, lose):
    await abort_in_vain(driving, lose)
    for _ in range(2):
        lose(driving, insert_commands, False, StoreError)
        with pytest.raises(StoreError):
            await driving.fleet.save()
    await driving.fleet.save()
    assert driving.waiting("r1") == ["Abort"]


async def test_one_robot_whose_abort_is_not_taken_keeps_no_other_from_having_its_own(driving, lose):
    await abort_in_vain(driving, lose)
    lose(driving, insert_commands, False, StoreError)
    with pytest.raises(StoreError):
        await driving.fleet.orders.abort(AbortTask("command-other", robot="r2"), "Ada")
    for robot in ("r2", "r1"):
        lose(driving, insert_commands, False, StoreError)
        with pytest.raises(StoreError):
            await driving.fleet.save()
        assert driving.fleet._commands._unstored.robots()[0] == robot


async def test_nor_does_it_keep_what_others_have_driven_from_being_stored(driving, lose):
    await driving.send("path", "SetPath", "r2", points=[(20.0, 40.0), (60.0, 40.0)])
    await driving.acknowledge_all("r2")
    for x in (22.0, 24.0):
        await driving.at(x, 40.0, v=1.0, robot="r2")
    await abort_in_vain(driving, lose)
    lose(driving, insert_commands, False, StoreError)
    with pytest.raises(StoreError):
        await driving.fleet.save()
    assert driving.sql("select driven from commands where id = 'command-path'") == [(4.0,)]


async def test_one_that_is_refused_as_data_is_not_kept(driving, lose):
    told = await abort_in_vain(driving, lose, DataRefusedError)
    assert told.endswith("it was sent to no robot")
    await driving.fleet.save()
    assert driving.waiting("r1") == []


@pytest.mark.parametrize("error", [RuntimeError, DataRefusedError])
async def test_one_that_is_refused_later_holds_up_nothing(driving, lose, caplog, error):
    await abort_in_vain(driving, lose)
    lose(driving, insert_commands, False, error)
    await driving.send("next")
    assert "Abort command-abort" in caplog.text and driving.waiting("r1") == ["SetPosEnd"]


async def test_an_emergency_stop_waits_for_none(driving, lose, monkeypatch):
    await abort_in_vain(driving, lose)
    run, written = driving.database.run, []

    async def noted(asked, *arguments):
        if asked is insert_commands:
            written.append({draft.order.message.emergency for draft in arguments[0]})
        return await run(asked, *arguments)

    monkeypatch.setattr(driving.database, "run", noted)
    await driving.fleet.emergency.stop(EmergencyStop("stop-0001"), "Ada")
    assert written == [{True}]
    await driving.fleet.save()
    assert written == [{True}, {False}]


async def test_a_target_on_its_way_is_not_sent_again_behind_an_abort(two):
    """Nor before it: the robot would set off for a moment."""
    await two.at(20.0, 40.0)
    await two.send("far")
    (target,) = await two.deliver()
    await two.fleet.orders.abort(AbortTask("command-abort", robot="r1"), "Ada")
    assert not await two.fleet.outboxes.mark_sending("r1", target.id)
    assert two.waiting("r1") == ["Abort"]
    await two.send("next")
    (_, newer) = await two.deliver()
    assert await two.fleet.outboxes.mark_sending("r1", newer.id)
    await two.acknowledge_all()
    assert await two.states() == {"far": "superseded", "abort": "acknowledged", "next": "acknowledged"}


async def test_one_of_a_robot_that_is_removed_is_forgotten(driving, lose):
    await abort_in_vain(driving, lose)
    await driving.fleet._commands.give_up("r1", "removed")
    await driving.fleet.save()
    assert "abort" not in await driving.states()


async def test_those_left_for_robots_that_are_gone_end_at_once_wherever_they_are_noted(driving):
    order, settled = CommandOrder("abort-of-r9", "r9", Abort(), "Ada"), []
    driving.fleet._commands._unstored._notes = SimpleNamespace(
        left_for=lambda robots: [KeptAbort(order, driving.now, is_left=True)] if "r9" in robots else [],
        write=lambda kept, ids: settled.append((kept, ids)),
    )
    driving.fleet._commands.end_left_for(["r8", "r9"])
    assert settled == [([], ["abort-of-r9"])]


def leave(yard, age=0.0, robot="r1"):
    """Have another gateway leave the Abort of a robot, of so many seconds ago."""
    order = CommandOrder(f"abort-of-{robot}", robot, Abort(), "Ada")
    yard.fleet._commands.keep_left([KeptAbort(order, yard.now - age, is_left=True)])


async def test_one_that_another_gateway_left_comes_before_anything_else(driving):
    leave(driving)
    await driving.send("next")
    assert driving.waiting("r1") == ["Abort", "SetPosEnd"]


@pytest.mark.parametrize("aside", [-1.0, 1.0])
async def test_it_is_void_where_the_robot_was_sent_on_long_after_it(driving, caplog, aside):
    """Its gateway comes back, and nobody knew of it meanwhile."""
    leave(driving, SENT_ON_S + aside)
    await driving.fleet.save()
    assert driving.waiting("r1") == ([] if aside > 0 else ["Abort"])
    assert ("the robot has been sent on since (SetPosEnd of Ada): look whether" in caplog.text) is (aside > 0)


async def test_one_of_long_ago_is_void_where_the_robot_was_sent_on_soon_after_it(driving, caplog):
    """It would stop a robot for no visible reason; sent on before, as in an outage, the robot is to stand."""
    driving.now += 30.0
    await driving.send("next")
    await driving.acknowledge_all()
    driving.now += YOUNG_S
    leave(driving, YOUNG_S + 30.0)
    leave(driving, YOUNG_S + 30.0, "r2")
    await driving.fleet.save()
    assert (driving.waiting("r1"), driving.waiting("r2")) == ([], ["Abort"])
    assert "Abort abort-of-r1 of robot 'r1': it was not stored, and the robot has been sent on" in caplog.text


async def test_what_sends_no_robot_on_makes_it_void_neither(driving):
    driving.now += 10 * SENT_ON_S
    await driving.send("here", "SetPosIni", x=20.0, y=40.0, theta=0.0)
    leave(driving, 9 * SENT_ON_S)
    await driving.fleet.save()
    assert driving.waiting("r1") == ["SetPosIni", "Abort"]


async def test_it_is_not_void_however_long_nobody_could_send_the_robot_anything(driving):
    driving.now += 10 * SENT_ON_S
    leave(driving, 9 * SENT_ON_S)
    await driving.fleet.save()
    assert driving.waiting("r1") == ["Abort"]


async def test_one_of_a_robot_that_another_gateway_has_is_left_to_that(driving):
    book = driving.fleet._commands
    book._fence = SimpleNamespace(owns=lambda robot: robot != "r1")
    for robot in ("r1", "r2", "r9"):
        leave(driving, robot=robot)
    assert book._unstored.robots() == ["r2"]


@pytest.mark.parametrize("error", [RefusedError, MessageError])
@pytest.mark.parametrize("is_pause", [False, True], ids=["abort", "pause"])
async def test_who_is_refused_hears_which_robots_were_sent_an_abort_by_then(
    driving, monkeypatch, is_pause, error
):
    monkeypatch.setattr(requests, "STORED_WITHIN", 0.0)
    sent = asyncio.Event()
    driving.fleet.orders.reach(lambda robot, _id: robot == "r1" and not sent.set())

    async def refuse():
        await sent.wait()
        raise error("its task has ended")

    aborts = [CommandOrder(f"abort-{robot}", robot, Abort(), "Ada") for robot in ("r1", "r2")]
    text = "its task has ended. r1 had been sent an Abort by then: look where it stands, then send it on, or"
    with pytest.raises(error, match=text):
        await driving.fleet.orders.send_if_unstored(aborts, asyncio.create_task(refuse()), is_pause=is_pause)
    await driving.fleet.save()
    assert driving.waiting("r1") == driving.waiting("r2") == []


async def test_who_is_refused_at_once_hears_of_none(driving):
    with pytest.raises(RefusedError) as caught:
        await driving.fleet.orders.abort(AbortTask("command-abort", aborts="command-none"), "Ada")
    assert "sent an Abort" not in str(caught.value)

"""A robot that says in Ready what it can do is sent nothing else, and stopped all the same."""

from __future__ import annotations

import pytest

from robot_bridge.core.errors import RefusedError
from robot_bridge.core.messages.commands import AbortTask

LANE = [(20.0, 40.0), (50.0, 40.0)]


async def able(yard, *abilities):
    await yard.ready("r1", magic=2, abilities=list(abilities), path_cones=True)
    await yard.acknowledge_all()
    return yard


async def refusal(sent):
    with pytest.raises(RefusedError) as caught:
        await sent
    return str(caught.value)


async def test_one_that_is_only_seen_takes_no_commands_and_is_stopped(two):
    yard = await able(two)
    assert await refusal(yard.send("a")) == (
        "robot 'r1' is only seen: its link websocket takes no commands for it"
    )
    await yard.fleet.orders.abort(AbortTask("abort-0001", "r1"), "Ada")
    assert yard.waiting() == ["Abort"]


async def test_it_is_told_what_the_robot_does_not_take(two):
    yard = await able(two, "targets", "start")
    assert await refusal(yard.send("a", "SetPath", points=LANE)) == (
        "robot 'r1' does not take SetPath, only what it said in Ready: start targets"
    )
    await yard.send("b")
    assert yard.waiting() == ["SetPosEnd"]


@pytest.mark.parametrize("what", [{"cone": True}, {"collect": True}, {}])
async def test_cones_are_for_robots_that_handle_them(two, what):
    for abilities in (["paths"], ["paths", "cones"]):
        yard = await able(two, *abilities)
        if what and "cones" not in abilities:
            assert (
                await refusal(yard.send("a", "SetPath", points=LANE, **what))
                == "robot 'r1' places and collects no cones; send it there without one"
            )
        else:
            await yard.send(f"b{len(abilities)}", "SetPath", points=LANE, **what)


async def test_one_that_says_nothing_of_it_is_sent_anything(two):
    await two.send("a", "SetPath", points=LANE)
    await two.send("b", cone=True)
    assert two.waiting() == ["SetPosEnd"]

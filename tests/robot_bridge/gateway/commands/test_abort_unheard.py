"""An Abort that comes too late for its robot: it has done its task while it could not be reached."""

from __future__ import annotations

import pytest

from robot_bridge.core.messages.commands import AbortTask
from robot_bridge.core.messages.safety import EmergencyStop
from tests.support.bridge.queue_line import PLACES, placed, task

CONE = PLACES["a"]
TOO_LATE = "it stood at its end when it was heard again, and the Abort came too late"


async def begin(line):
    """Send the robot to a cone; it has taken that on and is on its way."""
    await line.set(task("a", "place"))
    await line.yard.acknowledge_all()
    await line.yard.at(30.0, 40.0, v=1.0)
    assert (await line.states()) == {"a": "current"}


async def abort(line):
    await line.yard.fleet.orders.abort(AbortTask("command-abort", robot="r1"), "Ada")


async def stop(line):
    await line.yard.fleet.emergency.stop(EmergencyStop("stop-0001"), "Ada")


async def come_back(line, after=20.0):
    """Let the robot, not heard for a while, connect and take on the Abort, before it says a position."""
    line.yard.now += after
    line.yard.fleet.age()
    await line.yard.ready()
    assert "Abort" in await line.yard.acknowledge_all()


@pytest.mark.parametrize(("order", "after"), [(abort, 20.0), (stop, 20.0), (abort, 1.0)])
async def test_a_cone_that_was_put_down_before_the_abort_came_is_put_down_once(line, order, after):
    await begin(line)
    await order(line)
    await come_back(line, after)
    await line.yard.at(*CONE)
    await line.advance()
    assert await line.states() == {"a": "done"}
    (found,) = await placed(line)
    assert (found.x, found.y) == CONE
    (command,) = [c for c in await line.yard._stored() if c.op == "SetPosEnd"]
    assert (command.state.value, command.steps[-1].reason) == ("reached", TOO_LATE)


async def test_so_it_is_when_the_gateway_was_started_anew_before_the_robot_said_where_it_is(line):
    await begin(line)
    await line.yard.fleet.save()
    await abort(line)
    await come_back(line)
    await line.yard.restart()
    await line.yard.ready()
    await line.yard.at(*CONE)
    await line.advance()
    assert await line.states() == {"a": "done"}
    assert len(await placed(line)) == 1


async def test_so_it_is_on_sql_where_robots_do_not_connect_anew(line):
    await begin(line)
    await abort(line)
    line.yard.now += 20
    await line.yard.acknowledge_all()
    await line.yard.at(*CONE)
    await line.advance()
    assert await line.states() == {"a": "done"}


@pytest.mark.parametrize(("x", "v"), [(40.0, 0.0), (CONE[0], 0.5)])
async def test_a_robot_that_is_seen_elsewhere_or_driving_has_aborted(line, x, v):
    await begin(line)
    await abort(line)
    await come_back(line)
    assert (await line.yard.states())["abort"] == "acknowledged"
    await line.yard.at(x, CONE[1], v=v)
    await line.advance()
    assert await line.states() == {"a": "waiting"}
    (command,) = [c for c in await line.yard._stored() if c.op == "SetPosEnd"]
    assert (command.state.value, command.steps[-1].by) == ("aborted", "Ada")
    assert command.steps[-1].reason == "the robot acknowledged the Abort"
    assert await placed(line) == []


async def test_until_it_says_where_it_is_its_queue_sends_nothing_though_resumed(line):
    await begin(line)
    await abort(line)
    await come_back(line)
    await line.advance()
    await line.resume()
    assert await line.yard.deliver() == []
    await line.yard.at(*CONE)
    await line.advance()
    assert await line.states() == {"a": "done"}


async def test_a_robot_that_is_heard_all_along_has_aborted_when_it_says_so(line):
    await begin(line)
    await line.yard.at(CONE[0], CONE[1], v=0.5)
    await abort(line)
    await line.yard.acknowledge_all()
    await line.yard.at(*CONE)
    await line.advance()
    assert await line.states() == {"a": "waiting"}


async def test_a_cone_is_put_down_once_by_a_robot_that_says_where_it_is_before_it_takes_the_abort_on(line):
    await begin(line)
    await abort(line)
    # Its link was away for a moment, in which it came to its end.
    line.yard.now += 1.0
    (row,) = await line.yard.deliver()
    await line.yard.at(*CONE)
    await line.yard.ack(row.id)
    await line.advance()
    assert await line.states() == {"a": "done"}
    assert len(await placed(line)) == 1


async def test_a_queue_that_was_resumed_after_the_robot_took_the_abort_on_goes_on(line):
    await begin(line)
    await abort(line)
    await come_back(line)
    taken_on = line.yard.now
    line.yard.now += 5
    await line.advance()
    await line.resume()
    await line.yard.at(40.0, 40.0)
    await line.advance()
    assert await line.states() == {"a": "current"}
    first = next(c for c in await line.yard._stored() if c.op == "SetPosEnd")
    assert (first.state.value, first.steps[-1].at) == ("aborted", taken_on)
    assert (await line.sent()).count(CONE) == 2


async def test_one_that_was_resumed_before_that_goes_on_then_and_not_before(line):
    await begin(line)
    await abort(line)
    await line.advance()
    await line.resume()
    assert (await line.sent()).count(CONE) == 1
    await come_back(line)
    line.yard.now += 1
    await line.yard.at(40.0, 40.0)
    await line.advance()
    assert await line.states() == {"a": "current"}
    assert (await line.sent()).count(CONE) == 2

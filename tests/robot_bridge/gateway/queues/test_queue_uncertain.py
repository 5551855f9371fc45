"""A commit of which nobody knows whether it was done: no task is sent twice, no cone written down twice."""

from __future__ import annotations

import pytest

from robot_bridge.core.errors import UncertainError
from robot_bridge.core.messages.queues import PauseQueue
from robot_bridge.gateway.commands.persistence import insert_commands
from robot_bridge.gateway.queues.runner import write_outcome
from tests.support.bridge.queue_line import PLACES, placed, task


@pytest.mark.parametrize("done", [True, False], ids=["done", "not done"])
async def test_after_a_commit_of_which_nobody_knows_the_queue_is_what_the_database_holds(line, done, lose):
    await line.set(task("a"), task("b"))
    lose(line.yard, None, done)
    with pytest.raises(UncertainError):
        await line.queues.pause(PauseQueue("r1"), "Ada")
    await line.reach(*PLACES["a"])
    assert (await line.report()).state.value == ("paused" if done else "running")
    assert await line.states() == {"a": "done", "b": "waiting" if done else "current"}


@pytest.mark.parametrize("done", [True, False], ids=["done", "not done"])
async def test_a_queue_of_which_nobody_knows_whether_it_was_resumed_goes_on_if_it_was(line, done, lose):
    await line.set(task("a"))
    await line.queues.pause(PauseQueue("r1"), "Ada")
    await line.reach(*PLACES["a"])
    await line.set(task("b"))
    lose(line.yard, None, done)
    with pytest.raises(UncertainError):
        await line.resume()
    await line.advance()
    assert (await line.report()).state.value == ("running" if done else "paused")
    assert await line.sent() == ([PLACES["a"], PLACES["b"]] if done else [PLACES["a"]])


@pytest.mark.parametrize("done", [True, False], ids=["done", "not done"])
async def test_a_task_of_which_nobody_knows_whether_it_was_sent_is_sent_once(line, done, lose):
    lose(line.yard, insert_commands, done)
    await line.set(task("a"), task("b"))
    await line.advance()
    await line.reach(*PLACES["a"])
    assert await line.states() == {"a": "done", "b": "current"}
    assert await line.sent() == [PLACES["a"], PLACES["b"]]


async def test_a_cone_of_which_nobody_knows_whether_it_was_written_down_is_so_once(line, lose):
    await line.set(task("a", "place"), task("b"))
    await line.yard.acknowledge_all()
    await line.yard.at(*PLACES["a"])
    lose(line.yard, write_outcome, True)
    await line.advance()
    await line.advance()
    assert len(await placed(line)) == 1
    assert await line.states() == {"a": "done", "b": "current"}

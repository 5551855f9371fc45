"""Queues under any sequence of edits and events: no task lost, none twice, the current one first."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robot_bridge.core.errors import RefusedError
from robot_bridge.core.messages.commands import CommandReport, CommandState, CommandStep
from robot_bridge.core.messages.queues import LONGEST_QUEUE, QueueTask, Share, SharedTask, TakeOver, TaskState
from robot_bridge.gateway.model import task_queue
from robot_bridge.gateway.model.task_queue import Queue, QueuedTask
from robot_bridge.gateway.queues import task_life

IDS = [f"task-{n:04}" for n in range(12)]


def task(id):
    return QueueTask(id, float(id[-2:]), 0.0)


def report(state, **more):
    return CommandReport(
        "command", "r1", "SetPosEnd", {}, "Ada", state, [CommandStep(state, 5.0, "r1")], **more
    )


class Story:
    """A queue with what every task given to it has come to."""

    def __init__(self):
        self.queue, self.ended = Queue("r1"), {}

    def known(self):
        here = {one.id: task_queue.Whereabouts("r1", one.state) for one in self.queue.tasks}
        return {**{id: task_queue.Whereabouts("r1", state) for id, state in self.ended.items()}, **here}

    def edited(self, after):
        kept = {one.id for one in after.tasks}
        gone = {one.id: TaskState.REMOVED for one in self.queue.tasks if one.id not in kept}
        assert not any(one.is_current and one.id in gone for one in self.queue.tasks)
        assert after.revision == self.queue.revision + 1
        self.ended.update(gone)
        self.queue = after

    def edit(self, kind, first, second):
        queue, known = self.queue, self.known()
        chosen = [task(id) for id in dict.fromkeys([first, second, IDS[0]])]
        after = {
            "set": lambda: task_queue.replace_tasks(queue, chosen, known, "Ada", 1.0),
            "add": lambda: task_queue.add_tasks(queue, [task(first)], second, known, "Ada", 1.0),
            "append": lambda: task_queue.add_tasks(queue, [task(first)], None, known, "Ada", 1.0),
            "move": lambda: task_queue.move_task(queue, first, second),
            "remove": lambda: task_queue.remove_task(queue, first),
            "first": lambda: task_queue.move_task_first(queue, first),
            "resume": lambda: task_queue.resume_queue(queue, "Ada", 1.0),
        }
        self.edited(after[kind]())

    def go_on(self, state, skips):
        """Send the head, or let the current task's command end so."""
        if self.queue.current:
            outcome = task_life.settle_task(self.queue, report(CommandState(state)), 1, skips=skips)
            self.queue = outcome.queue
            if outcome.ended:
                self.ended[outcome.ended.id] = outcome.ended.state
        elif self.queue.running and self.queue.head:
            self.queue = task_life.mark_sent(self.queue, 2.0)

    def check(self):
        ids = [one.id for one in self.queue.tasks]
        assert len(set(ids)) == len(ids) and not set(ids) & set(self.ended)
        assert all(not one.is_current for one in self.queue.tasks[1:])
        places = [one.place for one in self.queue.tasks]
        assert places == sorted(set(places))


KINDS = ["set", "add", "append", "move", "remove", "first", "resume"]
ENDS = ["reached", "failed", "aborted", "expired", "superseded"]


@settings(max_examples=3 * settings.default.max_examples, deadline=None)
@given(
    st.lists(
        st.tuples(st.sampled_from(KINDS + ENDS), st.sampled_from(IDS), st.sampled_from(IDS)), max_size=40
    )
)
def test_whatever_happens_each_task_is_in_one_place(steps):
    story, commands = Story(), set()
    for kind, first, second in steps:
        given_before = set(story.known())
        try:
            if kind in KINDS:
                story.edit(kind, first, second)
            else:
                story.go_on(kind, skips=first < second)
        except RefusedError:
            assert set(story.known()) == given_before
        story.check()
        assert set(story.known()) >= given_before
        current = story.queue.current
        if current is not None and (current.id, current.attempts) not in commands:
            commands.add((current.id, current.attempts))
    # No attempt shares its command with another one.
    ids = {task_life.command_id(QueuedTask(task(id), "Ada", 1.0, attempts=n)) for id, n in commands}
    assert len(ids) == len(commands)


def test_a_failed_task_is_skipped_or_pauses_by_the_sites_settings():
    queue = task_life.mark_sent(
        task_queue.add_tasks(Queue("r1"), [task(IDS[0]), task(IDS[1])], None, {}, "Ada", 1.0), 2.0
    )
    skipped = task_life.settle_task(queue, report(CommandState.FAILED), 1, skips=True)
    assert skipped.ended is not None and skipped.ended.state is TaskState.SKIPPED
    assert "the robot gave no reason" in (skipped.ended.reason or "")
    assert skipped.queue.running and [one.id for one in skipped.queue.tasks] == [IDS[1]]
    paused = task_life.settle_task(queue, report(CommandState.FAILED), 1, skips=False)
    assert paused.ended is None and not paused.queue.running
    assert paused.queue.tasks[0].state is TaskState.FAILED


def test_a_queue_has_an_end():
    many = [QueueTask(f"task-{n:05}", 0.0, 0.0) for n in range(LONGEST_QUEUE)]
    queue = task_queue.add_tasks(Queue("r1"), many, None, {}, "Ada", 1.0)
    with pytest.raises(RefusedError, match="would hold 1001 tasks, and takes 1000 at most"):
        task_queue.add_tasks(queue, [task(IDS[0])], None, {}, "Ada", 1.0)


@settings(max_examples=settings.default.max_examples, deadline=None)
@given(st.permutations(IDS), st.integers(0, 12), st.booleans(), st.booleans())
def test_a_complete_split_keeps_every_task_once(order, cut, runs, takes_current):
    mine = task_queue.add_tasks(Queue("r1"), [task(id) for id in IDS[:8]], None, {}, "Ada", 1.0)
    mine = task_life.mark_sent(mine, 2.0) if runs else mine
    other = task_queue.add_tasks(Queue("r2"), [task(id) for id in IDS[8:]], None, {}, "Ada", 1.0)
    if runs and not takes_current:
        order = [id for id in order if id != IDS[0]]
    shares = [
        Share("r2", 1, [SharedTask(id) for id in order[:cut]]),
        Share("r3", 0, [SharedTask(id) for id in order[cut:]]),
    ]
    before = {"r1": mine, "r2": other, "r3": Queue("r3")}
    after = task_life.transfer_tasks(before, TakeOver("r1", 1, shares), "Ada", 3.0)
    left = [one.id for name in before for one in after[name].tasks]
    assert sorted(left) == sorted(IDS)
    assert not after["r1"].running and all(after[name].revision > before[name].revision for name in before)
    assert [one.id for one in after["r2"].tasks] == order[:cut]

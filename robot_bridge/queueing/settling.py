"""What comes of a task whose command has ended: written down with where its cone stands."""

from __future__ import annotations

import math

from sqlalchemy import Connection

from ..command_life.states import is_open
from ..errors import RefusedError
from ..messages import CommandReport, CommandState, PlacementReport, TaskKind
from ..queues import life
from ..queues.legs import cone_place, legs
from ..queues.life import Settled
from ..queues.queue import Queue, QueuedTask
from ..store import commands as stored_commands
from ..store import placements, queues
from ..store.placements import Collected, NewPlacement
from .context import QueueContext


class QueueSettling:
    """Settles the tasks whose commands have ended."""

    def __init__(self, context: QueueContext) -> None:
        self._site = context.site
        self._commands = context.commands
        self._book = context.book
        self._database = context.database
        self._clock = context.clock

    async def settle(self, queue: Queue) -> None:
        """Write down what came of the current task's command, if that has ended."""
        await self._settle_current(queue)
        await self._settle_given_back(self._book.get(queue.robot))

    async def _settle_current(self, queue: Queue) -> None:
        current = queue.current
        if current is None or current.command is None or self._commands.is_open(current.command):
            return
        found = (await self._database.run(stored_commands.find_all, [current.command])).get(current.command)
        if found is None:
            reason = "what its command came to is not stored any more"
            await self._book.save(queue, life.failed(queue, reason, self._clock(), skips=False).queue)
            return
        if is_open(found.report.state):
            return
        skips = self._site.settings.queues.on_failure == "skip"
        outcome = life.settled(queue, found.report, self._legs_of(current), skips=skips)
        await self._write(queue, outcome, found.report)

    async def _settle_given_back(self, queue: Queue) -> None:
        """Write down that the task that comes next is done, if its robot came to its end all the same."""
        head = queue.head
        if head is None or head.is_current or head.command is None or not queue.running:
            return
        found = (await self._database.run(stored_commands.find_all, [head.command])).get(head.command)
        if found is None or found.report.state is not CommandState.REACHED:
            return
        count = self._legs_of(head)
        again = life.done_after_all(queue, count)
        if again is not None:
            await self._write(queue, life.settled(again, found.report, count, skips=False), found.report)

    async def _write(self, before: Queue, outcome: Settled, report: CommandReport) -> None:
        ended, placed, collected = outcome.ended, None, None
        if ended is not None and report.state is CommandState.REACHED:
            if ended.task.kind is TaskKind.PLACE:
                placed = _placed(before.robot, ended, report, self._site.settings.cones.offset)
                ended = life.measured(ended, placed.deviation)
            elif ended.task.kind is TaskKind.COLLECT:
                task, at = ended.task, report.steps[-1].at
                collected = Collected(before.robot, at, task.placement, task.cone, task.layout)
        gone = [] if ended is None else [ended]
        written = await self._book.stored(
            [before.robot],
            self._database.run(write_outcome, before, outcome.queue, gone, placed, collected),
        )
        self._book.accept(outcome.queue, gone)
        if written is not None:
            self._book.announce_placement(written)

    def _legs_of(self, current: QueuedTask) -> int:
        try:
            return len(legs(current.task, self._site.settings.cones.offset))
        except RefusedError:
            # The site's settings have changed since; what was sent was the last that there is.
            return current.leg + 1


def _placed(robot: str, task: QueuedTask, report: CommandReport, offset: tuple[float, float]) -> NewPlacement:
    """Return the cone that a robot has put down by the command that ``report`` tells of."""
    wanted = task.task
    assert report.stood is not None
    x, y = cone_place(report.stood, offset)
    return NewPlacement(
        task=task.id,
        robot=robot,
        command=report.command,
        planned_x=wanted.x,
        planned_y=wanted.y,
        x=x,
        y=y,
        theta=report.stood[2],
        deviation=math.hypot(x - wanted.x, y - wanted.y),
        placed_at=report.steps[-1].at,
        cone=wanted.cone,
        label=wanted.label,
        layout=wanted.layout,
        plan=wanted.plan,
    )


def write_outcome(
    connection: Connection,
    before: Queue,
    after: Queue,
    ended: list[QueuedTask],
    placed: NewPlacement | None,
    collected: Collected | None,
) -> PlacementReport | None:
    """Write a task's end, and where its cone stands now."""
    queues.save(connection, before, after, ended)
    if placed is not None:
        return placements.add(connection, placed)
    return None if collected is None else placements.collect(connection, collected)

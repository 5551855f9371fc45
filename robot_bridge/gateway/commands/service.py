"""Service of open commands: issued, delivered, acknowledged, judged, ended; each step is stored first."""

from __future__ import annotations

import asyncio
import contextlib
import dataclasses
import logging
from collections.abc import (
    AsyncIterator,
    Awaitable,
    Callable,
    Collection,
    Coroutine,
    Iterable,
    Mapping,
    Sequence,
)
from concurrent.futures import Future
from typing import Any

from sqlalchemy import Connection

from ...core.clock import Clock, steady_time
from ...core.errors import DataRefusedError, RefusedError, StoreError, UsedIdError
from ...core.logs import log_and_continue
from ...core.messages.commands import CommandReport, CommandState
from ...core.messages.robots import MOTION_OPS, Answer, OpAck, SendPos, SetPath
from ..model.arrival import PathArrival, arrival_judge
from ..model.events import CommandChanged, EventBus, OutboxChanged
from ..model.robots import RobotPose, Robots
from ..storage.database import Database, to_its_end
from ..storage.repositories import commands
from ..storage.repositories import requests as answers
from ..storage.repositories.commands import StoredCommand
from ..storage.repositories.robots import CHECK_VALID_S, SOLE_FENCE, FencedError, OwnerFence
from . import active_command, persistence
from .active_command import ABORTED, GATEWAY, ActiveCommand, CommandOrder, Recall, given_up_by
from .validation import ActiveCommands, CommandReader, CommandRules, CommandValidator, WaitingRobots

log = logging.getLogger(__name__)

__all__ = ["GATEWAY", "ActiveCommand", "CommandOrder", "CommandService"]
DRIVEN_STEP = 0.5
"""metres along a path between two stored values of progress."""
NOWHERE = SendPos(x=1e8, y=1e8, theta=0.0, v=0.0)
"""Stands for a pose that was not stored: far from any real one."""
ABORTED_TOO_LATE = "it stood at its end when it was heard again, and the Abort came too late"
MOST_LATE = 1000
"""most acknowledgements of ended commands that wait for the database."""


class CommandService(CommandReader):
    """Holds the open commands and takes them through their states.

    Every change is committed before it is published: CommandChanged with the command's new report, and
    OutboxChanged with the robot that has a new message in SA.
    """

    def __init__(
        self,
        database: Database,
        robots: Robots,
        tolerance: float,
        clock: Clock,
        rules: CommandRules,
        waiting: WaitingRobots,
        events: EventBus,
        fence: OwnerFence = SOLE_FENCE,
        notes: active_command.AbortNotes | None = None,
    ) -> None:
        super().__init__(ActiveCommands())
        self.drafting = CommandValidator(self._open, robots, rules, waiting)
        self._tolerance = tolerance
        self._database = database
        self._robots = robots
        self._clock = clock
        self._events = events
        self._fence = fence
        self._held = persistence.RobotLocks(database, self, fence)
        self._turns = persistence.NamedLocks()
        self._sequences = persistence.RobotSequences(self)
        self._late: set[tuple[str, int]] = set()
        self._unstored = active_command.UnstoredAborts(notes)

    def set_tolerance(self, tolerance: float) -> None:
        """Set the metres within which a target counts as reached."""
        self._tolerance = tolerance

    async def restore(self) -> None:
        """Load the commands that an earlier gateway left open, and the Aborts that it left unstored."""
        await asyncio.to_thread(self._unstored.restore, self._robots.__contains__)
        stored = await self._database.run(commands.still_open)
        self.adopt(command for command in stored if self._fence.owns(command.report.robot))

    def adopt(self, stored: Iterable[StoredCommand]) -> None:
        """Add commands of robots that another gateway had."""
        for command in stored:
            self._open.add(self._restored(command))

    def drop(self, robots: Iterable[str]) -> None:
        """Remove the commands of robots that another gateway has."""
        for robot in robots:
            for command in self._open.of(robot):
                self._open.remove(command.report.command)
            self._unstored.drop(robot)
            self._late = {late for late in self._late if late[0] != robot}

    async def issue(
        self, orders: list[CommandOrder], also: persistence.Also | None = None
    ) -> list[CommandReport]:
        """Store new commands with their messages, and the writes ``also``, all or none; return the reports.

        A command with a known id is returned in its present state and changes nothing. An Abort that cannot
        be stored is kept, and stored before any other message to its robot. One of whatever the robot does
        makes void the motions that are being checked when this begins.
        """
        self.note_stop(order.robot for order in orders if order.is_stop)
        return await to_its_end(self._issue(orders, also))

    def note_stop(self, robots: Iterable[str]) -> None:
        """Have no motion of ``robots`` stored that was asked by now, and is being checked."""
        self.drafting.note_stop(robots)

    async def await_stored(self, robot: str) -> None:
        """Wait until orders of a robot that are being stored are, and its kept Aborts; raises StoreError."""
        await to_its_end(self._store_behind(robot))

    def keep_aborts(self, aborts: Iterable[CommandOrder]) -> Future[bool] | None:
        """Store Aborts before any other message of their robots; return the writing of their notes."""
        return self._unstored.keep(aborts)

    def release_aborts(self, aborts: Iterable[CommandOrder]) -> None:
        """Keep Aborts no longer: they are stored, or refused."""
        for order in aborts:
            self._unstored.discard(order)

    def replacing_failed_pauses(self, robot: str) -> contextlib.AbstractContextManager[None]:
        """Store what failed pauses of a robot have left no sooner than what is tried meanwhile has failed."""
        return self._unstored.replacing_failed_pauses(robot)

    async def store_kept(self, robot: str) -> None:
        """Store the kept Aborts of a robot, if there are any; raises StoreError."""
        if self._unstored.of([robot]):
            await to_its_end(self._issue_unstored(robot))

    def keep_left(self, left: Iterable[active_command.KeptAbort]) -> None:
        """Store those Aborts that another gateway left of robots of this one, before any other message."""
        mine = [o for o in left if o.order.robot in self._robots and self._fence.owns(o.order.robot)]
        self.note_stop(one.order.robot for one in mine if one.order.is_stop)
        self._unstored.keep_left(mine)

    def keep_left_for(self, robots: Collection[str]) -> None:
        """Store the Aborts left for ``robots``, which this gateway has, before any other message."""
        self._unstored.keep_left_for(robots)
        self.note_stop(kept.order.robot for kept in self._unstored.of(robots) if kept.order.is_stop)

    def end_left_for(self, robots: Iterable[str]) -> None:
        """Have nobody store the Aborts left for ``robots``, which are gone, or were never sent anything."""
        self._unstored.end(list(robots))
        self._unstored.write_notes()

    def discard_aborts(self, ids: Iterable[str]) -> None:
        """Keep the Aborts with these ids no longer: another gateway has stored them, or found them void."""
        self._unstored.discard_settled(ids)

    async def lead(self, robot: str, task: str, path: SetPath, write: Callable[[Connection], None]) -> None:
        """Send a robot the path to its target by ``write``. The target stays the command.

        :raises RefusedError: when ``task`` is no longer the robot's command; StoreError.
        """
        await to_its_end(self._lead(robot, task, path, write))

    async def mark_sending(self, robot: str, sa_id: int) -> bool:
        """Record message ``sa_id`` as delivered, before it is sent; return false where its command has ended.

        Neither is one sent that an Abort has overtaken, which is on its way.

        If recorded afterwards, a gateway that is killed in between would leave a command queued that the
        robot carries out, and withdraw it as one that never reached the robot.

        :raises FencedError: when another gateway has the robot, or may have it by now.
        """
        known = True
        if sa_id in self._open.queued:
            await to_its_end(self._hand_over(robot, sa_id))
            known = any(command.sa_id == sa_id for command in self._open.of(robot))
        elif self._unstored.of([robot]) or self.awaits_abort_after(robot, sa_id):
            # A path for a command that has begun, or a target that comes again on a later connection.
            known = await to_its_end(self._outlives_abort(robot, sa_id))
        else:
            await self._held.confirm([robot])
        if not self._fence.may_command(robot):
            raise FencedError(f"robot {robot!r} is sent nowhere: another gateway may have it by now")
        return known

    def may_send(self, robot: str, checked_at: float) -> bool:
        """Return whether a message that :meth:`mark_sending` allowed at ``checked_at`` may still be sent.

        ``checked_at`` is of :func:`.steady_time`.

        After a halt of the process in between another gateway may have the robot, or an operator may have
        given the command up: this is read before the message is offered again.
        """
        return self._fence.may_command(robot) and steady_time() - checked_at < CHECK_VALID_S

    async def delivered(self, sa_ids: Iterable[int]) -> None:
        """Record that the messages ``sa_ids`` have reached their robots."""
        queued = [id for id in sa_ids if id in self._open.queued]
        if queued:
            await to_its_end(self._delivered(queued))

    def acknowledge(self, robot: str, ack: OpAck) -> Awaitable[float | None]:
        """Process a robot's OpAck: it accepted the message, or (``ok`` false) refused it, or gave it up.

        This is begun at once; positions that come before it is stored are judged after it. The result is the
        time when the message was written into SA, for the first acknowledgement of a command.
        """
        return self._sequences.add(robot, self._acknowledge(robot, ack))

    def observe(self, robot: str, pose: SendPos) -> Awaitable[None] | None:
        """Judge the robot's acknowledged commands by its present pose, after work in progress on it.

        Return the storing of those that are done, already begun; None without any, or if it waits.
        """
        if self._sequences.add_position(robot, pose):
            return None
        work = self.evaluate_arrival(robot, pose)
        return None if work is None else self._sequences.add(robot, work)

    def evaluate_arrival(self, robot: str, pose: SendPos) -> Coroutine[Any, Any, None] | None:
        """Judge the robot's acknowledged commands by ``pose``.

        Return the storing of those that are done, to be awaited; None without any.
        """
        mine = self._open.of(robot)
        done = [
            (command, deviation, pose)
            for command in mine
            if command.arrival
            and not command.acknowledgement_waits
            and ((deviation := command.arrival.deviation(pose)) is not None or given_up_by(command, mine))
        ]
        return self._all_done(done) if done else None

    def with_open_commands(self, poses: Iterable[RobotPose]) -> list[RobotPose]:
        """Return the poses of robots that have open commands."""
        busy = self._open.robots
        return [pose for pose in poses if pose[0] in busy]

    def await_again(self, robot: str, sa_id: int) -> None:
        """Judge the command with this message only by positions that come after its acknowledgement.

        The acknowledgement waits to be processed, perhaps again; earlier positions are older than the
        command.
        """
        for command in self._open.of(robot):
            command.acknowledgement_waits |= command.sa_id == sa_id

    def lose_sight(self, robot: str) -> None:
        """Record that a robot may have driven without being seen."""
        for command in self._open.of(robot):
            command.lose_sight()

    async def on_idle(self, robot: str, pose: SendPos | None) -> None:
        """Process the report of a robot, at ``pose`` as far as known, that it is idle."""
        await self._sequences.add(robot, self._rests(robot, pose))

    async def deliver_again(
        self,
        robot: str,
        reason: str,
        expire_after: float,
        welcome: Sequence[Answer],
        note_run: Callable[[Connection], bool],
    ) -> None:
        """Send again the messages that a restarted robot may have forgotten, unless they are too old.

        Waiting messages, too, are put after ``welcome``: it must not drive before it has its map.
        ``note_run`` records the restart in the same transaction, and returns false where it is already
        recorded: then all is sent.
        """
        await to_its_end(self._deliver_again(robot, reason, expire_after, welcome, note_run))

    async def expire(self, expire_after: float) -> None:
        """End the commands not fetched in time: by their own limit, else within ``expire_after`` seconds."""
        now = self._clock.time()
        late = [c for c in self._open.queued.values() if c.expired(now, expire_after)]
        if late:
            await to_its_end(self._expire([c.report.command for c in late]))

    async def give_up(self, robot: str, reason: str) -> None:
        """End every command of a robot, which will not carry them out."""
        self._unstored.end([robot])
        self.drafting.stops.forget(robot)
        await to_its_end(self._give_up(robot, reason))

    async def resolve_uncertain_commit(self) -> None:
        """Resolve a transaction with an unknown outcome from the database; raises StoreError."""
        if self._held.has_uncertain_commit:
            async with self._held.of(()):
                # Taking the locks resolves it.
                return

    async def save_progress(self) -> None:
        """Store kept Aborts, note those that are left, store progress along paths and late acknowledgements.

        A robot that another gateway has by now does not prevent storing those of others, nor does one whose
        Abort cannot be stored: it is the last one the next time. Raises StoreError once the rest is stored.
        """
        self._unstored.write_notes()
        await self.resolve_uncertain_commit()
        failure = None
        for robot in self._unstored.robots():
            try:
                await to_its_end(self._issue_unstored(robot))
            except FencedError:
                continue
            except StoreError as error:
                self._unstored.postpone(robot)
                failure = error
                break
        await self._save_late()
        driven = self._open.progress(DRIVEN_STEP)
        if driven:
            await self._save_driven(driven)
        if failure is not None:
            raise failure

    async def _save_late(self) -> None:
        for robot, sa_id in list(self._late):
            # One that is refused, or fails otherwise, is dropped: the others have their turn.
            what = f"a late acknowledgement of robot {robot!r}"
            refused = contextlib.suppress(DataRefusedError, FencedError)
            with log_and_continue(log, what, except_for=StoreError), refused:
                await self.acknowledge(robot, OpAck(id=sa_id))
            self._late.discard((robot, sa_id))

    async def _save_driven(self, driven: Mapping[str, float]) -> None:
        """Store metres driven by command, except for robots of another gateway."""
        by_robot: dict[str, dict[str, float]] = {}
        for command, metres in driven.items():
            if (robot := self.robot_of(command)) is not None:
                by_robot.setdefault(robot, {})[command] = metres
        try:
            await self._held.run(by_robot, persistence.write_driven, driven)
        except FencedError:
            for robot, theirs in by_robot.items():
                with contextlib.suppress(FencedError):
                    await self._held.run([robot], persistence.write_driven, theirs)
        self._open.note_progress(driven)

    # --- work that must not be cancelled, with the robots' locks held --------------------------------------

    async def _issue(self, orders: list[CommandOrder], also: persistence.Also | None) -> list[CommandReport]:
        robots = {order.robot for order in orders}
        async with self._turns.of(() if all(order.is_emergency for order in orders) else robots):
            # Slow checks first: nothing may come between the checks and the transaction. And before the
            # robots are held: while a long path of one is checked, an emergency stop is stored for all.
            found = await self.drafting.prepare(orders)
            try:
                async with self._held.of(robots):
                    if not all(order.is_emergency for order in orders):
                        await self._store_unstored(robots)
                    issued, known = await self._store(orders, found, also)
                    stored = [command for command in issued if command.report.command in known]
                    again = self.used_again(orders, stored, self._clock.time())
                    if renamed := active_command.aborts_renamed(again):
                        renewed, _ = await self._store(renamed, [None] * len(again), None)
                        of = {old.command: new for old, new in zip(again, renewed, strict=True)}
                        issued = [of.get(command.report.command, command) for command in issued]
                    return [command.report for command in issued]
            except DataRefusedError:
                raise
            except StoreError:
                # Part of a change of a queue, which is refused as a whole, is one with a task.
                self._unstored.keep(o for o in orders if not o.is_emergency and o.task is None)
                raise

    async def _issue_unstored(self, robot: str) -> None:
        async with self._turns.of([robot]):
            await self._store_behind(robot)

    async def _store_behind(self, robot: str) -> None:
        async with self._held_behind_aborts([robot]):
            return

    @contextlib.asynccontextmanager
    async def _held_behind_aborts(self, robots: Collection[str]) -> AsyncIterator[None]:
        """Hold robots with their kept Aborts stored: no later message is sent before these."""
        async with self._held.of(robots):
            await self._store_unstored(robots)
            yield

    async def _store_unstored(self, robots: Iterable[str]) -> None:
        """Store the kept Aborts of robots; one that is refused, or came too late, is dropped."""
        for kept in self._unstored.of(robots):
            order = kept.order
            with log_and_continue(log, f"storing Abort {order.command}", except_for=StoreError):
                try:
                    if kept.is_left:
                        for motion in await self._database.run(commands.newest, order.robot, 1, MOTION_OPS):
                            kept.check_not_sent_on(motion, self._clock.time())
                    await self._store([order], [None], None)
                except (DataRefusedError, RefusedError) as error:
                    log.warning("Abort %s of robot %r: %s", order.command, order.robot, error)
            self._unstored.discard(order)

    async def _store(
        self, orders: list[CommandOrder], found: Sequence[RefusedError | None], also: persistence.Also | None
    ) -> tuple[list[ActiveCommand], Collection[str]]:
        """Store orders; return their commands, and the ids of those that were stored before."""
        now, robots = self._clock.time(), [order.robot for order in orders]
        drafts = [self.drafting.draft(order, fault, now) for order, fault in zip(orders, found, strict=True)]
        try:
            issued, changed, known = await self._held.run(robots, persistence.insert_commands, drafts, also)
        except UsedIdError as error:
            if not (renamed := active_command.aborts_renamed(orders)):
                raise
            log.warning("%s", error)
            return await self._store(renamed, found, also)
        for command in changed:
            self._apply(command)
        for command in issued:
            report = command.report
            if report.state is CommandState.QUEUED and self._open.get(report.command) is None:
                self._apply(command)
                self._events.publish(OutboxChanged(report.robot))
        return issued, known

    async def _lead(self, robot: str, task: str, path: SetPath, write: Callable[[Connection], None]) -> None:
        async with self._turns.of([robot]):
            await self.drafting.consider_way(path)
            async with self._held_behind_aborts([robot]):
                self.drafting.check_way(robot, task, path)
                await self._held.run([robot], write)
                self._events.publish(OutboxChanged(robot))

    async def _outlives_abort(self, robot: str, sa_id: int) -> bool:
        """Store the robot's Aborts, and withdraw message ``sa_id`` if a newer one is on its way."""
        async with self._turns.of([robot]), self._held_behind_aborts([robot]):
            if not self.awaits_abort_after(robot, sa_id):
                return True
            await self._held.run([robot], answers.remove_answers, [sa_id])
            return False

    async def _hand_over(self, robot: str, sa_id: int) -> None:
        async with self._held_behind_aborts([robot]):
            await self._save_delivered([sa_id])

    async def _delivered(self, sa_ids: list[int]) -> None:
        # By now some may have a later state.
        robots = {self._open.queued[id].report.robot for id in sa_ids if id in self._open.queued}
        async with self._held.of(robots):
            await self._save_delivered(sa_ids)

    async def _save_delivered(self, sa_ids: list[int]) -> None:
        queued = [self._open.queued[id] for id in sa_ids if id in self._open.queued]
        now = self._clock.time()
        await self._save([command.step(CommandState.DELIVERED, now, GATEWAY) for command in queued])

    async def _acknowledge(self, robot: str, ack: OpAck) -> float | None:
        async with self._held.of([robot]):
            command = next((c for c in self._open.of(robot) if c.sa_id == ack.id), None)
            if command is None and ack.ok and ack.id is not None:
                await self._record_late(robot, ack.id)
                return None
            if command is not None:
                command.acknowledgement_waits = False
            steps = [] if command is None else self._answered(command, ack)
            # One transaction: a message that is gone from SA with its step unsaved would be lost.
            await self._held.run([robot], persistence.write_acknowledged, robot, ack.id, steps)
            for step in steps:
                self._apply(step)
            return command.written_at if command is not None and command.is_on_its_way else None

    async def _record_late(self, robot: str, sa_id: int) -> None:
        """Record that the robot read the message of an ended command; kept if it cannot be stored now."""
        try:
            report = await self._held.run([robot], persistence.write_late, robot, sa_id, self._clock.time())
        except DataRefusedError:
            raise
        except StoreError:
            if len(self._late) < MOST_LATE:
                self._late.add((robot, sa_id))
            raise
        self._late.discard((robot, sa_id))
        if report is not None:
            self._events.publish(CommandChanged(report))

    async def _rests(self, robot: str, pose: SendPos | None) -> None:
        done = [
            (command, deviation, pose)
            for command in self._open.of(robot)
            if isinstance(command.arrival, PathArrival)
            and (deviation := command.arrival.idle_deviation(pose)) is not None
            and pose is not None
        ]
        await self._all_done(done)

    async def _all_done(self, done: Sequence[tuple[ActiveCommand, float | None, SendPos]]) -> None:
        for command, deviation, pose in done:
            await self._done(command, deviation, pose)

    async def _done(self, command: ActiveCommand, deviation: float | None, pose: SendPos) -> None:
        """Record that a robot has reached a command's end, or (no ``deviation``) has given it up unseen."""
        async with self._held.of([command.report.robot]):
            if self._open.get(command.report.command) is not command:
                return
            now, abort = self._clock.time(), given_up_by(command, self._open.of(command.report.robot))
            if deviation is not None:
                reason = None if abort is None else ABORTED_TOO_LATE
                # An Abort has no target to deviate from.
                off = None if command.is_abort else deviation
                stood = (pose.x, pose.y, pose.theta)
                await self._save([command.step(CommandState.REACHED, now, GATEWAY, reason, off, stood)])
            elif abort is not None:
                await self._save(active_command.ended_by(abort, [command], abort.acknowledged_at, ABORTED))

    async def _deliver_again(
        self,
        robot: str,
        reason: str,
        expire_after: float,
        welcome: Sequence[Answer],
        note_run: Callable[[Connection], bool],
    ) -> None:
        # A robot on SQL reads what is written here: an Abort that follows later would come too late.
        async with self._held_behind_aborts([robot]):
            restarted = active_command.restart_commands(
                self._open.of(robot), reason, self._clock.time(), expire_after, self._robots.pose
            )
            for command in await self._held.run(
                [robot], persistence.write_again, robot, welcome, *restarted, note_run
            ):
                self._apply(command)
            self._events.publish(OutboxChanged(robot))

    async def _expire(self, ids: list[str]) -> None:
        async with self._held.of({robot for id in ids if (robot := self.robot_of(id))}):
            found = [command for id in ids if (command := self._open.get(id))]
            late = [command for command in found if command.report.state is CommandState.QUEUED]
            now, reason = self._clock.time(), "the robot did not fetch it in time"
            recalls = [Recall(c, c.step(CommandState.EXPIRED, now, GATEWAY, reason)) for c in late]
            if recalls:
                robots = [recall.queued.report.robot for recall in recalls]
                for command in await self._held.run(robots, persistence.write_recalls, recalls):
                    self._apply(command)

    async def _give_up(self, robot: str, reason: str) -> None:
        async with self._held.of([robot]):
            now = self._clock.time()
            mine = self._open.of(robot)
            await self._save([c.step(CommandState.FAILED, now, GATEWAY, reason) for c in mine])

    # -------------------------------------------------------------------------------------------------------

    def _answered(self, command: ActiveCommand, ack: OpAck) -> list[ActiveCommand]:
        robot, now = command.report.robot, self._clock.time()
        unseen = self._robots.is_unseen(robot, now)
        return active_command.acknowledge_command(
            command, ack, self._open.of(robot), now, self._tolerance, unseen=unseen
        )

    def _restored(self, stored: StoredCommand) -> ActiveCommand:
        seen = self._robots.pose(stored.report.robot)
        command = dataclasses.replace(persistence.opened(stored), handed=seen or NOWHERE, out_of_sight=True)
        if stored.report.state is CommandState.ACKNOWLEDGED:
            command.arrival = arrival_judge(
                command.message, self._tolerance, driven=stored.driven, under_way=True, handed=seen
            )
        return command

    async def _save(self, steps: list[ActiveCommand]) -> None:
        if steps:
            await self._held.run([step.report.robot for step in steps], persistence.write_steps, steps)
            for command in steps:
                self._apply(command)

    def _apply(self, command: ActiveCommand) -> None:
        if command.report.state.is_open:
            self._open.add(command)
        else:
            self._open.remove(command.report.command)
        self._events.publish(CommandChanged(command.report))

    async def read_again(self) -> None:
        """Apply the stored state, after a transaction with an unknown outcome."""
        found = await self._database.run(commands.still_open)
        stored = {s.report.command: s for s in found if self._fence.owns(s.report.robot)}
        here = {command.report.command: command for command in self._open}
        ended = await self._database.run(commands.find_all, sorted(here.keys() - stored.keys()))
        for one in [*ended.values(), *stored.values()]:
            known = here.get(one.report.command)
            if known is None or (known.report, known.sa_id) != (one.report, one.sa_id):
                self._apply(self._restored(one))
                self._events.publish(OutboxChanged(one.report.robot))

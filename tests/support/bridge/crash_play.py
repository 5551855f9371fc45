"""A play: robots that drive, operators that order, and a gateway that dies in the midst and is started again.

Time is the play's. In each turn a second passes: robots drive and say where they are, and the gateway does
all that it would have done in that second.
"""

from __future__ import annotations

import contextlib
import itertools
import math
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import pytest

from robot_bridge.core.clock import ManualClock
from robot_bridge.core.errors import STORED_LATER, OutdatedError, RefusedError, StoreError
from robot_bridge.core.messages.commands import AbortTask, CommandState, Send
from robot_bridge.core.messages.queues import GetQueue, QueueTask, ResumeQueue, SetQueue
from robot_bridge.core.messages.safety import EmergencyStop
from robot_bridge.gateway.api.robot_sql import SqlInterface
from robot_bridge.gateway.commands.active_command import may_become
from robot_bridge.gateway.fleet.emergency_persistence import StopJournal
from robot_bridge.gateway.fleet.service import Fleet
from robot_bridge.gateway.site.site_maps import SiteMaps
from robot_bridge.gateway.traffic.road_planning import RoadPlanner
from tests.support.bridge.mortal_database import Killed, MortalDatabase
from tests.support.databases.database_client import DatabaseClient

DRIVE_ON, START_ANEW, STAY_AWAY = "drive on", "start anew", "stay away"
"""What robots do when the gateway dies: they drive on, they start anew as well, or they come back late."""
GONE = 3
"""seconds without a gateway."""
AWAY = 20
"""seconds for which robots stay away after that; they are lost by then."""
SAVE_EVERY = 3
"""turns: what is stored of a robot is metres behind it, as it is in earnest."""
LONGEST = 400
"""turns after which a play that does not come to its end has failed."""


async def _tried(work):
    with contextlib.suppress(StoreError):
        await work


class Cut(NamedTuple):
    """In which turn all robots' links are cut, and for how many seconds."""

    turn: int
    seconds: float


class Moment(NamedTuple):
    """When something happens in a play: after how many transactions and turns."""

    transactions: int = 0
    turns: int = 0


class Play:
    """One run of a scenario. ``death`` says when the gateway dies, ``cut`` when robots are out of reach, and
    ``how`` what they do meanwhile.
    """

    def __init__(self, site, url, journal: Path, death, how=DRIVE_ON, *, cut=None, roads=False):
        self.site, self.url, self.death, self.how, self.roads = site, url, death, how, roads
        self.cut = cut
        self.clock = ManualClock(wall=1000.0)
        self.robots = {}
        self.turns = 0
        self.stopped = Moment()
        """when operators were about to stop robots."""
        self.resumed = Moment()
        """when a queue was last told to go on."""
        self._journal = journal
        self._client = DatabaseClient(url)
        self.sql = self._client.sql
        self.database = self.fleet = self._link = None

    @property
    def now(self):
        """The time that the gateway goes by."""
        return self.clock.wall

    # --- the gateway ----------------------------------------------------------------------------------------

    async def begin(self, *robots):
        """Start the first gateway; plug in ``robots`` and wait until it knows where they are."""
        self.robots = {robot.name: robot for robot in robots}
        await self._start()
        await self.until(lambda: all(map(self.fleet.robots.is_placed, self.robots)))

    def ahead(self, metres):
        """Have cones stand so many metres ahead of the robots that put them down."""
        settings = self.site.site.settings
        cones = replace(settings.cones, offset_ahead_m=metres)
        self.site = SiteMaps(replace(self.site.site, settings=replace(settings, cones=cones)))

    async def _start(self):
        while True:
            self.database = MortalDatabase(self.url, self.death)
            try:
                await self.database.open()
                planner = RoadPlanner(self.site) if self.roads else None
                journal = StopJournal(self._journal)
                self.fleet = Fleet(self.site, self.database, self.clock, planner, journal)
                self.fleet.emergency.reach(self._stop_all)
                await self.fleet.start()
                self._link = SqlInterface(self.fleet, self.database)
                return
            except (Killed, StoreError):
                await self.database.close()

    async def _revive(self):
        """Start another gateway on the same database; the robots have lived on meanwhile."""
        await self.database.close()
        for _ in range(GONE):
            self.clock.advance(1)
            for robot in self.robots.values():
                robot.move(1.0)
                if robot.link == "sql":
                    robot.turn()
        for robot in self.robots.values():
            robot.lose_link()
            if self.how == START_ANEW:
                robot.start_anew()
            elif self.how == STAY_AWAY:
                robot.away_until = self.now + AWAY
        await self._start()

    async def end(self):
        """Close what is open."""
        await self.database.close()
        self._client.close()
        for robot in self.robots.values():
            robot.end()

    def _stop_all(self, call_id):
        for robot in self.robots.values():
            if robot.link == "websocket":
                robot.stop_now(call_id)

    async def _look(self):
        """Let time pass until all robots are back; who goes on has seen what has become of them."""
        await self.until(lambda: all(map(self.fleet.robots.is_placed, self.robots)))
        await self.wait(2)

    # --- time -----------------------------------------------------------------------------------------------

    async def turn(self):
        """Let a second pass; the gateway may die in it."""
        self.turns += 1
        assert self.turns < LONGEST, f"the play does not come to its end: {self._stage()}"
        self.clock.advance(1)
        for robot in self.robots.values():
            robot.move(1.0)
        if self.cut is not None and self.turns == self.cut.turn:
            self._cut_links(self.cut.seconds)
        try:
            await self._work()
        except Killed:
            await self._revive()

    def _cut_links(self, seconds):
        for robot in self.robots.values():
            robot.away_until, robot.says_late = self.now + seconds, True
            if self.how == START_ANEW:
                robot.start_anew()

    @property
    def was_disturbed(self):
        """Whether the gateway has died, a transaction failed, or the links were cut."""
        return self.death.has_come or (self.cut is not None and self.turns >= self.cut.turn)

    async def _work(self):
        """Do what a gateway does in a second; what fails is done again in the next one."""
        for robot in list(self.robots.values()):
            await robot.exchange()
        await _tried(self._link.poll())
        self.fleet.age()
        if self.turns % SAVE_EVERY == 0:
            await _tried(self.fleet.save())
        await _tried(self.fleet.watch_roads())
        self.fleet.driving.schedule_all()
        for _ in range(3):
            await self.fleet.driving.advance()
        if self.database.dead:
            raise Killed

    async def until(self, condition):
        """Let time pass until ``condition()`` holds."""
        while not condition():
            await self.turn()

    async def wait(self, seconds):
        """Let so many seconds pass, and more if something happens: who goes on has looked at it again."""
        quiet = not self.was_disturbed
        for _ in range(seconds):
            await self.turn()
        if quiet and self.was_disturbed:
            await self._look()

    # --- an operator ----------------------------------------------------------------------------------------

    async def ask(self, request):
        """Ask the gateway by ``await request(fleet)``; an operator whose gateway died asks again."""
        while True:
            try:
                answer = await request(self.fleet)
                if self.database.dead:
                    raise Killed
                return answer
            except Killed:
                await self._revive()
                await self._look()
            except StoreError:
                await self.turn()
            except OutdatedError:
                # What failed was done; the operator is told so, and looks again.
                if self.death.fails is None:
                    raise

    async def ask_once(self, request):
        """As :meth:`ask`, for what may be done already, or come too late, after the gateway has died."""
        try:
            return await self.ask(request)
        except RefusedError:
            if not self.was_disturbed:
                raise
            return None

    async def queue(self, robot="r1"):
        """Return a robot's queue as operators see it."""
        (found,) = (await self.ask(lambda fleet: fleet.queues.read(GetQueue(robot, paths=True)))).queues
        return found

    async def set_queue(self, *tasks, robot="r1"):
        """Give a robot a queue."""

        async def replace(fleet):
            (seen,) = (await fleet.queues.read(GetQueue(robot))).queues
            return await fleet.queues.set(SetQueue(robot, seen.revision, list(tasks)), "Ada")

        await self.ask(replace)

    async def resume(self, robot="r1"):
        """Let a robot's queue go on."""

        async def resume(fleet):
            (seen,) = (await fleet.queues.read(GetQueue(robot))).queues
            return await fleet.queues.resume(ResumeQueue(robot, seen.revision), "Ada")

        await self.ask_once(resume)
        self.resumed = self._moment()

    async def stop(self, id):
        """Stop every robot; who has heard that it is in force does not ask again."""
        report = await self.fleet.emergency.stop(EmergencyStop(id), "Ada")
        assert report.in_force
        if self.database.dead:
            await self._revive()
            report = self.fleet.emergency.report()
            assert (report.in_force, report.stop) == (True, id), "a stop is forgotten that was in force"
            await self._look()

    async def abort(self, robot):
        """Abort what a robot does; who has heard that the gateway keeps that, or finds it in the log
        afterwards, does not ask again.
        """
        id = f"abort-of-{robot}"
        while not self.sql("select id from commands where id = ?", id):
            try:
                await self.fleet.orders.abort(AbortTask(id, robot), "Ada")
                if not self.database.dead:
                    return
            except Killed:
                pass
            except StoreError as error:
                assert STORED_LATER in str(error)
                return
            await self._revive()
            await self._look()

    async def resume_all(self):
        """Let all queues go on; each was paused, unless nothing was left in it by then."""
        for name, robot in self.robots.items():
            robot.must_stand = False
            queue = await self.queue(name)
            if queue.state.value == "paused":
                await self.resume(name)
            else:
                assert not queue.tasks

    async def resume_until_done(self):
        """Let all queues go on until everything is done, also those whose robots have not stopped yet."""
        await self.resume_all()
        await self.until_done()

    def about_to_stop(self):
        """Note that operators are now going to stop robots."""
        self.stopped = self._moment()

    def _moment(self):
        return Moment(self.death.count, self.turns)

    async def order(self, id, op, robot="r1", **params):
        """Order a robot to do something beside its queue."""
        await self.ask(lambda fleet: fleet.orders.send(Send(f"command-{id}", robot, op, params), "Ada"))

    async def stand_for(self, seconds):
        """Let so many seconds pass in which no robot may be sent anywhere."""
        for robot in self.robots.values():
            robot.must_stand = True
        await self.wait(seconds)

    def is_done(self):
        """Tell whether no task is left in any queue and no command is open."""
        left = self.sql("select id from queue_tasks where state in ('waiting', 'current', 'failed')")
        return not left and not self.open_commands()

    def is_held(self, robot, why):
        """Tell whether a robot's queue is paused for a reason that holds ``why``."""
        held = self.sql("select reason from queues where robot = ? and state = 'paused'", robot)
        return any(why in reason for (reason,) in held)

    async def until_done(self):
        """Let time pass until no task is left in any queue and no command is open."""
        await self.until(self.is_done)

    # --- what it came to ------------------------------------------------------------------------------------

    def open_commands(self):
        """Return the commands that have a step to come, as they are stored."""
        states = "'queued', 'delivered', 'acknowledged'"
        return self.sql(f"select id, robot, op, state from commands where state in ({states})")

    def state_of(self, id):
        """Return the stored state of a command that was ordered by ``id``."""
        ((state,),) = self.sql("select state from commands where id = ?", f"command-{id}")
        return state

    def check(self, order=None, paused=()):
        """Check what must hold at the end of every play; ``order`` is the tasks that each robot did."""
        states = dict(self.sql("select robot, state from queues"))
        assert states == {robot: "paused" if robot in paused else "running" for robot in states}, (
            self._stage()
        )
        assert self.sql("select id, state from queue_tasks where state <> 'done'") == []
        assert self.open_commands() == []
        for robot, tasks in (order or {}).items():
            done = "select id from queue_tasks where robot = ? order by ended_at, place"
            assert [id for (id,) in self.sql(done, robot)] == list(tasks)
        assert {op for (op,) in self.sql("select op from sa")} <= {"Start", "OpAck", "SetMap"}
        assert self.sql("select op from rr where op not in ('SendPos', 'Stopped', 'OpAck')") == []
        for robot in self.robots.values():
            assert robot.record.after_stop == []
        self._check_steps()

    def check_cones(self, places, *, interrupted=False):
        """Check that a cone stands at each of ``places``, put down once and measured once.

        What a robot has done and could not say it is told to do once more: because it forgot it, or because
        its task was given back (``interrupted``) while it could not be reached.
        """
        wanted = sorted((one.x, one.y) if isinstance(one, QueueTask) else one for one in places)
        near = [pytest.approx(place, abs=0.05) for place in wanted]
        found = self.sql("select x, y, deviation from placements order by x, y")
        assert [(x, y) for x, y, _ in found] == near
        assert all(deviation < 0.05 for _, _, deviation in found)
        put_down = sorted(cone for robot in self.robots.values() for cone in robot.record.placed)
        if self.how == START_ANEW or (interrupted and self.was_disturbed):
            put_down = [
                b for a, b in itertools.pairwise([None, *put_down]) if a is None or math.dist(a, b) > 0.1
            ]
        assert put_down == near

    def _check_steps(self):
        """Check that every command took the steps of a command's life, and came to one end."""
        lives = {}
        for command, state in self.sql("select command, state from command_steps order by id"):
            lives.setdefault(command, []).append(CommandState(state))
        for steps in lives.values():
            for now, then in itertools.pairwise(steps):
                assert now is then or may_become(now, then), steps
            assert not steps[-1].is_open

    def _stage(self):
        """Return how things stand, for whoever reads why a play failed."""
        tasks = self.sql("select robot, id, state, command, reason from queue_tasks order by robot, place")
        queues = self.sql("select robot, state, reason from queues")
        robots = [(robot.name, robot.x, robot.y, robot.task) for robot in self.robots.values()]
        return "\n".join(map(str, [*robots, *queues, *tasks, *self.open_commands()]))

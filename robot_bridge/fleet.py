"""The fleet: what robots say and ask goes in here, and so does what operators want of them.

Links and the desk server call it; it knows neither. Everything that must outlive the process is committed
before it is answered.
"""

from __future__ import annotations

import logging
import time
from collections import Counter
from collections.abc import Callable, Coroutine
from typing import Any

from .answering import Answering
from .commanding.book import CommandBook
from .commanding.drafting import Rules
from .commanding.orders import Orders
from .emergency.journal import StopJournal
from .emergency.stops import EmergencyStops
from .exchange import Outcome
from .ground_track import GroundTracks
from .listeners import Listeners
from .mailboxes import Mailboxes
from .messages import (
    Answer,
    Command,
    CommandReport,
    CommandState,
    GetPath,
    ObservationReport,
    Observed,
    OpAck,
    Question,
    Ready,
    Request,
    RobotReport,
    SendGPS,
    SendPos,
    Stopped,
    to_json,
)
from .monitoring.tally import Tally
from .observation_book import ObservationBook
from .places import keepout_refusals
from .planning import Planner, StraightPlanner
from .queueing.book import QueueBook
from .queueing.context import QueueContext
from .queueing.driving import QueueDriving
from .queueing.orders import QueueOrders
from .queueing.pausing import RobotPauses
from .reception import Reception
from .removals import Removals
from .road_traffic.road_planning import RoadPlanner
from .road_traffic.roads import Roads
from .robots import Robot, Robots
from .served_site import ServedSite, SiteChoice
from .snapshots import ReportRow, Snapshots
from .store import commands
from .store import robots as stored_robots
from .store.database import Database
from .trajectories.recorder import Recorder
from .trajectories.saving import Saving

log = logging.getLogger(__name__)


class Fleet:
    """The robots of one site and their commands, on one database."""

    def __init__(
        self,
        site: ServedSite,
        database: Database,
        clock: Callable[[], float] = time.time,
        planner: Planner | None = None,
        stops: StopJournal | None = None,
    ) -> None:
        self.site = site
        self.site_choice: SiteChoice | None = None
        """the sites that supervisors may choose among, where there is a choice."""
        self._database = database
        self._clock = clock
        self.listeners = Listeners()
        """the operators' sessions, told what happens."""
        announce = self.listeners.announce
        self.robots = Robots(site.report.stale_after, site.report.lost_after)
        self.snapshots = Snapshots(self.robots, clock)
        self._book = CommandBook(
            database,
            self.robots,
            site.report.reached_tolerance,
            clock,
            Rules(self._check, self._consider, lambda messages: keepout_refusals(site, messages)),
            self._command_changed,
            self._outbox_changed,
        )
        self.orders = Orders(site, self.robots, self._book, database)
        self.emergency = EmergencyStops(self._book, database, clock, self.robots.names, announce, stops)
        self._queue_book = QueueBook(database, self.robots, announce)
        about_queues = QueueContext(site, self.robots, self._book, self._queue_book, database, clock)
        self.queues = QueueOrders(about_queues)
        self.driving = QueueDriving(about_queues)
        self.roads = Roads(
            site,
            self.robots,
            self._book,
            self.orders,
            self.driving,
            database,
            clock,
            planner if isinstance(planner, RoadPlanner) else None,
            announce,
        )
        self.pauses = RobotPauses(about_queues, self.roads.waiting.row_of)
        self.recorder = Recorder(lambda: self.site.settings.trajectories)
        self._saving = Saving(database, self.robots, self.recorder, clock)
        self.mailboxes = Mailboxes(database, self.robots, self._book, self.emergency, self._saving)
        self.reception = Reception(
            site, self.robots, self._book, self.emergency, self.mailboxes, self._saving, database, clock
        )
        self._removals = Removals(self.robots, self._saving, self._book, self.emergency, self.roads.waiting)
        self.observations = ObservationBook(site, database, clock, self._observation_changed)
        self._answering = Answering(
            site, database, self.robots, self._book, planner or StraightPlanner(), self.roads.ways
        )
        self._tracks = GroundTracks()
        self.tally = Tally()

    @property
    def database(self) -> Database:
        """The database that everything is kept in."""
        return self._database

    async def start(self) -> None:
        """Go on where the last gateway on this database stopped, and tell its robots Start."""
        await self.reception.restore()
        known = await self._database.run(stored_robots.load)
        for robot in known:
            self.robots.restore(robot, self._clock())
        await self._book.restore()
        self._removals.begin([robot.name for robot in known])
        for robot in known:
            self.robots.assign(robot.name, self._book.busy_with(robot.name))
        await self.emergency.restore()
        await self.roads.restore()
        await self._queue_book.restore()
        await self.observations.restore()
        start = self.reception.greeting()
        greetings = [Outcome(robot.name, answer=start) for robot in known if robot.link == "sql"]
        await self.mailboxes.finish(greetings, [], acks=False)

    # --- robots ---------------------------------------------------------------------------------------

    async def receive(
        self, robot: str, link: str, request: Request, id: int | None, *, waited: bool = False
    ) -> Outcome:
        """Deal with request ``id`` of a robot; its link sends what comes of it: :meth:`.Mailboxes.finish`.

        One that has ``waited`` until there was a gateway to read it tells what was, not what is.

        :raises NotReadyError: from a robot that never said Ready; RefusedError for what is not done, saying
            why; MessageError for what is wrong in itself.
        """
        now = self._clock()
        self.tally.requests[link, type(request).__name__] += 1
        if isinstance(request, Ready):
            return await self.reception.receive(robot, link, request, id)
        if isinstance(request, SendGPS):
            request = self._pose_of(robot, request, now)
        if isinstance(request, SendPos):
            if (rest := self._take_pose(robot, link, request, now, waited=waited)) is not None:
                await rest
            return Outcome(robot)
        # Only driving sets a robot that said Stopped in motion.
        stopped = isinstance(request, Stopped) or self.robots.get(robot).ended_in_order
        known = self.robots.heard(robot, link, now, stopped=stopped, waited=waited)
        self._saving.touch(robot)
        answer, note = await self._deal_with(known, link, request, id)
        return Outcome(robot, OpAck(id=id, reason=note or None) if request.acknowledged else None, answer)

    def take_pose(self, robot: str, link: str, pose: SendPos) -> Coroutine[Any, Any, None] | None:
        """Deal with a position as :meth:`receive` does, at once but for what is returned, to be awaited.

        That is the storing of a command that the robot has carried out, nearly always None.
        """
        self.tally.requests[link, "SendPos"] += 1
        return self._take_pose(robot, link, pose, self._clock())

    def closed(self, robot: str) -> None:
        """Note that the robot closed its link in good order."""
        self.robots.closed(robot)
        self._saving.touch(robot)

    # --- operators ------------------------------------------------------------------------------------

    def reports(self, since: int = -1) -> list[RobotReport]:
        """Return the robots that changed after revision ``since`` of :attr:`robots`."""
        return self.robots.reports(self._clock(), since)

    def rows(self, since: int = -1) -> list[Any]:
        """Return them as they are encoded (see :mod:`.snapshots`)."""
        return self.robots.rows(self._clock(), since, ReportRow)

    async def commands(self, robot: str | None, limit: int) -> list[CommandReport]:
        """Return the newest commands first, of one robot or of all."""
        return await self._database.run(commands.newest, robot, limit)

    def open_commands(self) -> Counter[CommandState]:
        """Return how many commands with a step to come are in each state."""
        return self._book.count()

    async def site_changed(self) -> None:
        """Go by the site's newest facts and settings from now on, and tell operators of them."""
        report = self.site.report
        self.robots.limit(report.stale_after, report.lost_after)
        self._book.tolerance = report.reached_tolerance
        await self.observations.restore()
        await self.roads.closures.site_changed()
        self.listeners.announce("site", report.id, to_json(report))

    # --- time -----------------------------------------------------------------------------------------

    async def watch_roads(self) -> None:
        """See to closed roads, and to robots in each other's way."""
        await self.roads.watch(listened_to=bool(self.listeners))

    def age(self) -> None:
        """Bring the liveness of every robot up to now."""
        self.robots.age(self._clock())

    async def save(self) -> None:
        """Store where robots are and have been since the last call, and see to who was removed."""
        await self._saving.save()
        await self._removals.carry_out()
        await self.emergency.store()
        await self.observations.catch_up()
        await self._book.save_progress()
        await self._book.expire(self.site.settings.commands.expire_after_s)

    async def finish_trajectories(self) -> None:
        """Store where robots are and have been, up to the last position of each: the gateway ends."""
        self.recorder.finish()
        await self.save()

    # ---------------------------------------------------------------------------------------------------

    async def _deal_with(
        self, robot: Robot, link: str, request: Request, id: int | None
    ) -> tuple[Answer | None, str]:
        """Deal with what is neither Ready nor a position; return the answer to it, and a note about that."""
        if isinstance(request, OpAck):
            self._measure(robot, await self._book.acknowledged(robot.name, request))
        elif isinstance(request, Stopped):
            if (rest := self._book.rests(robot.name, robot.pose if robot.located else None)) is not None:
                await rest
        elif isinstance(request, Observed):
            await self.observations.add(robot, link, request, id)
        elif isinstance(request, Question):
            if isinstance(request, GetPath):
                self.roads.waiting.check(robot.name)
            answer, note = await self._answering.answer(robot.name, request)
            self.emergency.check(answer)
            return answer, note
        return None, ""

    def _pose_of(self, robot: str, fix: SendGPS, now: float) -> SendPos:
        last = self.robots.get(robot).pose
        place, theta = self.site.place_on_earth(fix.lat, fix.lon, fix.heading)
        return self._tracks.pose(robot, fix, place, theta, last, now)

    def _take_pose(
        self, robot: str, link: str, pose: SendPos, now: float, *, waited: bool = False
    ) -> Coroutine[Any, Any, None] | None:
        unseen = self.robots.is_unseen(robot, now)
        if not self.robots.observe(robot, pose, link, now, waited=waited):
            return None
        if unseen:
            self._book.lose_sight(robot)
        self._saving.observe(robot, now, pose)
        return self._book.observe(robot, pose)

    def _measure(self, robot: Robot, written_at: float | None) -> None:
        """Take the time from a message's writing to its OpAck for the latency of a link that has no pings."""
        if robot.link == "sql" and written_at is not None:
            took = self._clock() - written_at
            # A robot that was away in between says nothing about its link.
            if 0 <= took < self.site.report.lost_after:
                self.robots.measured(robot.name, took)

    def _check(self, message: Command) -> None:
        """Raise RefusedError for a message that must not be sent to any robot now."""
        self.emergency.check(message)
        self.roads.closures.check(message)

    async def _consider(self, message: Command) -> None:
        await self.roads.closures.consider(message)

    def _command_changed(self, command: CommandReport) -> None:
        self.robots.assign(command.robot, self._book.busy_with(command.robot))
        self.tally.steps[command.state.value] += 1
        self.emergency.take(command)
        self.driving.take(command)
        self.roads.take(command)
        self.listeners.announce("command", command.command, to_json(command))

    def _observation_changed(self, observation: ObservationReport) -> None:
        self.listeners.announce("observation", str(observation.observation), to_json(observation))

    def _outbox_changed(self, robot: str) -> None:
        self.mailboxes.changed(robot)

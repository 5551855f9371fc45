"""The fleet: what robots say and ask goes in here, and so does what operators want of them.

Links and the desk server call it; it knows neither. Everything that must outlive the process is committed
before it is answered.
"""

from __future__ import annotations

import asyncio
import logging
import time
from collections import Counter
from collections.abc import Callable, Coroutine, Iterable
from typing import Any

from . import exchange
from .answering import Answering
from .commanding.book import CommandBook
from .commanding.orders import Orders
from .emergency.journal import StopJournal
from .emergency.stops import HELD_BACK, EmergencyStops
from .exchange import Outcome
from .ground_track import GroundTracks
from .handshake import Holds, refusal
from .listeners import Listeners
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
    SetMap,
    Start,
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
from .removals import Removals
from .road_traffic.closure_book import ClosureBook
from .road_traffic.detours import Detours
from .road_traffic.road_planning import RoadPlanner
from .road_traffic.traffic_control import TrafficControl
from .road_traffic.waiting_robots import WaitingRobots
from .road_traffic.ways import Ways
from .robots import Robot, Robots
from .served_site import ServedSite, SiteChoice
from .snapshots import ReportRow, Snapshots
from .store import answers, commands, facts, requests
from .store import robots as stored_robots
from .store.answers import AnswerRow
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
            site.report.reached_tolerance,
            clock,
            self._command_changed,
            self._outbox_changed,
            self._check,
            self._consider,
        )
        self._book.seen = self.robots.pose
        self._book.fence = lambda messages: keepout_refusals(site, messages)
        self._book.unseen = lambda robot: self.robots.is_unseen(robot, clock())
        self.ways = Ways(self.robots, self._book)
        self.roads = planner if isinstance(planner, RoadPlanner) else None
        self.orders = Orders(site, self.robots, self._book, database)
        self.emergency = EmergencyStops(self._book, database, clock, self.robots.names, announce, stops)
        self._queue_book = QueueBook(database, self.robots, announce)
        about_queues = QueueContext(site, self.robots, self._book, self._queue_book, database, clock)
        self.queues = QueueOrders(about_queues)
        self.driving = QueueDriving(about_queues)
        self._detours = Detours(
            self.ways,
            self.roads,
            self.orders,
            self.driving,
            self._book,
            lambda: self.site.settings.routes.no_way == "stop",
        )
        self.closures = ClosureBook(database, clock, self.roads, self._detours, announce)
        self._waiting = WaitingRobots(database, self._book, self._detours)
        self.pauses = RobotPauses(about_queues, self._waiting.row_of)
        self.traffic = TrafficControl(
            clock,
            self.robots,
            self.ways,
            self.roads,
            self._detours,
            self._waiting,
            lambda: self.site.settings.routes,
            announce,
        )
        self.recorder = Recorder(lambda: self.site.settings.trajectories)
        self._saving = Saving(database, self.robots, self.recorder, clock)
        self._removals = Removals(self.robots, self._saving, self._book, self.emergency, self._waiting)
        self.observations = ObservationBook(site, database, clock, self._observation_changed)
        self._answering = Answering(
            site, database, self.robots, self._book, planner or StraightPlanner(), self.ways
        )
        self._tracks = GroundTracks()
        self.holds = Holds()
        self.tally = Tally()
        self._database_id = ""
        self._outboxes: dict[str, asyncio.Event] = {}
        self._greeting: dict[str, asyncio.Lock] = {}

    @property
    def database(self) -> Database:
        """The database that everything is kept in."""
        return self._database

    async def start(self) -> None:
        """Go on where the last gateway on this database stopped, and tell its robots Start."""
        self._database_id = await self._database.run(facts.database_id)
        known = await self._database.run(stored_robots.load)
        for robot in known:
            self.robots.restore(robot, self._clock())
        await self._book.restore()
        self._removals.begin([robot.name for robot in known])
        for robot in known:
            self.robots.assign(robot.name, self._book.busy_with(robot.name))
        await self.emergency.restore()
        await self.closures.restore()
        await self._waiting.restore()
        await self._queue_book.restore()
        await self.observations.restore()
        greetings = [Outcome(robot.name, answer=self.greeting()) for robot in known if robot.link == "sql"]
        await self.finish(greetings, [], acks=False)

    # --- robots ---------------------------------------------------------------------------------------

    def greeting(self) -> Start:
        """Return what robots are told when the gateway begins to listen to them."""
        return Start(self._database_id)

    async def receive(
        self, robot: str, link: str, request: Request, id: int | None, *, waited: bool = False
    ) -> Outcome:
        """Deal with request ``id`` of a robot; its link sends what comes of it, through :meth:`finish`.

        One that has ``waited`` until there was a gateway to read it tells what was, not what is.

        :raises NotReadyError: from a robot that never said Ready; RefusedError for what is not done, saying
            why; MessageError for what is wrong in itself.
        """
        now = self._clock()
        self.tally.requests[link, type(request).__name__] += 1
        if isinstance(request, Ready):
            async with self._greeting.setdefault(robot, asyncio.Lock()):
                return await self._receive_ready(robot, link, request, id)
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

    async def finish(self, outcomes: list[Outcome], request_ids: list[int], *, acks: bool) -> None:
        """Write the answers of requests into SA, with their OpAcks if ``acks``, and delete them from RR.

        One transaction, with the positions that they told: a request is either answered and gone, or will be
        dealt with again. A robot that said Ready is stored before.
        """
        if outcomes or request_ids:
            rows = exchange.rows_of(outcomes, acks=acks)
            if admitted := {outcome.robot for outcome in outcomes if outcome.admitted}:
                # Together: one by one, the Readys of a whole fleet outlast a gateway that is killed soon.
                await self._saving.save(*admitted)
            if request_ids:
                # A request whose answer a power cut undid is there again, and is dealt with again.
                # It may have waited for long: where the robot was then must not be in memory alone.
                await self._saving.jot_with(exchange.finish, outcomes, rows, request_ids)
            else:
                await self._database.run(exchange.finish, outcomes, rows, request_ids, [])
        for outcome in outcomes:
            if outcome.answer is not None:
                self._outbox_changed(outcome.robot)

    def closed(self, robot: str) -> None:
        """Note that the robot closed its link in good order."""
        self.robots.closed(robot)
        self._saving.touch(robot)

    async def outbox(self, robot: str, after: int, after_urgent: int = 0) -> list[AnswerRow]:
        """Return the robot's messages as :func:`.answers.read`, without those that must not be sent now."""
        rows = await self._database.read(answers.read, robot, after, after_urgent)
        return [row for row in rows if row.op not in HELD_BACK] if self.emergency.in_force else rows

    def outbox_event(self, robot: str) -> asyncio.Event:
        """Return the event that is set whenever the robot's outbox holds something new."""
        return self._outboxes.setdefault(robot, asyncio.Event())

    async def hand_over(self, robot: str, id: int) -> bool:
        """Note that message ``id`` of SA is about to be sent to its robot; false where it must not be."""
        return await self._book.hand_over(robot, id)

    async def delivered(self, ids: Iterable[int]) -> None:
        """Note that messages of SA have reached their robots."""
        await self._book.delivered(ids)

    async def delivered_by_deletion(self, link: str) -> None:
        """Note the messages that the robots of ``link`` have read and deleted from SA themselves."""
        sent = self._undelivered(link)
        if sent:
            await self._book.delivered(sent - await self._database.run(answers.waiting, sorted(sent)))

    async def take_up(self) -> int:
        """Take note of what waits in RR from before it was read; return the id of the newest of it.

        Acknowledgements among that may have been dealt with already: their commands are judged by positions
        that come after them alone.
        """
        newest, acks = await self._database.read(requests.backlog)
        for robot, id in acks:
            self._book.await_again(robot, id)
        return newest

    async def look(self, link: str) -> list[requests.RequestRow]:
        """Return the oldest requests in RR, which stay there until :meth:`finish`; note what was read."""
        sent = self._undelivered(link)
        rows, waiting = await self._database.read(exchange.look, sorted(sent))
        if rows and (late := self._undelivered(link) - sent):
            # Sent while the database looked; its acknowledgement may be among the rows already.
            sent |= late
            waiting |= await self._database.read(answers.waiting, sorted(late))
        if sent - waiting:
            await self._book.delivered(sent - waiting)
        return rows

    def _undelivered(self, link: str) -> set[int]:
        return {
            id
            for id, robot in self._book.undelivered().items()
            if robot in self.robots and self.robots.get(robot).link == link
        }

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
        await self.closures.site_changed()
        self.listeners.announce("site", report.id, to_json(report))

    # --- time -----------------------------------------------------------------------------------------

    async def watch_roads(self) -> None:
        """Open roads that were closed until now; see to robots on closed ones, and in each other's way."""
        await self.closures.expire()
        await self.closures.catch_up()
        await self.traffic.watch(listened_to=bool(self.listeners))

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
                self._waiting.check(robot.name)
            answer, note = await self._answering.answer(robot.name, request)
            self.emergency.check(answer)
            return answer, note
        return None, ""

    async def _receive_ready(self, robot: str, link: str, request: Ready, id: int | None) -> Outcome:
        reason = await self._refusal(robot, request.magic)
        if reason is not None:
            log.warning("link %s: a second robot said Ready: %s", link, reason)
            return Outcome(robot, OpAck(id=id, ok=False, reason=reason, magic=request.magic))
        if starts_anew := self.robots.starts_anew(robot, request.magic):
            # Before it is known by its new number: after a failure it must be seen to start anew once more.
            await self.delivered_by_deletion(self.robots.get(robot).link)
            reason = f"robot {robot} started anew; sent once more"
            await self._book.deliver_again(robot, reason, self.site.settings.commands.expire_after_s)
        self.robots.ready(robot, request.magic, link, self._clock())
        self._saving.touch(robot)
        if starts_anew:
            # Not only with its answer: should the gateway die until then, it has not started anew once more.
            await self._saving.save(robot)
        await self.emergency.ready(robot)
        content = await asyncio.to_thread(self.site.whole_map)
        ack = OpAck(id=id, magic=request.magic, robot=robot, database=self._database_id)
        return Outcome(robot, ack, SetMap(content), void=("Start", "OpAck"))

    def _pose_of(self, robot: str, fix: SendGPS, now: float) -> SendPos:
        last = self.robots.get(robot).pose
        place, theta = self.site.place_on_earth(fix.lat, fix.lon, fix.heading)
        return self._tracks.pose(robot, fix, place, theta, last, now)

    async def _refusal(self, robot: str, magic: int) -> str | None:
        if robot not in self.robots:
            return None
        known, limit = self.robots.get(robot), self.site.report.stale_after
        return await refusal(known, magic, self._clock() - known.received_at, limit, self.holds)

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
        self.closures.check(message)

    async def _consider(self, message: Command) -> None:
        await self.closures.consider(message)

    def _command_changed(self, command: CommandReport) -> None:
        self.robots.assign(command.robot, self._book.busy_with(command.robot))
        self.tally.steps[command.state.value] += 1
        self.emergency.take(command)
        self.driving.take(command)
        self._waiting.take(command)
        self.listeners.announce("command", command.command, to_json(command))

    def _observation_changed(self, observation: ObservationReport) -> None:
        self.listeners.announce("observation", str(observation.observation), to_json(observation))

    def _outbox_changed(self, robot: str) -> None:
        self.outbox_event(robot).set()

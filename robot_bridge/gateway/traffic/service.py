"""Traffic control: conflicts found, reported and resolved; assembly of all parts of road traffic."""

from __future__ import annotations

import asyncio
import math
import time
from collections.abc import Iterable
from typing import Any, NamedTuple

from ...core.clock import Clock
from ...core.errors import RefusedError
from ...core.messages import roads as messages
from ...core.messages.base import to_json
from ...core.messages.commands import CommandReport
from ...core.messages.robots import path_to_end
from ...core.sites.site import Site
from ..commands.requests import CommandRequests
from ..commands.service import CommandService
from ..commands.validation import WaitingRobots
from ..model.arrival import Point
from ..model.events import EventBus, Listeners, handles
from ..model.robots import Robots
from ..monitoring import Steps
from ..site.places import ServedSite, route_in_site_frame
from ..storage.database import Database
from .closures import ClosureService, DetourQueues, Detours
from .conflicts import Movement, conflicts_with, driving_movement, find_conflicts
from .road_planning import RoadPlanner, RouteOptions, route_for_operator
from .robot_paths import RobotPath, RobotPaths, TrafficSnapshot, conflict_report, split_path
from .yielding import REACH, YieldManager, yield_beside_path, yield_on_path

# --- Conflicts of robots: found, reported to operators, and resolved when an operator requests it ---

SLOWEST = 0.3
"""A robot below this share of the usual speed is starting or stopping, and will not keep that speed."""
SHARE = 0.1
"""The share of one processor that the search for conflicts may take."""
SHORTEST = 0.5
"""Metres of a path below which a robot cannot be sent on to wait: it would have to stop at once."""


class YieldPlan(NamedTuple):
    """How a robot yields: it waits at ``station`` of its path, or drives ``points``.

    ``later`` is its delay on arrival in seconds, ``until`` the end of its waiting.
    """

    way: RobotPath
    points: list[Point]
    later: float
    station: float = 0.0
    until: float | None = None


class TrafficControl:
    """Searches for conflicts about once a second, and resolves one when an operator chooses who yields."""

    def __init__(
        self,
        clock: Clock,
        robots: Robots,
        ways: RobotPaths,
        roads: RoadPlanner | None,
        detours: Detours,
        waiting: YieldManager,
        site: ServedSite,
        listeners: Listeners,
    ) -> None:
        self._clock = clock
        self._robots = robots
        self._ways = ways
        self._roads = roads
        self._detours = detours
        self._waiting = waiting
        self._site = site
        self._listeners = listeners
        self._lock = asyncio.Lock()
        self._had_conflicts = False
        self._next = 0.0

    @handles(messages.GetConflicts)
    async def conflicts(self) -> messages.Conflicts:
        """Return the conflicts of all robots on their present paths."""
        seen = self.situation()
        found = await asyncio.to_thread(_found, seen)
        return messages.Conflicts(seen.now, found, self._waiting.report())

    async def watch(self, *, listened_to: bool) -> None:
        """Let robots continue after their wait; report conflicts to operators if ``listened_to``."""
        async with self._lock:
            await self._waiting.catch_up()
            if self._waiting:
                await self._waiting.end_waits(self.situation())
        if not listened_to or time.monotonic() < self._next:
            return
        began, found = time.monotonic(), list[messages.ConflictReport]()
        if self._ways.all():
            found = await asyncio.to_thread(_found, self.situation())
        self._next = time.monotonic() + (time.monotonic() - began) / SHARE
        report = messages.Conflicts(self._clock.time(), found, self._waiting.report())
        something = bool(report.conflicts or report.waiting)
        if something or self._had_conflicts:
            self._listeners.announce("conflicts", "conflicts", to_json(report))
        self._had_conflicts = something

    @handles(messages.GetWaysOut)
    async def ways_out(self, request: messages.GetWaysOut) -> messages.WaysOut:
        """Return the options of each of two robots in conflict; nothing is done or sent."""
        return await asyncio.to_thread(self._ways_out, self.situation(), request, self._site.site)

    @handles(messages.ResolveConflict)
    async def resolve(self, request: messages.ResolveConflict, operator: str) -> messages.ConflictResolved:
        """Make ``robot`` wait for ``other``, or send it another way.

        :raises RefusedError: when there is no such conflict, or it cannot be resolved so; nothing is changed.
        """
        async with self._lock:
            plan = await asyncio.to_thread(self._plan, self.situation(), request)
            if plan.until is None:
                return await self._send_round(request, plan, operator)
            return await self._let_wait(request, plan, operator)

    def situation(self, names: Iterable[str] | None = None) -> TrafficSnapshot:
        """Return the snapshot of the robots ``names``, or of all that take commands.

        The paths of those that are only seen are unknown: :mod:`.fleet.nearness` is for these.
        """
        settings, places, placed = self._site.settings.routes, {}, set()
        everybody = [*self._robots.commanded(), *self._robots.commanded_elsewhere()]
        for robot in self._robots.known(everybody if names is None else names):
            pose = robot.pose
            if pose is not None:
                usual = abs(pose.v) >= SLOWEST * settings.speed_ms
                places[robot.name] = (pose.x, pose.y), abs(pose.v) if usual else settings.speed_ms
                if robot.is_placed:
                    placed.add(robot.name)
        return TrafficSnapshot(
            self._clock.time(), settings, self._ways.all(), places, self._waiting.rows(), frozenset(placed)
        )

    def _ways_out(self, seen: TrafficSnapshot, request: messages.GetWaysOut, site: Site) -> messages.WaysOut:
        pairs = (request.robot, request.other), (request.other, request.robot)
        ways = [self._giving_way(seen, *pair) for pair in pairs]
        ways += [_aside(seen, site, *pair) for pair in pairs]
        return messages.WaysOut(seen.now, request.robot, request.other, ways)

    def _giving_way(self, seen: TrafficSnapshot, robot: str, other: str) -> messages.WayOut:
        try:
            plan = self._plan(seen, messages.ResolveConflict(robot, other))
        except RefusedError as error:
            return messages.WayOut(robot, "give way", False, str(error))
        if plan.until is None:
            text = f"{robot} takes another way and arrives about {plan.later:.0f} s later"
            return messages.WayOut(robot, "give way", True, text)
        x, y = split_path(plan.points, plan.station)[0][-1]
        text = f"{robot} waits at ({x:.1f}, {y:.1f}) for {other}, about {plan.later:.0f} s"
        return messages.WayOut(robot, "give way", True, text)

    def _plan(self, seen: TrafficSnapshot, request: messages.ResolveConflict) -> YieldPlan:
        """Return the plan by which the robot yields with the least delay; raises RefusedError without one."""
        movements = seen.movements()
        for robot in (request.robot, request.other):
            if robot not in movements:
                raise RefusedError(f"it is not known where robot {robot!r} is, so nothing can be planned")
        if request.robot not in seen.placed:
            raise RefusedError(
                f"it is not known where {request.robot} is now, and another way might lead it back to where "
                "it was; try again when it is heard"
            )
        mine, margin = movements[request.robot], seen.settings.margin_m
        if not conflicts_with(mine, [movements[request.other]], margin, seen.now):
            raise RefusedError(
                f"{request.robot} and {request.other} are not in each other's way now; nothing was done"
            )
        underway = next((one for one in seen.underway if one.robot == request.robot), None)
        if underway is None or request.robot in seen.holds:
            raise RefusedError(
                f"{request.robot} has no task or waits already, so it cannot give way; "
                f"let {request.other} do it, or send {request.robot} aside"
            )
        way = underway.way()
        plans = []
        if request.by != "route":
            plans.append(_waiting(way, movements, seen))
        if request.by != "waiting":
            plans.append(self._round(way, movements, seen))
        good = [plan for plan in plans if plan is not None]
        if not good:
            moves = any(one.robot == request.other for one in seen.underway)
            raise RefusedError(_unresolved(request, moves))
        return min(good, key=lambda plan: plan.later)

    def _round(
        self, way: RobotPath, movements: dict[str, Movement], seen: TrafficSnapshot
    ) -> YieldPlan | None:
        """Return another path without conflicts, None where there is none."""
        if self._roads is None:
            return None
        mine, margin = movements[way.robot], seen.settings.margin_m
        others = [movement for name, movement in movements.items() if name != way.robot]
        found = conflicts_with(mine, others, margin, seen.now)
        met = {name for one in found for name in (one.robot, one.other)}
        avoid = [movements[name].points.tolist() for name in met - {way.robot}]
        try:
            goal = self._detours.goal(way)
            route = self._roads.route(way.points[0], goal, RouteOptions(avoid=avoid))
        except RefusedError:
            return None
        movement = driving_movement(way.robot, route.points, seen.places[way.robot][1], seen.now, mine.radius)
        if route.note or conflicts_with(movement, others, margin, seen.now):
            return None
        return YieldPlan(way, route.points, max(movement.ends - mine.ends, 0.0))

    async def _send_round(
        self, request: messages.ResolveConflict, plan: YieldPlan, operator: str
    ) -> messages.ConflictResolved:
        robot, reason = plan.way.robot, f"out of the way of {request.other}"
        path = path_to_end(plan.way.task, plan.points)
        command = await self._detours.send(plan.way, path, operator, reason)
        text = f"{robot} was sent another way, {reason}, and arrives about {plan.later:.0f} s later"
        return messages.ConflictResolved(robot, "another way", text, command, round(plan.later, 1))

    async def _let_wait(
        self, request: messages.ResolveConflict, plan: YieldPlan, operator: str
    ) -> messages.ConflictResolved:
        assert plan.until is not None
        robot = plan.way.robot
        first, rest = split_path(plan.points, plan.station)
        command = await self._waiting.send(plan.way, first, rest, request.other, plan.until, operator)
        x, y = first[-1]
        text = f"{robot} waits at ({x:.1f}, {y:.1f}) for {request.other}, about {plan.later:.0f} s"
        return messages.ConflictResolved(robot, "waits", text, command, round(plan.later, 1))


def _found(seen: TrafficSnapshot) -> list[Any]:
    movements, settings = list(seen.movements().values()), seen.settings
    clearance = 2 * settings.radius_m + settings.margin_m
    return [conflict_report(one, clearance) for one in find_conflicts(movements, settings.margin_m, seen.now)]


def _aside(seen: TrafficSnapshot, site: Site, robot: str, other: str) -> messages.WayOut:
    """Return where a standing robot can go out of the way of all others, or why it cannot."""
    movements = seen.movements()
    why = ""
    if robot not in seen.placed:
        why = f"it is not known where {robot} is now"
    elif any(one.robot == robot for one in seen.underway) or robot in seen.holds:
        why = f"{robot} has a task or waits; let it give way, or stop it"
    elif other not in movements:
        why = f"it is not known where {other} is"
    if why:
        return messages.WayOut(robot, "aside", False, f"{robot} cannot go aside: {why}")
    others = [movement for name, movement in movements.items() if name != robot]
    points = yield_beside_path(
        movements[robot], others, site, seen.places[robot][1], seen.settings.margin_m, seen.now
    )
    if points is None:
        why = f"no free place within {REACH:g} m that it could reach before others come; stop {other}"
        return messages.WayOut(robot, "aside", False, f"{robot} cannot go aside: {why}")
    x, y = points[-1]
    text = f"{robot} goes {math.dist(*points):.1f} m aside, to ({x:.1f}, {y:.1f})"
    return messages.WayOut(robot, "aside", True, text, points)


def _waiting(way: RobotPath, movements: dict[str, Movement], seen: TrafficSnapshot) -> YieldPlan | None:
    """Return the robot's wait on its path, None where this does not help or is at its present position."""
    mine = movements[way.robot]
    others = [movement for name, movement in movements.items() if name != way.robot]
    wait = yield_on_path(mine, others, seen.settings.margin_m, seen.now) if way.known else None
    if wait is None or wait.station < SHORTEST or math.isinf(wait.movement.ends):
        return None
    until = mine.time_at(wait.station) + wait.seconds
    return YieldPlan(way, way.points, wait.seconds, wait.station, until)


def _unresolved(request: messages.ResolveConflict, other_moves: bool) -> str:
    """Return why a robot cannot yield, and the remedies: a standing robot can only go aside."""
    how = {
        "waiting": "waiting does not resolve it, or it is too late for that",
        "route": "no other way on the roads meets nobody",
        "either": "neither waiting nor another way resolves it",
    }[request.by]
    other = f"Let {request.other} give way" if other_moves else f"Send {request.other} aside"
    return (
        f"{request.robot} cannot give way to {request.other}: {how}. {other}, stop {request.robot}, "
        "or draw a route"
    )


# --- Road traffic as a whole: path planning, closed roads, and robots yielding to one another


class RoadTraffic:
    """The robots' paths, the closed roads, and the robots that wait for others.

    ``planner`` is None where the gateway plans without roads. Operators are notified through ``listeners``.
    """

    def __init__(
        self,
        site: ServedSite,
        robots: Robots,
        commands: CommandService,
        orders: CommandRequests,
        queues: DetourQueues,
        waiting: WaitingRobots,
        database: Database,
        clock: Clock,
        planner: RoadPlanner | None,
        listeners: Listeners,
        events: EventBus,
    ) -> None:
        self.planner = planner
        self._site = site
        self._robots = robots
        self._steps = Steps("roads")
        self.ways = RobotPaths(robots, commands)
        detours = Detours(self.ways, planner, orders, queues, commands, site)
        self.closures = ClosureService(database, clock, planner, detours, listeners, events)
        self.waiting = YieldManager(database, robots, commands, detours, waiting)
        self.traffic = TrafficControl(
            clock,
            robots,
            self.ways,
            planner,
            detours,
            self.waiting,
            site,
            listeners,
        )

    async def restore(self) -> None:
        """Restore the closed roads and the waiting robots that an earlier gateway left."""
        await self.closures.restore()
        await self.waiting.restore()

    @handles(messages.GetRoute)
    async def route(self, request: messages.GetRoute) -> messages.RouteReport:
        """Return the route along the roads that an operator requests; raises RefusedError without one."""
        request = await route_in_site_frame(self._site, request)
        return await route_for_operator(self.planner, self._robots, self.ways, request)

    @handles(messages.GetSurfaces)
    async def surfaces(self, request: messages.GetSurfaces) -> messages.Surfaces:
        """Return the road surface at each place; raises RefusedError for a CRS without a transform."""
        try:
            found = await asyncio.to_thread(self._site.surfaces_at, request.points, request.crs)
        except RefusedError as error:
            raise RefusedError(f"get_surface: {error}") from error
        return messages.Surfaces(
            [
                None if one is None else messages.SurfaceAt(one.label, one.origin, one.name or None)
                for one in found
            ]
        )

    def note_step(self, command: CommandReport) -> None:
        """Process a step of a command; called with each step."""
        self.waiting.note_step(command)

    async def watch(self, *, listened_to: bool) -> None:
        """Open roads with expired closures; handle robots on closed roads, and in conflict.

        Conflicts are searched for only if ``listened_to``: while there are operators to be notified.
        """
        await self._steps.run(
            {
                "closed roads": self.closures.expire,
                "detours": self.closures.catch_up,
                "traffic": lambda: self.traffic.watch(listened_to=listened_to),
            }
        )

"""Yielding: where a robot waits for another, and when it continues."""

from __future__ import annotations

import asyncio
import logging
import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from ...core.clock import ClockStep
from ...core.errors import BridgeError, RefusedError, UncertainError
from ...core.logs import TroubleNews, log_unforeseen
from ...core.messages.base import to_json
from ...core.messages.commands import CommandReport, CommandState
from ...core.messages.roads import HoldReport
from ...core.messages.robots import SetPath, path_to_end
from ...core.roads.surface_index import NOWHERE
from ...core.sites.fences import TOUCH_M, FencedAreas
from ...core.sites.site import Site
from ..commands.active_command import NOTHING
from ..commands.persistence import Also, AlsoOf
from ..commands.service import CommandService
from ..commands.validation import WaitingRobots
from ..model.arrival import Floats, Point
from ..model.robots import Robots
from ..storage.database import Database
from ..storage.repositories import closures as stored
from ..storage.repositories.closures import HoldRow
from .closures import Detours
from .conflicts import Movement, OtherMovements, Span, conflicts_with, driving_movement
from .robot_paths import RobotPath, TrafficSnapshot, hold_report

# --- Yielding on the path: where and how long a robot waits so that others, as planned, pass first ---
# Prioritised planning (Erdmann and Lozano-Pérez, 1987): the robot of higher priority is planned first and
# then fixed, and the next one is planned around it.

LONGEST_WAIT = 900.0
"""seconds."""
_BACK = 2.0
"""Metres between the places on its path at which a robot might wait."""
_PLACES = 12
"""Most places that are tried, further apart on a long path."""
_STEP = 0.5
"""Least seconds by which a wait is extended, as long as it is too short."""
_HALVINGS = 5
"""Number of bisections of the last step to find the shortest wait."""


@dataclass(frozen=True)
class YieldWait:
    """``movement`` waits ``seconds`` at ``station`` metres along its path and has no conflict."""

    movement: Movement
    station: float
    seconds: float


def yield_on_path(
    movement: Movement,
    others: Sequence[Movement],
    margin: float,
    now: float,
    longest: float = LONGEST_WAIT,
) -> YieldWait | None:
    """Return the wait that lets ``movement`` pass ``others`` as early as possible; None without one.

    The robot drives as near to the conflict as it can wait without being in the way of others. Without a
    conflict the wait is 0 s.
    """
    around = OtherMovements(others, margin, now)
    found = around.conflicts(movement)
    if not found:
        return YieldWait(movement, 0.0, 0.0)
    first = min(found, key=lambda one: one.begins)
    met = first.stations[0] if first.robot == movement.robot else first.stations[1]
    unless_waiting = [(one.begins, one.ends) for one in found]
    best: YieldWait | None = None
    for station in _places(met):
        # A further place counts only if the wait is shorter there by a second.
        below = math.inf if best is None else best.seconds - 1.0
        best = _wait_at(movement, station, around, unless_waiting, longest, below) or best
    return best


def _places(met: float) -> list[float]:
    count = min(math.ceil(met / _BACK), _PLACES)
    places = [met - (k + 1) * met / count for k in range(count)] if count else []
    return [*(place for place in places if place > 1e-6), 0.0]


def _wait_at(
    movement: Movement,
    station: float,
    around: OtherMovements,
    unless_waiting: list[Span],
    longest: float,
    below: float,
) -> YieldWait | None:
    """Return the shortest wait at ``station`` metres, within about a tenth of a second.

    ``unless_waiting`` are the spans of the conflicts without a wait. None where no wait below ``below``
    seconds helps.
    """
    short, seconds, found = 0.0, 0.0, unless_waiting
    arrives = movement.time_at(station)
    # Once all others stand nothing changes any more.
    longest = min(longest, around.ends - arrives + 2 * _STEP)
    while found:
        if any(math.isinf(ends) or begins < arrives + seconds for begins, ends in found):
            # The other never leaves, or the robot is itself in the way here: waiting does not help.
            return None
        short = seconds
        seconds += max(max(ends - begins for begins, ends in found) / 2, _STEP)
        if seconds > longest or short >= below:
            return None
        found = around.spans(movement.waiting(station, seconds))
    for _ in range(_HALVINGS):
        middle = (short + seconds) / 2
        if around.spans(movement.waiting(station, middle)):
            short = middle
        else:
            seconds = middle
        if short >= below:
            return None
    return YieldWait(movement.waiting(station, seconds), station, seconds) if seconds < below else None


# --- Yielding aside: the nearest free place for a standing robot, off the paths of all others; no I/O ---

REACH = 25.0
"""Metres around the robot within which a place is searched."""
STEP = 0.5
"""Metres between the circles on which places are tried."""
DIRECTIONS = 32
"""Places on each circle."""
MOST_TRIED = 400
"""Most places that are checked against the others' movements."""
SETS_OUT_AFTER = 3.0
"""Seconds until the robot starts: an operator checks the way before sending it."""

Bools = NDArray[np.bool_]


def yield_beside_path(
    robot: Movement, others: Sequence[Movement], site: Site, speed: float, margin: float, now: float
) -> list[Point] | None:
    """Return the straight way to the nearest place where ``robot``, which stands, is out of all others' way.

    ``others`` move as planned; ``speed`` is metres a second, ``margin`` metres between two robots. The place
    lies on the site, on a road surface where the robot stands on one, and the robot's circle touches neither
    a keepout nor an obstacle there, nor on the way except those that it is at already. None without one.
    """
    start: Point = (float(robot.points[0, 0]), float(robot.points[0, 1]))
    places = _on_site(_around(start), site, robot.radius)
    places = places[_is_on_surface(places, start, site)]
    for areas in (site.fences.keepouts, site.fences.obstacles):
        places = places[_is_clear(places, start, areas, robot.radius)]
    places = places[_is_off_ways(places, others, robot.radius + margin)]
    around = OtherMovements(others, margin, now)
    for x, y in places[:MOST_TRIED].tolist():
        moving = driving_movement(robot.robot, [start, (x, y)], speed, now, robot.radius)
        if not around.spans(moving.waiting(0.0, SETS_OUT_AFTER)):
            return [start, (round(x, 3), round(y, 3))]
    return None


def _around(start: Point) -> Floats:
    """Return the places to try, (n, 2), the nearest first."""
    radii = np.arange(1, round(REACH / STEP) + 1) * STEP
    turns = np.arange(DIRECTIONS) * 2 * math.pi / DIRECTIONS
    unit = np.column_stack([np.cos(turns), np.sin(turns)])
    offsets: Floats = (radii[:, None, None] * unit).reshape(-1, 2)
    places: Floats = offsets + np.array(start)
    return places


def _on_site(places: Floats, site: Site, radius: float) -> Floats:
    x_min, y_min, x_max, y_max = site.bounds
    low, high = np.array([x_min, y_min]) + radius, np.array([x_max, y_max]) - radius
    inside: Floats = places[((places >= low) & (places <= high)).all(axis=1)]
    return inside


def _is_on_surface(places: Floats, start: Point, site: Site) -> Bools:
    """Return which places are on a road surface; all where the robot itself stands on none."""
    index = site.surface_index
    if index.at(*start) == NOWHERE:
        return np.ones(len(places), dtype=bool)
    on: Bools = index.at_many(places) != NOWHERE
    return on


def _is_clear(places: Floats, start: Point, areas: FencedAreas, radius: float) -> Bools:
    """Return which places, and the legs to them, are clear of areas; a robot may leave those it is at."""
    clear = np.ones(len(places), dtype=bool)
    clear[areas.near(places, radius)[0]] = False
    for metres in (radius, TOUCH_M):
        here = areas.near(np.array([start]), metres)[1]
        leg, area = areas.near_legs(start, places, metres)
        clear[leg[~np.isin(area, here)]] = False
    return clear


def _is_off_ways(places: Floats, others: Sequence[Movement], clearance: float) -> Bools:
    """Return which places are off the paths of others, at any time, and off their final positions."""
    off = np.ones(len(places), dtype=bool)
    for other in others:
        low, high = other.points.min(axis=0) - REACH, other.points.max(axis=0) + REACH
        if ((places >= low) & (places <= high)).all(axis=1).any():
            off &= _metres_to(other.points, places) >= clearance + other.radius
    return off


def _metres_to(line: Floats, places: Floats) -> Floats:
    """Return the distance of each of ``places`` from a line through points, or from its only point."""
    nearest: Floats = np.hypot(*(places - line[0]).T)
    begin, step = line[:-1], np.diff(line, axis=0)
    square = np.maximum((step * step).sum(axis=1), 1e-12)
    # Leg by leg: all at once a long path would take memory in proportion to points times places.
    for origin, along, length in zip(begin, step, square, strict=True):
        share = np.clip(((places - origin) @ along) / length, 0.0, 1.0)
        foot = origin + share[:, None] * along
        nearest = np.minimum(nearest, np.hypot(*(places - foot).T))
    return nearest


# --- Robots that wait for others to pass: sent to their place of waiting, and on when the path is free

log = logging.getLogger(__name__)

ENDING = ("Abort", "SetPosEnd", "SetPath")
NEAR = 1.0
"""Metres within which a robot is at its place of waiting."""


class YieldManager:
    """The robots that wait. The rest of their paths is stored, so that they are sent on after a restart."""

    def __init__(
        self,
        database: Database,
        robots: Robots,
        commands: CommandService,
        detours: Detours,
        waiting: WaitingRobots,
    ) -> None:
        self._database = database
        self._robots = robots
        self._commands = commands
        self._detours = detours
        self._rows = waiting
        self._doubtful = False
        """whether a robot may be stored as waiting without being known here."""
        self._news = TroubleNews()

    def __len__(self) -> int:
        return len(self._rows)

    def rows(self) -> dict[str, HoldRow]:
        """Return the stored rows of the waiting robots, by name."""
        return dict(self._rows)

    def report(self) -> list[HoldReport]:
        """Return the reports of the waiting robots."""
        return [hold_report(row) for row in self._rows.values()]

    async def restore(self) -> None:
        """Load the robots that wait since an earlier gateway."""
        rows = await self._database.run(stored.held)
        self._rows.clear()
        # Robots of other gateways are sent on by those.
        self._rows.update({row.robot: row for row in rows if self._robots.gateway_of(row.robot) is None})

    def doubt(self) -> None:
        """Mark the stored rows to be read again: robots of another gateway may have come."""
        self._doubtful = True

    def clock_was_set(self, step: ClockStep) -> None:
        """Keep the remaining times of waiting: a robot would wait for years, or no more."""
        self._rows.update({n: row._replace(until=step.moved(row.until)) for n, row in self._rows.items()})

    async def catch_up(self) -> None:
        """Load robots that may be stored as waiting without being known here; raises StoreError."""
        if self._doubtful:
            await self._commands.resolve_uncertain_commit()
            # Before the rows are read: a robot that comes meanwhile may not be among them.
            self._doubtful = False
            try:
                await self.restore()
            except BaseException:
                self._doubtful = True
                raise

    async def send(
        self, way: RobotPath, first: list[Point], rest: list[Point], other: str, until: float, operator: str
    ) -> str:
        """Send a robot along ``first`` and make it wait there for ``other`` until ``until`` at least.

        Then it is sent along ``rest``; the path of a queue's task continues as that task. Return the id of
        the command that it carries out; raises as :meth:`.Detours.send`.
        """
        task, queues = self._detours.queued(way), self._detours.queues
        if task is not None:
            rest = queues.to_the_end(task, rest)
        after = to_json(path_to_end(way.task, rest))
        row = HoldRow(way.robot, other, "", after, until, operator, None if task is None else task.task)

        def also(command: str) -> Also:
            return partial(stored.hold, row=row._replace(command=command))

        try:
            command = await self._send(way, first, row, rest, also)
        except UncertainError:
            self._doubtful = True
            raise
        self._rows[way.robot] = row._replace(command=command)
        return command

    async def _send(
        self, way: RobotPath, first: list[Point], row: HoldRow, rest: list[Point], also: AlsoOf
    ) -> str:
        if row.task is None:
            reason = f"waits for {row.other}"
            return await self._detours.send(way, SetPath(first), row.by, reason, also)
        return await self._detours.queues.stop_over(way.robot, first, rest, row.other, row.by, also)

    def note_step(self, report: CommandReport) -> None:
        """Process a command: a robot that is sent another one no longer waits, and is not sent on."""
        row = self._rows.get(report.robot)
        ends = report.state is CommandState.QUEUED and report.op in ENDING
        # The command to its place of waiting may be written again.
        if ends and row is not None and row.command != report.command:
            del self._rows[report.robot]
            log.warning("robot %s was sent %s, and waits no longer", report.robot, report.op)

    def check(self, robot: str) -> None:
        """Raise RefusedError for a robot that requests its path while it must wait."""
        row = self._rows.get(robot)
        if row is not None and self._commands.busy_with(robot) == row.command:
            raise RefusedError(
                f"GetPath: robot {robot!r} waits for {row.other!r}; it is told its way when that has passed"
            )

    async def end_waits(self, seen: TrafficSnapshot) -> None:
        """Send on the robots with an expired wait and a free path.

        Robots with an unknown present position are left for later.
        """
        for row in [row for row in self._rows.values() if row.robot in seen.placed]:
            try:
                await self._send_on(row, seen)
            except BridgeError as error:
                if self._news.has(row.robot, str(error)):
                    text = "robot %s, which waits for %s, is not sent on: %s"
                    log.warning(text, row.robot, row.other, error)
            except Exception as error:
                if self._news.has(row.robot, repr(error)):
                    log_unforeseen(log, f"robot {row.robot}, which waits for {row.other}")

    async def _send_on(self, row: HoldRow, seen: TrafficSnapshot) -> None:
        task = self._commands.busy_with(row.robot)
        if not self._still_waits(row, task, seen):
            log.warning("robot %s has another command by now, or gave up; it waits no longer", row.robot)
            await self._forget(row.robot)
            return
        if seen.now < row.until:
            return
        rest = SetPath(**row.rest)
        if not await asyncio.to_thread(_is_free, row, seen):
            return
        if row.task is not None:
            await self._forget(row.robot)
            self._detours.queues.schedule(row.robot)
            return
        given = self._commands.task(row.robot)
        target = given[0] if given is not None else rest
        points = _from_here(seen, row.robot, rest)
        way = RobotPath(row.robot, task or NOTHING, target, points, True)
        path = path_to_end(rest, points)

        def also(_command: str) -> Also:
            return partial(stored.release, robot=row.robot)

        await self._detours.send(way, path, row.by, f"{row.other} has passed", also)
        self._rows.pop(row.robot, None)

    def _still_waits(self, row: HoldRow, task: str | None, seen: TrafficSnapshot) -> bool:
        """Return whether the robot still carries out its command, or stands at its place of waiting."""
        if task is not None:
            return task == row.command
        place, _ = seen.places[row.robot]
        return math.dist(place, SetPath(**row.rest).points[0]) <= NEAR

    async def forget(self, robot: str) -> None:
        """End the waiting of a robot without sending it on; raises StoreError."""
        if robot in self._rows:
            await self._forget(robot)

    async def _forget(self, robot: str) -> None:
        await self._database.run(stored.release, robot)
        self._rows.pop(robot, None)


def _is_free(row: HoldRow, seen: TrafficSnapshot) -> bool:
    """Return whether the robot has no conflict on the rest of its path if it continues now."""
    movements = seen._replace(holds={**seen.holds, row.robot: row._replace(until=seen.now)}).movements()
    mine = movements.pop(row.robot)
    return not conflicts_with(mine, movements.values(), seen.settings.margin_m, seen.now)


def _from_here(seen: TrafficSnapshot, robot: str, rest: SetPath) -> list[tuple[float, float]]:
    way = next((one.way() for one in seen.underway if one.robot == robot), None)
    before = [seen.places[robot][0]] if way is None else way.points[:-1]
    return [*before, *rest.points]

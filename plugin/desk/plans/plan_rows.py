"""A plan in words and numbers: what table, map and message say of it."""

from __future__ import annotations

import time
from dataclasses import dataclass, replace

from ....robot_bridge.assignment.editing import trips_of
from ....robot_bridge.assignment.plan import Plan, Stop
from ....robot_bridge.assignment.travel import STRAIGHT
from ....robot_bridge.messages import TaskState
from ...assignment_words import FOUND
from ...language import first_of, tr, tr_count
from .draft import Draft
from .progress import Progress

COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#8C510A", "#6A3D9A")
"""Of Okabe and Ito's palette and two more; with more robots they repeat, and the numbers tell them apart."""

_WORDS = {
    TaskState.WAITING: tr("in the queue"),
    TaskState.CURRENT: tr("under way"),
    TaskState.FAILED: tr("FAILED"),
    TaskState.DONE: tr("done"),
    TaskState.SKIPPED: tr("skipped"),
    TaskState.REMOVED: tr("taken out"),
}
NOT_DONE = (TaskState.FAILED, TaskState.SKIPPED)


@dataclass(frozen=True)
class StopRow:
    """One stop as it is shown. ``number`` counts the stops of its robot, from 1, those behind it first.

    ``state`` is what became of a cone that was sent, ``why`` what is said of it; ``deviation`` is metres.
    """

    robot: str
    number: int
    trip: int
    stop: Stop
    arrives: str
    state: TaskState | None = None
    why: str = ""
    deviation: float | None = None

    def in_words(self) -> str:
        """Return state and reason for the operator, nothing for what was not sent."""
        words = "" if self.state is None else _WORDS[self.state]
        return f"{words}: {self.why}" if self.why else words


def colour_of(plan: Plan, robot: str) -> str:
    """Return a robot's colour in the plan, as ``#rrggbb``."""
    names = [one.robot.id for one in plan.robots]
    return COLOURS[names.index(robot) % len(COLOURS)]


def rows_of(draft: Draft, progress: Progress | None) -> dict[str, list[StopRow]]:
    """Return the stops of each robot, those behind it first."""
    began = None if progress is None else progress.began_at
    rows: dict[str, list[StopRow]] = {}
    for one in draft.plan.robots:
        behind = [(0, stop) for stop in one.done]
        to_come = [(trip.number, stop) for trip in one.trips for stop in trip.stops]
        rows[one.robot.id] = [
            _row(one.robot.id, number, trip, stop, began, progress)
            for number, (trip, stop) in enumerate([*behind, *to_come], 1)
        ]
    return rows


def summary(draft: Draft) -> str:
    """Return how good a plan is and what it leaves out."""
    plan = draft.plan
    cones = sum(stop.is_target for _, stop in plan.all_stops())
    robots = sum(bool(one.stops) for one in plan.robots)
    text = tr(
        "{cones}, {robots}, {metres:.0f} m, done after {span} ({method}, along {travel})",
        cones=tr_count(cones, "1 cone", "%n cones"),
        robots=tr_count(robots, "1 robot", "%n robots"),
        metres=plan.metres,
        span=_span(plan.end_s),
        method=FOUND[plan.method],
        travel=tr("straight lines") if plan.travel == STRAIGHT else tr("the roads"),
    )
    out = plan.left_out
    return (
        tr(
            "{text}. Left out: {names}",
            text=text,
            names=", ".join(first_of([f"{one.target.id} ({one.reason})" for one in out])),
        )
        if out
        else text
    )


def how_made(draft: Draft) -> str:
    """Return by which parts a plan was made, for those who want to know."""
    return tr("Found by: {method}. Ways along: {travel}.", method=draft.plan.method, travel=draft.plan.travel)


def clock(seconds: float, began_at: float | None) -> str:
    """Return when that is: the time of day once the plan was begun, before as time after its begin."""
    if began_at is None:
        return f"+{_span(seconds)}"
    return time.strftime("%H:%M:%S", time.localtime(began_at + seconds))


def place_for(plan: Plan, target: str, onto: str, *, after: bool) -> tuple[str, int, int] | None:
    """Return robot, trip and place of ``target`` when it is dropped before or ``after`` cone ``onto``.

    Trip and place are as :func:`~.editing.moved` takes them. None when ``onto`` is nobody's.
    """
    names = [one.robot.id for one in plan.robots if not one.lost]
    for robot, day in zip(names, trips_of(plan), strict=True):
        for trip, cones in enumerate(day):
            left = [cone for cone in cones if cone != target]
            if onto in left:
                return robot, trip, left.index(onto) + after
    return None


def end_of(plan: Plan, target: str, robot: str) -> tuple[str, int, int] | None:
    """Return robot, trip and place of ``target`` when it is given to ``robot`` as its last cone."""
    names = [one.robot.id for one in plan.robots if not one.lost]
    if robot not in names:
        return None
    day = trips_of(plan)[names.index(robot)]
    trip = max((k for k, cones in enumerate(day) if any(cone != target for cone in cones)), default=0)
    room = plan.robot(robot)
    kept = len([cone for cone in day[trip] if cone != target])
    full = room is not None and kept >= (room.robot.aboard if trip == 0 else room.robot.capacity)
    if full and plan.stores:
        return robot, len(day), 0
    return robot, trip, kept


def _row(
    robot: str, number: int, trip: int, stop: Stop, began: float | None, progress: Progress | None
) -> StopRow:
    row = StopRow(robot, number, trip, stop, clock(stop.arrival_s, began))
    if progress is None or not stop.is_target:
        return row
    placed = progress.placed.get(stop.id)
    return replace(
        row,
        state=progress.state_of(stop.id),
        why=progress.remark_on(stop.id),
        deviation=None if placed is None else placed.deviation,
    )


def _span(seconds: float) -> str:
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02d}:{rest:02d}" if hours else f"{minutes}:{rest:02d}"

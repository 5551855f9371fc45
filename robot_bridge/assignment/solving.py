"""Who serves which target on which trip: stage after stage, by PyVRP or as a quick preview."""

from __future__ import annotations

import importlib.util
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

from ..counting import counted
from ..known_names import told
from .days import Day, Days
from .errors import CancelledError, JobError, UnservedError
from .job import Job
from .plan import Plan
from .pyvrp_search import load_pyvrp
from .scheduling import BALANCED, OBJECTIVES, Aim
from .stages import Effort, solved_stage
from .timetable import plan_of
from .travel import CancellableTravel, Travel

AUTOMATIC, PYVRP, PREVIEW = "automatic", "pyvrp", "preview"
PREVIEW_KEPT = f"{PYVRP}, which found nothing better than the preview"
"""The method of a plan that PyVRP looked at and could not improve."""
METHODS = (AUTOMATIC, PYVRP, PREVIEW)

Progress = Callable[[float], bool]
"""Is told which share of the work is done, 0 to 1; what it returns says whether to go on."""


@dataclass(frozen=True)
class Wanted:
    """What is to be least, by which method, and how many seconds it may take.

    :raises JobError: when one of them is none.
    """

    objective: str = BALANCED
    method: str = AUTOMATIC
    time_limit_s: float = 10.0
    seed: int = 0

    def __post_init__(self) -> None:
        for what, value, choices in (
            ("objective", self.objective, OBJECTIVES),
            ("method", self.method, METHODS),
        ):
            if value not in choices:
                raise JobError(f"There is no {what} {value!r}: choose of {', '.join(choices)}.")
        if not (math.isfinite(self.time_limit_s) and self.time_limit_s > 0):
            raise JobError(f"The time limit is {self.time_limit_s:g} s: give seconds above 0.")


def assign(job: Job, travel: Travel, wanted: Wanted | None = None, progress: Progress | None = None) -> Plan:
    """Return the plan by which the robots of ``job`` serve all its targets.

    :raises UnservedError: naming targets that no robot can reach or has the battery for;
        MissingSolverError when PyVRP is asked for and not installed; CancelledError when ``progress`` says
        so.
    """
    wanted = wanted or Wanted()
    use_pyvrp = _use_pyvrp(wanted.method)
    days = Days(job, travel.metres)
    _refuse_unreachable(days)
    progress = progress or (lambda share: True)
    plan, improved_by_pyvrp = _solved(days, wanted, use_pyvrp, progress)
    method = PREVIEW
    if use_pyvrp:
        method = PYVRP if improved_by_pyvrp else PREVIEW_KEPT
    return plan_of(days, CancellableTravel(travel, lambda: progress(1.0)), plan, wanted.objective, method)


def _use_pyvrp(method: str) -> bool:
    if method == PYVRP:
        load_pyvrp()
    return method == PYVRP or (method == AUTOMATIC and importlib.util.find_spec("pyvrp") is not None)


def _solved(days: Days, wanted: Wanted, use_pyvrp: bool, progress: Progress) -> tuple[list[Day], bool]:
    job = days.job
    plan: list[Day] = [[[]] for _ in job.robots]
    done, by_pyvrp = 0, False
    for stage in job.stages:
        targets = [place for place in _places(job) if job.target(place).stage == stage]
        before, part = done / len(job.targets), len(targets) / len(job.targets)

        def tell(share: float, before: float = before, part: float = part) -> None:
            if not progress(before + part * share):
                raise CancelledError("The assignment was cancelled.")

        aim = Aim(wanted.objective, last=stage == job.stages[-1])
        effort = Effort(wanted.time_limit_s * part, use_pyvrp, tell, wanted.seed)
        answer = solved_stage(days, targets, plan, aim, effort)
        if answer.left:
            _refuse(job, answer.left)
        plan, by_pyvrp = answer.plan, by_pyvrp or answer.by_pyvrp
        done += len(targets)
        _close_stage(days, plan, stage)
    return plan, by_pyvrp


def _places(job: Job) -> range:
    return range(job.first_target, len(job.places))


def _close_stage(days: Days, plan: Sequence[Day], stage: int) -> None:
    """Let targets of later stages wait until all of ``plan`` are done."""
    end = max(days.cost(robot, day).served_s for robot, day in enumerate(plan) if any(day))
    for later in days.job.stages:
        if later > stage:
            days.gates[later] = end


def _refuse_unreachable(days: Days) -> None:
    for reason, what_to_do, reachable in (
        ("no way leads from any robot to", "check roads, closed roads and one-way roads", _has_way),
        ("no robot has the battery for", "charge the robots, or place a store nearer", _has_battery),
    ):
        bad = [place for place in _places(days.job) if not reachable(days, place)]
        if bad:
            raise UnservedError(
                f"{counted(len(bad), 'cone')} cannot be served; {reason} {_named(days.job, bad)}: "
                f"{what_to_do}, or leave the cones out.",
                tuple(days.job.target(place).id for place in bad),
            )


def _alone(days: Days, place: int) -> list[tuple[int, Day]]:
    """Return the days of robots that could serve ``place`` if nothing else was to be done."""
    robots = range(len(days.job.robots))
    on_board: list[tuple[int, Day]] = [(one, [[place]]) for one in robots if days.fits(one, [place], True)]
    if not days.job.stores:
        return on_board
    return on_board + [(one, [[], [place]]) for one in robots if days.fits(one, [place], False)]


def _has_way(days: Days, place: int) -> bool:
    return any(_metres(days, robot, day) < math.inf for robot, day in _alone(days, place))


def _has_battery(days: Days, place: int) -> bool:
    return any(days.cost(robot, day).metres < math.inf for robot, day in _alone(days, place))


def _metres(days: Days, robot: int, day: Day) -> float:
    tour = [robot, *days.tour(robot, day)]
    return sum(days.metres[a][b] for a, b in pairwise(tour))


def _refuse(job: Job, left: Sequence[int]) -> None:
    raise UnservedError(
        f"The robots' batteries do not suffice for all {len(job.targets)} cones; left over are "
        f"{_named(job, left)}: charge the robots, give more of them, or leave cones out.",
        tuple(job.target(place).id for place in left),
    )


def _named(job: Job, places: Sequence[int]) -> str:
    return told([job.target(place).id for place in places])

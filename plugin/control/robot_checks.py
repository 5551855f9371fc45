"""Checks of a pending command against its robot's abilities and orders, and against other robots."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from ...robot_bridge.core.messages.commands import CommandReport
from ...robot_bridge.core.messages.queues import TaskState
from ...robot_bridge.core.messages.robots import SetPath, SetPosEnd
from ...robot_bridge.core.messages.safety import Ability, RobotState
from ..gateway_client.command_cache import CommandCache, command_in_words
from ..gateway_client.report_caches import QueueCache
from ..gateway_client.robot_states import RobotView
from ..gateway_client.state_words import ROBOT_STATES
from ..ui.language import age_in_words, tr
from .pending_command import CONE, ROUTE, START, TARGETS, Findings, PendingCommand

Ints = npt.NDArray[np.int64]
ROW = np.int64(2**32)
"""From a cell's number to that of the cell above it; the cell beside it is the next."""
LARGEST = 2**30
"""Cells from the origin; nobody's place is told further away."""


def close_pairs(xy: npt.NDArray[np.float64], reach: float) -> tuple[Ints, Ints, npt.NDArray[np.float64]]:
    """Return all pairs i < j of (n, 2) finite places at most ``reach`` apart, and how far apart they are."""
    nothing = np.empty(0, np.int64)
    if len(xy) < 2 or reach <= 0:
        return nothing, nothing, np.empty(0)
    number = _cells(xy, reach)
    order = np.argsort(number, kind="stable")
    ranked = number[order]
    # Cells beside each other have numbers beside each other. Half of those about a cell are enough: the other
    # half finds the same pairs from the other side.
    beside = np.arange(1, len(order) + 1), np.searchsorted(ranked, ranked + 1, side="right")
    above = (
        np.searchsorted(ranked, ranked + ROW - 1, side="left"),
        np.searchsorted(ranked, ranked + ROW + 1, side="right"),
    )
    found = [_pairs(begin, end) for begin, end in (beside, above)]
    one = order[np.concatenate([pair[0] for pair in found])]
    other = order[np.concatenate([pair[1] for pair in found])]
    apart = np.hypot(*(xy[one] - xy[other]).T)
    near = apart <= reach
    one, other, apart = one[near], other[near], apart[near]
    return np.minimum(one, other), np.maximum(one, other), apart


def pairs_between(
    ones: npt.NDArray[np.float64], others: npt.NDArray[np.float64], reach: float
) -> tuple[Ints, Ints, npt.NDArray[np.float64]]:
    """Return the rows of (n, 2) ``ones`` and (m, 2) ``others`` at most ``reach`` apart, and how far apart."""
    cells = _cells(others, reach)
    order = np.argsort(cells, kind="stable")
    ranked = cells[order]
    cells = _cells(ones, reach)
    found = [
        _pairs(np.searchsorted(ranked, row - 1, side="left"), np.searchsorted(ranked, row + 1, side="right"))
        for row in (cells - ROW, cells, cells + ROW)
    ]
    one = np.concatenate([pair[0] for pair in found])
    other = order[np.concatenate([pair[1] for pair in found])]
    apart = np.hypot(*(ones[one] - others[other]).T)
    near = apart <= reach
    return one[near], other[near], apart[near]


def _cells(xy: npt.NDArray[np.float64], reach: float) -> Ints:
    """Return the number of the cell that each place is in; those beside one another have numbers that are."""
    cell = np.clip(np.floor(xy / reach), -LARGEST, LARGEST).astype(np.int64)
    return cell[:, 1] * ROW + cell[:, 0]


def _pairs(begin: Ints, end: Ints) -> tuple[Ints, Ints]:
    """Return k and every number from begin[k] to before end[k], for each k."""
    count = end - begin
    one = np.repeat(np.arange(len(begin)), count)
    first = np.repeat(begin - (np.cumsum(count) - count), count)
    return one, first + np.arange(len(one))


_NEEDED: dict[str, Ability] = {CONE: "targets", TARGETS: "targets", ROUTE: "paths", START: "start"}


def has_ability(robot: RobotView | None, ability: Ability) -> bool:
    """Tell whether a robot did not say that it cannot do this."""
    abilities = None if robot is None else robot.values.get("abilities")
    return abilities is None or ability in abilities.split()


def check_abilities(draft: PendingCommand, robot: RobotView | None) -> Findings:
    """Refuse what the draft's ``robot`` cannot do; warn where it goes to a cone target without a cone."""
    if robot is None or robot.values.get("abilities") is None:
        return Findings()
    if not robot.values["abilities"]:
        return Findings(refused=(tr("{robot} is only seen: it takes no commands.", robot=draft.robot),))
    if not has_ability(robot, _NEEDED[draft.kind]):
        texts = {
            ROUTE: tr("{robot} cannot follow routes.", robot=draft.robot),
            START: tr("{robot} cannot be told where it starts.", robot=draft.robot),
        }
        otherwise = tr("{robot} cannot be sent to targets.", robot=draft.robot)
        return Findings(refused=(texts.get(draft.kind, otherwise),))
    if has_ability(robot, "cones"):
        return Findings()
    if draft.kind == TARGETS:
        return Findings(refused=(tr("{robot} places no cones.", robot=draft.robot),))
    if draft.kind == CONE:
        return Findings(warnings=(tr("{robot} places no cones: it only drives there.", robot=draft.robot),))
    return Findings()


REPLACING = (CONE, ROUTE)
"""What a robot does in place of what it is at."""


GONE = (RobotState.LOST, RobotState.OFFLINE)


def check_last_seen(draft: PendingCommand, robot: RobotView | None) -> Findings:
    """Warn where nothing is heard of the draft's ``robot``: what is sent waits, or is not carried out."""
    if robot is None or robot.state not in GONE:
        return Findings()
    return Findings(
        warnings=(
            tr(
                "{robot} is {state}, last heard {age} ago: it is told this when it is heard again, if that "
                "is soon enough.",
                robot=draft.robot,
                state=ROBOT_STATES[robot.state],
                age=age_in_words(robot.age),
            ),
        )
    )


def check_orders(draft: PendingCommand, task: CommandReport | None, operator: str) -> Findings:
    """Warn where ``task``, what the draft's robot is at, was asked for by another than ``operator``.

    An empty ``operator`` is one whose name the gateway has not told.
    """
    if task is None or not operator or task.operator == operator or draft.kind not in REPLACING:
        return Findings()
    return Findings(
        warnings=(
            tr(
                "{robot} is at work for {operator} ({task}): sending this takes its place.",
                robot=draft.robot,
                operator=task.operator,
                task=command_in_words(task),
            ),
        )
    )


CLEAR_M = 1.0
"""Metres between the targets of two robots."""


class OtherTarget(NamedTuple):
    """Where a robot is to go, metres in the site frame, and ``what`` that is in words."""

    robot: str
    what: str
    x: float
    y: float


class TargetCheck:
    """Knows the targets of all robots, now and in their queues; reads only those with news again."""

    def __init__(self, book: CommandCache, queues: QueueCache):
        self._book = book
        self._queues = queues
        self._of: dict[str, list[OtherTarget]] = {}
        self._with_news: set[str] = set()
        self._targets: list[OtherTarget] = []
        self._places: npt.NDArray[np.float64] = np.empty((0, 2))

    def mark_changed(self, robots: Iterable[str]) -> None:
        """Take in that something new is known of what these robots have to do."""
        self._with_news.update(robots)

    def clear(self) -> None:
        """Forget every robot."""
        self._of.clear()
        self._with_news.clear()
        self._targets, self._places = [], np.empty((0, 2))

    def check_command(self, draft: PendingCommand) -> Findings:
        """Find the targets of other robots that a draft ends too near to."""
        if draft.kind == START:
            return Findings()
        self._read_news()
        ends = np.array(draft.points if draft.kind == TARGETS else draft.points[-1:], dtype=np.float64)
        if not self._targets:
            return Findings()
        one, other, apart = pairs_between(ends, self._places, CLEAR_M)
        found: dict[str, None] = {}
        for end, number, away in sorted(zip(one.tolist(), other.tolist(), apart.tolist(), strict=True)):
            target = self._targets[number]
            if target.robot != draft.robot and away < CLEAR_M:
                found[_target_text(*ends[end].tolist(), target, away)] = None
        return Findings(overridable=tuple(found))

    def _read_news(self) -> None:
        if not self._with_news:
            return
        for robot in self._with_news:
            self._of[robot] = [*_now(self._book.task_of(robot)), *self._later(robot)]
            if not self._of[robot]:
                del self._of[robot]
        self._with_news.clear()
        self._targets = [target for targets in self._of.values() for target in targets]
        self._places = np.array([target[2:] for target in self._targets], dtype=np.float64).reshape(-1, 2)

    def _later(self, robot: str) -> Iterator[OtherTarget]:
        queue = self._queues.get(robot)
        for task in queue.tasks if queue is not None else ():
            # The current one is under way, as a command.
            if task.state is not TaskState.CURRENT:
                yield OtherTarget(robot, tr("a task"), task.x, task.y)


def _now(report: CommandReport | None) -> Iterator[OtherTarget]:
    if report is None:
        return
    if report.op == SetPosEnd.__name__:
        yield OtherTarget(report.robot, tr("the target"), report.params["x"], report.params["y"])
    elif report.op == SetPath.__name__:
        x, y = report.params["points"][-1]
        yield OtherTarget(report.robot, tr("the end of the route"), x, y)


def _target_text(x: float, y: float, target: OtherTarget, away: float) -> str:
    return tr(
        "({x:.2f}, {y:.2f}) m is {away:.2f} m from {what} of {robot} at {other_x:.2f}, {other_y:.2f}: keep "
        "{clear_m:g} m between targets.",
        x=x,
        y=y,
        away=away,
        what=target.what,
        robot=target.robot,
        other_x=target.x,
        other_y=target.y,
        clear_m=CLEAR_M,
    )

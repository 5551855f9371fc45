"""A plan as tasks in the robots' queues, sent request by request."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from qgis.PyQt.QtCore import QObject, pyqtSignal

from ...robot_bridge.core.messages import (
    PauseQueue,
    QueueReport,
    QueueState,
    QueueTask,
    ResumeQueue,
    SetQueue,
    Share,
    SharedTask,
    TakeOver,
    TaskState,
)
from ..control.fleet_controller import FleetController
from ..control.messages import PLAN_SENT
from ..gateway_client.requests import RequestResult
from ..ui.errors import NotSentError
from ..ui.language import first_of, tr

# --- Sends a plan to the robots' queues, step by step; stops at what is refused and says how far it came

Request = SetQueue | PauseQueue | ResumeQueue | TakeOver


@dataclass(frozen=True)
class QueueStep:
    """One request, made when it is its turn: by then the queue's revision is known. None: nothing to do."""

    words: str
    request: Callable[[], Request | None]


@dataclass(frozen=True)
class RefusedStep:
    """A step that the gateway does with an override alone: its words, and all that speaks against it."""

    words: str
    found: tuple[str, ...]
    told: str
    """How the desk told of it."""


class QueueRequests(QObject):
    """Asks for one step after the other, each when the one before is done.

    Where there is a :attr:`refusal`, it waits for :meth:`override` or :meth:`leave`.
    """

    ended = pyqtSignal(bool, str)
    """Whether all of it was done, and what was refused."""
    refused = pyqtSignal()
    """There is a :attr:`refusal`."""

    def __init__(self, desk: FleetController, steps: Sequence[QueueStep], parent: QObject | None = None):
        super().__init__(parent)
        self._desk = desk
        self._steps = list(steps)
        self._key: str | None = None
        self._now: QueueStep | None = None
        self._sent: Request | None = None
        self.refusal: RefusedStep | None = None
        self.done: list[str] = []
        """What was done, in words."""
        desk.orders.answered.connect(self._answered)

    def start(self) -> None:
        """Ask for the first step."""
        self._next()

    def give_up(self) -> None:
        """Ask for nothing more, and tell nothing of what was asked for."""
        self._desk.orders.answered.disconnect(self._answered)

    def override(self, why: str) -> None:
        """Ask again for what was refused, with ``why`` it is right all the same, and then for the rest."""
        self.refusal = None
        if not self._ask(why):
            self._next()

    def leave(self) -> None:
        """Ask for nothing more than what is done by now."""
        refusal, self.refusal = self.refusal, None
        self._end(False, refusal.told)

    def _next(self) -> None:
        while self._steps:
            self._now = self._steps.pop(0)
            if self._ask():
                return
        self._end(True, "")

    def _ask(self, override: str | None = None) -> bool:
        """Ask for the step whose turn it is; false when there is nothing to do."""
        request = self._now.request()
        if request is None:
            return False
        self._sent = request if override is None else replace(request, override=override)
        try:
            self._key = self._desk.orders.ask(self._sent, self._now.words, PLAN_SENT)
        except NotSentError as error:
            self._end(False, str(error))
        return True

    def _answered(self, answer: RequestResult) -> None:
        if self._key is None or answer.order.key != self._key:
            return
        self._key = None
        if answer.error is not None and not self._is_done_already():
            self._refused(f"{self._now.words}: {answer.error}", answer.overridable)
            return
        self.done.append(self._now.words)
        self._next()

    def _refused(self, told: str, overridable: Sequence[str]) -> None:
        if not overridable:
            self._end(False, told)
            return
        self.refusal = RefusedStep(self._now.words, tuple(f"{text}." for text in overridable), told)
        self.refused.emit()

    def _is_done_already(self) -> bool:
        """Tell whether what was refused was done before: its answer was lost with the link."""
        if not isinstance(self._sent, SetQueue) or not self._sent.tasks:
            return False
        report = self._desk.state.queues.get(self._sent.robot)
        if report is None:
            return False
        there = {task.task for task in (*report.tasks, *report.ended)}
        return all(task.task in there for task in self._sent.tasks)

    def _end(self, done: bool, why: str) -> None:
        self._desk.orders.answered.disconnect(self._answered)
        self._key = None
        left = [step.words for step in self._steps]
        if not done and left:
            why = tr("{why} Not done therefore: {left}.", why=why, left=", ".join(first_of(left)))
        if not done and self.done:
            why = tr("{why} Done before: {done}.", why=why, done=", ".join(first_of(self.done)))
        self.ended.emit(done, why)


def paused_at(desk: FleetController, robots: Iterable[str]) -> dict[str, float | None]:
    """Return since when the queues of ``robots`` are paused, of those that are.

    A pause of another time is another's: whoever lets a robot go on says which pause was seen.
    """
    reports = (desk.state.queues.get(robot) for robot in robots)
    return {one.robot: one.at for one in reports if one is not None and one.state is QueueState.PAUSED}


def has_failed(desk: FleetController, robot: str) -> bool:
    """Tell whether a robot's queue stands still because of a task that failed."""
    report = desk.state.queues.get(robot)
    return report is not None and any(task.state is TaskState.FAILED for task in report.tasks)


def first_steps(desk: FleetController, tasks: Mapping[str, Sequence[QueueTask]]) -> list[QueueStep]:
    """Return what fills the robots' queues, and lets those go on that are paused now."""
    steps, seen = [], paused_at(desk, tasks)
    for robot, theirs in tasks.items():
        if theirs:
            steps += [_filling(desk, robot, theirs), _resuming(desk, robot, seen)]
    return steps


def holding_steps(robots: Sequence[str], reason: str) -> list[QueueStep]:
    """Return what holds robots: they finish what they are doing, and are sent nothing more."""
    return [
        QueueStep(tr("holding {robot}", robot=robot), lambda robot=robot: PauseQueue(robot, reason))
        for robot in robots
    ]


def continuing_steps(desk: FleetController, held: Mapping[str, float | None]) -> list[QueueStep]:
    """Return what lets robots go on that are held since the times of ``held``, and by nobody since."""
    return [_resuming(desk, robot, held) for robot in held]


def later_steps(
    desk: FleetController,
    tasks: Mapping[str, Sequence[QueueTask]],
    away: Sequence[str],
    held: Mapping[str, float | None],
    reason: str,
) -> list[QueueStep]:
    """Return what hands the tasks of robots that are ``away`` to others, and gives every robot its new list.

    The robots of ``tasks`` are to be held before, so that nobody sets off in between.
    """
    staying = list(tasks)
    steps = [_taking(desk, robot, staying[0], reason) for robot in away] if staying else []
    steps += [_filling(desk, robot, theirs) for robot, theirs in tasks.items()]
    return steps + continuing_steps(desk, held)


def _filling(desk: FleetController, robot: str, tasks: Sequence[QueueTask]) -> QueueStep:
    return QueueStep(
        tr("the queue of {robot}", robot=robot),
        lambda: SetQueue(robot, desk.state.queues.revision(robot), list(tasks)),
    )


def _resuming(desk: FleetController, robot: str, seen: Mapping[str, float | None]) -> QueueStep:
    def request() -> ResumeQueue | None:
        report = desk.state.queues.get(robot)
        if report is None or report.state is not QueueState.PAUSED:
            return None
        if robot not in seen or seen[robot] != report.at:
            # Somebody holds it since: it is not ours to let go.
            return None
        return ResumeQueue(robot, report.revision)

    return QueueStep(tr("letting {robot} go on", robot=robot), request)


def _taking(desk: FleetController, lost: str, taker: str, reason: str) -> QueueStep:
    def request() -> TakeOver | None:
        report = desk.state.queues.get(lost)
        if report is None or not report.tasks:
            return None
        own = _waiting(desk.state.queues.get(taker))
        tasks = [SharedTask(task) for task in (*own, *(task.task for task in report.tasks))]
        share = Share(taker, desk.state.queues.revision(taker), tasks)
        return TakeOver(lost, report.revision, [share], reason)

    return QueueStep(tr("taking over from {lost}", lost=lost), request)


def _waiting(report: QueueReport | None) -> list[str]:
    tasks: Sequence[Any] = () if report is None else report.tasks
    return [task.task for task in tasks if task.state is not TaskState.CURRENT]

"""Queues: the tasks of each robot in order, as requested by and reported to operators.

A queue has a ``revision`` that changes with everything but plain progress. A change names the revision that
it is based on; an outdated one is refused, together with the newer state.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from enum import Enum
from typing import Any, ClassVar

from . import base
from .base import DeskRequest, Priority, Role, known_fields
from .safety import RobotState, check_override, check_reason

LONGEST_QUEUE = 1000
"""tasks."""
LONGEST_PATH = 50_000
"""points."""
_SAME_PLACE = 0.01
"""metres between a path's end and its task's target that count as none."""


class TaskKind(str, Enum):
    """The action of a robot where its task ends: nothing, put a cone down, or pick one up."""

    DRIVE = "drive"
    PLACE = "place"
    COLLECT = "collect"


class TaskState(str, Enum):
    """The state of a task. One that failed waits at the head of its queue, which is paused.

    The last three are final: a ``skipped`` one failed and was passed over, by the site's settings.
    """

    WAITING = "waiting"
    CURRENT = "current"
    FAILED = "failed"
    DONE = "done"
    SKIPPED = "skipped"
    REMOVED = "removed"


class QueueState(str, Enum):
    """Whether the gateway sends a robot its next task by itself."""

    RUNNING = "running"
    PAUSED = "paused"


@dataclass(frozen=True)
class QueueTask:
    """One task of a queue: a place to reach, with the action there.

    ``x``, ``y`` (metres, site frame) are the place for the cone, or the end for a robot that only drives;
    ``theta`` is its heading there. ``path``, if given, is driven to get there and ends there. ``task`` is an
    id that the client chooses: given twice, done once. ``placement`` says which placed cone is collected.
    ``cone``, ``label``, ``layout`` and ``plan`` are the operator's own names, stored with the measurements.
    ``after`` names tasks, of any robot's queue, that must be done before this one is sent: its queue waits
    until they are, even for tasks that are only given later. In the CRS ``crs``, if given, are ``x``, ``y``
    and ``path``, x (longitude, easting) before y; the gateway keeps metres in the site frame.
    """

    task: str
    x: float
    y: float
    theta: float | None = None
    kind: TaskKind = TaskKind.DRIVE
    path: list[tuple[float, float]] | None = None
    cone: str | None = None
    label: str | None = None
    layout: str | None = None
    plan: str | None = None
    placement: int | None = None
    after: list[str] | None = None
    crs: str | None = None
    texts: ClassVar[base.Texts] = dict.fromkeys(("cone", "label", "layout", "plan"), base.LONGEST_LABEL)

    def __post_init__(self) -> None:
        check_task_id(self.task)
        base.check_finite(x=self.x, y=self.y, theta=self.theta)
        base.check_crs(self.crs)
        base.check_texts(self)
        base.check_stored_number(placement=self.placement)
        if self.placement is not None and self.kind is not TaskKind.COLLECT:
            raise base.MessageError(
                f"task {self.task}: placement is for what is collected, not {self.kind.value}"
            )
        if self.path is not None:
            check_path(self.task, self.path, (self.x, self.y))
        if self.after is not None:
            _check_after(self.task, self.after)


@dataclass(frozen=True)
class TaskReport:
    """The state of a task. ``path_points`` counts its path's points; ``path`` comes on request.

    ``command`` is the command that drives it, or drove it last, after ``attempts``; ``reason`` is why it
    failed, was given back or is not sent yet, in the robot's or the gateway's words. ``deviation`` is metres
    between target and robot (of a cone: between planned and as-placed).
    """

    task: str
    robot: str
    kind: TaskKind
    state: TaskState
    x: float
    y: float
    added_by: str
    added_at: float
    theta: float | None = None
    cone: str | None = None
    label: str | None = None
    layout: str | None = None
    plan: str | None = None
    placement: int | None = None
    path_points: int = 0
    path: list[tuple[float, float]] | None = None
    attempts: int = 0
    command: str | None = None
    began_at: float | None = None
    ended_at: float | None = None
    reason: str | None = None
    deviation: float | None = None


@dataclass(frozen=True)
class QueueReport:
    """A robot's queue: its open tasks in order, and the newest that ended, newest first.

    ``reason``, ``by`` and ``at`` say why, by whom and when it was paused or resumed last. ``robot_state`` is
    the state of the robot's contact: nothing is sent to one that is lost or offline.
    """

    robot: str
    revision: int
    state: QueueState
    robot_state: RobotState
    tasks: list[TaskReport] = field(default_factory=list)
    ended: list[TaskReport] = field(default_factory=list)
    reason: str | None = None
    by: str | None = None
    at: float | None = None


@dataclass(frozen=True)
class SetQueue(DeskRequest[QueueReport]):
    """Replace the tasks not yet begun by ``tasks``; the present task continues.

    Tasks of this queue that are being done, or were done meanwhile, are skipped. A robot without a queue has
    revision 0. ``override`` states the objections and the reason to proceed, as with ``send``.
    """

    method = "set_queue"
    least_role = Role.OPERATOR
    priority = Priority.MOVE
    robot: str
    revision: int
    tasks: list[QueueTask]
    override: str | None = None

    def __post_init__(self) -> None:
        _check_edit(self.robot, self.revision)
        check_override(self.override)
        _check_tasks(self.tasks)


@dataclass(frozen=True)
class AddTasks(DeskRequest[QueueReport]):
    """Put tasks into a queue, in front of task ``before``, or at its end: sent twice, done once.

    ``override`` states the objections and the reason to proceed, as with ``send``.
    """

    method = "add_tasks"
    least_role = Role.OPERATOR
    priority = Priority.MOVE
    robot: str
    revision: int
    tasks: list[QueueTask]
    before: str | None = None
    override: str | None = None

    def __post_init__(self) -> None:
        _check_edit(self.robot, self.revision)
        check_override(self.override)
        _check_tasks(self.tasks)


@dataclass(frozen=True)
class MoveTask(DeskRequest[QueueReport]):
    """Move a task that is not being done in front of task ``before``, or to the end of its queue."""

    method = "move_task"
    least_role = Role.OPERATOR
    robot: str
    revision: int
    task: str
    before: str | None = None

    def __post_init__(self) -> None:
        _check_edit(self.robot, self.revision)


@dataclass(frozen=True)
class RemoveTask(DeskRequest[QueueReport]):
    """Remove a task that is not being done from its queue."""

    method = "remove_task"
    least_role = Role.OPERATOR
    robot: str
    revision: int
    task: str
    reason: str | None = None

    def __post_init__(self) -> None:
        _check_edit(self.robot, self.revision)
        check_reason(self.reason)


@dataclass(frozen=True)
class MakeCurrent(DeskRequest[QueueReport]):
    """Let a robot do this task first: at once, in place of its present one, which then comes next.

    In a queue that is paused the task is put first, and nothing is sent.
    """

    method = "make_current"
    least_role = Role.OPERATOR
    priority = Priority.MOVE
    robot: str
    revision: int
    task: str

    def __post_init__(self) -> None:
        _check_edit(self.robot, self.revision)


@dataclass(frozen=True)
class PauseQueue(DeskRequest[QueueReport]):
    """Send the robot no further task; it finishes its present one (``abort`` stops it).

    Needs no revision: to hold is never refused.
    """

    method = "pause_queue"
    least_role = Role.OPERATOR
    stops = True
    robot: str
    reason: str | None = None

    def __post_init__(self) -> None:
        base.check_robot_name(self.robot)
        check_reason(self.reason)


@dataclass(frozen=True)
class PauseRobot(DeskRequest[QueueReport]):
    """Let a robot stand, whatever it does, until its queue is resumed; it continues from where it is then.

    It is sent Abort. Its present task waits at the head of its queue, which is paused: a task of the queue,
    or else one made of the SetPosEnd or SetPath that it was sent. Needs no revision; repeating it changes
    nothing.
    """

    method = "pause_robot"
    least_role = Role.OPERATOR
    priority = Priority.STOP
    stops = True
    robot: str
    reason: str | None = None

    def __post_init__(self) -> None:
        base.check_robot_name(self.robot)
        check_reason(self.reason)

    @property
    def abort_reason(self) -> str:
        """The reason of the Abort by which the robot is paused."""
        return f"paused: {self.reason}" if self.reason else "paused"


@dataclass(frozen=True)
class ResumeQueue(DeskRequest[QueueReport]):
    """Resume a paused queue, with the task at its head."""

    method = "resume_queue"
    least_role = Role.OPERATOR
    priority = Priority.MOVE
    robot: str
    revision: int

    def __post_init__(self) -> None:
        _check_edit(self.robot, self.revision)


@dataclass(frozen=True)
class Queues:
    """The queues of robots, by robot."""

    queues: list[QueueReport]


@dataclass(frozen=True)
class GetQueue(DeskRequest[Queues]):
    """Ask for the queue of one robot, or of every robot that has one; with paths if ``paths``.

    ``ended`` is how many of the newest tasks that ended come with each.
    """

    method = "get_queue"
    least_role = Role.VIEWER
    robot: str | None = None
    paths: bool = False
    ended: int = 10

    def __post_init__(self) -> None:
        if self.robot is not None:
            base.check_robot_name(self.robot)
        if not 0 <= self.ended <= LONGEST_QUEUE:
            raise base.MessageError(f"ended is {self.ended}; give a number from 0 to {LONGEST_QUEUE}")


@dataclass(frozen=True)
class SharedTask:
    """A task at its place in the new order, with its new ``path``.

    Without one, a task keeps its path in its own robot's queue. In another's it loses it, since the path
    began elsewhere; a task that only drives keeps it, since the path is the task.
    """

    task: str
    path: list[tuple[float, float]] | None = None


@dataclass(frozen=True)
class Share:
    """The tasks of a robot after one in progress: every task that should wait in its queue, in order."""

    robot: str
    revision: int
    tasks: list[SharedTask]

    def __post_init__(self) -> None:
        _check_edit(self.robot, self.revision)


@dataclass(frozen=True)
class TakeOver(DeskRequest[Queues]):
    """Let other robots take over the waiting tasks of ``robot``, in one step.

    ``shares`` hold for each of them its new queue: its own tasks and those it takes over. All tasks of these
    queues that are not being done must be in them once. The task that ``robot`` is doing may be among them:
    then that robot is sent Abort. Its queue is paused. ``override`` states the objections to a new path and
    the reason to proceed, as with ``send``.
    """

    method = "take_over"
    least_role = Role.OPERATOR
    priority = Priority.MOVE_SEVERAL
    robot: str
    revision: int
    shares: list[Share]
    reason: str | None = None
    override: str | None = None

    def __post_init__(self) -> None:
        _check_edit(self.robot, self.revision)
        check_reason(self.reason)
        check_override(self.override)
        names = [self.robot, *(share.robot for share in self.shares)]
        twice = sorted({name for name in names if names.count(name) > 1})
        if twice:
            raise base.MessageError(
                f"shares: {', '.join(twice)} is named more than once; give each robot one share"
            )


def check_task_id(task: str) -> None:
    """Refuse an id that cannot identify a task; raises MessageError."""
    if not (8 <= len(task) <= 64 and task.isprintable()):
        raise base.MessageError(f"task is {task[:80]!r}; give an id of 8 to 64 characters, say a UUID")


def check_path(task: str, path: list[tuple[float, float]], end: tuple[float, float]) -> None:
    """Refuse points that are no path to ``end``; raises MessageError naming the task."""
    if not 2 <= len(path) <= LONGEST_PATH:
        raise base.MessageError(f"task {task}: path holds {len(path)} points; give 2 to {LONGEST_PATH}")
    # There may be tens of thousands: the wrong one is searched only after the check of all failed.
    if not all(math.isfinite(x) and math.isfinite(y) for x, y in path):
        for number, (x, y) in enumerate(path):
            base.check_finite(**{f"task {task}: path[{number}].x": x, f"task {task}: path[{number}].y": y})
    if max(abs(path[-1][0] - end[0]), abs(path[-1][1] - end[1])) > _SAME_PLACE:
        raise base.MessageError(
            f"task {task}: its path ends at {path[-1]} and its target is {end}; let the path end there"
        )


def _check_after(task: str, after: list[str]) -> None:
    if len(after) > LONGEST_QUEUE:
        raise base.MessageError(f"task {task}: after names {len(after)} tasks; give {LONGEST_QUEUE} at most")
    if task in after:
        raise base.MessageError(f"task {task}: after names the task itself; it would wait for ever")
    for one in after:
        check_task_id(one)


def _check_edit(robot: str, revision: int) -> None:
    base.check_robot_name(robot)
    base.check_stored_number(revision=revision)


def _check_tasks(tasks: list[QueueTask]) -> None:
    if len(tasks) > LONGEST_QUEUE:
        raise base.MessageError(f"tasks holds {len(tasks)} tasks; a queue takes {LONGEST_QUEUE} at most")
    ids = [task.task for task in tasks]
    if len(set(ids)) < len(ids):
        twice = next(id for id in ids if ids.count(id) > 1)
        raise base.MessageError(f"tasks: {twice} is there more than once; give each task an id of its own")


# --- Read from plain JSON values, as a gateway sent them; unknown fields of newer ones are ignored ---


def queue_report(values: dict[str, Any]) -> QueueReport:
    """Return the queue that a gateway sent as JSON."""
    enums = {
        "state": QueueState(values["state"]),
        "robot_state": RobotState(values["robot_state"]),
        "tasks": [task_report(task) for task in values.get("tasks", [])],
        "ended": [task_report(task) for task in values.get("ended", [])],
    }
    return QueueReport(**{**known_fields(QueueReport, values), **enums})


def task_report(values: dict[str, Any]) -> TaskReport:
    """Return the task of a queue that a gateway sent as JSON."""
    typed: dict[str, Any] = {"kind": TaskKind(values["kind"]), "state": TaskState(values["state"])}
    if values.get("path") is not None:
        typed["path"] = [tuple(point) for point in values["path"]]
    return TaskReport(**{**known_fields(TaskReport, values), **typed})

"""Where cones were put down: planned and as placed, and how they are collected again."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import ClassVar

from .bounds import LONGEST_LABEL
from .checks import MessageError, Texts, check_finite, check_robot_name, check_stored_number, check_texts
from .queues import QueueTask

MOST_PLACEMENTS = 5000


@dataclass(frozen=True)
class PlacementReport:
    """A cone that a robot put down; metres and radians in the site frame.

    ``planned_x``, ``planned_y`` is where it was to stand, ``x``, ``y`` where it does: the robot's pose when
    it had reached its target, and from there the site's cone offset. ``theta`` is the robot's heading.
    """

    placement: int
    task: str
    robot: str
    planned_x: float
    planned_y: float
    x: float
    y: float
    theta: float
    deviation: float
    placed_at: float
    command: str
    cone: str | None = None
    label: str | None = None
    layout: str | None = None
    plan: str | None = None
    collected_at: float | None = None
    collected_by: str | None = None


@dataclass(frozen=True)
class GetPlacements:
    """Ask for cones that were put down, newest first: at most ``limit`` with an id below ``before``.

    Of one layout, plan, cone, robot or of all; put down from ``since`` up to ``until`` (seconds since 1970);
    with ``collected`` only those that were collected again, or (false) that were not.
    """

    method: ClassVar[str] = "get_placements"
    layout: str | None = None
    plan: str | None = None
    cone: str | None = None
    robot: str | None = None
    since: float | None = None
    until: float | None = None
    collected: bool | None = None
    before: int | None = None
    limit: int = 1000
    texts: ClassVar[Texts] = dict.fromkeys(("layout", "plan", "cone"), LONGEST_LABEL)

    def __post_init__(self) -> None:
        check_texts(self)
        check_finite(since=self.since, until=self.until)
        check_stored_number(before=self.before)
        if self.robot is not None:
            check_robot_name(self.robot)
        if not 1 <= self.limit <= MOST_PLACEMENTS:
            raise MessageError(f"limit is {self.limit}; give a number from 1 to {MOST_PLACEMENTS}")


@dataclass(frozen=True)
class CollectLayout:
    """Ask for the tasks that collect what stands of a layout; nothing is sent to any robot.

    Without ``layout``, of every cone that was put down and not collected. Which robot takes which is the
    operator's: the tasks go into queues by ``set_queue`` or ``add_tasks``.
    """

    method: ClassVar[str] = "collect_layout"
    layout: str | None = None
    texts: ClassVar[Texts] = {"layout": LONGEST_LABEL}

    def __post_init__(self) -> None:
        check_texts(self)


@dataclass(frozen=True)
class CollectingTasks:
    """The answer to ``collect_layout``: a task for each cone that stands and is in no queue yet.

    ``in_queues`` counts those that a task of some queue collects already.
    """

    tasks: list[QueueTask] = field(default_factory=list)
    in_queues: int = 0


@dataclass(frozen=True)
class Placements:
    """Cones that were put down, newest first."""

    placements: list[PlacementReport]

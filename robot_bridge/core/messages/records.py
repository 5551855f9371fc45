"""Stored records of robots: observations, placed cones, trajectories."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from enum import Enum
from typing import Any, ClassVar, NamedTuple

from . import base
from .base import DeskRequest, Priority, Role, known_fields
from .queues import QueueTask

# --- Observations of robots, and their review by operators ---

LONGEST_REASON = 1000
"""characters."""


class ObservationState(str, Enum):
    """Whether an operator has reviewed an observation, and the outcome."""

    PENDING = "pending"
    ACCEPTED = "accepted"
    REJECTED = "rejected"


@dataclass(frozen=True)
class ObservationReport:
    """One observation: the robot's report by ``op`` (SetObject or SendImage), and its review.

    ``height`` and ``radius`` (metres) are the robot's until an operator changes them; ``label`` is the
    robot's word for the object and ``semantics`` the map's. ``seen_at`` is by the robot's clock. With
    ``doubts`` it is no new object: the robot's sensors see through the map's obstacle with that ``src``.
    """

    observation: int
    robot: str
    op: str
    object: str
    x: float
    y: float
    received_at: float
    state: ObservationState
    seen_at: float | None = None
    label: str | None = None
    height: float | None = None
    radius: float | None = None
    media_type: str | None = None
    image_bytes: int | None = None
    semantics: str | None = None
    reason: str | None = None
    reviewed_at: float | None = None
    reviewed_by: str | None = None
    doubts: str | None = None


@dataclass(frozen=True)
class Observations:
    """What robots saw, newest first."""

    observations: list[ObservationReport]


@dataclass(frozen=True)
class GetObservations(DeskRequest[Observations]):
    """Ask for observations, newest first: at most ``limit`` with an id below ``before``.

    Filtered by ``state``, robot and object (its images too), or all.
    """

    method = "get_observations"
    least_role = Role.VIEWER
    state: ObservationState | None = None
    robot: str | None = None
    object: str | None = None
    before: int | None = None
    limit: int = 100
    ranges: ClassVar[base.Ranges] = {"limit": (1, 1000)}

    def __post_init__(self) -> None:
        base.check_stored_number(before=self.before)
        base.check_ranges(self)


@dataclass(frozen=True)
class Image:
    """An image, in base64."""

    media_type: str
    image: bytes


@dataclass(frozen=True)
class GetImage(DeskRequest[Image]):
    """Ask for the image of an observation; answered with ``media_type`` and ``image`` in base64."""

    method = "get_image"
    least_role = Role.VIEWER
    priority = Priority.SLOW
    observation: int

    def __post_init__(self) -> None:
        base.check_stored_number(observation=self.observation)


@dataclass(frozen=True)
class ReviewObservation(DeskRequest[ObservationReport]):
    """Accept an observation, so that its object is on later maps, or reject it.

    ``semantics`` is the object's word on the map, ``height`` and ``radius`` are in metres; what is left out
    stays as the robot reported. ``revise`` changes an earlier review.
    """

    method = "review_observation"
    least_role = Role.OPERATOR
    observation: int
    accept: bool
    semantics: str | None = None
    height: float | None = None
    radius: float | None = None
    reason: str | None = None
    revise: bool = False
    ranges: ClassVar[base.Ranges] = {"height": (0, 1000), "radius": (0.01, 50)}
    texts: ClassVar[base.Texts] = {"semantics": base.LONGEST_LABEL, "reason": LONGEST_REASON}

    def __post_init__(self) -> None:
        base.check_stored_number(observation=self.observation)
        base.check_ranges(self)
        base.check_texts(self)
        if not self.accept and (self.semantics, self.height, self.radius) != (None, None, None):
            raise base.MessageError(
                "accept is false, and semantics, height and radius are for what is accepted"
            )


# --- Placed cones: planned and actual places, and their collection ---

MOST_PLACEMENTS = 5000


@dataclass(frozen=True)
class PlacementReport:
    """A cone that a robot put down; metres and radians in the site frame.

    ``planned_x``, ``planned_y`` is its planned place, ``x``, ``y`` its actual one: the robot's pose when it
    had reached its target, plus the site's cone offset. ``theta`` is the robot's heading.
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
class Placements:
    """Cones that were put down, newest first."""

    placements: list[PlacementReport]


@dataclass(frozen=True)
class GetPlacements(DeskRequest[Placements]):
    """Ask for cones that were put down, newest first: at most ``limit`` with an id below ``before``.

    Of one layout, plan, cone, robot or of all; put down from ``since`` up to ``until`` (seconds since 1970);
    with ``collected`` only those that were (true) or were not (false) collected.
    """

    method = "get_placements"
    least_role = Role.VIEWER
    layout: str | None = None
    plan: str | None = None
    cone: str | None = None
    robot: str | None = None
    since: float | None = None
    until: float | None = None
    collected: bool | None = None
    before: int | None = None
    limit: int = 1000
    texts: ClassVar[base.Texts] = dict.fromkeys(("layout", "plan", "cone"), base.LONGEST_LABEL)

    def __post_init__(self) -> None:
        base.check_texts(self)
        base.check_finite(since=self.since, until=self.until)
        base.check_stored_number(before=self.before)
        if self.robot is not None:
            base.check_robot_name(self.robot)
        if not 1 <= self.limit <= MOST_PLACEMENTS:
            raise base.MessageError(f"limit is {self.limit}; give a number from 1 to {MOST_PLACEMENTS}")


@dataclass(frozen=True)
class CollectingTasks:
    """The answer to ``collect_layout``: a task for each standing cone that is in no queue yet.

    ``in_queues`` counts those that a queued task collects already.
    """

    tasks: list[QueueTask] = field(default_factory=list)
    in_queues: int = 0


@dataclass(frozen=True)
class CollectLayout(DeskRequest[CollectingTasks]):
    """Ask for the tasks that collect the standing cones of a layout; nothing is sent to any robot.

    Without ``layout``, of every placed cone that is not collected. The operator decides which robot takes
    which: the tasks go into queues by ``set_queue`` or ``add_tasks``.
    """

    method = "collect_layout"
    least_role = Role.VIEWER
    layout: str | None = None
    texts: ClassVar[base.Texts] = {"layout": base.LONGEST_LABEL}

    def __post_init__(self) -> None:
        base.check_texts(self)


# --- Requests of operators for trajectories ---

MOST_PLACES = 5000
_MARK = re.compile(r"(-?\d+(?:\.\d+)?(?:e[+-]?\d+)?):(\d{1,18})")


class TrajectoryPlace(NamedTuple):
    """Where a robot was at the gateway's time ``received_at``; ``t`` and ``fix_t`` are by its own clock."""

    robot: str
    received_at: float
    x: float
    y: float
    theta: float
    v: float
    device_time: float | None
    fix_time: float | None


@dataclass(frozen=True)
class Trajectory:
    """Stored positions, oldest first; ``next`` is the ``after`` of the next page, None at the end."""

    places: list[TrajectoryPlace]
    next: str | None = None


@dataclass(frozen=True)
class GetTrajectory(DeskRequest[Trajectory]):
    """Ask where robots (none named: all) have been, from ``since`` up to ``until``, inside ``bounds``.

    ``bounds`` is x_min, y_min, x_max, y_max in the site frame. ``after`` is ``next`` of the page before.
    """

    method = "get_trajectory"
    least_role = Role.VIEWER
    priority = Priority.SLOW
    robots: list[str] = field(default_factory=list)
    since: float | None = None
    until: float | None = None
    bounds: tuple[float, float, float, float] | None = None
    after: str | None = None
    limit: int = 1000

    def __post_init__(self) -> None:
        base.check_finite(since=self.since, until=self.until)
        if self.bounds is not None:
            x_min, y_min, x_max, y_max = self.bounds
            base.check_finite(x_min=x_min, y_min=y_min, x_max=x_max, y_max=y_max)
            if x_min > x_max or y_min > y_max:
                raise base.MessageError(
                    f"bounds {list(self.bounds)} hold nothing; give x_min, y_min, x_max, y_max"
                )
        if not 1 <= self.limit <= MOST_PLACES:
            raise base.MessageError(f"limit is {self.limit}; give a number from 1 to {MOST_PLACES}")
        if self.after is not None and _MARK.fullmatch(self.after) is None:
            raise base.MessageError(f"after is {self.after[:80]!r}; give 'next' of the page before")

    def mark(self) -> tuple[float, int] | None:
        """Return the time and id encoded in ``after``."""
        found = _MARK.fullmatch(self.after or "")
        return (float(found[1]), int(found[2])) if found else None


def mark_text(received_at: float, id: int) -> str:
    """Return the ``next`` of a page whose last position has this time and id."""
    return f"{received_at!r}:{id}"


# --- Read from plain JSON values, as a gateway sent them; unknown fields of newer ones are ignored ---


def observation_report(values: dict[str, Any]) -> ObservationReport:
    """Return the observation that a gateway sent as JSON."""
    known = known_fields(ObservationReport, values)
    return ObservationReport(**{**known, "state": ObservationState(values["state"])})


def placement_report(values: dict[str, Any]) -> PlacementReport:
    """Return the placed cone that a gateway sent as JSON."""
    return PlacementReport(**known_fields(PlacementReport, values))

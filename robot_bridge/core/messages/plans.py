"""Cone plans that the gateway executes: submitted, followed, paused, replanned, cleared.

A plan has a ``revision`` that changes with everything but plain progress. A change names the revision that it
is based on; an outdated one is refused.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import Enum
from typing import Any

from .base import (
    LONGEST_LABEL,
    DeskRequest,
    MessageError,
    Priority,
    Role,
    check_finite,
    check_stored_number,
    known_fields,
)
from .queues import LONGEST_QUEUE, TaskState
from .safety import check_override, check_reason

MOST_CONES = 5000
"""cones of a plan, and standing cones around it."""
LONGEST_PLANNING = 10.0
"""seconds."""
FARTHEST = 10_000.0
"""metres of each distance that a plan keeps."""


class PlanState(str, Enum):
    """The state of a plan.

    While it is ``replanning`` its robots are held; a ``proposed`` plan for the remaining cones waits to be
    confirmed or discarded. The last two are final.
    """

    DRIVEN = "driven"
    PAUSED = "paused"
    REPLANNING = "replanning"
    PROPOSED = "proposed"
    FINISHED = "finished"
    CLEARED = "cleared"


@dataclass(frozen=True)
class PlanCone:
    """Stored facts on the cone ``id`` of a plan: the operator's name of it and its layout.

    ``placement`` is the number of the placed cone that is collected, with the heading ``theta`` in which it
    was placed.
    """

    id: str
    cone: str
    layout: str = ""
    placement: int | None = None
    theta: float | None = None

    def __post_init__(self) -> None:
        check_label("id", self.id)
        check_label("cone", self.cone)
        if self.layout:
            check_label("layout", self.layout)
        check_stored_number(placement=self.placement)
        check_finite(theta=self.theta)


@dataclass(frozen=True)
class PlanReport:
    """The state of a plan: ``done`` of its ``cones`` are placed or collected, ``left_out`` are given up.

    ``reason``, ``by`` and ``at`` say why, by whom and when it came into its state. ``document``, and
    ``proposal``, the plan for the remaining cones, come on request; ``meetings`` counts where robots come too
    near to one another in the proposal, ``closed`` its paths along closed roads.
    """

    plan: str
    revision: int
    state: PlanState
    submitted_by: str
    submitted_at: float
    by_itself: bool
    cones: int
    done: int
    robots: list[str]
    stops: list[PlanStopReport] = field(default_factory=list)
    problems: list[PlanProblemReport] = field(default_factory=list)
    left_out: list[str] = field(default_factory=list)
    reason: str | None = None
    by: str | None = None
    at: float | None = None
    ended_at: float | None = None
    meetings: int | None = None
    closed: int | None = None
    document: dict[str, Any] | None = None
    proposal: dict[str, Any] | None = None


@dataclass(frozen=True)
class SubmitPlan(DeskRequest[PlanReport]):
    """Give the robots of a plan their tasks, all in one step, and have the gateway follow it from then on.

    ``plan`` is a name that the client chooses; given twice, done once. ``document`` is the plan as
    ``fleet-supervisor-assignment``, ``cones`` name what it places and collects. ``revisions`` are those of
    the robots' queues that the operator saw; what waits in these is replaced. What is left is planned again
    along roads (``on_roads``) for ways longer than ``direct_m``, keeping ``clearance_m`` from cones, also
    from those that ``stand``, and ``apart_m`` between robots, within ``seconds``; unasked if ``by_itself``.
    ``override`` states the objections and the reason to proceed, as with ``send``.
    """

    method = "submit_plan"
    least_role = Role.OPERATOR
    priority = Priority.MOVE
    plan: str
    document: dict[str, Any]
    cones: list[PlanCone]
    revisions: dict[str, int] = field(default_factory=dict)
    stand: list[tuple[float, float]] = field(default_factory=list)
    on_roads: bool = True
    direct_m: float = 25.0
    clearance_m: float = 0.8
    apart_m: float = 2.0
    seconds: float = 2.0
    by_itself: bool = False
    override: str | None = None

    def __post_init__(self) -> None:
        check_label("plan", self.plan)
        check_override(self.override)
        for name, many in (("cones", len(self.cones)), ("stand", len(self.stand))):
            if many > MOST_CONES:
                raise MessageError(f"{name} holds {many} cones; give {MOST_CONES} at most")
        if len(self.revisions) > LONGEST_QUEUE:
            raise MessageError(f"revisions names {len(self.revisions)} robots; give {LONGEST_QUEUE} at most")
        for robot, revision in self.revisions.items():
            check_stored_number(**{f"revisions.{robot[:63]}": revision})
        for number, (x, y) in enumerate(self.stand):
            check_finite(**{f"stand[{number}].x": x, f"stand[{number}].y": y})
        for name in ("direct_m", "clearance_m", "apart_m"):
            if not 0 <= getattr(self, name) <= FARTHEST:
                raise MessageError(f"{name} is {getattr(self, name)}; give metres from 0 to {FARTHEST:g}")
        if not 0 < self.seconds <= LONGEST_PLANNING:
            raise MessageError(f"seconds is {self.seconds}; give more than 0, up to {LONGEST_PLANNING:g}")


@dataclass(frozen=True)
class Plans:
    """Plans, active ones first."""

    plans: list[PlanReport]


@dataclass(frozen=True)
class GetPlans(DeskRequest[Plans]):
    """Ask for one plan, or for all active and the newest ``ended`` ones; with documents if ``documents``."""

    method = "get_plans"
    least_role = Role.VIEWER
    plan: str | None = None
    documents: bool = False
    ended: int = 10

    def __post_init__(self) -> None:
        if self.plan is not None:
            check_label("plan", self.plan)
        if not 0 <= self.ended <= LONGEST_QUEUE:
            raise MessageError(f"ended is {self.ended}; give a number from 0 to {LONGEST_QUEUE}")


@dataclass(frozen=True)
class PausePlan(DeskRequest[PlanReport]):
    """Send the plan's robots no further task; they finish their present ones (``abort`` stops them).

    Needs no revision: holding is never refused.
    """

    method = "pause_plan"
    least_role = Role.OPERATOR
    stops = True
    plan: str
    reason: str | None = None

    def __post_init__(self) -> None:
        check_label("plan", self.plan)
        check_reason(self.reason)


@dataclass(frozen=True)
class ResumePlan(DeskRequest[PlanReport]):
    """Let those of the plan's robots continue whose queues are paused; not one whose cone failed, nor a lost
    one: those need a replan."""

    method = "resume_plan"
    least_role = Role.OPERATOR
    priority = Priority.MOVE
    plan: str
    revision: int

    def __post_init__(self) -> None:
        _check_edit(self.plan, self.revision)


@dataclass(frozen=True)
class Replan(DeskRequest[PlanReport]):
    """Hold the plan's robots and plan the remaining cones without lost or offline robots.

    With ``try_again`` failed cones are tried again by some robot; else they are left out.
    """

    method = "replan"
    least_role = Role.OPERATOR
    plan: str
    revision: int
    try_again: bool = False

    def __post_init__(self) -> None:
        _check_edit(self.plan, self.revision)


@dataclass(frozen=True)
class ConfirmReplan(DeskRequest[PlanReport]):
    """Give the robots the proposed plan for the remaining cones, in one step, and let them continue.

    ``override`` states the objections and the reason to proceed, as with ``send``.
    """

    method = "confirm_replan"
    least_role = Role.OPERATOR
    priority = Priority.MOVE
    plan: str
    revision: int
    override: str | None = None

    def __post_init__(self) -> None:
        _check_edit(self.plan, self.revision)
        check_override(self.override)


@dataclass(frozen=True)
class DiscardReplan(DeskRequest[PlanReport]):
    """Give up a replan or its proposal; robots that were held for it continue as before."""

    method = "discard_replan"
    least_role = Role.OPERATOR
    priority = Priority.MOVE
    plan: str
    revision: int

    def __post_init__(self) -> None:
        _check_edit(self.plan, self.revision)


@dataclass(frozen=True)
class ClearPlan(DeskRequest[PlanReport]):
    """Stop following a plan; robots continue with their queues. Repeating it changes nothing."""

    method = "clear_plan"
    least_role = Role.OPERATOR
    plan: str

    def __post_init__(self) -> None:
        check_label("plan", self.plan)


@dataclass(frozen=True)
class PlanStopReport:
    """A stop of a plan: its robot, its task, and the outcome; ``id`` is the cone's, the store's, or at
    ``home`` the robot's. ``placement`` numbers the placed cone that is collected there."""

    task: str
    robot: str
    kind: str
    id: str
    x: float
    y: float
    state: TaskState
    reason: str | None = None
    placement: int | None = None


class PlanProblemKind(str, Enum):
    """What keeps a plan from continuing: a robot lost or offline, a cone that failed, a road that is
    closed."""

    AWAY = "away"
    FAILED = "failed"
    CLOSED = "closed"


@dataclass(frozen=True)
class PlanProblemReport:
    """A problem that keeps a plan from continuing: of robot ``robot``, or of the cone or stop ``stop``."""

    kind: PlanProblemKind
    robot: str | None = None
    stop: str | None = None
    reason: str | None = None


def check_label(name: str, text: str) -> None:
    """Refuse a text that no column can store, or that is unreadable; raises MessageError."""
    if not (0 < len(text) <= LONGEST_LABEL and text.isprintable()):
        raise MessageError(f"{name} is {text[:80]!r}; give 1 to {LONGEST_LABEL} printable characters")


def _check_edit(plan: str, revision: int) -> None:
    check_label("plan", plan)
    check_stored_number(revision=revision)


# --- Read from plain JSON values, as a gateway sent them; unknown fields of newer ones are ignored ---


def plan_report(values: dict[str, Any]) -> PlanReport:
    """Return the cone plan that a gateway sent as JSON; its documents stay plain values."""
    stops = [
        PlanStopReport(**{**known_fields(PlanStopReport, one), "state": TaskState(one["state"])})
        for one in values.get("stops", [])
    ]
    problems = [
        PlanProblemReport(**{**known_fields(PlanProblemReport, one), "kind": PlanProblemKind(one["kind"])})
        for one in values.get("problems", [])
    ]
    typed = {"state": PlanState(values["state"]), "stops": stops, "problems": problems}
    return PlanReport(**{**known_fields(PlanReport, values), **typed})

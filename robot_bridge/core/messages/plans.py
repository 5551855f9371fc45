"""Cone plans that the gateway drives: submitted, followed, paused, planned again for what is left, cleared.

A plan has a ``revision`` that changes with everything but plain progress. Who changes it says which revision
they saw; another one is refused.
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
"""cones of a plan, and cones that stand around it."""
LONGEST_PLANNING = 10.0
"""seconds."""
FARTHEST = 10_000.0
"""metres of each distance that a plan keeps."""


class PlanState(str, Enum):
    """How a plan stands.

    While it is ``replanning`` its robots are held; a ``proposed`` plan of what is left waits to be confirmed
    or discarded. The last two are ends.
    """

    DRIVEN = "driven"
    PAUSED = "paused"
    REPLANNING = "replanning"
    PROPOSED = "proposed"
    FINISHED = "finished"
    CLEARED = "cleared"


@dataclass(frozen=True)
class PlanCone:
    """What is written down of the cone ``id`` of a plan: the operator's name of it and its layout.

    ``placement`` is the number of the placed cone that is collected, with the heading ``theta`` that it was
    placed in.
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
    """A plan as it stands: ``done`` of its ``cones`` are placed or collected, ``left_out`` are given up.

    ``reason``, ``by`` and ``at`` say why, by whom and when it came into its state. ``document``, and of the
    plan of what is left ``proposal``, come when asked for; ``meetings`` counts where robots come too near to
    one another by that, ``closed`` its ways along closed roads.
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
    """Give the robots of a plan their tasks, all in one step, and let the gateway follow it from then on.

    ``plan`` is a name that the operator's side invents; given twice, done once. ``document`` is the plan as
    ``fleet-supervisor-assignment``, ``cones`` name what it places and collects. ``revisions`` are those of
    the robots' queues that the operator saw; what waits in these is replaced. What is left is planned again
    along roads (``on_roads``) for ways longer than ``direct_m``, keeping ``clearance_m`` from cones, also
    from those that ``stand``, and ``apart_m`` between robots, within ``seconds``; unasked if ``by_itself``.
    ``override`` says what speaks against it, and why it is asked for all the same, as with ``send``.
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
    """Plans, those that are driven first."""

    plans: list[PlanReport]


@dataclass(frozen=True)
class GetPlans(DeskRequest[Plans]):
    """Ask for one plan, or for all that are driven and the newest ``ended`` ones; whole if ``documents``."""

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
    """Send the plan's robots no further task; what they are doing they finish (``abort`` stops them).

    Needs no revision: to hold is never refused.
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
    """Let those of the plan's robots go on whose queues are paused; not one whose cone failed, nor a lost
    one: that takes a plan of what is left."""

    method = "resume_plan"
    least_role = Role.OPERATOR
    priority = Priority.MOVE
    plan: str
    revision: int

    def __post_init__(self) -> None:
        _check_edit(self.plan, self.revision)


@dataclass(frozen=True)
class Replan(DeskRequest[PlanReport]):
    """Hold the plan's robots and plan what is left, without those that are lost or offline.

    With ``try_again`` cones that failed are tried by somebody again; else they are left out.
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
    """Give the robots the proposed plan of what is left, in one step, and let them go on.

    ``override`` says what speaks against it, and why it is asked for all the same, as with ``send``.
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
    """Give up planning what is left, or the plan of that; robots that were held for it go on as before."""

    method = "discard_replan"
    least_role = Role.OPERATOR
    priority = Priority.MOVE
    plan: str
    revision: int

    def __post_init__(self) -> None:
        _check_edit(self.plan, self.revision)


@dataclass(frozen=True)
class ClearPlan(DeskRequest[PlanReport]):
    """Follow a plan no more; robots go on with what is in their queues. Asked again it changes nothing."""

    method = "clear_plan"
    least_role = Role.OPERATOR
    plan: str

    def __post_init__(self) -> None:
        check_label("plan", self.plan)


@dataclass(frozen=True)
class PlanStopReport:
    """A stop of a plan: who makes it as which task, and what became of that; ``id`` is the cone's, the
    store's, or at ``home`` the robot's. ``placement`` numbers the placed cone that is collected there."""

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
    """What keeps a plan from going on: a robot lost or offline, a cone that failed, a road that is closed."""

    AWAY = "away"
    FAILED = "failed"
    CLOSED = "closed"


@dataclass(frozen=True)
class PlanProblemReport:
    """What keeps a plan from going on as it is: of robot ``robot``, or of the cone or stop ``stop``."""

    kind: PlanProblemKind
    robot: str | None = None
    stop: str | None = None
    reason: str | None = None


def check_label(name: str, text: str) -> None:
    """Refuse a text that no column takes, or that nobody can read; raises MessageError."""
    if not (0 < len(text) <= LONGEST_LABEL and text.isprintable()):
        raise MessageError(f"{name} is {text[:80]!r}; give 1 to {LONGEST_LABEL} printable characters")


def _check_edit(plan: str, revision: int) -> None:
    check_label("plan", plan)
    check_stored_number(revision=revision)


# --- Read from plain JSON values, as a gateway sent them; unknown fields of newer ones are passed over ---


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

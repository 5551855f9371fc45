"""Caches of queues, cone plans, placed cones, observations, geofence and nearness, and their decoders."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

from ...robot_bridge.core.assignment.plan import ConePlan, plan_of_document
from ...robot_bridge.core.clock import Clock
from ...robot_bridge.core.errors import PlanFileError
from ...robot_bridge.core.messages.plans import PlanReport, PlanState, plan_report
from ...robot_bridge.core.messages.queues import QueueReport, queue_report
from ...robot_bridge.core.messages.records import (
    ObservationReport,
    ObservationState,
    PlacementReport,
    observation_report,
    placement_report,
)
from ...robot_bridge.core.messages.safety import FenceAlarm, Geofence, Nearness, NearnessAlarm
from ..ui.language import tr


class QueueCache:
    """The newest report of each queue, by robot."""

    def __init__(self) -> None:
        self.queues: dict[str, QueueReport] = {}

    def __iter__(self) -> Iterator[QueueReport]:
        return iter(self.queues.values())

    def __len__(self) -> int:
        return len(self.queues)

    def merge(self, reports: Mapping[str, QueueReport], *, are_all: bool = False) -> list[str]:
        """Apply reports by robot and return the robots whose queues have changed.

        With ``are_all``, queues that are not among them are forgotten.
        """
        gone = self.queues.keys() - reports.keys() if are_all else set()
        for robot in gone:
            del self.queues[robot]
        new = [robot for robot, report in reports.items() if self.queues.get(robot) != report]
        self.queues.update(reports)
        return [*gone, *new]

    def forget(self, robots: Iterable[str]) -> None:
        """Forget the queues of robots that no longer exist."""
        for robot in robots:
            self.queues.pop(robot, None)

    def get(self, robot: str) -> QueueReport | None:
        """Return a robot's queue, None if it has none."""
        return self.queues.get(robot)

    def revision(self, robot: str) -> int:
        """Return the revision that an edit of a robot's queue must name: 0 where it has none yet."""
        report = self.queues.get(robot)
        return 0 if report is None else report.revision

    def clear(self) -> None:
        """Forget everything: it belongs to another site."""
        self.queues.clear()


def queues_in(values: dict[str, Any]) -> list[QueueReport]:
    """Return the queues in an answer, or in the data of a refusal.

    :raises KeyError: for an invalid queue; ValueError and TypeError likewise.
    """
    if {"robot", "revision", "tasks", "robot_state"} <= values.keys():
        return [queue_report(values)]
    return [queue_report(queue) for queue in values.get("queues") or ()]


PLAN_ENDS = (PlanState.FINISHED, PlanState.CLEARED)
MOST_ENDED_PLANS = 10
MOST_STOPS = 20_000
"""Stops kept of one plan; a gateway drives 5000 cones in one, with stores between them."""


@dataclass(frozen=True)
class KnownPlan:
    """The last report of a cone plan.

    ``document`` is what its robots drive by, ``proposal`` is proposed for the remainder; both as they were
    at the plan's revision ``whole_at``, which is -1 before they arrived.
    """

    report: PlanReport
    document: ConePlan | None = None
    proposal: ConePlan | None = None
    whole_at: int = -1

    @property
    def plan(self) -> str:
        """The plan's name."""
        return self.report.plan

    @property
    def is_open(self) -> bool:
        """Whether the gateway drives it."""
        return self.report.state not in PLAN_ENDS

    @property
    def is_whole(self) -> bool:
        """Whether its documents belong to the last report."""
        return self.whole_at == self.report.revision


def newer_plan(known: KnownPlan | None, reported: KnownPlan) -> KnownPlan:
    """Return the plan as known after ``reported`` arrived, which may have been overtaken on its way."""
    if known is None:
        return reported
    if reported.report.revision < known.report.revision:
        return known
    return replace(known, report=reported.report) if reported.whole_at < 0 else reported


class PlanCache:
    """The newest report of each cone plan, by name; of those that ended only some."""

    def __init__(self) -> None:
        self._plans: dict[str, KnownPlan] = {}
        self.is_driving: bool | None = None
        """Whether this gateway drives cone plans, None before it has reported that."""

    def __iter__(self) -> Iterator[KnownPlan]:
        return iter(self._plans.values())

    def get(self, name: str | None) -> KnownPlan | None:
        """Return a plan, None for one that is not known."""
        return None if name is None else self._plans.get(name)

    def open(self) -> list[KnownPlan]:
        """Return the plans that the gateway drives, the newest first."""
        return sorted(
            (one for one in self if one.is_open), key=lambda one: one.report.submitted_at, reverse=True
        )

    def merge(self, reported: Mapping[str, KnownPlan], is_driving: bool | None = None) -> list[str]:
        """Apply plans by name and return those that have changed.

        With ``is_driving``, which is sent at the beginning of a link, there are no others.
        """
        gone: list[str] = []
        if is_driving is not None:
            self.is_driving = is_driving
            gone = [name for name in self._plans if name not in reported]
            for name in gone:
                del self._plans[name]
        new = []
        for name, one in reported.items():
            known = self._plans.get(name)
            if is_driving is not None and known is not None and one.whole_at < 0:
                one = replace(known, report=one.report)
            elif is_driving is None:
                one = newer_plan(known, one)
            if one != known:
                self._plans[name] = one
                new.append(name)
        ended = sorted((one for one in self if not one.is_open), key=lambda one: one.report.ended_at or 0.0)
        for one in ended[: max(0, len(ended) - MOST_ENDED_PLANS)]:
            del self._plans[one.plan]
        return [*gone, *new]

    def clear(self) -> None:
        """Forget everything: it belongs to another site."""
        self._plans.clear()
        self.is_driving = None


def plan_in(values: dict[str, Any]) -> KnownPlan:
    """Return the plan that a gateway sent as JSON.

    :raises KeyError: for an invalid plan; ValueError and TypeError likewise.
    """
    if len(values.get("stops") or ()) > MOST_STOPS:
        raise ValueError(f"plan {values['plan']!r} has more than {MOST_STOPS} stops")
    report = replace(plan_report(values), document=None, proposal=None)
    try:
        document, proposal = (
            None if values.get(name) is None else plan_of_document(values[name])
            for name in ("document", "proposal")
        )
    except PlanFileError as error:
        raise ValueError(str(error)) from error
    return KnownPlan(report, document, proposal, -1 if document is None else report.revision)


def plans_in(values: dict[str, Any]) -> list[KnownPlan]:
    """Return the plans in an answer, or in the data of a refusal; raises as :func:`plan_in`."""
    if {"plan", "revision", "state", "submitted_by"} <= values.keys():
        return [plan_in(values)]
    return [plan_in(one) for one in values.get("plans") or ()]


MOST_PLACEMENTS = 20_000
"""Cones that are kept; a gateway reports at most ``messages.records.MOST_PLACEMENTS`` at once."""


class PlacedConeCache:
    """The newest report of each placed cone, by number; if there are very many, the newest only."""

    def __init__(self) -> None:
        self._reports: dict[int, PlacementReport] = {}

    def __iter__(self) -> Iterator[PlacementReport]:
        return iter(self._reports.values())

    def __len__(self) -> int:
        return len(self._reports)

    def merge(self, reports: Mapping[int, PlacementReport]) -> list[int]:
        """Apply reports and return the numbers of the cones that have changed."""
        new = [number for number, one in reports.items() if self._reports.get(number) != one]
        self._reports.update(reports)
        for number in sorted(self._reports)[: max(0, len(self._reports) - MOST_PLACEMENTS)]:
            del self._reports[number]
        return new

    def clear(self) -> None:
        """Forget everything: it belongs to another site."""
        self._reports.clear()


def placements_in(values: dict[str, Any]) -> list[PlacementReport]:
    """Return the placed cones in an answer; raises KeyError or TypeError for an invalid one."""
    return [placement_report(placement) for placement in values.get("placements") or ()]


MOST_REVIEWED = 1000
"""Reviewed ones that are kept; those waiting for review are all kept."""


class ObservationCache:
    """The newest report of each observation, by number."""

    def __init__(self) -> None:
        self._reports: dict[int, ObservationReport] = {}

    def __iter__(self) -> Iterator[ObservationReport]:
        return iter(self._reports.values())

    def __len__(self) -> int:
        return len(self._reports)

    @property
    def pending(self) -> int:
        """The number of those waiting for review."""
        return sum(is_pending(report) for report in self._reports.values())

    def merge(self, reports: Mapping[int, ObservationReport]) -> list[int]:
        """Apply reports and return the numbers of those that have changed."""
        new = [number for number, one in reports.items() if self._reports.get(number) != one]
        self._reports.update(reports)
        if new:
            reviewed = sorted(n for n, one in self._reports.items() if not is_pending(one))
            for number in reviewed[: max(0, len(reviewed) - MOST_REVIEWED)]:
                del self._reports[number]
        return new

    def get(self, number: int) -> ObservationReport | None:
        """Return an observation, None if it is not known."""
        return self._reports.get(number)

    def ordered(self) -> list[ObservationReport]:
        """Return all, those waiting first, of these the newest first."""
        return sorted(self._reports.values(), key=lambda one: (not is_pending(one), -one.observation))

    def clear(self) -> None:
        """Forget everything: it belongs to another site."""
        self._reports.clear()


def is_pending(report: ObservationReport) -> bool:
    """Return whether an observation has not been reviewed yet."""
    return report.state is ObservationState.PENDING


def observations_in(values: dict[str, Any]) -> list[ObservationReport]:
    """Return the observations in an answer.

    :raises KeyError: for an invalid one; ValueError and TypeError likewise.
    """
    if {"observation", "op", "object", "state"} <= values.keys():
        return [observation_report(values)]
    return [observation_report(one) for one in values.get("observations") or ()]


GEOFENCE_SILENT_AFTER = 10.0
"""Seconds without a report after which nothing is known: a gateway sends one every few seconds."""
NAMED = 3


class GeofenceState:
    """Keeps the newest geofence report, for as long as it counts by ``clock``."""

    def __init__(self, clock: Clock):
        self._clock = clock
        self._report: Geofence | None = None
        self._since = clock.steady()

    def update(self, report: Geofence) -> None:
        """Apply a report of the gateway."""
        self._report, self._since = report, self._clock.steady()

    def begin_link(self) -> None:
        """Wait for the first report on a new link; that of the previous link holds until then."""
        self._since = self._clock.steady()

    def clear(self) -> None:
        """Forget everything, and wait for the first report of another gateway."""
        self._report, self._since = None, self._clock.steady()

    @property
    def is_silent(self) -> bool:
        """Whether the last report is so old that nothing is known."""
        return self._clock.steady() - self._since > GEOFENCE_SILENT_AFTER

    @property
    def alarms(self) -> list[FenceAlarm]:
        """The robots in keepouts and at obstacles now."""
        return [] if self._report is None or self.is_silent else self._report.alarms

    def why_not(self) -> str:
        """Return what is not watched and why, empty when everything is or no report was due yet."""
        if self.is_silent:
            return tr(
                "Keepouts and obstacles are not watched: the gateway tells nothing of them. It may be older "
                "than this plugin."
            )
        report = self._report
        if report is None:
            return ""
        if report.fault:
            return tr("Keepouts and obstacles are not watched: {why}.", why=report.fault.rstrip("."))
        return " ".join(text for text in (*_without(report), _unjudged(report), _more(report)) if text)


def _without(report: Geofence) -> list[str]:
    texts = []
    if not report.keepouts:
        texts.append(tr("The published site has no keepouts."))
    if not report.obstacles:
        texts.append(tr("The published site has no obstacles, so nobody is told to be at one."))
    return texts


def _unjudged(report: Geofence) -> str:
    if not report.unjudged:
        return ""
    hidden = max(len(report.unjudged) - NAMED, 0) + report.unjudged_more
    names = [*report.unjudged[:NAMED], *([tr("{more} more", more=hidden)] if hidden else [])]
    return tr(
        "Not judged by keepouts and obstacles, since it is not known where they are: {names}.",
        names=", ".join(names),
    )


def _more(report: Geofence) -> str:
    if not report.more:
        return ""
    return tr("{more} more are in keepouts or at obstacles and not listed.", more=report.more)


NEARNESS_SILENT_AFTER = 5.0
"""Seconds without a report after which nobody is near: it is sent every second while somebody is."""


class NearnessState:
    """Keeps the newest nearness report, for as long as it counts by ``clock``."""

    def __init__(self, clock: Clock):
        self._clock = clock
        self._report: Nearness | None = None
        self._since = clock.steady()

    def update(self, report: Nearness) -> None:
        """Apply a report of the gateway."""
        self._report, self._since = report, self._clock.steady()

    def clear(self) -> None:
        """Forget everything."""
        self._report = None

    @property
    def alarms(self) -> list[NearnessAlarm]:
        """Pairs of robots that are near each other now, or will be soon."""
        report = self._current()
        return [] if report is None else report.alarms

    def why_not(self) -> str:
        """Return why nothing is watched, empty when it is."""
        report = self._current()
        if report is None or not report.fault:
            return ""
        return tr("People near robots are not watched: {why}.", why=report.fault.rstrip("."))

    def _current(self) -> Nearness | None:
        return None if self._clock.steady() - self._since > NEARNESS_SILENT_AFTER else self._report

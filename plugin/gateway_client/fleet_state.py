"""FleetState: the one store of all that the gateway reports, with a signal for each topic."""

from __future__ import annotations

import threading
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any, NamedTuple, Protocol

from qgis.PyQt.QtCore import QObject, QTimer, pyqtSignal

from ...robot_bridge.core.clock import Clock
from ...robot_bridge.core.messages.administration import SiteReport, Suspensions
from ...robot_bridge.core.messages.base import DeskRequest, to_json
from ...robot_bridge.core.messages.commands import CommandReport
from ...robot_bridge.core.messages.links import Links
from ...robot_bridge.core.messages.positions import RobotReport
from ...robot_bridge.core.messages.queues import QueueReport
from ...robot_bridge.core.messages.records import ObservationReport, PlacementReport
from ...robot_bridge.core.messages.roads import Closures, Conflicts, ReplannedRobot
from ...robot_bridge.core.messages.safety import EmergencyReport, Geofence, Nearness
from ...robot_bridge.core.reconnection import FleetGateways
from ..ui.language import tr
from ..ui.scheduling import PULL_EVERY_MS
from . import report_caches
from .command_cache import CommandCache, place_of
from .connection_status import ConnectionPhase, ConnectionStatus
from .robot_states import RobotStates, RobotTable, RobotView

# --- Requests of the operator, and their results ---


class RequestGround(NamedTuple):
    """The context of places and names in a request: the frame of a site, and the gateway's database."""

    crs: str
    origin: tuple[float, float]
    rotation: float
    database: str

    @classmethod
    def of(cls, site: SiteReport, database: str) -> RequestGround:
        """Return the context for a gateway that serves ``site``; an older one names no database."""
        return cls(site.crs, tuple(site.origin), site.rotation, database)

    def is_same(self, other: RequestGround) -> bool:
        """Return whether equal numbers mean the same place, and equal names the same robots."""
        is_same_fleet = not (self.database and other.database) or self.database == other.database
        return is_same_fleet and self[:-1] == other[:-1]


@dataclass(frozen=True)
class OperatorRequest:
    """One request of the operator, made by pressing one button once.

    ``key`` stays the same however often the request must be repeated; for ``send`` it is the command's id,
    by which the gateway recognises a repetition. ``requested_at`` is on the monotonic clock. ``lasting`` is
    for requests that are valid however late they arrive, like an emergency stop. ``ground`` is the context
    known to the window at the time of the request; None for requests valid at every gateway.
    """

    key: str
    method: str
    params: dict[str, Any] = field(default_factory=dict)
    requested_at: float = 0.0
    lasting: bool = False
    ground: RequestGround | None = None

    @classmethod
    def of(
        cls, key: str, request: DeskRequest[Any], requested_at: float = 0.0, *, lasting: bool = False
    ) -> OperatorRequest:
        """Return ``request`` under ``key``."""
        return cls(key, request.method, to_json(request), requested_at, lasting)


@dataclass(frozen=True)
class RequestResult:
    """The outcome of a request: the gateway's ``result``, or ``error`` as text for the operator.

    ``outdated`` is true when it was refused because its object has changed since it was read.
    ``overridable`` is all that speaks against it where it was refused, but can be done with an override.
    ``may_be_done`` is true of a refusal where it was sent on a lost link as well: it may have been done then.
    """

    order: OperatorRequest
    result: dict[str, Any] | None = None
    error: str | None = None
    outdated: bool = False
    overridable: tuple[str, ...] = ()
    may_be_done: bool = False


# --- The store ---

MOST_COMMANDS = 1000
"""Commands that may wait for the window."""
KEYS = {"commands": "command", "queues": "robot", "placed_cones": "placement", "observations": "observation"}
"""Topics of which only the newest report of each object is kept: the field that names the object."""


@dataclass
class StateUpdate:
    """Updates that arrived since the window last collected them.

    Only the newest of each object is kept, so that a window that is busy for a while costs no memory and
    then paints the current state. ``site`` is set when a gateway reported which site it serves;
    ``greeting_of`` names its database where that was the first message on a link, empty where it does not:
    it may be another gateway than before. With ``are_all_queues`` there are no others, and with
    ``is_driving``, which is whether the gateway drives cone plans, no other plans.
    """

    link: ConnectionStatus
    site: SiteReport | None = None
    greeting_of: str | None = None
    robots: RobotTable = field(default_factory=RobotTable)
    commands: dict[str, CommandReport] = field(default_factory=dict)
    queues: dict[str, QueueReport] = field(default_factory=dict)
    are_all_queues: bool = False
    plans: dict[str, report_caches.KnownPlan] = field(default_factory=dict)
    is_driving: bool | None = None
    placed_cones: dict[int, PlacementReport] = field(default_factory=dict)
    observations: dict[int, ObservationReport] = field(default_factory=dict)
    closures: Closures | None = None
    conflicts: Conflicts | None = None
    replanned: list[ReplannedRobot] = field(default_factory=list)
    geofence: Geofence | None = None
    nearness: Nearness | None = None
    emergency: EmergencyReport | None = None
    suspensions: Suspensions | None = None
    links: Links | None = None
    gateways: FleetGateways | None = None
    answers: list[RequestResult] = field(default_factory=list)
    is_heard: bool = False
    """Whether the gateway sent any of this, unlike a report that the link is down."""

    def add(self, **reports: Any) -> None:
        """Add reports by their topics."""
        self.is_heard |= bool(reports.keys() - {"link"})
        if reports.pop("are_all_queues", False):
            self.queues.clear()
            self.are_all_queues = True
        if reports.get("is_driving") is not None:
            self.plans.clear()
        for topic, report in reports.items():
            if topic == "robots":
                self._add_robots(report)
            elif topic == "plans":
                self.plans.update(
                    {one.plan: report_caches.newer_plan(self.plans.get(one.plan), one) for one in report}
                )
            elif topic in KEYS:
                self._add_keyed(topic, report)
            elif topic == "replanned":
                self.replanned += report
            elif topic == "is_driving" and report is None:
                continue
            else:
                setattr(self, topic, report)

    def _add_robots(self, table: RobotTable) -> None:
        # Where the window keeps up there is nothing yet, and the table is merged only once, by the store.
        if self.robots.tells_nothing:
            self.robots = table
        else:
            self.robots.merge(table)

    def _add_keyed(self, topic: str, reports: Iterable[Any]) -> None:
        known = getattr(self, topic)
        for report in reports:
            key = getattr(report, KEYS[topic])
            # The one that changed last is at the end.
            known.pop(key, None)
            known[key] = report
        while topic == "commands" and len(known) > MOST_COMMANDS:
            del known[next(iter(known))]


class UpdateBuffer:
    """The update that the connection's thread fills and the window collects; thread-safe."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._update = StateUpdate(ConnectionStatus(ConnectionPhase.CLOSED))
        self._names: list[str] = []
        """The robots of the last table."""

    def add(self, **reports: Any) -> None:
        """Add reports by their topics, the fields of :class:`StateUpdate`, all at once.

        ``commands``, ``queues``, ``plans``, ``placed_cones``, ``observations``, ``replanned`` take several.
        """
        with self._lock:
            if "robots" in reports:
                self._share_names(reports["robots"])
            self._update.add(**reports)

    def _share_names(self, table: RobotTable) -> None:
        """Give ``table`` the list of names of the one before, if it has the same ones: the window compares
        such lists, and need not read the names."""
        if table.names == self._names:
            table.names = self._names
        self._names = table.names

    def add_answer(self, answer: RequestResult) -> None:
        """Add the outcome of a request; every one of them is kept."""
        with self._lock:
            self._update.answers.append(answer)

    def collect(self) -> StateUpdate:
        """Return all updates since the last call and start afresh; the link's state stays."""
        with self._lock:
            update, self._update = self._update, StateUpdate(self._update.link)
        return update


class UpdateSource(Protocol):
    """A source from which a store collects its updates: the connection's thread."""

    def collect_updates(self) -> StateUpdate:
        """Return the updates since the last call, without waiting."""


LATE_S = 0.1
"""Age in seconds from which collected updates are not applied without polling for newer ones."""
STANDSTILL_S, CATCHING_UP_S = 5.0, 1.0
"""Seconds without a collection after which clicks may be old, and seconds in which the window handles the
clicks made meanwhile."""
CONFLICTS_SILENT_AFTER = 10.0
"""Seconds without a report after which conflicts are not known any more."""


class ReportedCone(NamedTuple):
    """A cone that ``robot`` put down at x, y, metres in the site frame, ``deviation`` metres off its target.

    ``placed_at`` is seconds since 1970; ``placement`` is its number where a queue's task put it down.
    """

    x: float
    y: float
    robot: str
    label: str
    placed_at: float | None
    deviation: float | None
    placement: int | None = None


class FleetState(QObject):
    """Collects the newest reports twenty times a second; nothing in it waits for the network.

    One timer alternates between collecting, which emits the signals of the topics, and ``updated``: the
    window handles the operator's events in between.
    """

    updated = pyqtSignal()
    """Emitted every twentieth of a second: positions, ages and countdowns may have changed."""
    merged = pyqtSignal()
    """An update was applied; before ``updated``, in the same event as the topics' signals."""
    link_changed = pyqtSignal()
    site_changed = pyqtSignal()
    about_to_forget = pyqtSignal()
    """The gateway's robots have been replaced: knowledge of the former ones is about to be forgotten."""
    forgotten = pyqtSignal()
    """Knowledge of other robots has been forgotten; ``site`` is still the former one."""
    replaced = pyqtSignal(str)
    """Another site or database is served than before: the text, which must be seen by the operator."""
    robots_removed = pyqtSignal(object)
    """Robots are gone or out of view, and others have moved up into their rows: the RemovedRobots."""
    commands_changed = pyqtSignal(list)
    """The CommandReports with new information."""
    queues_changed = pyqtSignal(list)
    """The robots whose queues have changed."""
    plans_changed = pyqtSignal(list)
    """The names of the cone plans that have changed."""
    placed_cones_changed = pyqtSignal(list)
    """The numbers of the placed cones that have changed."""
    observations_changed = pyqtSignal(list)
    """The numbers of the observations that have changed."""
    closures_changed = pyqtSignal()
    conflicts_changed = pyqtSignal()
    replanned = pyqtSignal(object)
    """A robot was sent another way or stopped: the ReplannedRobot."""
    suspensions_changed = pyqtSignal()
    links_changed = pyqtSignal()
    gateways_changed = pyqtSignal(object)
    """Other addresses of the fleet were reported: the FleetGateways."""
    emergency_changed = pyqtSignal()
    """The gateway reported the state of an emergency stop."""
    answered = pyqtSignal(object)
    """The outcome of a request: the RequestResult."""

    def __init__(self, source: UpdateSource, clock: Clock, parent: QObject | None = None):
        super().__init__(parent)
        self._source = source
        self.clock = clock
        self.link = ConnectionStatus(ConnectionPhase.CLOSED)
        self.site: SiteReport | None = None
        self.robots = RobotStates()
        self.commands = CommandCache()
        self.queues = report_caches.QueueCache()
        self.plans = report_caches.PlanCache()
        self.placed_cones = report_caches.PlacedConeCache()
        self.observations = report_caches.ObservationCache()
        self.closures: tuple = ()
        self.conflicts = Conflicts(0.0)
        self.geofence = report_caches.GeofenceState(clock)
        self.nearness = report_caches.NearnessState(clock)
        self.suspensions = Suspensions()
        self.links = Links()
        self.emergency: EmergencyReport | None = None
        self.heard_at = self.clock.steady()
        """Time of the gateway's last message, by the steady clock."""
        self._conflicts_at = -CONFLICTS_SILENT_AFTER
        self._url, self._is_other_gateway = "", False
        self._database = ""
        """Identifies the gateway's database; empty where the gateway does not name it."""
        self._is_running = self._is_collected = False
        self._collected_at = self._due = clock.steady()
        self._standstill, self._caught_up_at = 0.0, self._due
        self._timer = QTimer(self)
        self._timer.setSingleShot(True)
        self._timer.timeout.connect(self._next)

    @property
    def url(self) -> str:
        """The address of the gateway that sent these reports; empty before the first."""
        return self._url

    @property
    def ground(self) -> RequestGround | None:
        """The context of the places and names that the window shows; None before a gateway reported it."""
        return None if self.site is None else RequestGround.of(self.site, self._database)

    def start(self, url: str) -> None:
        """Start collecting the reports of the gateway at ``url``.

        Reports of another one are forgotten when this one reports which site it serves.
        """
        self._is_other_gateway = self._is_other_gateway or url != self._url
        self._url = url
        if not self._is_running:
            self._collected_at = self.clock.steady()
        self._is_running = True
        self.pull()

    @property
    def standstill(self) -> float:
        """For how many seconds the window did nothing until now, or a moment ago; 0 where it was at work.

        What is clicked in a window that hangs, or on a computer that sleeps, is dealt with when that is over.
        """
        now = self.clock.steady()
        if self._is_running and now - self._collected_at > STANDSTILL_S:
            return now - self._collected_at
        return self._standstill if now < self._caught_up_at else 0.0

    def stop(self) -> None:
        """Stop collecting."""
        self._is_running = self._is_collected = False
        self._timer.stop()

    def pull(self) -> None:
        """Collect now; ``updated`` follows in an event of its own."""
        try:
            self._collect()
        finally:
            # Even if an update raises, the next one is collected.
            self._is_collected = True
            self._timer.start(0)

    def standing_cones(self) -> list[ReportedCone]:
        """Return the cones that were put down and not collected, those that queues' tasks put down first.

        A cone that a single target put down stands at that target; the gateway keeps no account of it, so it
        stands until the site changes.
        """
        standing, known = [], set()
        for cone in self.placed_cones:
            known.add(cone.command)
            if cone.collected_at is None:
                label = cone.label or cone.cone or ""
                standing.append(
                    ReportedCone(
                        cone.x, cone.y, cone.robot, label, cone.placed_at, cone.deviation, cone.placement
                    )
                )
        for report in self.commands.cones_put_down():
            place = place_of(report)
            if report.command not in known and place is not None:
                at = report.steps[-1].at if report.steps else None
                standing.append(ReportedCone(*place, report.robot, "", at, report.deviation))
        return standing

    def robot(self, name: str) -> RobotView | None:
        """Return the present view of robot ``name``, None if it is not known."""
        return self.robots.view(name, self.clock.steady())

    def report_of(self, name: str) -> RobotReport | None:
        """Return the newest report of robot ``name``, None if it is not known."""
        view = self.robot(name)
        return None if view is None else view.report

    def _next(self) -> None:
        if not self._is_collected:
            self.pull()
            return
        self._is_collected = False
        now = self.clock.steady()
        if self._is_running:
            self._due = max(now, self._due + PULL_EVERY_MS / 1000)
            self._timer.start(round((self._due - now) * 1000))
        if now - self._collected_at > LATE_S:
            # The window was blocked meanwhile: it must show the current state first.
            self._collect()
        self.updated.emit()

    def _collect(self) -> None:
        now = self.clock.steady()
        late = now - self._collected_at
        if self._is_running and late > STANDSTILL_S:
            self._standstill, self._caught_up_at = late, now + CATCHING_UP_S
        elif now - late < self._caught_up_at and late > LATE_S:
            # Applying and painting what came meanwhile took so long that older clicks may still wait.
            self._caught_up_at = now + CATCHING_UP_S
        self._collected_at = now
        self.merge(self._source.collect_updates())

    def merge(self, update: StateUpdate) -> None:
        """Apply an update, and emit the signal of each topic that has changed."""
        if update.is_heard:
            self.heard_at = self.clock.steady()
        try:
            self._merge_reports(update)
        finally:
            # Even if a report raises, the outcome of a stop or an abort is known.
            for answer in update.answers:
                self.answered.emit(answer)
            self._merge_notices(update)
            self.merged.emit()

    def _merge_reports(self, update: StateUpdate) -> None:
        self._merge_link(update.link)
        if update.site is not None:
            self.merge_site(update.site, update.greeting_of)
        self._merge_robots(update.robots)
        if changed := self.commands.merge(update.commands.values()):
            self.commands_changed.emit(changed)
        self._merge_roads(update)
        if update.geofence is not None:
            self.geofence.update(update.geofence)
        if update.nearness is not None:
            self.nearness.update(update.nearness)
        if queues := self.queues.merge(update.queues, are_all=update.are_all_queues):
            self.queues_changed.emit(queues)
        plans = self.plans.merge(update.plans, update.is_driving)
        if plans or update.is_driving is not None:
            self.plans_changed.emit(plans)
        if placed := self.placed_cones.merge(update.placed_cones):
            self.placed_cones_changed.emit(placed)
        if seen := self.observations.merge(update.observations):
            self.observations_changed.emit(seen)

    def _merge_link(self, link: ConnectionStatus) -> None:
        if link == self.link:
            return
        self.link = link
        if link.phase is ConnectionPhase.CONNECTED:
            self.geofence.begin_link()
        self.link_changed.emit()

    def _merge_robots(self, table: RobotTable) -> None:
        gone = self.robots.merge(table)
        if not len(gone.rows):
            return
        # The activity of robots out of view continues.
        self.queues.forget(gone.names)
        self.robots_removed.emit(gone)
        if gone.names:
            self.queues_changed.emit(sorted(gone.names))

    def _merge_roads(self, update: StateUpdate) -> None:
        if update.closures is not None and self.closures != tuple(update.closures.closures):
            self.closures = tuple(update.closures.closures)
            self.closures_changed.emit()
        if update.conflicts is not None:
            self._conflicts_at = self.clock.steady()
            self._set_conflicts(update.conflicts)
        elif self.clock.steady() - self._conflicts_at > CONFLICTS_SILENT_AFTER:
            # A gateway reports them every second for as long as there are any.
            self._set_conflicts(Conflicts(self.conflicts.t))
        for robot in update.replanned:
            self.replanned.emit(robot)

    def _set_conflicts(self, conflicts: Conflicts) -> None:
        same = (conflicts.conflicts, conflicts.waiting) == (self.conflicts.conflicts, self.conflicts.waiting)
        self.conflicts = conflicts
        if not same:
            self.conflicts_changed.emit()

    def _merge_notices(self, update: StateUpdate) -> None:
        if update.suspensions is not None:
            self.suspensions = update.suspensions
            self.suspensions_changed.emit()
        if update.links is not None:
            self.links = update.links
            self.links_changed.emit()
        if update.gateways is not None:
            self.gateways_changed.emit(update.gateways)
        if update.emergency is not None:
            self.emergency = update.emergency
            self.emergency_changed.emit()

    def merge_site(self, site: SiteReport, greeting_of: str | None = None) -> None:
        """Apply the site that is served; ``greeting_of`` as in :class:`StateUpdate`."""
        before, is_elsewhere = self.site, self._is_other_gateway
        is_other_database = bool(greeting_of and self._database and greeting_of != self._database)
        self._database = greeting_of or self._database
        if site == before and not is_elsewhere and not is_other_database:
            return
        is_another = is_other_database or self._is_another(site, is_greeting=greeting_of is not None)
        if before is not None and is_another:
            self.about_to_forget.emit()
        if not is_elsewhere and (text := _replacement(before, site, is_other_database)):
            self.replaced.emit(text)
        if is_another:
            self._forget()
        self.site, self._is_other_gateway = site, False
        self.robots.set_limits(site.stale_after, site.lost_after)
        self.site_changed.emit()

    def _is_another(self, site: SiteReport, *, is_greeting: bool) -> bool:
        """Return whether ``site`` has other robots than the site before.

        Two gateways may serve one site, for practice and for work, each with its own robots. A site chosen
        while the link is up is served to the same robots: commands, queues and an emergency stop continue.
        """
        was = self.site
        if was is None or self._is_other_gateway or (is_greeting and site.id != was.id):
            return True
        return (site.crs, site.origin, site.rotation) != (was.crs, was.origin, was.rotation)

    def _forget(self) -> None:
        for part in (
            self.robots, self.commands, self.queues, self.plans, self.placed_cones, self.observations,
        ):  # fmt: skip
            part.clear()
        self.emergency = None
        self.suspensions, self.links = Suspensions(), Links()
        self.suspensions_changed.emit()
        self.links_changed.emit()
        self.closures = ()
        self.closures_changed.emit()
        self._set_conflicts(Conflicts(0.0))
        self.geofence.clear()
        self.nearness.clear()
        self.forgotten.emit()


def _replacement(before: SiteReport | None, site: SiteReport, is_other_database: bool) -> str:
    """Return the message about a site that replaces another; empty for none.

    Nobody at this desk requested it, and it comes with alarms that would hide short-lived messages.
    """
    if before is not None and site.id != before.id:
        return tr(
            "Another site is served now: {site}, no longer {before}. Open its project.",
            site=site.name,
            before=before.name,
        )
    if is_other_database:
        return tr(
            "The gateway has another database than before: its robots and commands are others, "
            "and those of before are not shown any more."
        )
    return ""

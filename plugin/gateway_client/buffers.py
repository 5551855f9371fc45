"""Buffers between the window's and the connection's thread: requests out, newest updates in."""

from __future__ import annotations

import dataclasses
import threading
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import numpy.typing as npt

from ...robot_bridge.core.messages import (
    Closures,
    CommandReport,
    Conflicts,
    EmergencyReport,
    Geofence,
    Links,
    Nearness,
    ObservationReport,
    PlacementReport,
    QueueReport,
    ReplannedRobot,
    SetPath,
    SiteReport,
    Suspensions,
    closures_report,
    command_report,
    conflicts_report,
    observation_report,
    placement_report,
    queue_report,
    replanned_robot,
)
from .connection_status import ConnectionPhase, ConnectionStatus
from .robot_table import RobotTable


@dataclass(frozen=True)
class OperatorRequest:
    """One thing that the operator asked for, with one button pressed once.

    ``key`` stays the same however often the order has to be repeated; for ``send`` it is the command's id,
    which lets the gateway recognise a repetition. ``asked_at`` is on the monotonic clock. ``lasting`` is for
    what is right however late it comes, as an emergency stop is.
    """

    key: str
    method: str
    params: dict[str, Any] = field(default_factory=dict)
    asked_at: float = 0.0
    lasting: bool = False


@dataclass(frozen=True)
class RequestResult:
    """What became of an order: the gateway's ``result``, or ``error`` in words for the operator.

    ``outdated`` is true when it was refused because what it changes has changed since it was looked at.
    ``overridable`` is all that speaks against it where it was refused, and would be done with an override.
    """

    order: OperatorRequest
    result: dict[str, Any] | None = None
    error: str | None = None
    outdated: bool = False
    overridable: tuple[str, ...] = ()


class RequestOutbox:
    """Keeps orders over the loss of a link, so that each is repeated until answered and then never again.

    A robot must not drive off because of something that was asked for long ago: an order older than
    ``repeat_within`` seconds is not repeated but handed back as not known to have arrived, unless it lasts.
    """

    def __init__(self, repeat_within: float = 30.0):
        self._repeat_within = repeat_within
        self._waiting: dict[str, OperatorRequest] = {}

    def __len__(self) -> int:
        return len(self._waiting)

    def add(self, order: OperatorRequest) -> bool:
        """Keep ``order`` until it is answered; false when the same order waits already."""
        if order.key in self._waiting:
            return False
        self._waiting[order.key] = order
        return True

    def answered(self, key: str) -> OperatorRequest | None:
        """Take out the order that was answered; None when it was answered before."""
        return self._waiting.pop(key, None)

    def renew(self, now: float) -> tuple[list[OperatorRequest], list[OperatorRequest]]:
        """Return the orders to send on a new link, oldest first, and those that are too old, taken out."""
        limit = now - self._repeat_within
        too_old = [o for o in self._waiting.values() if o.asked_at < limit and not o.lasting]
        for order in too_old:
            del self._waiting[order.key]
        return list(self._waiting.values()), too_old

    def clear(self) -> list[OperatorRequest]:
        """Take out every order that still waits and return them."""
        left = list(self._waiting.values())
        self._waiting.clear()
        return left


class PathPoints(Sequence[tuple[float, float]]):
    """Points that never change, x and y in metres in the site frame; numpy takes them as an (n, 2) array."""

    __slots__ = ("_points",)

    def __init__(self, points: npt.NDArray[np.float64]) -> None:
        self._points = points

    def __len__(self) -> int:
        return len(self._points)

    def __iter__(self) -> Iterator[tuple[float, float]]:
        return map(tuple, self._points.tolist())

    def __getitem__(self, which: int | slice) -> Any:
        if isinstance(which, slice):
            return list(map(tuple, self._points[which].tolist()))
        return tuple(self._points[which].tolist())

    def __eq__(self, other: object) -> bool:
        if isinstance(other, PathPoints):
            return np.array_equal(self._points, other._points)
        return NotImplemented

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> npt.NDArray[Any]:
        return np.array(self._points, dtype=dtype)


def pack_points(points: object) -> object:
    """Return a path's points as :class:`PathPoints`; what is no list of pairs of numbers as it came."""
    if not isinstance(points, list):
        return points
    try:
        numbers = np.array(points, dtype=np.float64)
    except (TypeError, ValueError):
        return points
    if numbers.ndim != 2 or numbers.shape[1] != 2 or not np.isfinite(numbers).all():
        return points
    return PathPoints(numbers)


COMMAND_METHOD = "command"


def command_in(values: dict[str, Any]) -> CommandReport:
    """Return the command that a gateway sent as JSON.

    A path along roads has hundreds of points, which would take 90 kB.
    """
    report = command_report(values)
    if report.op != SetPath.__name__ or "points" not in report.params:
        return report
    return dataclasses.replace(
        report, params={**report.params, "points": pack_points(report.params["points"])}
    )


def commands_in(result: dict[str, Any]) -> list[CommandReport]:
    """Return the reports in an answer; oldest first, since get_commands answers with the newest first."""
    if "commands" in result:
        return [command_in(values) for values in reversed(result["commands"])]
    return [command_in(result)] if "command" in result and "op" in result else []


OBSERVATION_METHOD = "observation"


@dataclass
class ObservationUpdates:
    """The newest of each observation, by its number."""

    observations: dict[int, ObservationReport] = field(default_factory=dict)

    def add(self, reports: Iterable[ObservationReport]) -> None:
        """Take in what was told."""
        self.observations.update({report.observation: report for report in reports})


def observations_in(values: dict[str, Any]) -> list[ObservationReport]:
    """Return the observations in an answer.

    :raises KeyError: for what names itself one and is none; ValueError and TypeError likewise.
    """
    if {"observation", "op", "object", "state"} <= values.keys():
        return [observation_report(values)]
    return [observation_report(one) for one in values.get("observations") or ()]


PLACEMENT_METHOD = "placement"


@dataclass
class PlacedConeUpdates:
    """The newest of each placed cone, by its number."""

    placements: dict[int, PlacementReport] = field(default_factory=dict)

    def add(self, reports: Iterable[PlacementReport]) -> None:
        """Take in what was told."""
        self.placements.update({report.placement: report for report in reports})


def placements_in(values: dict[str, Any]) -> list[PlacementReport]:
    """Return the placed cones in an answer; raises KeyError or TypeError for what names itself one."""
    return [placement_report(placement) for placement in values.get("placements") or ()]


QUEUE_METHOD = "queue"


@dataclass
class QueueUpdates:
    """The newest of each queue by its robot; ``every`` says that there are no others."""

    queues: dict[str, QueueReport] = field(default_factory=dict)
    every: bool = False

    def add(self, report: QueueReport) -> None:
        """Take in how a robot's queue stands."""
        self.queues[report.robot] = report

    def take_all(self, reports: Iterable[QueueReport]) -> None:
        """Take in how every queue stands."""
        self.queues = {report.robot: report for report in reports}
        self.every = True


def queues_in(values: dict[str, Any]) -> list[QueueReport]:
    """Return the queues in an answer, or in what comes with a refusal.

    :raises KeyError: for what names itself a queue and is none; ValueError and TypeError likewise.
    """
    if {"robot", "revision", "tasks", "robot_state"} <= values.keys():
        return [queue_report(values)]
    return [queue_report(queue) for queue in values.get("queues") or ()]


ROAD_METHODS = ("closures", "conflicts", "replanned")


@dataclass
class RoadUpdates:
    """The newest of closed roads and of conflicts, and every robot that was sent another way or stopped."""

    closures: Closures | None = None
    conflicts: Conflicts | None = None
    replanned: list[ReplannedRobot] = field(default_factory=list)

    def add(self, method: str, params: dict[str, Any]) -> None:
        """Take in one notification; raises ValueError, KeyError or TypeError for what is none."""
        if method == "closures":
            self.closures = closures_report(params)
        elif method == "conflicts":
            self.conflicts = conflicts_report(params)
        else:
            self.replanned.append(replanned_robot(params))


# Only the newest of each thing is kept, so that a window that is busy for a while costs no memory and then
# paints what is true now, not what was.

MOST_COMMANDS = 1000


@dataclass
class StateUpdate:
    """What arrived since the last look; ``site`` is set when a gateway said which site it serves.

    ``greeting_of`` names the database of the gateway that said so on a new link, empty where it does not say:
    it may be another gateway than before. None on a link that goes on.
    """

    link: ConnectionStatus
    site: SiteReport | None = None
    greeting_of: str | None = None
    robots: RobotTable = field(default_factory=RobotTable)
    commands: dict[str, CommandReport] = field(default_factory=dict)
    answers: list[RequestResult] = field(default_factory=list)
    emergency: EmergencyReport | None = None
    suspensions: Suspensions | None = None
    links: Links | None = None
    roads: RoadUpdates = field(default_factory=RoadUpdates)
    geofence: Geofence | None = None
    nearness: Nearness | None = None
    queues: QueueUpdates = field(default_factory=QueueUpdates)
    placements: PlacedConeUpdates = field(default_factory=PlacedConeUpdates)
    observations: ObservationUpdates = field(default_factory=ObservationUpdates)


class UpdateBuffer:
    """The newest state of everything, safe to use from two threads."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._news = StateUpdate(ConnectionStatus(ConnectionPhase.CLOSED))

    def put_link(self, link: ConnectionStatus) -> None:
        """Leave how the link stands."""
        with self._lock:
            self._news.link = link

    def put_site(self, site: SiteReport, *, greeting_of: str | None = None) -> None:
        """Leave the site that the gateway serves; ``greeting_of`` its database as first word on a link."""
        with self._lock:
            self._news.site = site
            if greeting_of is not None:
                self._news.greeting_of = greeting_of

    def put_robots(self, robots: RobotTable) -> None:
        """Leave what was told of robots; it replaces what is older of the same robots."""
        with self._lock:
            if self._news.robots.tells_nothing:
                self._news.robots = robots
            else:
                self._news.robots.merge(robots)

    def put_commands(self, reports: Iterable[CommandReport]) -> None:
        """Leave reports of commands, which hold all their steps; those longest unchanged go first."""
        with self._lock:
            commands = self._news.commands
            for report in reports:
                commands.pop(report.command, None)
                commands[report.command] = report
            while len(commands) > MOST_COMMANDS:
                del commands[next(iter(commands))]

    def put_emergency(self, report: EmergencyReport) -> None:
        """Leave how an emergency stop stands."""
        with self._lock:
            self._news.emergency = report

    def put_suspensions(self, report: Suspensions) -> None:
        """Leave which robots' accounts are locked."""
        with self._lock:
            self._news.suspensions = report

    def put_links(self, report: Links) -> None:
        """Leave how links to robots of another kind are."""
        with self._lock:
            self._news.links = report

    def put_roads(self, method: str, params: dict[str, Any]) -> None:
        """Leave what was told of roads."""
        with self._lock:
            self._news.roads.add(method, params)

    def put_geofence(self, report: Geofence) -> None:
        """Leave which robots are in keepouts and at obstacles."""
        with self._lock:
            self._news.geofence = report

    def put_nearness(self, report: Nearness) -> None:
        """Leave who is near which robot."""
        with self._lock:
            self._news.nearness = report

    def put_queue(self, report: QueueReport) -> None:
        """Leave how a robot's queue stands."""
        with self._lock:
            self._news.queues.add(report)

    def put_every_queue(self, reports: Iterable[QueueReport]) -> None:
        """Leave how every queue stands: there are no others."""
        with self._lock:
            self._news.queues.take_all(reports)

    def put_placements(self, reports: Iterable[PlacementReport]) -> None:
        """Leave which cones were put down or collected."""
        with self._lock:
            self._news.placements.add(reports)

    def put_observations(self, reports: Iterable[ObservationReport]) -> None:
        """Leave what robots saw, and what became of it."""
        with self._lock:
            self._news.observations.add(reports)

    def put_answer(self, answer: RequestResult) -> None:
        """Leave what became of an order; every one of them is kept."""
        with self._lock:
            self._news.answers.append(answer)

    def collect(self) -> StateUpdate:
        """Return all that arrived since the last call and begin anew; the link's state stays."""
        with self._lock:
            news, self._news = self._news, StateUpdate(self._news.link)
        return news

"""Communication between parts: events and subscriptions, operators' sessions, request handlers."""

from __future__ import annotations

import inspect
import logging
from collections.abc import Callable, Collection, Coroutine
from dataclasses import dataclass
from typing import Any, Generic, ParamSpec, Protocol, TypeVar, overload

from ...core.logs import log_and_continue
from ...core.messages.base import DESK_REQUESTS, DeskRequest, to_json
from ...core.messages.commands import CommandReport
from ...core.messages.records import ObservationReport, PlacementReport
from ...core.messages.safety import Geofence

log = logging.getLogger(__name__)

# --- Events inside the gateway ---


@dataclass(frozen=True)
class CommandChanged:
    """A command has changed its state; the step is stored."""

    report: CommandReport

    def __str__(self) -> str:
        return f"command {self.report.command}"


@dataclass(frozen=True)
class CommandChangedElsewhere:
    """The state, changed or repeated, of a command of a robot that another gateway has."""

    report: CommandReport

    def __str__(self) -> str:
        return f"command {self.report.command} at another gateway"


@dataclass(frozen=True)
class OutboxChanged:
    """Messages to be delivered to a robot were added, or withdrawn."""

    robot: str

    def __str__(self) -> str:
        return f"the outbox of robot {self.robot!r}"


@dataclass(frozen=True)
class ObservationChanged:
    """An observation is new, or was reviewed; this is stored."""

    report: ObservationReport

    def __str__(self) -> str:
        return f"observation {self.report.observation}"


@dataclass(frozen=True)
class PlacementChanged:
    """A cone was placed or collected; this is stored."""

    report: PlacementReport

    def __str__(self) -> str:
        return f"placed cone {self.report.placement}"


@dataclass(frozen=True)
class PlanChanged:
    """A plan was submitted, or is at another revision; this is stored."""

    plan: str

    def __str__(self) -> str:
        return f"plan {self.plan}"


@dataclass(frozen=True)
class ClosuresChanged:
    """A road was closed or opened; this is stored, or may be."""

    def __str__(self) -> str:
        return "the closed roads"


@dataclass(frozen=True)
class QueueChanged:
    """A robot's queue may have something to send."""

    robot: str

    def __str__(self) -> str:
        return f"the queue of robot {self.robot!r}"


@dataclass(frozen=True)
class QueueReported:
    """The queue of a robot, which is stored, is reported to operators of this gateway."""

    robot: str

    def __str__(self) -> str:
        return f"the report of the queue of robot {self.robot!r}"


@dataclass(frozen=True)
class QueueEditedElsewhere:
    """The queue of a robot that another gateway has was edited here; this is stored."""

    robot: str

    def __str__(self) -> str:
        return f"the queue of robot {self.robot!r} at another gateway"


@dataclass(frozen=True)
class RobotReturned:
    """A robot that was lost or offline is received again, after ``away_s`` seconds of silence."""

    robot: str
    away_s: float

    def __str__(self) -> str:
        return f"the return of robot {self.robot!r}"


@dataclass(frozen=True)
class RobotClaimed:
    """A robot that another gateway has says Ready here: this gateway is about to take it over."""

    robot: str

    def __str__(self) -> str:
        return f"the claim of robot {self.robot!r}"


@dataclass(frozen=True)
class RobotsTakenUp:
    """This gateway has taken over robots from another one."""

    robots: tuple[str, ...]

    def __str__(self) -> str:
        return f"{len(self.robots)} robots that were another gateway's"


@dataclass(frozen=True)
class RobotLeft:
    """Another gateway of the fleet has taken over a robot from this one."""

    robot: str
    gateway: str

    def __str__(self) -> str:
        return f"robot {self.robot!r} that went to gateway {self.gateway!r}"


@dataclass(frozen=True)
class FenceJudged:
    """The geofence judged the robots of this gateway: ``report`` covers only those."""

    report: Geofence

    def __str__(self) -> str:
        return f"the geofence's {len(self.report.alarms) + self.report.more} alarms"


@dataclass(frozen=True)
class FenceJudgedElsewhere:
    """The geofence of another gateway judged the robots of that one."""

    gateway: str
    report: Geofence

    def __str__(self) -> str:
        return f"the alarms of gateway {self.gateway!r}'s geofence"


@dataclass(frozen=True)
class StopBegun:
    """An emergency stop is about to be sent to robots: work that takes time should wait."""

    stop: str

    def __str__(self) -> str:
        return f"the beginning of emergency stop {self.stop}"


@dataclass(frozen=True)
class GatewaysChanged:
    """The set ``gateways`` of addresses that serve the fleet has changed."""

    gateways: frozenset[str]

    def __str__(self) -> str:
        return f"the {len(self.gateways)} gateways of the fleet"


@dataclass(frozen=True)
class SiteChosen:
    """A supervisor chose the served site at this gateway; this is stored."""

    site: str

    def __str__(self) -> str:
        return f"the choice of site {self.site}"


Event = TypeVar("Event")


class EventBus:
    """Delivers each event to the subscribers of its class, at once and in the order of subscription."""

    def __init__(self) -> None:
        self._subscribers: dict[type, list[Callable[[Any], None]]] = {}

    def subscribe(self, kind: type[Event], handler: Callable[[Event], None]) -> None:
        """Call ``handler``, which must not block, with each event of ``kind`` from now on."""
        self._subscribers.setdefault(kind, []).append(handler)

    def publish(self, event: object) -> None:
        """Deliver ``event``; a subscriber that fails is logged, and the others still receive it."""
        for handler in self._subscribers.get(type(event), ()):
            with log_and_continue(log, "telling of %s", event):
                handler(event)


# --- Notifications to operators ---


class Listener(Protocol):
    """An operator's session, which receives notifications."""

    def notify(self, method: str, key: str, params: dict[str, Any]) -> None:
        """Queue a notification; of those of one method and key only the last counts. Must not block."""


class Listeners:
    """The sessions that receive notifications, such as every step of every command."""

    def __init__(self) -> None:
        self._all: set[Listener] = set()

    def __len__(self) -> int:
        return len(self._all)

    def add(self, listener: Listener) -> None:
        """Add a listener for notifications."""
        self._all.add(listener)

    def discard(self, listener: Listener) -> None:
        """Remove a listener."""
        self._all.discard(listener)

    def announce(self, method: str, key: str, params: dict[str, Any]) -> None:
        """Notify every session; if one fails, the others are still notified.

        See :meth:`Listener.notify`.
        """
        for listener in list(self._all):
            with log_and_continue(log, f"telling an operator's session of {method}"):
                listener.notify(method, key, params)


# --- Handlers: the methods of services that answer operators' requests ---

P = ParamSpec("P")
R = TypeVar("R")

_HANDLED: dict[Any, type[DeskRequest[Any]]] = {}
"""The kind of request that each function answers."""


@dataclass(frozen=True)
class Encoded(Generic[R]):
    """A result that is already JSON values, so that a large one is made once and not copied."""

    values: dict[str, Any]


class handles(Generic[R]):  # noqa: N801 - a decorator
    """Mark the method of a service that answers requests of one kind: ``@handles(PauseRobot)``.

    It is a coroutine function that takes the request and the operator's name, or only the request, or nothing
    where the request has no fields. It returns the result type that the request declares.
    """

    def __init__(self, kind: type[DeskRequest[R]]) -> None:
        self._kind = kind

    @overload
    def __call__(
        self, method: Callable[P, Coroutine[Any, Any, R]]
    ) -> Callable[P, Coroutine[Any, Any, R]]: ...
    @overload
    def __call__(
        self, method: Callable[P, Coroutine[Any, Any, Encoded[R]]]
    ) -> Callable[P, Coroutine[Any, Any, Encoded[R]]]: ...
    def __call__(self, method: Any) -> Any:
        """Register ``method`` for its kind of request, and return it unchanged."""
        _HANDLED[method] = self._kind
        return method


class Answering(Protocol):
    """Answers the requests of operators."""

    async def answer(self, request: DeskRequest[Any], operator: str) -> dict[str, Any]:
        """Return the result of a request as JSON values; raises what its handler raises."""


class RequestHandlers:
    """The handlers of ``services``: every method of theirs that is marked by :class:`handles`.

    :raises TypeError: when two of them answer the same request.
    """

    def __init__(self, *services: object) -> None:
        self._handlers: dict[type[DeskRequest[Any]], tuple[Any, int]] = {}
        for service in services:
            for function in vars(type(service)).values():
                if inspect.isfunction(function) and function in _HANDLED:
                    self._add(_HANDLED[function], function.__get__(service))

    def _add(self, kind: type[DeskRequest[Any]], handler: Any) -> None:
        if kind in self._handlers:
            raise TypeError(f"{kind.method} is answered by {self._handlers[kind][0]} and by {handler}")
        self._handlers[kind] = handler, len(inspect.signature(handler).parameters)

    def check_complete(self, except_for: Collection[type[DeskRequest[Any]]] = ()) -> None:
        """Raise TypeError naming the requests without a handler."""
        kinds = set(DESK_REQUESTS.values()) - set(except_for) - self._handlers.keys()
        if kinds:
            raise TypeError(f"nobody answers {', '.join(sorted(kind.method for kind in kinds))}")

    async def answer(self, request: DeskRequest[Any], operator: str) -> dict[str, Any]:
        """Return the result of ``request`` as JSON values; raises what its handler raises."""
        handler, arguments = self._handlers[type(request)]
        result = await handler(*(request, operator)[:arguments])
        return result.values if isinstance(result, Encoded) else to_json(result)

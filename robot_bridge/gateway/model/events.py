"""How parts reach one another: events and who has subscribed, operators' sessions, handlers of requests."""

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

# --- What happens inside the gateway ---


@dataclass(frozen=True)
class CommandChanged:
    """A command has taken a step, which is stored."""

    report: CommandReport

    def __str__(self) -> str:
        return f"command {self.report.command}"


@dataclass(frozen=True)
class CommandChangedElsewhere:
    """A command of a robot that another gateway has is, or has come, as far as this."""

    report: CommandReport

    def __str__(self) -> str:
        return f"command {self.report.command} at another gateway"


@dataclass(frozen=True)
class OutboxChanged:
    """There is something new to be delivered to a robot, or nothing of what was."""

    robot: str

    def __str__(self) -> str:
        return f"the outbox of robot {self.robot!r}"


@dataclass(frozen=True)
class ObservationChanged:
    """An observation is new, or was reviewed; that is stored."""

    report: ObservationReport

    def __str__(self) -> str:
        return f"observation {self.report.observation}"


@dataclass(frozen=True)
class PlacementChanged:
    """A cone was put down or collected; that is stored."""

    report: PlacementReport

    def __str__(self) -> str:
        return f"placed cone {self.report.placement}"


@dataclass(frozen=True)
class PlanChanged:
    """A plan was submitted, or is at another revision; that is stored."""

    plan: str

    def __str__(self) -> str:
        return f"plan {self.plan}"


@dataclass(frozen=True)
class ClosuresChanged:
    """A road was closed or opened; that is stored, or may be."""

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
    """Operators of this gateway are told of a robot's queue, which is stored."""

    robot: str

    def __str__(self) -> str:
        return f"the report of the queue of robot {self.robot!r}"


@dataclass(frozen=True)
class QueueEditedElsewhere:
    """The queue of a robot that another gateway has was edited here; that is stored."""

    robot: str

    def __str__(self) -> str:
        return f"the queue of robot {self.robot!r} at another gateway"


@dataclass(frozen=True)
class RobotReturned:
    """A robot is heard again that was lost or offline; nobody heard it for ``away_s`` seconds."""

    robot: str
    away_s: float

    def __str__(self) -> str:
        return f"the return of robot {self.robot!r}"


@dataclass(frozen=True)
class RobotClaimed:
    """A robot that another gateway has says Ready here: it is this gateway's in a moment."""

    robot: str

    def __str__(self) -> str:
        return f"the claim of robot {self.robot!r}"


@dataclass(frozen=True)
class RobotsTakenUp:
    """This gateway has robots that another one had."""

    robots: tuple[str, ...]

    def __str__(self) -> str:
        return f"{len(self.robots)} robots that were another gateway's"


@dataclass(frozen=True)
class RobotLeft:
    """Another gateway of the fleet has a robot that this one had."""

    robot: str
    gateway: str

    def __str__(self) -> str:
        return f"robot {self.robot!r} that went to gateway {self.gateway!r}"


@dataclass(frozen=True)
class FenceJudged:
    """The geofence judged the robots of this gateway: ``report`` is of those alone."""

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
    """An emergency stop goes out to robots next: whatever takes time had better wait."""

    stop: str

    def __str__(self) -> str:
        return f"the beginning of emergency stop {self.stop}"


@dataclass(frozen=True)
class GatewaysChanged:
    """The fleet is served by ``gateways``, addresses of which one is new or one is left out."""

    gateways: frozenset[str]

    def __str__(self) -> str:
        return f"the {len(self.gateways)} gateways of the fleet"


@dataclass(frozen=True)
class SiteChosen:
    """A supervisor chose at this gateway which site is served; that is stored."""

    site: str

    def __str__(self) -> str:
        return f"the choice of site {self.site}"


Event = TypeVar("Event")


class EventBus:
    """Hands each event to those who subscribed to its class, at once and in the order of subscribing."""

    def __init__(self) -> None:
        self._subscribers: dict[type, list[Callable[[Any], None]]] = {}

    def subscribe(self, kind: type[Event], handler: Callable[[Event], None]) -> None:
        """Call ``handler``, which must not block, with each event of ``kind`` from now on."""
        self._subscribers.setdefault(kind, []).append(handler)

    def publish(self, event: object) -> None:
        """Hand ``event`` on; a subscriber that fails is logged, and keeps it from no other."""
        for handler in self._subscribers.get(type(event), ()):
            with log_and_continue(log, "telling of %s", event):
                handler(event)


# --- What operators are told ---


class Listener(Protocol):
    """An operator's session, which hears what happens."""

    def notify(self, method: str, key: str, params: dict[str, Any]) -> None:
        """Take note of news; of those with the same method and key only the last counts. Must not block."""


class Listeners:
    """The sessions that hear what happens, such as every step of every command."""

    def __init__(self) -> None:
        self._all: set[Listener] = set()

    def __len__(self) -> int:
        return len(self._all)

    def add(self, listener: Listener) -> None:
        """Have ``listener`` hear from now on what happens."""
        self._all.add(listener)

    def discard(self, listener: Listener) -> None:
        """Have ``listener`` hear nothing more."""
        self._all.discard(listener)

    def announce(self, method: str, key: str, params: dict[str, Any]) -> None:
        """Notify every session of what happened; one that fails keeps no other from hearing it.

        See :meth:`Listener.notify`.
        """
        for listener in list(self._all):
            with log_and_continue(log, f"telling an operator's session of {method}"):
                listener.notify(method, key, params)


# --- Handlers: which method of a service answers which request of operators ---

P = ParamSpec("P")
R = TypeVar("R")

_HANDLED: dict[Any, type[DeskRequest[Any]]] = {}
"""The kind of request that a function answers, by the function."""


@dataclass(frozen=True)
class Encoded(Generic[R]):
    """A result that is JSON values already, as a large one is made once and not copied."""

    values: dict[str, Any]


class handles(Generic[R]):  # noqa: N801 - a decorator
    """Mark the method of a service that answers requests of one kind: ``@handles(PauseRobot)``.

    It is a coroutine function that takes the request and the operator's name, or only the request, or nothing
    where that says nothing. It returns what the request declares as its result.
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
        """Note what ``method`` answers, and return it as it is."""
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
        """Raise TypeError naming the requests that nobody answers."""
        kinds = set(DESK_REQUESTS.values()) - set(except_for) - self._handlers.keys()
        if kinds:
            raise TypeError(f"nobody answers {', '.join(sorted(kind.method for kind in kinds))}")

    async def answer(self, request: DeskRequest[Any], operator: str) -> dict[str, Any]:
        """Return the result of ``request`` as JSON values; raises what its handler raises."""
        handler, arguments = self._handlers[type(request)]
        result = await handler(*(request, operator)[:arguments])
        return result.values if isinstance(result, Encoded) else to_json(result)

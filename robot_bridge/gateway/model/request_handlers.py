"""Registry of request handlers: which method of a service answers which request of operators."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Collection, Coroutine
from dataclasses import dataclass
from typing import Any, Generic, ParamSpec, Protocol, TypeVar, overload

from ...core.messages.json_values import to_json
from ...core.messages.operator_requests import DESK_REQUESTS, DeskRequest

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

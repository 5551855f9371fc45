"""What every operator's request declares: its method, least role, priority and type of result.

A request is one class, a dataclass and :class:`DeskRequest`, with its fields and their checks in the
module of its subject. Decoder, scheduler, permission check, JSON Schemas and AsyncAPI read what it declares.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from types import GenericAlias
from typing import Any, ClassVar, Generic, TypeVar, get_args


class Role(str, Enum):
    """What an operator's account may do; each role may do what the one before it may."""

    VIEWER = "viewer"
    OPERATOR = "operator"
    SUPERVISOR = "supervisor"

    def includes(self, other: Role) -> bool:
        """Tell whether this role may do what ``other`` may."""
        order = list(Role)
        return order.index(self) >= order.index(other)


class Priority(Enum):
    """How a request is dealt with beside others of the same connection."""

    STOP = "stop"
    """at once, whatever was asked before; what waits and would move its robot is refused then."""
    MOVE = "move"
    """in turn; it sets its ``robot`` in motion, every robot where it names none."""
    MOVE_SEVERAL = "move several"
    """in turn; it sets other robots than its ``robot`` in motion, too."""
    SLOW = "slow"
    """beside the others: it changes nothing, and takes long or brings much."""
    FIFO = "fifo"
    """in turn; it sets no robot in motion."""


Result = TypeVar("Result")

DESK_REQUESTS: dict[str, type[DeskRequest[Any]]] = {}
"""Every request of operators, by its method."""


class DeskRequest(Generic[Result]):
    """A request of an operator, answered with a ``Result``; each subclass is known by being defined.

    :raises TypeError: when a class does not say its method, least role or result, or its method is taken.
    """

    method: ClassVar[str]
    least_role: ClassVar[Role]
    priority: ClassVar[Priority] = Priority.FIFO
    stops: ClassVar[bool] = False
    """Parameters that are not known are passed over: what stops or holds robots is never refused for them."""
    result: ClassVar[type]

    def __class_getitem__(cls, result: Any) -> GenericAlias:
        """Return what a subclass names as its base.

        Not of typing, which keeps what was made: after a reload of the plugin no older class may live.
        """
        return GenericAlias(cls, result)

    def __init_subclass__(cls) -> None:
        """Check what the class declares, and make it known under its method."""
        super().__init_subclass__()
        for name in ("method", "least_role"):
            if not hasattr(cls, name):
                raise TypeError(f"{cls.__name__} does not say its {name}")
        # Python keeps the base as the class names it, DeskRequest[Result]; mypy does not know that.
        (cls.result,) = get_args(cls.__orig_bases__[0])  # type: ignore[attr-defined]
        if DESK_REQUESTS.setdefault(cls.method, cls) is not cls:
            taken = DESK_REQUESTS[cls.method].__name__
            raise TypeError(f"{cls.__name__}: method {cls.method!r} is {taken}'s")


@dataclass(frozen=True)
class Done:
    """The answer to what has nothing to tell."""

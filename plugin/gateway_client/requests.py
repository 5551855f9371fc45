"""What the operator asked for and the gateway has not answered yet, and what became of it."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any


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

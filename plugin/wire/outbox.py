"""What the operator asked for and the gateway has not answered yet."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True)
class Order:
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
class Answer:
    """What became of an order: the gateway's ``result``, or ``error`` in words for the operator.

    ``outdated`` is true when it was refused because what it changes has changed since it was looked at.
    ``overridable`` is all that speaks against it where it was refused, and would be done with an override.
    """

    order: Order
    result: dict[str, Any] | None = None
    error: str | None = None
    outdated: bool = False
    overridable: tuple[str, ...] = ()


class Outbox:
    """Keeps orders over the loss of a link, so that each is repeated until answered and then never again.

    A robot must not drive off because of something that was asked for long ago: an order older than
    ``repeat_within`` seconds is not repeated but handed back as not known to have arrived, unless it lasts.
    """

    def __init__(self, repeat_within: float = 30.0):
        self._repeat_within = repeat_within
        self._waiting: dict[str, Order] = {}

    def __len__(self) -> int:
        return len(self._waiting)

    def put(self, order: Order) -> bool:
        """Keep ``order`` until it is answered; false when the same order waits already."""
        if order.key in self._waiting:
            return False
        self._waiting[order.key] = order
        return True

    def answered(self, key: str) -> Order | None:
        """Take out the order that was answered; None when it was answered before."""
        return self._waiting.pop(key, None)

    def renew(self, now: float) -> tuple[list[Order], list[Order]]:
        """Return the orders to send on a new link, oldest first, and those that are too old, taken out."""
        limit = now - self._repeat_within
        too_old = [o for o in self._waiting.values() if o.asked_at < limit and not o.lasting]
        for order in too_old:
            del self._waiting[order.key]
        return list(self._waiting.values()), too_old

    def clear(self) -> list[Order]:
        """Take out every order that still waits and return them."""
        left = list(self._waiting.values())
        self._waiting.clear()
        return left

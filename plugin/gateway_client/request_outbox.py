"""Outbox of the desk: requests that wait for their answers, over the loss of links."""

from __future__ import annotations

import json

from ...robot_bridge.core.messages import commands
from ...robot_bridge.core.messages.base import DESK_REQUESTS
from ...robot_bridge.core.messages.safety import EmergencyStop
from .fleet_state import OperatorRequest, RequestGround

REPEAT_WITHIN = 30.0
"""Seconds within which a request may be sent, or repeated, on a later link, and be begun there."""


def stops_robots(order: OperatorRequest) -> bool:
    """Return whether an order stops robots at once: it goes before all others."""
    request = DESK_REQUESTS.get(order.method)
    return request is not None and commands.stops_robots(request, order.params.get("op"))


class RequestOutbox:
    """Keeps requests over the loss of a link, so that each is repeated until answered and then never again.

    A robot must not drive off because of an old request: one older than ``repeat_within`` seconds is not
    repeated but handed back as not known to have arrived, unless it is lasting. Nor must a robot drive to
    numbers of another site's frame: a request made in another context (``ground``) is handed back as well.
    A request that a later stop makes void is never repeated, whether or not that stop was answered: it may
    have stopped nothing yet, or the gateway's refusal of the request may be lost.
    """

    def __init__(self, repeat_within: float = REPEAT_WITHIN):
        self._repeat_within = repeat_within
        self._waiting: dict[str, OperatorRequest] = {}
        self._void: set[str] = set()

    def __len__(self) -> int:
        return len(self._waiting)

    def __contains__(self, key: str) -> bool:
        return key in self._waiting

    def add(self, order: OperatorRequest) -> bool:
        """Keep ``order`` until it is answered; false when the same request waits already."""
        if order.key in self._waiting:
            return False
        if stops_robots(order):
            self.overtake(order.params.get("robot"))
        self._waiting[order.key] = order
        return True

    def overtake(self, robot: str | None) -> None:
        """Have nothing repeated that waits and would set ``robot`` in motion, or any where that is None."""
        self._void |= {key for key, one in self._waiting.items() if _is_made_void(one, robot)}

    def answered(self, key: str) -> OperatorRequest | None:
        """Remove and return the request that was answered; None when it was answered before."""
        self._void.discard(key)
        return self._waiting.pop(key, None)

    def stop_made(self, stop: str | None) -> OperatorRequest | None:
        """Remove and return the request that has made an emergency stop, if it waits for its answer."""
        made = (
            key
            for key, one in self._waiting.items()
            if one.method == EmergencyStop.method and one.params.get("command") == stop
        )
        key = next(made, None)
        return None if key is None else self.answered(key)

    def renew(self, now: float) -> tuple[list[OperatorRequest], list[OperatorRequest]]:
        """Return the requests to send on a new link, and those too old, which are removed.

        Stops come first, then the oldest.
        """
        limit = now - self._repeat_within
        too_old = [o for o in self._waiting.values() if o.requested_at < limit and not o.lasting]
        self._withdraw(too_old)
        return sorted(self._waiting.values(), key=lambda one: not stops_robots(one)), too_old

    @property
    def has_stop(self) -> bool:
        """Whether something waits that stops robots."""
        return any(map(stops_robots, self._waiting.values()))

    def withdraw_void(self) -> list[OperatorRequest]:
        """Take out the orders that a stop has made void, and return them."""
        void = [self._waiting[key] for key in self._waiting if key in self._void]
        self._withdraw(void)
        return void

    def without_ground(self, ground: RequestGround) -> list[OperatorRequest]:
        """Remove and return the requests that were made in another context than ``ground``."""
        strange = [one for one in self._waiting.values() if not _holds_on(one, ground)]
        self._withdraw(strange)
        return strange

    def _withdraw(self, orders: list[OperatorRequest]) -> None:
        for order in orders:
            self.answered(order.key)

    def largest(self) -> tuple[OperatorRequest | None, int]:
        """Remove the largest waiting request, and return it with its size in bytes; never a stop."""
        sizes = {key: len(json.dumps(one.params)) for key, one in self._waiting.items() if not one.lasting}
        if not sizes:
            return None, 0
        key = max(sizes, key=sizes.__getitem__)
        return self.answered(key), sizes[key]

    def clear(self) -> list[OperatorRequest]:
        """Remove and return all waiting requests."""
        left = list(self._waiting.values())
        self._withdraw(left)
        return left


def _holds_on(order: OperatorRequest, ground: RequestGround) -> bool:
    return order.ground is None or order.ground.is_same(ground)


def moves_robots(order: OperatorRequest) -> bool:
    """Return whether an order sets robots in motion."""
    return _is_made_void(order, None)


def _is_made_void(order: OperatorRequest, stopped: str | None) -> bool:
    """Return whether ``order`` would move a robot that a later stop of ``stopped`` stops; None is all."""
    request = DESK_REQUESTS.get(order.method)
    if request is None or stops_robots(order):
        return False
    return commands.is_overtaken(request, order.params.get("robot"), stopped)

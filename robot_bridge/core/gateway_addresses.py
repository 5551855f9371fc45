"""The gateways of a fleet as one robot, or one link, knows them: which it connects to next, and when."""

from __future__ import annotations

import random
from typing import Any

from ..core.messages.validation import usable_addresses

FIRST_WAIT, LONGEST_WAIT = 0.5, 10.0
"""seconds between two attempts to connect, at first and at most."""
SPREAD = 0.2
"""of a wait by which it is longer or shorter: robots whose gateway died do not all come in one moment."""
PING_INTERVAL, PING_TIMEOUT = 5.0, 10.0
"""seconds between two pings, and for the answer: a computer without power closes no connection."""
OPEN_TIMEOUT, OPEN_TIMEOUT_OF_SEVERAL = 10.0, 5.0
"""seconds that a gateway has to take a connection, with no other one to go to and with some."""


class GatewayAddresses:
    """The address that was ``given``, and those that gateways told; they are tried in turn.

    After a connection that was lost the same gateway is tried once more, unless it said that it ends: to
    change the gateway for each hole in a radio network would be work for all. Waits become longer with each
    round in which nobody answered.
    """

    def __init__(self, given: str) -> None:
        self._given = self._current = given
        self._ring = [given]
        self._failures = 0
        self._random = random.Random()  # nosec B311 # no secret

    @property
    def current(self) -> str:
        """The address to connect to."""
        return self._current

    @property
    def is_given(self) -> bool:
        """Whether that is the one that a person gave: what is wrong with it is theirs to put right."""
        return self._current == self._given

    @property
    def known(self) -> list[str]:
        """All addresses, in the order in which they are tried."""
        return list(self._ring)

    def options(self) -> dict[str, Any]:
        """Return what ``websockets`` is to connect with, beside credentials and sizes."""
        return {
            "open_timeout": OPEN_TIMEOUT if len(self._ring) == 1 else OPEN_TIMEOUT_OF_SEVERAL,
            "ping_interval": PING_INTERVAL,
            "ping_timeout": PING_TIMEOUT,
            "close_timeout": 1,
        }

    def learn(self, told: object) -> None:
        """Know the addresses that a gateway ``told``, its own first, in place of those told before.

        Who was given an address with TLS goes nowhere without. What is no list of addresses is passed over.
        """
        texts = [one for one in told if isinstance(one, str)] if isinstance(told, list) else []
        usable = usable_addresses([one for one in texts if self._is_as_safe(one)])
        if usable is None:
            return
        stays = [one for one in self._ring if one in usable or one in (self._given, self._current)]
        # In an order of each one's own: those of a gateway that died are spread over all others.
        new = self._random.sample(others := [one for one in usable if one not in stays], len(others))
        # The one that it is connected to, perhaps by another name, comes last.
        new.sort(key=lambda one: one == usable[0])
        self._ring = [*stays, *new]

    def answered(self) -> None:
        """Note that the gateway there listens."""
        self._failures = 0

    def next_wait(self, *, ends: bool = False) -> float:
        """Go on to the address to try next; return the seconds until then. ``ends``: the gateway says so."""
        if ends or self._failures:
            self._current = self._ring[(self._ring.index(self._current) + 1) % len(self._ring)]
        rounds = self._failures // len(self._ring)
        self._failures += 1
        wait = min(FIRST_WAIT * 2.0 ** min(rounds, 10), LONGEST_WAIT)
        return wait * self._random.uniform(1 - SPREAD, 1 + SPREAD)

    def _is_as_safe(self, address: str) -> bool:
        return address.startswith("wss:") or not self._given.startswith("wss:")

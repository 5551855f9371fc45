"""Addresses of a fleet's gateways at a robot, link or desk: the next one, reconnect back-off, token, TLS."""

from __future__ import annotations

import logging
import random
import ssl
import stat
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

from .errors import AccessError
from .messages.base import is_loopback, usable_addresses

log = logging.getLogger(__name__)

# --- Which gateway is tried next, and when: the back-off ---

SPREAD = 0.2
"""of a wait by which it is longer or shorter: those whose gateway died do not all come in one moment."""


@dataclass(frozen=True)
class FleetGateways:
    """The ``gateways`` of a fleet by their addresses, as one of them told; ``database`` tells which fleet."""

    database: str
    gateways: tuple[str, ...] = ()


@dataclass(frozen=True)
class Pace:
    """How patient who connects is, in seconds.

    A round, in which each gateway is tried, begins after ``first_wait``, twice as long after each one in
    which none answered, and ``longest_wait`` at most; within a round the next gateway is tried after
    ``between``. A gateway has ``alone`` to take a connection where there is no
    other one to go to, else ``of_several``, twice as long with each round, up to ``alone``. A computer
    without power closes no connection: it is pinged every ``ping_interval``, and has ``ping_timeout`` to
    answer. ``given_first``: whether after a connection that was lost the gateway that was given is tried
    first, and not once more the one that was lost.
    """

    first_wait: float
    between: float
    longest_wait: float
    alone: float
    of_several: float
    ping_interval: float
    ping_timeout: float
    given_first: bool = False


ROBOT_PACE = Pace(0.5, 0.1, 10.0, 10.0, 5.0, 5.0, 10.0)
"""To change the gateway for each hole in a radio network would be work for all."""
DESK_PACE = Pace(0.25, 0.1, 4.0, 5.0, 1.5, 2.0, 2.5, given_first=True)
"""An operator who wants to stop robots is at a gateway that lives within two seconds; a cable that is pulled
out shows before the operator wonders."""


class GatewayAddresses:
    """The address that was ``given``, and those that gateways told; they are tried in turn.

    Who has a token takes it nowhere that is less safe than what was given: see :meth:`learn`.
    """

    def __init__(self, given: str, pace: Pace = ROBOT_PACE, *, has_token: bool = False) -> None:
        self._given = self._current = given
        self._pace = pace
        self._has_token = has_token
        self._ring = [given]
        self._refusing: set[str] = set()
        self._failures = self._round = 0
        self._random = random.Random()  # nosec B311 # no secret

    @property
    def current(self) -> str:
        """The address to connect to."""
        return self._current

    @property
    def given(self) -> str:
        """The address that a person gave."""
        return self._given

    @property
    def is_given(self) -> bool:
        """Whether that is the one that a person gave: what is wrong with it is theirs to put right."""
        return self._current == self._given

    @property
    def known(self) -> list[str]:
        """All addresses, in the order in which they are tried."""
        return list(self._ring)

    @property
    def all_refuse(self) -> bool:
        """Whether there is no gateway left to try."""
        return self._refusing.issuperset(self._ring)

    @property
    def patience(self) -> float:
        """Seconds that the gateway there has to take a connection, and to greet."""
        pace = self._pace
        if len(self._ring) == 1:
            return pace.alone
        return min(pace.of_several * 2.0 ** min(self._round, 10), pace.alone)

    def options(self) -> dict[str, Any]:
        """Return what ``websockets`` is to connect with, beside credentials and sizes."""
        return {
            "open_timeout": self.patience,
            "ping_interval": self._pace.ping_interval,
            "ping_timeout": self._pace.ping_timeout,
            "close_timeout": 1,
        }

    def learn(self, told: object) -> None:
        """Know the addresses that a gateway ``told``, its own first, in place of those told before.

        Who was given an address with TLS goes nowhere without. A token that is for this computer alone stays
        here: nobody knows who listens on this computer's addresses. What is no list of addresses
        is passed over.
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

    def forget(self) -> None:
        """Know only the address that was given, and the one that is connected to."""
        self._ring = [one for one in self._ring if one in (self._given, self._current)]

    def answered(self) -> None:
        """Note that the gateway there listens."""
        self._failures = self._round = 0
        self._refusing.clear()

    def refused(self) -> None:
        """Note that the gateway there refuses for good: it is passed over until another has answered."""
        self._refusing.add(self._current)

    def next_wait(self, *, ends: bool = False) -> float:
        """Go on to the address to try next; return the seconds until then. ``ends``: the gateway says so."""
        lost, pace = self._current, self._pace
        if self._failures or ends or lost in self._refusing:
            self._go_on()
        is_worth_it = self._given not in self._refusing and not (ends and lost == self._given)
        if pace.given_first and not self._failures and is_worth_it:
            self._current = self._given
        self._round, tried = divmod(self._failures, len(self._ring))
        self._failures += 1
        wait = min(pace.first_wait * 2.0 ** min(self._round, 10), pace.longest_wait)
        if tried:
            wait = pace.between
        return wait * self._random.uniform(1 - SPREAD, 1 + SPREAD)

    def _go_on(self) -> None:
        at = self._ring.index(self._current)
        later = [*self._ring[at + 1 :], *self._ring[: at + 1]]
        self._current = next((one for one in later if one not in self._refusing), later[0])

    def _is_as_safe(self, address: str) -> bool:
        if self._given.startswith("wss:"):
            return address.startswith("wss:")
        return not self._has_token or is_loopback(urlsplit(address).hostname or "")


# --- What a client brings to a gateway: its token, and the authority that it trusts ---


@dataclass(frozen=True)
class ClientCredentials:
    """Files with a token and with the certificate of the site's authority (PEM); None where there is none."""

    token_file: Path | None = None
    ca: Path | None = None

    def options(self, url: str) -> dict[str, Any]:
        """Return what ``websockets`` is to connect to ``url`` with; the files are read again each time.

        :raises AccessError: when a file cannot be used, or the token would travel for everybody to read.
        """
        parts = urlsplit(url)
        options: dict[str, Any] = {}
        if parts.scheme == "wss":
            options["ssl"] = client_context(self.ca)
        if self.token_file is not None:
            if parts.scheme != "wss" and not is_loopback(parts.hostname or ""):
                raise AccessError(f"{url}: without TLS everybody on the way reads the token; use wss://")
            options["additional_headers"] = {"Authorization": f"Bearer {read_token(self.token_file)}"}
        return options


def client_context(ca: Path | None) -> ssl.SSLContext:
    """Return the context of who connects: trusts the authority in ``ca`` alone, without it the system's.

    :raises AccessError: when ``ca`` cannot be read.
    """
    try:
        context = ssl.create_default_context(cafile=ca)
    except (OSError, ssl.SSLError) as error:
        raise AccessError(
            f"CA file {ca} cannot be used: {error.strerror or error}; give the site's ca.pem"
        ) from error
    context.minimum_version = ssl.TLSVersion.TLSv1_2
    return context


def read_token(file: Path) -> str:
    """Return the token in ``file``; raises AccessError when there is none."""
    try:
        token = file.read_text(encoding="utf-8").strip()
        mode = file.stat().st_mode
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", None) or error
        raise AccessError(f"token file {file} cannot be read: {reason}") from None
    if not token.isascii() or len(token.split()) != 1:
        raise AccessError(f"token file {file} holds no token; write the one that was printed into it, alone")
    if sys.platform != "win32" and mode & (stat.S_IRGRP | stat.S_IROTH):
        log.warning("token file %s can be read by others; chmod 600 keeps it to yourself", file)
    return token

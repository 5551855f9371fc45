"""Reconnection to a fleet's gateways: addresses, back-off, token and TLS of robots, links and desks."""

from __future__ import annotations

import errno
import logging
import random
import socket
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

# --- Why there is no connection ---

_REFUSED = f"[Errno {errno.ECONNREFUSED}]"


def connection_failure(error: Exception) -> str:
    """Return why there is no connection, in the other side's own words if it gave any.

    ``error`` is what the library raised that connects. The text follows the address and a colon.
    """
    response = getattr(error, "response", None)
    if response is not None:
        text = bytes(response.body or b"").decode("utf-8", "replace").strip()
        return f"the gateway refuses (HTTP {response.status_code}): {text[:300]}"
    if isinstance(error, ConnectionRefusedError) or _REFUSED in str(error):
        # Of a host with several addresses asyncio raises each failure as text only.
        return "nothing listens there; start it, or correct the address"
    if isinstance(error, socket.gaierror):
        return "that host is not known to this network; correct the address"
    return str(error)


# --- Which gateway is tried next, and when: the back-off ---

SPREAD = 0.2
"""fraction by which a wait is randomly longer or shorter: the peers of a dead gateway do not all come at
once."""


@dataclass(frozen=True)
class FleetGateways:
    """Addresses of the ``gateways`` of a fleet, as one of them reported; ``database`` identifies the
    fleet."""

    database: str
    gateways: tuple[str, ...] = ()


@dataclass(frozen=True)
class Pace:
    """Timing of connection attempts, in seconds.

    A round, in which each gateway is tried, begins after ``first_wait``, doubled after each round without an
    answer, up to ``longest_wait``; within a round the next gateway is tried after ``between``. A gateway has
    ``alone`` to accept a connection if there is no other one, else ``of_several``, doubled with each round,
    up to ``alone``. A computer without power closes no connection: it is pinged every ``ping_interval``, and
    has ``ping_timeout`` to answer. ``given_first``: whether after a lost connection the configured gateway is
    tried first, instead of the lost one again.
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
"""Changing the gateway at each gap in radio coverage would cost everybody work."""
DESK_PACE = Pace(0.25, 0.1, 4.0, 5.0, 1.5, 2.0, 2.5, given_first=True)
"""An operator who wants to stop robots reaches a live gateway within two seconds; a pulled cable is noticed
before the operator wonders."""


class GatewayAddresses:
    """The ``given`` address, and those that gateways reported; they are tried in turn.

    A token is never sent to an address less secure than the given one: see :meth:`learn`.
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
        """The configured address."""
        return self._given

    @property
    def is_given(self) -> bool:
        """Whether the current address is the configured one: only a person can correct it."""
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
        """Seconds that the current gateway has to accept a connection, and to greet."""
        pace = self._pace
        if len(self._ring) == 1:
            return pace.alone
        return min(pace.of_several * 2.0 ** min(self._round, 10), pace.alone)

    def options(self) -> dict[str, Any]:
        """Return the connection options for ``websockets``, except credentials and sizes."""
        return {
            "open_timeout": self.patience,
            "ping_interval": self._pace.ping_interval,
            "ping_timeout": self._pace.ping_timeout,
            "close_timeout": 1,
        }

    def learn(self, addresses: object) -> None:
        """Replace the known addresses by those of a gateway's message, its own first.

        If the given address has TLS, others without it are ignored. A token for this computer alone stays
        here: it is unknown who listens on this computer's addresses. Anything but a list of addresses is
        ignored.
        """
        texts = [one for one in addresses if isinstance(one, str)] if isinstance(addresses, list) else []
        usable = usable_addresses([one for one in texts if self._is_as_safe(one)])
        if usable is None:
            return
        stays = [one for one in self._ring if one in usable or one in (self._given, self._current)]
        # Each client has an order of its own: the clients of a dead gateway spread over all others.
        new = self._random.sample(others := [one for one in usable if one not in stays], len(others))
        # The connected one, perhaps under another name, comes last.
        new.sort(key=lambda one: one == usable[0])
        self._ring = [*stays, *new]

    def forget(self) -> None:
        """Forget all addresses but the given one and the connected one."""
        self._ring = [one for one in self._ring if one in (self._given, self._current)]

    def answered(self) -> None:
        """Record that the current gateway listens."""
        self._failures = self._round = 0
        self._refusing.clear()

    def refused(self) -> None:
        """Record that the current gateway refuses for good: it is skipped until another has answered."""
        self._refusing.add(self._current)

    def next_wait(self, *, ends: bool = False) -> float:
        """Move to the next address to try; return the seconds to wait. ``ends``: the gateway announced its
        end."""
        lost, pace = self._current, self._pace
        if self._failures or ends or lost in self._refusing:
            self._advance()
        is_worth_it = self._given not in self._refusing and not (ends and lost == self._given)
        if pace.given_first and not self._failures and is_worth_it:
            self._current = self._given
        self._round, tried = divmod(self._failures, len(self._ring))
        self._failures += 1
        wait = min(pace.first_wait * 2.0 ** min(self._round, 10), pace.longest_wait)
        if tried:
            wait = pace.between
        return wait * self._random.uniform(1 - SPREAD, 1 + SPREAD)

    def _advance(self) -> None:
        at = self._ring.index(self._current)
        later = [*self._ring[at + 1 :], *self._ring[: at + 1]]
        self._current = next((one for one in later if one not in self._refusing), later[0])

    def _is_as_safe(self, address: str) -> bool:
        if self._given.startswith("wss:"):
            return address.startswith("wss:")
        return not self._has_token or is_loopback(urlsplit(address).hostname or "")


# --- Credentials of a client: its token, and the authority that it trusts ---


@dataclass(frozen=True)
class ClientCredentials:
    """Files with a token and with the certificate of the site's authority (PEM); each may be None."""

    token_file: Path | None = None
    ca: Path | None = None

    def options(self, url: str) -> dict[str, Any]:
        """Return the options for ``websockets`` to connect to ``url``; the files are read again each time.

        :raises AccessError: when a file cannot be used, or the token would travel unencrypted.
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
    """Return a client's TLS context: it trusts only the authority in ``ca``, without it the system's.

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

"""Authorisation: what roles permit; admission, limits per kind and disconnection of connections."""

from __future__ import annotations

import asyncio
import http
import logging
import time
from collections import Counter, defaultdict
from collections.abc import Iterator
from typing import Any

from websockets.frames import CloseCode
from websockets.http11 import Request, Response

from ...core.clock import SYSTEM_CLOCK, Clock
from ...core.errors import AccessError, ForbiddenError, StoreError, counted
from ...core.messages.base import DeskRequest, Role
from ...core.sites.settings_tables import LimitSettings
from ..monitoring import BackgroundTasks, until_tick
from ..storage.database import Database
from . import audit
from .accounts import AccountCache, TokenKind, new_id, token_in
from .audit import AuditJournal, SessionRow
from .client_connection import ClientConnection, Identity, RateLimit

log = logging.getLogger(__name__)


# --- Requests: what the role of an operator permits ---


def check_permission(request: DeskRequest[Any], operator: str, role: Role, override_role: Role) -> None:
    """Raise ForbiddenError for a request, or an override in it, that an operator's role does not permit.

    ``override_role`` is the least role that may override a check, by the site's settings.
    """
    if not role.includes(request.least_role):
        raise ForbiddenError(
            f"{request.method}: {operator} is {role.value}, and this takes {request.least_role.value}; "
            "ask one, or have the role changed by 'robot-bridge operators role'"
        )
    if getattr(request, "override", None) is not None and not role.includes(override_role):
        raise ForbiddenError(
            f"{request.method}: {operator} is {role.value}, and an override takes {override_role.value}; "
            "choose another place or way, or ask one (override_role in the site's settings)"
        )


# --- The present connections: counted by kind, and ended ---

SHED_LINES_PER_S, SHED_LINES = 1 / 60, 5.0
"""Log lines about connections that made room: a flood of them must not flood the log."""


class ConnectionRegistry:
    """The admitted connections, and by address those not admitted yet.

    Robots, desks and connections not yet identified as either have separate limits. Of the last, and of desks
    that have sent nothing, the oldest makes room for a new one: neither robots nor silent connections keep an
    operator out.
    """

    def __init__(self, limits: LimitSettings, journal: AuditJournal) -> None:
        self._limits = limits
        self._journal = journal
        self._inside: dict[ClientConnection, Identity] = {}
        self._counts: Counter[object] = Counter()
        self._pending: defaultdict[str, dict[ClientConnection, None]] = defaultdict(dict)
        self._shed_lines = RateLimit(SHED_LINES_PER_S, SHED_LINES)
        self._endings = BackgroundTasks()

    def __iter__(self) -> Iterator[tuple[ClientConnection, Identity]]:
        return iter(list(self._inside.items()))

    @property
    def sessions(self) -> dict[str, ClientConnection]:
        """The desks by their sessions' ids."""
        operator = TokenKind.OPERATOR
        return {i.session: connection for connection, i in self._inside.items() if i.kind is operator}

    def arrived(self, connection: ClientConnection) -> None:
        """Count a connection before its request; with one too many the oldest ends."""
        pending = self._pending[connection.address]
        pending[connection] = None
        if len(pending) <= self._limits.pending_per_address:
            return
        # A connection with a request is about to be admitted or refused.
        oldest = next((one for one in pending if one.request is None), next(iter(pending)))
        self._forget_pending(oldest)
        if self._shed_lines.consume():
            log.warning(
                "%s has more than %s that have not said what they want; the oldest are ended",
                connection.address,
                counted(self._limits.pending_per_address, "connection"),
            )
        oldest.transport.abort()

    def left(self, connection: ClientConnection) -> None:
        """Count a connection that is gone."""
        if connection.identity is None:
            self._forget_pending(connection)
        elif (identity := self._remove(connection)) is not None and identity.kind is TokenKind.OPERATOR:
            self._journal.ended(identity.session, connection.close_reason or "the connection ended")

    def crowded(self, connection: ClientConnection, identity: Identity) -> str | None:
        """Return why one more connection is refused, or None."""
        robots, limits = identity.kind is not TokenKind.OPERATOR, self._limits
        what, most = {
            TokenKind.ROBOT: ("robot", limits.robots),
            TokenKind.LINK: ("link", limits.links),
            TokenKind.OPERATOR: ("desk", limits.desks),
        }[identity.kind]
        if not self._has_room(identity.kind, most, robots):
            return f"there is room for {counted(most, what)}, and it is taken; try later."
        if not self._has_room(("from", connection.address, identity.kind), limits.per_address, robots):
            open_ones = counted(limits.per_address, what)
            return f"{connection.address} has {open_ones} open, and gets no more; close some."
        if not robots and not self._has_room(("of", identity.token), limits.desks_per_account):
            open_ones = counted(limits.desks_per_account, "desk")
            return f"{identity.name} has {open_ones} open, and gets no more; close one."
        return None

    def _has_room(self, kind: object, most: int, keeps: bool = False) -> bool:
        """Return whether there is room for one more of ``kind``; the oldest silent desk makes some."""
        if self._counts[kind] < most:
            return True
        if keeps:
            # A fleet larger than the limit reconnects in one moment: robots would end one another for ever.
            return False
        for connection, identity in self._inside.items():
            if not connection.has_sent and kind in _kinds(connection, identity):
                self.end(connection, CloseCode.TRY_AGAIN_LATER, "it said nothing, and others need its place")
                return True
        return False

    def enter(self, connection: ClientConnection, identity: Identity, largest_message: int) -> None:
        """Let a connection in."""
        self._forget_pending(connection)
        self._inside[connection] = identity
        self._counts.update(_kinds(connection, identity))
        connection.let_in(identity, largest_message)

    def end(self, connection: ClientConnection, code: int, reason: str) -> None:
        """End a connection at once, with ``code`` as its close code."""
        identity = self._remove(connection)
        if identity is None:
            return
        log.warning("%s from %s: connection ended: %s", connection.who, connection.address, reason)
        self._journal.note(
            identity.name or f"{identity.kind.value} without an account",
            "session ended",
            address=connection.address,
            subject=identity.session,
            detail=reason,
        )
        if identity.kind is TokenKind.OPERATOR:
            self._journal.ended(identity.session, reason)
        # A close frame carries at most 123 bytes of reason.
        short = reason.encode()[:120].decode(errors="ignore")
        self._endings.start(connection.expel(code, short))

    def _remove(self, connection: ClientConnection) -> Identity | None:
        identity = self._inside.pop(connection, None)
        if identity is not None:
            for kind in _kinds(connection, identity):
                self._uncount(kind)
        return identity

    def _forget_pending(self, connection: ClientConnection) -> None:
        pending = self._pending[connection.address]
        pending.pop(connection, None)
        if not pending:
            del self._pending[connection.address]

    def _uncount(self, kind: object) -> None:
        self._counts[kind] -= 1
        if self._counts[kind] <= 0:
            del self._counts[kind]


def _kinds(connection: ClientConnection, identity: Identity) -> list[object]:
    """Return all keys that a connection is counted under."""
    account: list[object] = [] if identity.token is None else [("of", identity.token)]
    return [identity.kind, ("from", connection.address, identity.kind), *account]


# --- Admission of connections, and their end ---

LOOK_INTERVAL = 0.5
"""Seconds after which a token that was revoked elsewhere is noticed."""
READ_AGAIN_AFTER = 0.1
"""Seconds between two reads of the accounts because of an unknown token."""
LOOK_UP_SHARE = 0.5
"""share of a handshake's time after which a token not confirmed by the database is answered 503: at the end
of that time the connection is cut without an answer."""
REVOKED = 4003
"""Close code of a connection whose token is no longer valid."""
ENDED = 4004
"""Close code of a session ended by a supervisor or on the command line."""
MOST_ADDRESSES = 10_000
PATHS = {TokenKind.ROBOT: "/robot", TokenKind.OPERATOR: "/desk", TokenKind.LINK: "/link"}
OWNERS = {
    TokenKind.ROBOT: "a robot's",
    TokenKind.OPERATOR: "an operator's",
    TokenKind.LINK: "a link's",
}
ANY_LINK, ANY_ROBOT = "link", ("*",)
"""Name and robots of a link without a token."""


class AuthGate:
    """Identifies a connection by its token, and ends it when the token is no longer valid.

    If no token of a kind was ever made, and ``may_be_open``, everybody is admitted: a gateway that only its
    own computer can reach needs no accounts. Operators are then supervisors.
    """

    def __init__(
        self,
        database: Database,
        limits: LimitSettings,
        *,
        may_be_open: bool,
        clock: Clock = SYSTEM_CLOCK,
    ) -> None:
        self.limits = limits
        self.journal = AuditJournal(database, clock)
        self.accounts = AccountCache(database)
        self._guests = ConnectionRegistry(limits, self.journal)
        self.gone = 0
        """Number of connections closed since the start."""
        self._database = database
        self._may_be_open = may_be_open
        self._clock = clock
        self._reading = asyncio.Lock()
        self._read_at = self._tried_at = 0.0
        self._failures: dict[str, RateLimit] = {}

    async def open(self) -> None:
        """Read the accounts, and end the sessions that an earlier gateway left open; raises StoreError."""
        await self._database.run(audit.end_all_sessions, self._clock.time())
        await self.accounts.refresh()

    def warn(self) -> None:
        """Log what is open to everybody."""
        for kind, path in PATHS.items():
            if self._is_open(kind):
                log.warning("%s is open to everybody on this computer: no %s has a token", path, kind.value)

    async def watch(self) -> None:
        """Apply changed accounts, and end connections no longer permitted, until cancelled.

        :raises StoreError: as :meth:`refresh`.
        """
        while True:
            await asyncio.sleep(until_tick(LOOK_INTERVAL))
            await self.refresh()

    async def refresh(self) -> None:
        """Apply changed accounts, and end connections no longer permitted.

        :raises StoreError: when the accounts cannot be read, the last ones stay in force; when ended sessions
            alone cannot be read, the accounts were applied.
        """
        desks = self._guests.sessions
        try:
            ended = await self.accounts.refresh_with(audit.ended_sessions, list(desks))
        except StoreError as error:
            await self._apply_accounts_alone()
            raise StoreError(f"{error}; sessions that were ended elsewhere go on until then") from error
        self._end_unpermitted()
        # A gateway that starts cannot distinguish the sessions of its own earlier run.
        left = [session for session, reason in ended.items() if reason == audit.GATEWAY_ENDED]
        if left:
            await self._database.run(audit.reopen_sessions, left)
        for session in ended.keys() - left:
            self._guests.end(desks[session], ENDED, ended[session])

    async def _apply_accounts_alone(self) -> None:
        """Apply changed accounts where ended sessions cannot be read: what is revoked must not go on."""
        try:
            await self.accounts.refresh()
        except StoreError as error:
            raise StoreError(f"{error}; accounts stay as they were last read") from error
        self._end_unpermitted()

    def _end_unpermitted(self) -> None:
        """End the connections whose tokens are no longer valid."""
        without_token = {kind: self._fault_without_token(kind) for kind in TokenKind}
        for connection, identity in self._guests:
            fault = without_token[identity.kind] if identity.token is None else self._fault(identity)
            if fault is not None:
                self._guests.end(connection, REVOKED, fault)

    async def close(self) -> None:
        """Write the waiting entries."""
        try:
            await self.journal.flush()
        except StoreError as error:
            log.error("%s; the end of the audit log is lost", error)

    # --- connections come and go ----------------------------------------------------------------------

    def arrived(self, connection: ClientConnection) -> None:
        """Count a connection before its request; it may end an older one."""
        self._guests.arrived(connection)

    def left(self, connection: ClientConnection) -> None:
        """Count a connection that is gone."""
        self.gone += 1
        self._guests.left(connection)

    def name_desk(self, connection: ClientConnection, operator: str) -> str:
        """Return the operator of a desk that claims to be ``operator``: its account, if accounts exist."""
        assert connection.identity is not None
        if connection.identity.name is not None:
            return connection.identity.name
        self.journal.renamed(connection.identity.session, operator)
        return operator

    def role(self, connection: ClientConnection) -> Role:
        """Return the present role of a desk."""
        assert connection.identity is not None
        if connection.identity.token is None:
            return Role.SUPERVISOR
        grant = self.accounts.grant(connection.identity.token)
        return (grant.role if grant is not None else None) or Role.VIEWER

    def robots_of_link(self, connection: ClientConnection) -> tuple[str, ...]:
        """Return the patterns of the robots that a link may speak for now."""
        assert connection.identity is not None
        if connection.identity.token is None:
            return ANY_ROBOT
        grant = self.accounts.grant(connection.identity.token)
        return grant.robots if grant is not None else ()

    # --- admission --------------------------------------------------------------------------------

    def refuse_page(
        self, connection: ClientConnection, request: Request, own: str | None = None
    ) -> Response | None:
        """Return the refusal of a web page's script that may not connect, None for everybody else.

        ``own`` is the origin of the gateway's own page, which may.
        """
        allowed = {*self.limits.origins, own}
        if all(origin in allowed for origin in request.headers.get_all("Origin")):
            return None
        return connection.respond(
            http.HTTPStatus.FORBIDDEN,
            "Web pages may not connect here; 'origins' in [limits] of site.toml names those that may.\n",
        )

    async def may_read(self, connection: ClientConnection, request: Request) -> Response | None:
        """Return the refusal of a client that may not read the gateway's pages, None for a viewer."""
        found = await self._identify(connection, request, TokenKind.OPERATOR)
        return found if isinstance(found, Response) else None

    async def admit(
        self,
        connection: ClientConnection,
        request: Request,
        kind: TokenKind,
        name: str | None,
        largest_message: int,
    ) -> Response | None:
        """Admit a client as a desk, or as the robot that it claims to be, or return its refusal."""
        found = await self._identify(connection, request, kind)
        if isinstance(found, Response):
            return found
        if kind is not TokenKind.OPERATOR:
            if found.name is None:
                found = Identity(kind, name, None, found.session)
            elif name not in (None, found.name):
                what = kind.value
                self._record_refusal(connection, found.name, f"{PATHS[kind]}: asked to be {what} {name}")
                text = f"This token is {what} {found.name}'s, not {name}'s; give each {what} its own.\n"
                return connection.respond(http.HTTPStatus.FORBIDDEN, text)
        if connection.is_gone:
            return _later(connection, http.HTTPStatus.SERVICE_UNAVAILABLE, "The connection has ended.", 5)
        if (text := self._guests.crowded(connection, found) or "") != "":
            return _later(connection, http.HTTPStatus.SERVICE_UNAVAILABLE, text, 5)
        self._guests.enter(connection, found, largest_message)
        self._record_login(connection, found)
        return None

    async def _identify(
        self, connection: ClientConnection, request: Request, kind: TokenKind
    ) -> Identity | Response:
        headers = request.headers
        try:
            token = token_in(headers.get_all("Authorization"), headers.get_all("Sec-WebSocket-Protocol"))
        except AccessError as error:
            return connection.respond(http.HTTPStatus.BAD_REQUEST, f"{error}\n")
        try:
            if token is not None and self.accounts.find(token) is None:
                async with asyncio.timeout(LOOK_UP_SHARE * self.limits.handshake_s):
                    await self._read_again()
        except (StoreError, TimeoutError) as error:
            reason = str(error) or f"database {self._database.where} does not answer"
            log.error("%s; a token could not be looked up", reason)
            text = "The accounts cannot be read now: the database is away. Try again."
            return _later(connection, http.HTTPStatus.SERVICE_UNAVAILABLE, text, 5)
        if self._is_open(kind):
            return Identity(kind, None, None, new_id())
        if token is None:
            return self._refuse(connection, kind, "nobody", "no token came with the request")
        grant = self.accounts.find(token)
        if grant is None:
            return self._refuse(connection, kind, "nobody", "this token is not known")
        if grant.kind is not kind:
            fault = f"this token is {OWNERS[grant.kind]}, and {PATHS[kind]} takes {OWNERS[kind]}"
            return self._refuse(connection, kind, grant.owner, fault)
        identity = Identity(kind, grant.owner, grant.token, new_id())
        if (wrong := self._fault(identity)) is not None:
            return self._refuse(connection, kind, grant.owner, wrong)
        return identity

    async def _read_again(self) -> None:
        """Read the accounts for a token that may have been made a moment ago; once for all who wait."""
        knocked = time.monotonic()
        async with self._reading:
            if self._read_at >= knocked:
                return
            await asyncio.sleep(max(0.0, self._tried_at + READ_AGAIN_AFTER - time.monotonic()))
            self._tried_at = began = time.monotonic()
            await self.accounts.refresh()
            # After a failure, waiting clients must not have their tokens treated as unknown.
            self._read_at = began

    def _fault(self, identity: Identity) -> str | None:
        if identity.token is None:
            return self._fault_without_token(identity.kind)
        grant = self.accounts.grant(identity.token)
        if grant is None or (identity.kind is TokenKind.OPERATOR and grant.role is None):
            return "this token is not known any more"
        return grant.fault(self._clock.time())

    def _fault_without_token(self, kind: TokenKind) -> str | None:
        return None if self._is_open(kind) else "accounts are in use now: connect with a token"

    def _record_login(self, connection: ClientConnection, identity: Identity) -> None:
        if identity.token is not None:
            self.journal.used(identity.token)
        if identity.kind is TokenKind.ROBOT:
            # A robot at the edge of radio coverage reconnects a thousand times a day.
            return
        if identity.kind is TokenKind.LINK:
            name = identity.name or ANY_LINK
            self.journal.note(f"link {name}", "login", address=connection.address, subject=identity.session)
            return
        role, address, session = self.role(connection).value, connection.address, identity.session
        who = identity.name or f"desk {address}"
        if identity.token is not None:
            self.journal.note(who, "login", role=role, address=address, subject=session)
        self.journal.began(SessionRow(session, who, identity.token, role, address, self._clock.time()))

    def _refuse(self, connection: ClientConnection, kind: TokenKind, who: str, fault: str) -> Response:
        # Attempts with wrong tokens must fill neither the log nor the disk.
        failures = self._failures_of(connection.address)
        if not failures.consume():
            text = "Too many refused logins came from this address."
            return _later(connection, http.HTTPStatus.TOO_MANY_REQUESTS, text, failures.wait() + 1)
        self._record_refusal(connection, who, f"{PATHS[kind]}: {fault}")
        text = f"{fault[:1].upper()}{fault[1:]}. Ask whoever runs the site for a token.\n"
        response = connection.respond(http.HTTPStatus.UNAUTHORIZED, text)
        response.headers["WWW-Authenticate"] = 'Bearer realm="fleet"'
        return response

    def _record_refusal(self, connection: ClientConnection, who: str, why: str) -> None:
        log.warning("%s from %s was not let in: %s", who, connection.address, why)
        self.journal.note(who, "login", done=False, address=connection.address, detail=why)

    def _failures_of(self, address: str) -> RateLimit:
        if len(self._failures) > MOST_ADDRESSES:
            del self._failures[next(iter(self._failures))]
        a_minute = self.limits.failed_logins_per_minute
        return self._failures.setdefault(address, RateLimit(a_minute / 60, a_minute))

    def _is_open(self, kind: TokenKind) -> bool:
        # A link speaks for robots: if those need tokens, so does it.
        kinds = (kind, TokenKind.ROBOT) if kind is TokenKind.LINK else (kind,)
        return self._may_be_open and all(self.accounts.is_open(one) for one in kinds)


def _later(connection: ClientConnection, status: http.HTTPStatus, text: str, seconds: float) -> Response:
    response = connection.respond(status, f"{text}\n")
    response.headers["Retry-After"] = str(int(seconds))
    return response

"""Who is connected now, how many there are of each sort, and how a connection is ended."""

from __future__ import annotations

import asyncio
import logging
from collections import Counter, defaultdict
from collections.abc import Iterator

from websockets.frames import CloseCode

from ..counting import counted
from ..sites.limit_settings import LimitSettings
from .buckets import Bucket
from .journal import Journal
from .tokens import TokenKind
from .visitor import Identity, Visitor

log = logging.getLogger(__name__)

SHED_LINES_PER_S, SHED_LINES = 1 / 60, 5.0
"""Lines of the log about connections that made room: their flood is not to become one of the log."""


class Guests:
    """The connections that were let in, and by address those that were not yet.

    Robots, desks and those that have not said yet which of the two they are have places of their own. Of the
    last, and of desks that have not said anything, the oldest makes room for one that comes: neither robots
    nor silent connections keep an operator out.
    """

    def __init__(self, limits: LimitSettings, journal: Journal) -> None:
        self._limits = limits
        self._journal = journal
        self._inside: dict[Visitor, Identity] = {}
        self._counts: Counter[object] = Counter()
        self._pending: defaultdict[str, dict[Visitor, None]] = defaultdict(dict)
        self._shed_lines = Bucket(SHED_LINES_PER_S, SHED_LINES)
        self._endings: set[asyncio.Task[None]] = set()

    def __iter__(self) -> Iterator[tuple[Visitor, Identity]]:
        return iter(list(self._inside.items()))

    @property
    def sessions(self) -> dict[str, Visitor]:
        """The desks by their sessions' ids."""
        return {i.session: visitor for visitor, i in self._inside.items() if i.kind is TokenKind.OPERATOR}

    def arrived(self, visitor: Visitor) -> None:
        """Count a connection that has not said yet what it wants; with one too many the oldest ends."""
        pending = self._pending[visitor.address]
        pending[visitor] = None
        if len(pending) <= self._limits.pending_per_address:
            return
        # Whoever has asked for something is about to be let in or refused.
        oldest = next((one for one in pending if one.request is None), next(iter(pending)))
        self._forget_pending(oldest)
        if self._shed_lines.take():
            log.warning(
                "%s has more than %s that have not said what they want; the oldest are ended",
                visitor.address,
                counted(self._limits.pending_per_address, "connection"),
            )
        oldest.transport.abort()

    def left(self, visitor: Visitor) -> None:
        """Count a connection that is gone."""
        if visitor.identity is None:
            self._forget_pending(visitor)
        elif (identity := self._take_out(visitor)) is not None and identity.kind is TokenKind.OPERATOR:
            self._journal.ended(identity.session, visitor.close_reason or "the connection ended")

    def crowded(self, visitor: Visitor, identity: Identity) -> str | None:
        """Return why one more connection is not taken, None when it is."""
        robots, limits = identity.kind is not TokenKind.OPERATOR, self._limits
        what, most = {
            TokenKind.ROBOT: ("robot", limits.robots),
            TokenKind.LINK: ("link", limits.links),
            TokenKind.OPERATOR: ("desk", limits.desks),
        }[identity.kind]
        if not self._has_room(identity.kind, most, robots):
            return f"there is room for {counted(most, what)}, and it is taken; try later."
        if not self._has_room(("from", visitor.address, identity.kind), limits.per_address, robots):
            open_ones = counted(limits.per_address, what)
            return f"{visitor.address} has {open_ones} open, and gets no more; close some."
        if not robots and not self._has_room(("of", identity.token), limits.desks_per_account):
            open_ones = counted(limits.desks_per_account, "desk")
            return f"{identity.name} has {open_ones} open, and gets no more; close one."
        return None

    def _has_room(self, kind: object, most: int, keeps: bool = False) -> bool:
        """Tell whether there is room for one more of ``kind``; the oldest silent desk makes some."""
        if self._counts[kind] < most:
            return True
        if keeps:
            # A fleet larger than the limit comes back in one moment: robots would end one another for ever.
            return False
        for visitor, identity in self._inside.items():
            if not visitor.has_spoken and kind in _kinds(visitor, identity):
                self.end(visitor, CloseCode.TRY_AGAIN_LATER, "it said nothing, and others need its place")
                return True
        return False

    def enter(self, visitor: Visitor, identity: Identity, largest_message: int) -> None:
        """Let a connection in."""
        self._forget_pending(visitor)
        self._inside[visitor] = identity
        self._counts.update(_kinds(visitor, identity))
        visitor.let_in(identity, largest_message)

    def end(self, visitor: Visitor, code: int, reason: str) -> None:
        """End a connection at once, with ``code`` as its close code."""
        identity = self._take_out(visitor)
        if identity is None:
            return
        log.warning("%s from %s: connection ended: %s", visitor.who, visitor.address, reason)
        self._journal.note(
            identity.name or f"{identity.kind.value} without an account",
            "session ended",
            address=visitor.address,
            subject=identity.session,
            detail=reason,
        )
        if identity.kind is TokenKind.OPERATOR:
            self._journal.ended(identity.session, reason)
        # A close frame carries at most 123 bytes of reason.
        short = reason.encode()[:120].decode(errors="ignore")
        task = asyncio.get_running_loop().create_task(visitor.expel(code, short))
        self._endings.add(task)
        task.add_done_callback(self._endings.discard)

    def _take_out(self, visitor: Visitor) -> Identity | None:
        identity = self._inside.pop(visitor, None)
        if identity is not None:
            for kind in _kinds(visitor, identity):
                self._uncount(kind)
        return identity

    def _forget_pending(self, visitor: Visitor) -> None:
        pending = self._pending[visitor.address]
        pending.pop(visitor, None)
        if not pending:
            del self._pending[visitor.address]

    def _uncount(self, kind: object) -> None:
        self._counts[kind] -= 1
        if self._counts[kind] <= 0:
            del self._counts[kind]


def _kinds(visitor: Visitor, identity: Identity) -> list[object]:
    """Return everything that a connection is counted under."""
    account: list[object] = [] if identity.token is None else [("of", identity.token)]
    return [identity.kind, ("from", visitor.address, identity.kind), *account]

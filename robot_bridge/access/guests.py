"""Who is connected now, how many there are of each sort, and how a connection is ended."""

from __future__ import annotations

import asyncio
import logging
from collections import Counter
from collections.abc import Iterator

from ..counting import counted
from ..sites.limit_settings import LimitSettings
from .journal import Journal
from .tokens import TokenKind
from .visitor import Identity, Visitor

log = logging.getLogger(__name__)


class Guests:
    """The connections that were let in, and by address those that were not yet."""

    def __init__(self, limits: LimitSettings, journal: Journal) -> None:
        self._limits = limits
        self._journal = journal
        self._inside: dict[Visitor, Identity] = {}
        self._counts: Counter[object] = Counter()
        self._endings: set[asyncio.Task[None]] = set()

    def __iter__(self) -> Iterator[tuple[Visitor, Identity]]:
        return iter(list(self._inside.items()))

    @property
    def sessions(self) -> dict[str, Visitor]:
        """The desks by their sessions' ids."""
        return {i.session: visitor for visitor, i in self._inside.items() if i.kind is TokenKind.OPERATOR}

    def arrived(self, visitor: Visitor) -> bool:
        """Count a connection that has not said yet what it wants; false when it is one too many."""
        self._counts["pending", visitor.address] += 1
        return self._counts["pending", visitor.address] <= self._limits.pending_per_address

    def left(self, visitor: Visitor) -> None:
        """Count a connection that is gone."""
        if visitor.identity is None:
            self._uncount(("pending", visitor.address))
        elif (identity := self._take_out(visitor)) is not None and identity.kind is TokenKind.OPERATOR:
            self._journal.ended(identity.session, visitor.close_reason or "the connection ended")

    def crowded(self, visitor: Visitor, identity: Identity) -> str | None:
        """Return why one more connection is not taken, None when it is."""
        robots, limits = identity.kind is TokenKind.ROBOT, self._limits
        most = limits.robots if robots else limits.desks
        if self._counts[identity.kind] >= most:
            room = counted(most, "robot" if robots else "desk")
            return f"there is room for {room}, and it is taken; try later."
        if self._counts["from", visitor.address] >= limits.per_address:
            open_ones = counted(limits.per_address, "connection")
            return f"{visitor.address} has {open_ones} open, and gets no more; close some."
        if not robots and self._counts["of", identity.token] >= limits.desks_per_account > 0:
            open_ones = counted(limits.desks_per_account, "desk")
            return f"{identity.name} has {open_ones} open, and gets no more; close one."
        return None

    def enter(self, visitor: Visitor, identity: Identity, largest_message: int) -> None:
        """Let a connection in."""
        self._uncount(("pending", visitor.address))
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

    def _uncount(self, kind: object) -> None:
        self._counts[kind] -= 1
        if self._counts[kind] <= 0:
            del self._counts[kind]


def _kinds(visitor: Visitor, identity: Identity) -> list[object]:
    """Return everything that a connection is counted under."""
    account: list[object] = [] if identity.token is None else [("of", identity.token)]
    return [identity.kind, ("from", visitor.address), *account]

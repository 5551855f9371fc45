"""One robot of a link, as the link's side knows it; no I/O."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Iterator
from dataclasses import dataclass, field

from ...messages import Ability, OpAck, Ready, Request, SendGPS, SendPos, Stopped

NEW_ENOUGH = 2.0
"""seconds: an older position is not told when the gateway is back."""
FIRST_WAIT, LONGEST_WAIT = 1.0, 30.0
"""seconds after which a robot that was refused says Ready once more."""


@dataclass
class Kept:
    """What a robot said, kept until the gateway has acknowledged it; ``call`` is its id while it is asked."""

    request: Request
    answer: asyncio.Future[OpAck]
    call: int | None = None


@dataclass
class LinkedRobot:
    """``can`` is what its Ready declares. A position is ``fresh`` until it is on its way to the gateway."""

    name: str
    can: tuple[Ability, ...]
    path_cones: bool = False
    admitted: bool = False
    position: SendPos | SendGPS | None = None
    position_at: float = 0.0
    fresh: bool = False
    is_alive: bool = False
    kept: list[Kept] = field(default_factory=list)
    wait: float = FIRST_WAIT

    @property
    def is_only_seen(self) -> bool:
        """Whether it takes no commands, and so nothing to stop."""
        return not self.can

    def ready(self, magic: int) -> Ready:
        """Return what it says first."""
        return Ready(magic, path_cones=self.path_cones or None, abilities=list(self.can))

    def change(self, can: tuple[Ability, ...], path_cones: bool) -> bool:
        """Take what it can do now; tell whether that is something else than before."""
        before = self.can, self.path_cones
        self.can, self.path_cones = can, path_cones
        return before != (can, path_cones)

    def place(self, position: SendPos | SendGPS) -> None:
        """Take its newest position in place of the last."""
        self.position, self.position_at, self.fresh = position, time.monotonic(), True

    def admit(self) -> None:
        """Note that the gateway has let it in: where it was a moment ago is told again."""
        self.admitted, self.wait = True, FIRST_WAIT
        self.fresh = self.position is not None and time.monotonic() - self.position_at < NEW_ENOUGH

    def lose(self) -> None:
        """Note that the gateway does not listen to it any more."""
        self.admitted = self.fresh = self.is_alive = False
        for kept in self.kept:
            kept.call = None

    def next_wait(self) -> float:
        """Return the seconds until it says Ready once more."""
        wait, self.wait = self.wait, min(self.wait * 2, LONGEST_WAIT)
        return wait

    def keep(self, kept: Kept) -> None:
        """Keep what it says; a Stopped takes the place of one that was not told yet."""
        if isinstance(kept.request, Stopped):
            for older in [k for k in self.kept if isinstance(k.request, Stopped) and k.call is None]:
                self.kept.remove(older)
                older.answer.cancel()
        self.kept.append(kept)

    def untold(self) -> Iterator[Kept]:
        """Yield what was not asked yet on this connection."""
        return (kept for kept in list(self.kept) if kept.call is None)

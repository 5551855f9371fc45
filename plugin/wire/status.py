"""How the link to the gateway stands."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from .role_words import role_in_words


class Phase(str, Enum):
    """The stages of the link."""

    CLOSED = "closed"
    CONNECTING = "connecting"
    CONNECTED = "connected"
    RETRYING = "retrying"
    FAILED = "failed"


@dataclass(frozen=True)
class LinkStatus:
    """The link's stage, why it is not connected, and when the next attempt is due (monotonic clock).

    While connected, ``operator`` and ``role`` are who the desk is to the gateway; a role that is changed
    meanwhile is not told. ``wants_token`` is true when it takes another token or CA file to connect.
    """

    phase: Phase
    reason: str = ""
    next_try: float | None = None
    wants_token: bool = False
    operator: str = ""
    role: str = ""

    @property
    def who(self) -> str:
        """Who the desk is to the gateway, as people read it: ``Ada, supervisor``."""
        return ", ".join(filter(None, (self.operator, role_in_words(self.role))))

    def wait(self, now: float) -> float:
        """Return the seconds until the next attempt, 0 when it is due."""
        return max(0.0, self.next_try - now) if self.next_try is not None else 0.0

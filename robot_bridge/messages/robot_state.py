"""How far the knowledge of a robot can be trusted."""

from __future__ import annotations

from enum import Enum


class RobotState(str, Enum):
    """How far the knowledge of a robot can be trusted (see :mod:`.liveness`)."""

    FRESH = "fresh"
    STALE = "stale"
    LOST = "lost"
    OFFLINE = "offline"

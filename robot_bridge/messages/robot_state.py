"""How far the knowledge of a robot can be trusted."""

from __future__ import annotations

from enum import Enum
from typing import Literal

PathDeclaration = Literal["asks", "cones", "asks and cones"]
"""What a robot declared in Ready: ``asks_path``, ``path_cones``, or both."""


Ability = Literal["targets", "paths", "start", "cones", "map", "images"]
"""What a robot can do: drive to targets, along paths, start elsewhere, place cones, use maps, send images."""


class RobotState(str, Enum):
    """How far the knowledge of a robot can be trusted (see :mod:`.liveness`)."""

    FRESH = "fresh"
    STALE = "stale"
    LOST = "lost"
    OFFLINE = "offline"

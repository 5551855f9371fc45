"""What the gateway tells of roads without being asked, and how it is kept until the window looks."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from ...robot_bridge.messages import (
    Closures,
    Conflicts,
    ReplannedRobot,
    closures_report,
    conflicts_report,
    replanned_robot,
)

METHODS = ("closures", "conflicts", "replanned")


@dataclass
class RoadNews:
    """The newest of closed roads and of conflicts, and every robot that was sent another way or stopped."""

    closures: Closures | None = None
    conflicts: Conflicts | None = None
    replanned: list[ReplannedRobot] = field(default_factory=list)

    def take(self, method: str, params: dict[str, Any]) -> None:
        """Take in one notification; raises ValueError, KeyError or TypeError for what is none."""
        if method == "closures":
            self.closures = closures_report(params)
        elif method == "conflicts":
            self.conflicts = conflicts_report(params)
        else:
            self.replanned.append(replanned_robot(params))

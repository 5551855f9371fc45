"""Every layout by its name."""

from __future__ import annotations

from .circles import ConstantRadius, SkidPad
from .corridor import Corridor
from .lane_changes import DoubleLaneChange, ObstacleAvoidance
from .layout import Layout
from .straights import Acceleration, BrakingLane, Slalom

LAYOUTS: dict[str, type[Layout]] = {
    kind.NAME: kind
    for kind in (
        Slalom,
        DoubleLaneChange,
        ObstacleAvoidance,
        ConstantRadius,
        SkidPad,
        Acceleration,
        BrakingLane,
        Corridor,
    )
}

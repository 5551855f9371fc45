"""What a check of a robot map says: where something is wrong, how badly, and what to do."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import Any

from numpy.typing import NDArray


class Severity(str, Enum):
    """``ERROR``: a robot is misled. ``WARNING``: probably not meant. ``INFO``: worth knowing."""

    ERROR = "error"
    WARNING = "warning"
    INFO = "info"


class Kind(str, Enum):
    """What is wrong; the value is what users read and filter by."""

    ORIENTATION = "orientation"
    GAP = "gap"
    SLIVER = "sliver"
    DUPLICATE = "duplicate"
    OVERLAP = "overlap"
    SHARED_WALL = "shared wall"
    POCKET = "pocket"
    HEIGHT = "height"
    OUTSIDE = "outside"
    ID = "id"


@dataclass(frozen=True)
class Limits:
    """What the checks take for meant; metres and m²."""

    gap: float = 0.10
    """A line that ends at most so far from another obstacle was meant to reach it."""
    sliver: float = 0.05
    """A ring narrower than this, on average, is no obstacle but the remains of one."""
    robot_width: float = 0.60
    """A robot passes where this much is free."""
    pocket: float = 1.0
    """The smallest unreachable free area worth a finding."""


@dataclass(frozen=True, eq=False)
class Finding:
    """One thing that is odd. ``obstacle`` is the id of the one to change, None where none can be named."""

    kind: Kind
    severity: Severity
    obstacle: int | None
    text: str
    segments: NDArray[Any]
    """(m, 2, 2) float64, the lines that show the place, metres in the site frame; m is at least 1."""

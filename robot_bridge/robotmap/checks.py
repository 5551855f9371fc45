"""Checks of a robot map; numpy only, so that they run wherever a map can be read."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from .checks_chains import broken_chains, near_misses
from .checks_finding import Finding, Kind, Limits, Severity
from .checks_pairs import meeting_obstacles
from .checks_plain import outside_border, repeated_ids, without_length, wrong_heights
from .checks_pockets import unreachable_pockets
from .checks_rings import wrong_rings
from .checks_stairs import turned_risers
from .checks_table import SegmentTable
from .model import RobotMap

__all__ = ["CHECKS", "Check", "Finding", "Kind", "Limits", "SegmentTable", "Severity", "check_map"]

Check = Callable[[SegmentTable, Limits], Iterable[Finding]]

CHECKS: tuple[Check, ...] = (
    repeated_ids,
    outside_border,
    without_length,
    wrong_heights,
    turned_risers,
    broken_chains,
    near_misses,
    wrong_rings,
    meeting_obstacles,
    unreachable_pockets,
)
"""Every check, the quick ones first; each looks at the whole map and is independent of the others."""


def check_map(robot_map: RobotMap, limits: Limits | None = None) -> list[Finding]:
    """Return what is odd in ``robot_map``, in the order of :data:`CHECKS`; nothing is changed or raised."""
    table = SegmentTable.of(robot_map)
    return [finding for check in CHECKS for finding in check(table, limits or Limits())]

"""Checks that look at one obstacle or one segment at a time: ids, border, heights, lengths."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..counting import counted
from .checks_finding import Finding, Kind, Limits, Severity
from .checks_table import SAME_PLACE, SegmentTable, mark, place
from .model import ShapeType


def repeated_ids(table: SegmentTable, limits: Limits) -> Iterator[Finding]:
    """Yield a finding for each id that several obstacles have."""
    rows = defaultdict(list)
    for row, obstacle in enumerate(table.obstacles):
        rows[obstacle.id].append(row)
    for id, bearers in rows.items():
        if len(bearers) > 1:
            yield Finding(
                Kind.ID,
                Severity.ERROR,
                id,
                f"{len(bearers)} obstacles have the id {id}: number them anew, a robot keeps one of them",
                _of_all(table, bearers),
            )


def outside_border(table: SegmentTable, limits: Limits) -> Iterator[Finding]:
    """Yield a finding for each obstacle that leaves the border of the map."""
    border = table.robot_map.border
    low = np.array([border.x_min, border.y_min]) - SAME_PLACE
    high = np.array([border.x_max, border.y_max]) + SAME_PLACE
    within = (table.a >= low) & (table.a <= high) & (table.b >= low) & (table.b <= high)
    inside: NDArray[Any] = np.all(within, axis=1)
    for row, segments in _by_obstacle(table, ~inside):
        yield Finding(
            Kind.OUTSIDE,
            Severity.ERROR,
            table.obstacles[row].id,
            f"{counted(len(segments), 'segment')} outside the border of the map: clip the map to its border "
            "or widen it",
            table.lines(segments),
        )


def without_length(table: SegmentTable, limits: Limits) -> Iterator[Finding]:
    """Yield a finding for each obstacle with segments whose two ends are one point."""
    for row, segments in _by_obstacle(table, table.lengths < SAME_PLACE):
        first = table.a[segments[0]]
        yield Finding(
            Kind.SLIVER,
            Severity.WARNING,
            table.obstacles[row].id,
            f"{counted(len(segments), 'segment')} without length, the first at {place(first)}: leave it out",
            mark(first),
        )


def wrong_heights(table: SegmentTable, limits: Limits) -> Iterator[Finding]:
    """Yield a finding for each obstacle with a height that its shape cannot have.

    Ramps have height 0 and so has the last riser of stairs (paper 1, section II); nothing else has.
    """
    kind = table.shape_type[table.row]
    last = np.zeros(len(kind), dtype=bool)
    last[table.offsets[1:][np.diff(table.offsets) > 0] - 1] = True
    level = (kind == ShapeType.RAMP) | ((kind == ShapeType.STAIRS) & last)
    for row, segments in _by_obstacle(table, ~level & (table.height <= 0)):
        yield _height(
            table,
            row,
            segments,
            "a height of 0 or less: a robot may take it for floor; give its height in metres",
        )
    for row, segments in _by_obstacle(table, level & (table.height != 0)):
        ramp = table.shape_type[row] == ShapeType.RAMP
        rule = "a ramp has height 0" if ramp else "the last riser of stairs has height 0"
        yield _height(table, row, segments, f"a height that is not 0, and {rule}: write 0")


def _height(table: SegmentTable, row: int, segments: NDArray[Any], text: str) -> Finding:
    id = table.obstacles[row].id
    said = f"{counted(len(segments), 'segment')} with {text}"
    return Finding(Kind.HEIGHT, Severity.WARNING, id, said, table.lines(segments))


def _by_obstacle(table: SegmentTable, odd: NDArray[Any]) -> Iterator[tuple[int, NDArray[Any]]]:
    """Yield each obstacle that has segments marked in ``odd``, and the indices of those."""
    indices = np.flatnonzero(odd)
    for row in np.unique(table.row[indices]):
        yield int(row), indices[table.row[indices] == row]


def _of_all(table: SegmentTable, rows: list[int]) -> NDArray[Any]:
    """Return the segments of all obstacles in ``rows``; where they have none, a cross in the middle."""
    lines = table.lines(np.isin(table.row, rows))
    border = table.robot_map.border
    middle = np.array([(border.x_min + border.x_max) / 2, (border.y_min + border.y_max) / 2])
    return lines if len(lines) else mark(middle)

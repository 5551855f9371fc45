"""Whether flights of stairs run the way the paper has them."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from .checks_finding import Finding, Kind, Limits, Severity
from .checks_table import SegmentTable
from .model import ShapeType


def turned_risers(table: SegmentTable, limits: Limits) -> Iterator[Finding]:
    """Yield a finding for each flight with risers that have the way up on their right.

    The first riser is the bottom one; seen from there each runs from left to right, so that free space is on
    its right (paper 1, section II).
    """
    for row in np.flatnonzero(table.shape_type == ShapeType.STAIRS):
        at = table.of_obstacle(int(row))
        a, b = table.a[at], table.b[at]
        if len(a) < 2:
            continue
        up = (a[-1] + b[-1] - a[0] - b[0]) / 2
        along = b - a
        turned = along[:, 0] * up[1] - along[:, 1] * up[0] < 0
        if turned.any():
            yield Finding(
                Kind.ORIENTATION,
                Severity.ERROR,
                table.obstacles[row].id,
                f"{turned.sum()} of {len(a)} risers run from right to left seen from the bottom: turn them "
                "round, or write the bottom riser first",
                table.lines(np.arange(at.start, at.stop)[turned]),
            )

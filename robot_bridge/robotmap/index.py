"""Windows of many outlines, each found without looking at the others."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .builder import Window, map_of
from .grid import BoxGrid
from .model import Border, RobotMap
from .outlines import Outlines
from .segments import Segments, clip, oriented_segments
from .usable import inspected, touching


class OutlineIndex:
    """K outlines, checked, oriented and rounded once; its maps are those of :func:`~.builder.build_map`.

    It keeps some 60 bytes for each segment. Making it takes as long as a map of everything, and then a
    window takes as long as what lies in it.
    """

    def __init__(self, outlines: Outlines) -> None:
        self._found = inspected(outlines)
        usable = np.flatnonzero(self._found.usable)
        self._segments = oriented_segments(self._found.outlines, self._found.usable)
        counts = np.bincount(self._segments.outline, minlength=len(outlines))
        self._first = np.cumsum(counts) - counts
        self._count = counts
        self._grid = BoxGrid(self._found.low[usable], self._found.high[usable])
        self._usable = usable

    def __len__(self) -> int:
        return len(self._found.usable)

    def segments_in(self, border: Border) -> Segments:
        """Return the oriented segments inside ``border``, cut there."""
        rows = self._usable[self._grid.touching(border)]
        return clip(self._of(rows), border)

    def map_of(self, window: Window, meta: Mapping[str, str] | None = None) -> RobotMap:
        """Return the map of ``window``."""
        border = window.border
        warnings = self._notes_in(border)
        return map_of(self._found.outlines, self.segments_in(border), border, meta, warnings)

    def _of(self, rows: NDArray[Any]) -> Segments:
        """Return the segments of the outlines ``rows``, which are in rising order."""
        counts = self._count[rows]
        before = np.cumsum(counts) - counts
        kept = np.repeat(self._first[rows] - before, counts) + np.arange(int(counts.sum()))
        every = self._segments
        return Segments(
            every.a[kept], every.b[kept], every.height[kept], every.outline[kept], every.joined[kept]
        )

    def _notes_in(self, border: Border) -> tuple[str, ...]:
        found = self._found
        row = found.note_row
        kept = found.note_everywhere | touching(found.low[row], found.high[row], border)
        return tuple(found.notes[k] for k in np.flatnonzero(kept))

"""Windows of many outlines, each found without looking at the others."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .builder import Window, map_of
from .clipping import clip_table, rows_of, table_of_rows
from .grid import BoxGrid
from .model import Border, RobotMap
from .outlines import Outlines
from .segments import Segments, oriented_segments
from .usable import inspected, touching


class Notes(NamedTuple):
    """What is said of outlines that are no obstacles: texts, their boxes, and which hold everywhere."""

    texts: Sequence[str]
    low: NDArray[Any]
    high: NDArray[Any]
    everywhere: NDArray[Any]

    def within(self, border: Border) -> tuple[str, ...]:
        """Return the notes on what touches ``border``, and on what has no place."""
        if not len(self.texts):
            return ()
        kept = self.everywhere | touching(self.low, self.high, border)
        return tuple(self.texts[k] for k in np.flatnonzero(kept).tolist())


class OutlineIndex:
    """K outlines, checked, oriented and rounded once; its maps are those of :func:`~.builder.build_map`.

    It keeps some 28 bytes for each segment. Making it takes as long as a map of everything, and then a
    window takes as long as what lies in it. ``outlines`` have every ring closed; ``rows``, (n, 7), are their
    segments cell by cell (see :func:`.clipping.rows_of`).
    """

    def __init__(self, outlines: Outlines, rows: NDArray[Any], grid: BoxGrid, notes: Notes) -> None:
        self.outlines = outlines
        self.rows = rows
        self.grid = grid
        self.notes = notes

    @classmethod
    def of(cls, outlines: Outlines) -> OutlineIndex:
        """Return the index of ``outlines``."""
        found = inspected(outlines)
        segments = oriented_segments(found.outlines, found.usable)
        grid, order = BoxGrid.of(np.minimum(segments.a, segments.b), np.maximum(segments.a, segments.b))
        # In the grid's order what lies in a window is some long pieces of memory.
        rows = rows_of(segments, found.outlines.height)[order]
        row = found.note_row
        notes = Notes(found.notes, found.low[row], found.high[row], found.note_everywhere)
        return cls(found.outlines, rows, grid, notes)

    def __len__(self) -> int:
        return len(self.outlines)

    def count_near(self, border: Border) -> int:
        """Return how many segments are in the cells that ``border`` touches: some more than are in it."""
        return sum(span.stop - span.start for span in self.grid.spans(border))

    def segments_in(self, border: Border) -> Segments:
        """Return the oriented segments inside ``border``, cut there."""
        spans = self.grid.spans(border)
        rows = np.concatenate([self.rows[:0], *(self.rows[span] for span in spans)])
        return clip_table(table_of_rows(rows, self.outlines.height), border)

    def map_of(self, window: Window, meta: Mapping[str, str] | None = None) -> RobotMap:
        """Return the map of ``window``."""
        border = window.border
        return map_of(self.outlines, self.segments_in(border), border, meta, self.notes.within(border))

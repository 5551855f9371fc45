"""Windows of many outlines, each found without looking at the others."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from .builder import Window, map_of
from .clipping import clip_table, table_of
from .grid import BoxGrid
from .model import Border, RobotMap
from .outlines import Outlines
from .segments import Segments, oriented_segments
from .usable import inspected, touching


class OutlineIndex:
    """K outlines, checked, oriented and rounded once; its maps are those of :func:`~.builder.build_map`.

    It keeps some 60 bytes for each segment. Making it takes as long as a map of everything, and then a
    window takes as long as what lies in it.
    """

    def __init__(self, outlines: Outlines) -> None:
        self._found = inspected(outlines)
        segments = oriented_segments(self._found.outlines, self._found.usable)
        self._grid = BoxGrid(np.minimum(segments.a, segments.b), np.maximum(segments.a, segments.b))
        # In the grid's order what lies in a window is some long pieces of memory.
        self._table = table_of(segments)[self._grid.order]

    def __len__(self) -> int:
        return len(self._found.usable)

    def segments_in(self, border: Border) -> Segments:
        """Return the oriented segments inside ``border``, cut there."""
        spans = self._grid.spans(border)
        return clip_table(np.concatenate([self._table[:0], *(self._table[span] for span in spans)]), border)

    def map_of(self, window: Window, meta: Mapping[str, str] | None = None) -> RobotMap:
        """Return the map of ``window``."""
        border = window.border
        warnings = self._notes_in(border)
        return map_of(self._found.outlines, self.segments_in(border), border, meta, warnings)

    def _notes_in(self, border: Border) -> tuple[str, ...]:
        found = self._found
        row = found.note_row
        kept = found.note_everywhere | touching(found.low[row], found.high[row], border)
        return tuple(found.notes[k] for k in np.flatnonzero(kept))

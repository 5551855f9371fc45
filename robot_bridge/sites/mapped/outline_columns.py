"""The columns of outlines, and of what is said of those that are no obstacles, written as they come."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from ...robotmap.outlines import Outlines
from ...robotmap.usable import Inspection
from ..extras import extras_text
from .row_file import ColumnFiles, RowFile
from .text_columns import CodedTextColumns, TextColumns, bytes_of_texts

_PLAIN = ("shape_type", "courtyard", "height", "outdoor")
_BESIDE = (("low", np.float64, 2), ("high", np.float64, 2), ("everywhere", np.bool_, 0))
"""What is kept of a note besides its text."""


class OutlineColumns:
    """Appends outlines to ``columns``."""

    def __init__(self, columns: ColumnFiles) -> None:
        self._columns = columns
        self._semantics = CodedTextColumns(columns, "semantics")
        self._source = TextColumns(columns, "source")
        self._extras = CodedTextColumns(columns, "ext")
        self._has_base = self._has_extras = False
        columns.append("offsets", np.zeros(1, dtype=np.int64))

    def add(self, outlines: Outlines) -> None:
        """Add ``outlines``; raises OSError."""
        columns = self._columns
        columns.append("coordinates", outlines.coordinates)
        points = len(columns["coordinates"]) - len(outlines.coordinates)
        columns.append("offsets", outlines.offsets[1:] + points)
        for name in _PLAIN:
            columns.append(name, getattr(outlines, name))
        columns.append("base", outlines.bases)
        self._semantics.add(outlines.semantics)
        self._source.add(outlines.source)
        self._extras.add(map(extras_text, outlines.extras))
        self._has_base |= outlines.base is not None
        self._has_extras |= outlines.ext is not None

    def end(self) -> None:
        """Remove the columns in which nothing is said."""
        if not self._has_base:
            self._columns.remove("base")
        if not self._has_extras:
            for part in ("codes", "text", "offsets"):
                self._columns.remove(f"ext_{part}")


class NoteColumns:
    """Keeps notes in ``folder``, those of one kind together, until they are put into columns."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._kinds: dict[int, dict[str, RowFile]] = {}

    def add(self, found: Inspection) -> None:
        """Add the notes of ``found``; raises OSError."""
        for kind, (begin, end) in enumerate(pairwise(np.cumsum([0, *found.note_counts]).tolist())):
            if begin == end:
                continue
            own = self._kinds.get(kind) or self._made(kind)
            raw, lengths = bytes_of_texts(found.notes[begin:end])
            row = found.note_row[begin:end]
            everywhere = found.note_everywhere[begin:end]
            said = {"text": raw, "lengths": lengths, "low": found.low[row], "high": found.high[row]}
            for name, rows in {**said, "everywhere": everywhere}.items():
                own[name].append(rows)

    def end(self, columns: ColumnFiles) -> None:
        """Put all notes into ``columns``, kind by kind; raises OSError."""
        texts = TextColumns(columns, "note")
        beside = {name: columns.make(f"note_{name}", kind, width) for name, kind, width in _BESIDE}
        put = {"text": texts.add_bytes, "lengths": texts.add_lengths}
        put |= {name: column.append for name, column in beside.items()}
        for _, own in sorted(self._kinds.items()):
            for name, file in own.items():
                for piece in file.pieces():
                    put[name](piece)

    def remove(self) -> None:
        """Delete what is kept."""
        for own in self._kinds.values():
            for file in own.values():
                file.remove()

    def _made(self, kind: int) -> dict[str, RowFile]:
        parts: tuple[tuple[str, Any, int], ...] = (("text", np.uint8, 0), ("lengths", np.int64, 0), *_BESIDE)
        own = {name: RowFile(self._folder / f"notes{kind}.{name}", of, width) for name, of, width in parts}
        self._kinds[kind] = own
        return own

"""Writers of columns larger than memory: texts, outlines, medians, boxes sorted by cell."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..robotmap.outlines import Outlines, OutlineValidation
from ..robotmap.window_index import cell_keys, level_counts, placed_in
from .column_file import AT_ONCE, HALVES, ColumnFiles, RowFile
from .geopackage import extras_text

# --- Texts appended to columns, as read by :mod:`.column_file` ---

_MOST_KNOWN = 8 << 20
"""approximate bytes of remembered texts, so that each is written once."""
_EACH = 100
"""approximate bytes that a remembered text takes besides its characters."""


class TextColumns:
    """Appends texts to the columns ``name`` + ``_text`` and ``_offsets``, which it makes."""

    def __init__(self, columns: ColumnFiles, name: str) -> None:
        self._content = columns.make(f"{name}_text", np.uint8)
        self._offsets = columns.make(f"{name}_offsets", np.int64)
        self._end = 0
        self._offsets.append(np.zeros(1, dtype=np.int64))

    def add(self, texts: Iterable[str]) -> None:
        """Add ``texts``; raises OSError."""
        content, lengths = bytes_of_texts(texts)
        self.add_bytes(content)
        self.add_lengths(lengths)

    def add_bytes(self, content: NDArray[Any]) -> None:
        """Add bytes of texts whose lengths are added by :meth:`add_lengths`; raises OSError."""
        self._content.append(content)

    def add_lengths(self, lengths: NDArray[Any]) -> None:
        """Add the lengths of texts in bytes; raises OSError."""
        self._offsets.append(self._end + np.cumsum(lengths))
        self._end += int(lengths.sum())


class CodedTextColumns:
    """Appends texts of which many are equal: distinct ones to a table, their indices to ``_codes``.

    If there are very many distinct ones, some occur in the table again.
    """

    def __init__(self, columns: ColumnFiles, name: str) -> None:
        self._codes = columns.make(f"{name}_codes", np.int32)
        self._table = TextColumns(columns, name)
        self._count = 0
        self._room = _MOST_KNOWN
        self._known: dict[str, int] = {}

    def add(self, texts: Iterable[str]) -> None:
        """Add ``texts``; raises OSError."""
        some, new = list(texts), list[str]()
        codes = list(map(self._known.get, some))
        if None in codes:
            codes = [self._code(text, new) for text in some]
        self._codes.append(np.array(codes, dtype=np.int32))
        self._table.add(new)

    def _code(self, text: str, new: list[str]) -> int:
        code = self._known.get(text)
        if code is None:
            self._room -= len(text) + _EACH
            if self._room < 0:
                self._known.clear()
                self._room = _MOST_KNOWN
            code = self._known[text] = self._count
            self._count += 1
            new.append(text)
        return code


def bytes_of_texts(texts: Iterable[str]) -> tuple[NDArray[Any], NDArray[Any]]:
    """Return ``texts`` one after the other in UTF-8, and how many bytes each has."""
    raw = [text.encode("utf-8", HALVES) for text in texts]
    return np.frombuffer(b"".join(raw), np.uint8), np.fromiter(map(len, raw), np.int64, len(raw))


# --- The columns of outlines, and of notes on those that are no obstacles, written incrementally

_PLAIN = ("shape_type", "courtyard", "height", "outdoor")
_BESIDE = (("low", np.float64, 2), ("high", np.float64, 2), ("everywhere", np.bool_, 0))
"""The columns of a note besides its text."""


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
        self._extras.add(extras_text(one) if one else "" for one in outlines.extras)
        self._has_base |= outlines.base is not None
        self._has_extras |= outlines.ext is not None

    def end(self) -> None:
        """Remove empty columns."""
        if not self._has_base:
            self._columns.remove("base")
        if not self._has_extras:
            for part in ("codes", "text", "offsets"):
                self._columns.remove(f"ext_{part}")


class NoteColumns:
    """Stores notes in ``folder``, grouped by kind, until they are written into columns."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._kinds: dict[int, dict[str, RowFile]] = {}

    def add(self, found: OutlineValidation) -> None:
        """Add the notes of ``found``; raises OSError."""
        for kind, (begin, end) in enumerate(pairwise(np.cumsum([0, *found.note_counts]).tolist())):
            if begin == end:
                continue
            own = self._kinds.get(kind) or self._made(kind)
            raw, lengths = bytes_of_texts(found.notes[begin:end])
            row = found.note_row[begin:end]
            everywhere = found.note_everywhere[begin:end]
            columns = {"text": raw, "lengths": lengths, "low": found.low[row], "high": found.high[row]}
            for name, rows in {**columns, "everywhere": everywhere}.items():
                own[name].append(rows)

    def end(self, columns: ColumnFiles) -> None:
        """Write all notes into ``columns``, kind by kind; raises OSError."""
        texts = TextColumns(columns, "note")
        beside = {name: columns.make(f"note_{name}", kind, width) for name, kind, width in _BESIDE}
        put = {"text": texts.add_bytes, "lengths": texts.add_lengths}
        put |= {name: column.append for name, column in beside.items()}
        for _, own in sorted(self._kinds.items()):
            for name, file in own.items():
                for piece in file.pieces():
                    put[name](piece)

    def remove(self) -> None:
        """Delete the temporary files."""
        for own in self._kinds.values():
            for file in own.values():
                file.remove()

    def _made(self, kind: int) -> dict[str, RowFile]:
        parts: tuple[tuple[str, Any, int], ...] = (("text", np.uint8, 0), ("lengths", np.int64, 0), *_BESIDE)
        own = {name: RowFile(self._folder / f"notes{kind}.{name}", of, width) for name, of, width in parts}
        self._kinds[kind] = own
        return own


# --- Median of more numbers than fit into memory ---

_BINS = 1 << 16
_SIGN = np.uint64(1 << 63)

Codes = NDArray[np.uint64]


def median(numbers: RowFile) -> float:
    """Return ``numpy.median`` of ``numbers``, float64 and finite; 0 if there are none. Raises OSError."""
    count = len(numbers)
    if not count:
        return 0.0
    lower = _at_rank(numbers, (count - 1) // 2)
    if count % 2:
        return lower
    up_to, beyond = 0, np.inf
    for some in numbers.pieces():
        more = some > lower
        up_to += len(some) - int(more.sum())
        beyond = min(beyond, some[more].min(initial=np.inf))
    return (lower + (lower if up_to > count // 2 else float(beyond))) / 2


def _at_rank(numbers: RowFile, rank: int) -> float:
    """Return the number that would be at ``rank`` if they were sorted.

    Candidates are counted in ever narrower bins, until few enough are left to sort.
    """
    low, high, left = 0, 1 << 64, len(numbers)
    while left > AT_ONCE and high - low > 1:
        width = -(-(high - low) // _BINS)
        counts = np.zeros(_BINS, dtype=np.int64)
        for some in numbers.pieces():
            bins = (_within(_codes(some), low, high) - np.uint64(low)) // np.uint64(width)
            counts += np.bincount(bins.astype(np.int64), minlength=_BINS)
        one = int(np.searchsorted(np.cumsum(counts), rank, side="right"))
        rank -= int(counts[:one].sum())
        low, high, left = low + one * width, min(low + (one + 1) * width, high), int(counts[one])
    if high - low == 1:
        return _number(low)
    found = np.concatenate([_within(_codes(some), low, high) for some in numbers.pieces()])
    return _number(int(np.partition(found, rank)[rank]))


def _codes(numbers: NDArray[np.float64]) -> Codes:
    """Return integers that are in the same order."""
    bits = numbers.view(np.uint64)
    # For negative numbers all bits are inverted, else the sign bit alone.
    return np.where(bits & _SIGN, ~bits, bits | _SIGN)


def _number(code: int) -> float:
    bits = code - (1 << 63) if code >> 63 else (1 << 64) - 1 - code
    return float(np.array(bits, dtype=np.uint64).view(np.float64))


def _within(codes: Codes, low: int, high: int) -> Codes:
    return codes[(codes >= np.uint64(low)) & (codes <= np.uint64(high - 1))]


# --- Boxes sorted by cell on the disk, for a :class:`~..robotmap.window_index.BoxGrid` ---

_SAMPLED = 256
"""One key in so many of each run is sampled, to estimate the distribution of boxes."""
_LEAST, _MOST = np.iinfo(np.int64).min, np.iinfo(np.int64).max


class _Piece(NamedTuple):
    """Rows in the order of arrival, in a file of their own dtype."""

    file: RowFile
    begin: int
    end: int


class CellSorting:
    """Receives boxes with a row of numbers each, and sorts the rows by cell, with ``folder`` for its files.

    The order is that of :meth:`.grid.BoxGrid.of`. In memory are some :data:`~.column_file.AT_ONCE` boxes, and
    a number for each :data:`_SAMPLED` of all.
    """

    def __init__(self, folder: Path, name: str) -> None:
        self._folder, self._name = folder, name
        self._low = [RowFile(folder / f"{name}.low{axis}", np.float64) for axis in range(2)]
        self._level = RowFile(folder / f"{name}.level", np.int8)
        self._rows: dict[str, RowFile] = {}
        self._pieces: list[_Piece] = []
        self._counts = level_counts(np.empty(0, dtype=np.int64))

    def add(self, low: NDArray[Any], level: NDArray[Any], rows: NDArray[Any]) -> None:
        """Add boxes by their lower corners, (n, 2), and levels, (n,); ``rows`` is (n, width).

        ``rows`` may have a wider dtype than earlier ones. Raises OSError.
        """
        for axis, column in enumerate(self._low):
            column.append(low[:, axis])
        self._level.append(level)
        self._counts = self._counts + level_counts(level)
        own = self._rows.get(rows.dtype.str)
        if own is None:
            file = self._folder / f"{self._name}.{rows.dtype.name}"
            own = self._rows[rows.dtype.str] = RowFile(file, rows.dtype, rows.shape[1])
        first = len(own)
        own.append(rows)
        for begin in range(first, len(own), AT_ONCE):
            self._pieces.append(_Piece(own, begin, min(begin + AT_ONCE, len(own))))

    def sort_into(self, columns: ColumnFiles, grid: str, names: str) -> dict[str, Any]:
        """Add the rows and the grid to ``columns``, and return the grid's description; raises OSError.

        The columns are called ``names``; those of the grid begin with ``grid``. Temporary files are deleted.
        """
        origin = [median(file) for file in self._low]
        runs = _Runs(self._folder, self._name, *self._kind())
        try:
            for piece, low, level in self._boxes():
                runs.add(cell_keys(low, level, origin), piece.file.read(piece.begin, piece.end))
            self.remove()
            cells = _CellColumns(columns, grid)
            rows = columns.make(names, *self._kind())
            for keys, some in runs.merged():
                cells.add(keys)
                rows.append(some)
            cells.end()
        finally:
            runs.remove()
        placed, levels = placed_in(self._counts)
        return {"origin": origin, "placed": placed, "levels": list(levels)}

    def remove(self) -> None:
        """Delete the temporary files."""
        for file in (*self._low, self._level, *self._rows.values()):
            file.remove()

    def _kind(self) -> tuple[Any, int]:
        files = self._rows.values()
        return np.result_type(*(file.dtype for file in files)), next(iter(files)).shape[1]

    def _boxes(self) -> Iterator[tuple[_Piece, NDArray[Any], NDArray[Any]]]:
        begin = 0
        for piece in self._pieces:
            end = begin + piece.end - piece.begin
            low = np.column_stack([file.read(begin, end) for file in self._low])
            yield piece, low, self._level.read(begin, end).astype(np.int64)
            begin = end


class _Runs:
    """Rows with a key each, sorted run by run on arrival, then merged."""

    def __init__(self, folder: Path, name: str, kind: Any, width: int) -> None:
        self._keys = RowFile(folder / f"{name}.keys", np.int64)
        self._rows = RowFile(folder / f"{name}.runs", kind, width)
        self._ends = [0]
        self._samples: list[NDArray[Any]] = []

    def add(self, keys: NDArray[Any], rows: NDArray[Any]) -> None:
        """Add a run; rows of one key stay in the order in which they come."""
        order = np.argsort(keys, kind="stable")
        keys = keys[order]
        self._keys.append(keys)
        self._rows.append(rows[order])
        self._ends.append(len(self._keys))
        self._samples.append(keys[_SAMPLED - 1 :: _SAMPLED])

    def merged(self) -> Iterator[tuple[NDArray[Any], NDArray[Any]]]:
        """Yield keys and rows in their order, about :data:`~.column_file.AT_ONCE` at a time."""
        borders = _borders(np.concatenate([np.empty(0, dtype=np.int64), *self._samples]))
        places = [
            begin + np.searchsorted(self._keys.read(begin, end), borders)
            for begin, end in pairwise(self._ends)
        ]
        for place, (low, high) in enumerate(pairwise(borders)):
            spans = [(int(run[place]), int(run[place + 1])) for run in places]
            some = ((self._keys.read(*span), self._rows.read(*span)) for span in spans if span[0] < span[1])
            if high - low == 1:
                yield from some
            elif pieces := list(some):
                keys, rows = map(np.concatenate, zip(*pieces, strict=True))
                order = np.argsort(keys, kind="stable")
                yield keys[order], rows[order]

    def remove(self) -> None:
        """Delete everything."""
        self._keys.remove()
        self._rows.remove()


def _borders(samples: NDArray[Any]) -> list[int]:
    """Return keys with few samples between them, or with no other key than the first."""
    few = AT_ONCE // _SAMPLED
    borders, room = [int(_LEAST)], few
    for key, count in zip(*(found.tolist() for found in np.unique(samples, return_counts=True)), strict=True):
        if count > room and borders[-1] != key:
            borders.append(key)
            room = few
        room -= count
        if count > few:
            borders.append(key + 1)
            room = few
    return [*borders, int(_MOST)]


class _CellColumns:
    """The columns of a grid, made from the sorted keys of its boxes."""

    def __init__(self, columns: ColumnFiles, name: str) -> None:
        self._keys = columns.make(f"{name}_keys", np.int64)
        self._starts = columns.make(f"{name}_starts", np.int64)
        self._last: int | None = None
        self._count = 0

    def add(self, keys: NDArray[Any]) -> None:
        """Add the next keys, sorted."""
        cells, starts = np.unique(keys, return_index=True)
        # A cell may continue from the previous keys.
        goes_on = int(cells[0] == self._last)
        self._keys.append(cells[goes_on:])
        self._starts.append(starts[goes_on:] + self._count)
        self._last, self._count = int(cells[-1]), self._count + len(keys)

    def end(self) -> None:
        """Write the end of the last cell."""
        self._starts.append(np.array([self._count]))

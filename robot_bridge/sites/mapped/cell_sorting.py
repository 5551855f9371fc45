"""Many boxes put cell by cell on the disk, for a :class:`~...robotmap.grid.BoxGrid`."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...robotmap.grid import cell_keys, level_counts, placed_in
from .medians import median
from .row_file import AT_ONCE, ColumnFiles, RowFile

_SAMPLED = 256
"""One key in so many of each run tells how many boxes are where."""
_LEAST, _MOST = np.iinfo(np.int64).min, np.iinfo(np.int64).max


class _Piece(NamedTuple):
    """Rows as they came, in a file of their own kind."""

    file: RowFile
    begin: int
    end: int


class CellSorting:
    """Takes boxes with a row of numbers each, and puts the rows cell by cell, in ``folder`` meanwhile.

    The order is that of :meth:`.grid.BoxGrid.of`. In memory are some :data:`~.row_file.AT_ONCE` boxes, and a
    number for each :data:`_SAMPLED` of all.
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

        ``rows`` may be of a wider kind than others were. Raises OSError.
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
        """Add the rows and the grid to ``columns``, and return what is said of the grid; raises OSError.

        The columns are called ``names``; those of the grid begin with ``grid``. What was kept is deleted.
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
        """Delete what is kept."""
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
    """Rows with a key each, sorted run by run as they come, then all together."""

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
        """Yield keys and rows in their order, about :data:`~.row_file.AT_ONCE` at a time."""
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
    """Return keys between which there are few samples, or no other key than the first."""
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
    """The columns of a grid, made of the keys of its boxes in their order."""

    def __init__(self, columns: ColumnFiles, name: str) -> None:
        self._keys = columns.make(f"{name}_keys", np.int64)
        self._starts = columns.make(f"{name}_starts", np.int64)
        self._last: int | None = None
        self._count = 0

    def add(self, keys: NDArray[Any]) -> None:
        """Add some keys, which are sorted."""
        cells, starts = np.unique(keys, return_index=True)
        # A cell may go on from those before.
        goes_on = int(cells[0] == self._last)
        self._keys.append(cells[goes_on:])
        self._starts.append(starts[goes_on:] + self._count)
        self._last, self._count = int(cells[-1]), self._count + len(keys)

    def end(self) -> None:
        """Say where the last cell ends."""
        self._starts.append(np.array([self._count]))

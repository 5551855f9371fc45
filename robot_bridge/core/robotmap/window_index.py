"""Spatial index of outlines: boxes on a grid, maps of windows, the whole map's text by groups."""

from __future__ import annotations

import heapq
import zlib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from math import floor
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .builder import clip, clip_table, group_of, map_of, rows_of, table_of_rows
from .model import Border, RobotMap, Window
from .outlines import Outlines, Segments, oriented_segments, touching_border, validate_outlines
from .text_format import write_obstacles

# --- Boxes that may touch a rectangle: a sparse grid of non-empty cells ---

_SMALLEST_CELL = 20.0
"""metres; a robot's window is some cells wide, and a cell holds some walls."""
_GROWTH = 8
"""Ratio of cell sizes between levels."""
_LEVELS = 12
_FARTHEST = 1 << 28
"""cells from the first; boxes beyond are placed there."""
_ROW = 4 * _FARTHEST
_LEVEL = 2 * _FARTHEST * _ROW
_FITS = 0.999
"""of a cell; a margin for rounding of the largest boxes."""
_SIZES = _SMALLEST_CELL * float(_GROWTH) ** np.arange(_LEVELS)


class GridCells(NamedTuple):
    """The data of a grid: the m non-empty cells, and where their boxes begin.

    ``keys`` is (m,) and ``starts`` (m + 1,) int64. ``placed`` boxes are in cells of ``levels``; those larger
    than any cell follow.
    """

    keys: NDArray[Any]
    starts: NDArray[Any]
    origin: list[float]
    placed: int
    levels: tuple[int, ...]


class BoxGrid:
    """n boxes from ``low`` to ``high``, (n, 2) each, finite metres, each in the cell of its lower corner.

    A box is in the first level whose cells are larger than itself, so a query for a rectangle visits at most
    one further row and column of cells. Boxes are identified by their positions in cell order.
    """

    def __init__(self, cells: GridCells) -> None:
        self.cells = cells
        self._origin, self._keys, self._starts = cells.origin, cells.keys, cells.starts
        self._count = int(cells.starts[-1])
        # Boxes larger than any cell are returned by every query.
        self._always = [slice(cells.placed, self._count)] if cells.placed < self._count else []
        self._levels = [(level * _LEVEL, _SMALLEST_CELL * float(_GROWTH) ** level) for level in cells.levels]

    @classmethod
    def of(cls, low: NDArray[Any], high: NDArray[Any]) -> tuple[BoxGrid, NDArray[Any]]:
        """Return the grid of boxes, and the boxes in cell order: (n,) int64."""
        origin = np.median(low, axis=0).tolist() if len(low) else [0.0, 0.0]
        level = levels_of(low, high)
        keys = cell_keys(low, level, origin)
        order = np.argsort(keys, kind="stable")
        cells, starts = np.unique(keys[order], return_index=True)
        made = GridCells(cells, np.append(starts, len(keys)), origin, *placed_in(level_counts(level)))
        return cls(made), order

    def spans(self, border: Border) -> list[slice]:
        """Return the slices of ``order`` with boxes that may touch ``border``."""
        x, y = self._origin
        begins: list[int] = []
        ends: list[int] = []
        for base, size in self._levels:
            left, right = floor((border.x_min - size - x) / size), floor((border.x_max - x) / size)
            lower, upper = floor((border.y_min - size - y) / size), floor((border.y_max - y) / size)
            if upper - lower >= len(self._keys):
                return [slice(0, self._count)]
            if min(left, lower) < -_FARTHEST or max(right, upper) > _FARTHEST:
                left, right, lower, upper = map(_within_reach, (left, right, lower, upper))
            first, last = base + lower * _ROW + left, base + upper * _ROW + left
            begins += range(first, last + 1, _ROW)
            ends += range(first + right - left + 1, last + right - left + 2, _ROW)
        places = self._starts.take(self._keys.searchsorted(begins + ends)).tolist() if begins else []
        return [*map(slice, places[: len(begins)], places[len(begins) :]), *self._always]

    def pairs(self, low: NDArray[Any], high: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
        """Return which boxes may touch which of the rectangles from ``low`` to ``high``, (k, 2) each.

        Two arrays of int64: rectangle and box. For many small rectangles.
        """
        queries = [np.repeat(np.arange(len(low)), len(self._always))]
        begins = [np.tile(np.array([one.start for one in self._always], dtype=np.int64), len(low))]
        ends = [np.tile(np.array([one.stop for one in self._always], dtype=np.int64), len(low))]
        for base, size in self._levels:
            first = np.floor((low - size - self._origin) / size).clip(-_FARTHEST, _FARTHEST).astype(np.int64)
            last = np.floor((high - self._origin) / size).clip(-_FARTHEST, _FARTHEST).astype(np.int64)
            rectangle, row = _ranges(first[:, 1], last[:, 1] + 1)
            keys = base + row * _ROW + first[rectangle, 0]
            beyond = keys + (last - first)[rectangle, 0] + 1
            queries.append(rectangle)
            begins.append(self._starts[np.searchsorted(self._keys, keys)])
            ends.append(self._starts[np.searchsorted(self._keys, beyond)])
        span, box = _ranges(np.concatenate(begins), np.concatenate(ends))
        return np.concatenate(queries)[span], box


def levels_of(low: NDArray[Any], high: NDArray[Any]) -> NDArray[Any]:
    """Return the level of each box from ``low`` to ``high``, (n, 2) each: (n,) int64."""
    levels: NDArray[Any] = np.searchsorted(_FITS * _SIZES, (high - low).max(axis=1, initial=0.0))
    return levels


def level_counts(levels: NDArray[Any]) -> NDArray[Any]:
    """Return the number of boxes per level, and at the end of those beyond all levels."""
    return np.bincount(levels, minlength=_LEVELS + 1)


def placed_in(counts: NDArray[Any]) -> tuple[int, tuple[int, ...]]:
    """Return how many boxes are in cells, and the levels of these, from the result of
    :func:`level_counts`."""
    return int(counts[:_LEVELS].sum()), tuple(np.flatnonzero(counts[:_LEVELS]).tolist())


def cell_keys(low: NDArray[Any], level: NDArray[Any], origin: Sequence[float]) -> NDArray[Any]:
    """Return the cell of each box by its lower corner and its level: (n,) int64.

    Sorted by it, boxes are in cell order, followed by those larger than any cell.
    """
    cell = np.floor((low - origin) / _SIZES[np.minimum(level, _LEVELS - 1)][:, None])
    column, row = cell.clip(-_FARTHEST, _FARTHEST).astype(np.int64).T
    return np.where(level < _LEVELS, level * _LEVEL + row * _ROW + column, _LEVELS * _LEVEL)


def _ranges(begins: NDArray[Any], ends: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
    """Return the range of each number, and the numbers of all ranges one after the other."""
    lengths = ends - begins
    of = np.repeat(np.arange(len(begins)), lengths)
    return of, np.arange(len(of)) + (begins - np.cumsum(lengths) + lengths)[of]


def _within_reach(cell: int) -> int:
    return max(-_FARTHEST, min(_FARTHEST, cell))


# --- Windows of many outlines, found by an index ---


class OutlineNotes(NamedTuple):
    """Notes on outlines that are no obstacles: texts, boxes, and which apply everywhere."""

    texts: Sequence[str]
    low: NDArray[Any]
    high: NDArray[Any]
    everywhere: NDArray[Any]

    def within(self, border: Border) -> tuple[str, ...]:
        """Return the notes on outlines that touch ``border``, and on those without a place."""
        if not len(self.texts):
            return ()
        kept = self.everywhere | touching_border(self.low, self.high, border)
        return tuple(self.texts[k] for k in np.flatnonzero(kept).tolist())


class OutlineIndex:
    """K outlines, checked, oriented and rounded once; its maps are those of :func:`~.builder.build_map`.

    It keeps some 28 bytes for each segment. Creating it takes as long as a map of everything; then the time
    of a window depends on its content. ``outlines`` have every ring closed; ``rows``, (n, 7), are their
    segments in cell order (see :func:`.builder.rows_of`).
    """

    def __init__(self, outlines: Outlines, rows: NDArray[Any], grid: BoxGrid, notes: OutlineNotes) -> None:
        self.outlines = outlines
        self.rows = rows
        self.grid = grid
        self.notes = notes

    @classmethod
    def of(cls, outlines: Outlines) -> OutlineIndex:
        """Return the index of ``outlines``."""
        found = validate_outlines(outlines)
        segments = oriented_segments(found.outlines, found.usable)
        grid, order = BoxGrid.of(np.minimum(segments.a, segments.b), np.maximum(segments.a, segments.b))
        # In the grid's order the content of a window is a few long pieces of memory.
        rows = rows_of(segments, found.outlines.height)[order]
        row = found.note_row
        notes = OutlineNotes(found.notes, found.low[row], found.high[row], found.note_everywhere)
        return cls(found.outlines, rows, grid, notes)

    def __len__(self) -> int:
        return len(self.outlines)

    def count_near(self, border: Border) -> int:
        """Return how many segments are in the cells that ``border`` touches, somewhat more than inside it."""
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


# --- The text of a large map in parts, by groups of obstacles ---

_AT_ONCE = 1000
"""outlines whose obstacles are in memory at a time."""
_WINDOWS, _SIDE = 40, 60.0
"""Number and side in metres of sample squares for estimating the total size."""


class GroupText(NamedTuple):
    """The text of consecutive obstacles, and their group."""

    group: str
    text: str


def group_texts(outlines: Outlines, border: Border) -> Iterator[GroupText]:
    """Yield the text of the map of ``border`` after its head, in parts; every ring must be closed."""
    groups = [group_of(outlines, row) for row in range(len(outlines))]
    names = sorted(set(groups))
    places = {name: place for place, name in enumerate(names)}
    of = np.array([places[group] for group in groups], dtype=np.int64)
    order, ends = np.argsort(of, kind="stable"), np.cumsum(np.bincount(of, minlength=len(names)))
    for group, own in zip(names, np.split(order, ends[:-1]), strict=bool(names)):
        for begin in range(0, len(own), _AT_ONCE):
            if text := _text(outlines, own[begin : begin + _AT_ONCE], border):
                yield GroupText(group, text)


def merged(texts: Iterable[GroupText], more: Iterable[GroupText]) -> Iterator[GroupText]:
    """Yield both in the order of their groups; within a group ``more`` comes later."""
    return heapq.merge(texts, more, key=lambda part: part.group)


def size_in_binary(index: OutlineIndex, border: Border) -> int:
    """Return the approximate bytes of the map of ``border`` in codec 1, estimated from some windows."""
    if not len(index.rows):
        return 0
    rows = index.rows[np.unique(np.linspace(0, len(index.rows) - 1, _WINDOWS).astype(np.int64))]
    texts, sampled = [], 0
    for x, y in rows[:, :2].tolist():
        near = index.map_of(Window(x / 100, y / 100, _SIDE, _SIDE))
        texts.append(write_obstacles(near.obstacles))
        sampled += near.segment_count
    if not sampled:
        return 0
    return len(zlib.compress("".join(texts).encode())) * index.count_near(border) // sampled


def _text(outlines: Outlines, rows: NDArray[Any], border: Border) -> str:
    """Return the text of the outlines ``rows``."""
    found = validate_outlines(outlines.chosen(rows))
    segments = clip(oriented_segments(found.outlines, found.usable), border)
    own = replace(segments, outline=rows[segments.outline])
    return write_obstacles(map_of(outlines, own, border, None, ()).obstacles)

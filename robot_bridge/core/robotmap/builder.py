"""Builder of robot maps: segments clipped by a border, chained into obstacles (paper 1, section III.B)."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import WindowError
from .model import CUT, Border, BuiltObstacles, RobotMap, ShapeType, Window
from .outlines import (
    CLOSED_TYPES,
    Outlines,
    OutlineValidation,
    Segments,
    is_closed,
    oriented_segments,
    validate_outlines,
    without_vanished,
)

# --- Clipping of segments by a rectangle; vectorised ---

_ON_BORDER = 1e-5
"""centimetres; floating-point error of a cut on its border for large coordinates."""

_HEIGHT, _OUTLINE, _NUMBER = 4, 5, 6
"""Columns of a table of segments, after the two ends."""
_HELD = ((np.int32, 2.0**31 - 1), (np.int64, 2.0**53))
"""Integer types of rows, and the largest exact value of each."""
_WHOLE = np.array([[0.0], [1.0]])
"""Begin and end of an uncut segment, as shares of its length."""
_INWARDS = np.array([[0, 0], [1, -1], [_ON_BORDER, -_ON_BORDER]]).reshape(3, 2, 1, 1)
"""Offsets from the lower and the upper side to themselves, to the next coordinate inside, and to their
tolerance."""


def table_of(segments: Segments) -> NDArray[Any]:
    """Return ``segments`` as one row of float64 each, (n, 7), so that one call gathers them.

    Its columns are a and b in centimetres, then height, outline and number unchanged.
    """
    ends = np.rint(np.column_stack([segments.a, segments.b]) * 100)
    return np.column_stack([ends, segments.height, segments.outline, segments.number])


def rows_of(segments: Segments, heights: NDArray[Any], first: tuple[int, float] = (0, 0)) -> NDArray[Any]:
    """Return ``segments`` as integers of the smallest sufficient type, (n, 7).

    As :func:`table_of`, except the height: 1 for that of the outline, in ``heights``, 0 for none. ``first``,
    the count of earlier outlines and the last number, is added to outlines and numbers.
    """
    table = table_of(segments)
    table[:, _HEIGHT] = segments.height == heights[segments.outline]
    table[:, _OUTLINE:] += first
    largest = np.abs(table).max(initial=0.0)
    return table.astype(next((kind for kind, most in _HELD if largest <= most), np.float64))


def corners_of_rows(rows: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
    """Return the lower and upper corners, (n, 2) metres each, of the segments in ``rows``."""
    a, b = rows[:, 0:2].astype(np.float64) / 100, rows[:, 2:4].astype(np.float64) / 100
    return np.minimum(a, b), np.maximum(a, b)


def table_of_rows(rows: NDArray[Any], heights: NDArray[Any]) -> NDArray[Any]:
    """Return the table, as of :func:`table_of`, of the segments in ``rows``, made by :func:`rows_of`."""
    table = rows.astype(np.float64)
    table[:, _HEIGHT] *= heights[rows[:, _OUTLINE].astype(np.int64)]
    return table


def clip(segments: Segments, border: Border) -> Segments:
    """Return the parts of the segments inside ``border``: :func:`clip_table` of all of them."""
    return clip_table(table_of(segments), border)


def clip_table(table: NDArray[Any], border: Border) -> Segments:
    """Return the parts of the segments in ``table`` inside ``border``, in the order of their numbers.

    Segments are cut one by one (Liang and Barsky, 1984), so no wall is invented along the border. Cuts are
    rounded to centimetres, the unit of the border. A window of a city has so few segments that the number of
    calls dominates, not that of segments: all of them go through every step.
    """
    sides = np.array([round(100 * side) for side in border], dtype=np.float64).reshape(2, 2, 1)
    # A column each, side by side in memory.
    columns = table.T.copy()
    shares = _shares(columns[:4].reshape(2, 2, -1), sides)
    kept = (shares[0] < shares[1]).nonzero()[0]
    kept = kept.take(columns[_NUMBER].take(kept).argsort())
    columns, shares = columns.take(kept, axis=1), shares.take(kept, axis=1)
    ends, cut = columns[:4].reshape(2, 2, -1), shares != _WHOLE
    np.copyto(ends, _crossings(ends, shares, sides), where=cut[:, None])
    ends = ends / 100
    outline = columns[_OUTLINE].astype(np.int64)
    return Segments(ends[0].T, ends[1].T, columns[_HEIGHT], outline, columns[_NUMBER], cut)


def _shares(ends: NDArray[Any], sides: NDArray[Any]) -> NDArray[Any]:
    """Return the shares of its length between which each of n segments is inside, (2, n) from 0 to 1.

    For one outside, the end is not after the begin. ``ends`` is (2, 2, n) and ``sides`` (2, 2, 1): from
    and to, then x and y.
    """
    a, shares = ends[0], np.empty((2, ends.shape[2]))
    direction = ends[1] - a
    with np.errstate(divide="ignore", invalid="ignore"):
        # For a segment along a side: minus infinity and infinity inside, infinity twice outside, and NaN on
        # the side itself, where the other axis decides.
        low, high = (sides[0] - a) / direction, (sides[1] - a) / direction
    first, last = np.minimum(low, high), np.maximum(low, high)
    np.fmax(first[0], first[1], out=shares[0])
    np.fmin(last[0], last[1], out=shares[1])
    return shares.clip(0.0, 1.0)


def _crossings(ends: NDArray[Any], shares: NDArray[Any], sides: NDArray[Any]) -> NDArray[Any]:
    """Return the places, (2, 2, n), at those shares of segments, in whole centimetres.

    A coordinate near another side of the border, but not on it, stays off it: if rounded onto it, the stub of
    a segment in a corner would become a wall along the border.
    """
    a, limits = ends[0], sides + _INWARDS
    (low, high), beside, reach = limits[0], limits[1], limits[2]
    places = a + shares[:, None] * (ends[1] - a)
    crossings: NDArray[Any] = np.minimum(np.maximum(np.rint(places), beside[0]), beside[1])
    np.copyto(crossings, low, where=places <= reach[0])
    np.copyto(crossings, high, where=places >= reach[1])
    return crossings


# --- Building a robot map from outlines (paper 1, section III.B) ---

__all__ = ["Window", "build_map"]

Rows = slice | NDArray[Any]
"""Selection of segments, in order."""

_SHAPE_TYPES = {int(one): one for one in ShapeType}
_WHEN_CUT = {
    ShapeType.CLOSED_POLYGON: ShapeType.OPEN_POLYGON,
    ShapeType.CLOSED_CURVE: ShapeType.OPEN_CURVE,
}


def build_map(
    outlines: Outlines, window: Window | None = None, meta: Mapping[str, str] | None = None
) -> RobotMap:
    """Return the map of ``outlines`` inside ``window``, or of all of them.

    An outline that the window cuts becomes open chains, each an obstacle, marked by the extra ``cut`` where
    it was a ring. Obstacles are grouped by the first word of their semantics; the id of an outline is its row
    plus one in every window, and each further chain of it adds the number of outlines, so that an id means
    the same outline in every window. ``ext`` names the source. Outlines that are no obstacle (fewer than two
    different points, a ring that encloses nothing, coordinates that are not finite) are left out and rings
    that do not close are closed, each with a warning if it lies in the window or nowhere at all. Raises
    WindowError when there is neither a window nor an outline.
    """
    found = validate_outlines(outlines)
    if window is None:
        near, border = np.ones(len(outlines), dtype=bool), _bounds(found)
    else:
        near, border = found.near(window.border), window.border
    segments = clip(oriented_segments(found.outlines, found.usable & near), border)
    return map_of(found.outlines, segments, border, meta, found.notes_on(near))


class SurroundingOutlines:
    """Finds obstacles that enclose a whole window, of which a map of walls shows nothing.

    Courtyards come after the ring that they are in.
    """

    def __init__(self, outlines: Outlines) -> None:
        found = validate_outlines(outlines)
        self._outlines = found.outlines
        kinds = np.isin(outlines.shape_type, [int(one) for one in _WHEN_CUT])
        self._rings = np.flatnonzero(found.usable & kinds & ~outlines.courtyard)
        self._low, self._high = found.low[self._rings], found.high[self._rings]

    def around(self, border: Border) -> list[str]:
        """Return the sources of the obstacles that enclose all of ``border``."""
        low, high = (border.x_min, border.y_min), (border.x_max, border.y_max)
        near = (self._low < low).all(axis=1) & (self._high > high).all(axis=1)
        return [self._outlines.source[k] for k in self._rings[near].tolist() if self._is_around(k, border)]

    def _is_around(self, shell: int, border: Border) -> bool:
        rows, outlines = [shell], self._outlines
        for k in range(shell + 1, len(outlines)):
            if not outlines.courtyard[k] or outlines.source[k] != outlines.source[shell]:
                break
            rows.append(k)
        own = outlines.chosen(np.array(rows))
        segments = oriented_segments(own, np.ones(len(own), dtype=bool))
        if len(clip(segments, border).a):
            return False
        # No wall is inside: an obstacle that holds its middle holds all of it.
        x, y = (border.x_min + border.x_max) / 2, (border.y_min + border.y_max) / 2
        across = (segments.a[:, 1] > y) != (segments.b[:, 1] > y)
        a, b = segments.a[across], segments.b[across]
        at = a[:, 0] + (y - a[:, 1]) * (b[:, 0] - a[:, 0]) / (b[:, 1] - a[:, 1])
        return int((at > x).sum()) % 2 == 1


def map_of(
    outlines: Outlines,
    segments: Segments,
    border: Border,
    meta: Mapping[str, str] | None,
    warnings: tuple[str, ...],
) -> RobotMap:
    """Return the map of ``border`` whose obstacles are the clipped ``segments`` of ``outlines``."""
    segments = without_vanished(segments)
    chains = sorted(
        _numbered(_chains(segments, outlines), len(outlines)),
        key=lambda chain: (group_of(outlines, chain[2]), chain[2], chain[0]),
    )
    obstacles = _built(outlines, segments, chains) if chains else ()
    return RobotMap(border, obstacles, dict(meta or {}), warnings)


def _bounds(found: OutlineValidation) -> Border:
    if not found.usable.any():
        raise WindowError("window: there is no obstacle to take the extent from; give a window")
    (x_min, y_min), (x_max, y_max) = found.low[found.usable].min(axis=0), found.high[found.usable].max(axis=0)
    # A single straight wall has no width; but the map needs a border with an inside.
    x_spare, y_spare = max(0.0, 0.5 - (x_max - x_min) / 2), max(0.0, 0.5 - (y_max - y_min) / 2)
    return Window.from_bounds(
        float(x_min - x_spare), float(y_min - y_spare), float(x_max + x_spare), float(y_max + y_spare)
    ).border


def _chains(segments: Segments, outlines: Outlines) -> Iterator[tuple[int, Rows, bool]]:
    """Yield outline, segments in their order, and whether they close a ring, for each chain."""
    if not len(segments.outline):
        return
    types = outlines.shape_type[segments.outline]
    begins = np.concatenate([[True], np.diff(segments.outline) != 0])
    run_begins = begins | (~segments.joined & (types != int(ShapeType.STAIRS)))
    starts = np.flatnonzero(run_begins)
    ends = np.append(starts[1:], len(types))
    firsts = np.flatnonzero(begins[starts])
    lasts = np.append(firsts[1:], len(starts)) - 1
    meets = _meet_where_they_begin(segments, outlines, starts[firsts], ends[lasts] - 1).tolist()
    runs = [slice(start, end) for start, end in zip(starts.tolist(), ends.tolist(), strict=True)]
    outline = segments.outline[starts[firsts]].tolist()
    for k, (first, last) in enumerate(zip(firsts.tolist(), lasts.tolist(), strict=True)):
        own = runs[first : last + 1]
        if meets[k] and len(own) == 1:
            yield outline[k], own[0], True
            continue
        if meets[k]:
            # The last run of a ring continues in the first.
            both = (own[-1], own[0])
            round_corner = np.concatenate([np.arange(some.start, some.stop) for some in both])
            yield outline[k], round_corner, False
            own = own[1:-1]
        for run in own:
            yield outline[k], run, False


def _meet_where_they_begin(
    segments: Segments, outlines: Outlines, first: NDArray[Any], last: NDArray[Any]
) -> NDArray[Any]:
    """Return which outlines are rings whose segments, ``first`` to ``last``, pass their first point.

    Not any two coincident cuts: the ring's own first corner.
    """
    outline = segments.outline[first]
    corner = np.round(outlines.coordinates[outlines.offsets[outline]], 2)
    meets: NDArray[Any] = (
        is_closed(outlines.shape_type[outline])
        & (segments.b[last] == corner).all(axis=1)
        & (segments.a[first] == corner).all(axis=1)
    )
    return meets


def _numbered(chains: Iterable[tuple[int, Rows, bool]], rows: int) -> Iterator[tuple[int, Rows, int, bool]]:
    """Yield id, segments, outline and whether closed, for each chain; ``rows`` is the number of outlines."""
    count: Counter[int] = Counter()
    for outline, indices, closed in chains:
        yield outline + 1 + count[outline] * rows, indices, outline, closed
        count[outline] += 1


def group_of(outlines: Outlines, outline: int) -> str:
    """Return the word by which the obstacles of ``outline`` are grouped."""
    return outlines.semantics[outline].partition(",")[0]


def _built(
    outlines: Outlines, segments: Segments, chains: Sequence[tuple[int, Rows, int, bool]]
) -> BuiltObstacles:
    """Return the obstacles of ``chains``, in their order: id, segments, outline and whether it is closed."""
    rows: list[int] = []
    offsets, shape_types, extras = [0], [], []
    types = outlines.shape_type[[outline for _, _, outline, _ in chains]].tolist()
    for (_, own, outline, closed), number in zip(chains, types, strict=True):
        rows += range(own.start, own.stop) if isinstance(own, slice) else own.tolist()
        offsets.append(len(rows))
        shape_type = _SHAPE_TYPES[number]
        shape_types.append(shape_type if closed else _WHEN_CUT.get(shape_type, shape_type))
        extras.append(_ext(outlines, outline, cut=not closed and shape_type in CLOSED_TYPES))
    order = np.array(rows, dtype=np.int64)
    return BuiltObstacles(
        ids=[id for id, _, _, _ in chains],
        shape_types=shape_types,
        semantics=[outlines.semantics[outline] for _, _, outline, _ in chains],
        ext=extras,
        offsets=offsets,
        a=segments.a[order],
        b=segments.b[order],
        height=np.round(segments.height[order], 2),
        outdoor=outlines.outdoor[segments.outline[order]],
    )


def _ext(outlines: Outlines, outline: int, cut: bool) -> dict[str, str]:
    source = outlines.source[outline]
    extras = {"src": source} if source else {}
    if outlines.ext is not None:
        extras.update(outlines.ext[outline])
    if cut:
        extras[CUT] = "1"
    return extras

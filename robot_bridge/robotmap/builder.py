"""Builds a robot map from outlines (paper 1, section III.B)."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .clipping import clip
from .errors import WindowError
from .model import CUT, Border, Obstacle, RobotMap, ShapeType
from .outlines import Outlines
from .segments import CLOSED_TYPES, Segments, is_closed, oriented_segments, without_vanished
from .usable import Inspection, inspected
from .window import Window

__all__ = ["Window", "build_map"]

Rows = slice | NDArray[Any]
"""Which segments, in their order."""

_WHEN_CUT = {
    ShapeType.CLOSED_POLYGON: ShapeType.OPEN_POLYGON,
    ShapeType.CLOSED_CURVE: ShapeType.OPEN_CURVE,
}


def build_map(
    outlines: Outlines, window: Window | None = None, meta: Mapping[str, str] | None = None
) -> RobotMap:
    """Return the map of ``outlines`` inside ``window``, or of all of them.

    An outline that the window cuts becomes open chains, each an obstacle, marked by the extra ``cut`` where
    it was a ring. Obstacles are grouped by the first word of their semantics; the id of an outline is its
    row plus one in every window, each further chain of it has the number of outlines more, so that no id
    means another outline in another window. ``ext`` names the source. Outlines that are
    no obstacle (fewer than two different points, a ring that encloses nothing, coordinates that are not
    finite) are left out and rings that do not close are closed, each with a warning if it lies
    in the window or nowhere at all. Raises WindowError when there is neither a window nor an outline.
    """
    found = inspected(outlines)
    if window is None:
        near, border = np.ones(len(outlines), dtype=bool), _bounds(found)
    else:
        near, border = found.near(window.border), window.border
    segments = clip(oriented_segments(found.outlines, found.usable & near), border)
    return map_of(found.outlines, segments, border, meta, found.notes_on(near))


def map_of(
    outlines: Outlines,
    segments: Segments,
    border: Border,
    meta: Mapping[str, str] | None,
    warnings: tuple[str, ...],
) -> RobotMap:
    """Return the map of ``border`` whose obstacles are the clipped ``segments`` of ``outlines``."""
    segments = without_vanished(segments)
    obstacles = sorted(
        _numbered(_chains(segments, outlines), len(outlines)),
        key=lambda item: (group_of(outlines, item[2]), item[2], item[0]),
    )
    heights, outdoor = np.round(segments.height, 2), outlines.outdoor[segments.outline]
    return RobotMap(
        border=border,
        obstacles=tuple(
            _obstacle(outlines, segments, heights[rows], outdoor[rows], id, rows, outline, closed)
            for id, rows, outline, closed in obstacles
        ),
        meta=dict(meta or {}),
        warnings=warnings,
    )


def _bounds(found: Inspection) -> Border:
    if not found.usable.any():
        raise WindowError("window: there is no obstacle to take the extent from; give a window")
    (x_min, y_min), (x_max, y_max) = found.low[found.usable].min(axis=0), found.high[found.usable].max(axis=0)
    # A single straight wall has no width; the map still needs a border with an inside.
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
            # The last run of a ring goes on in the first.
            both = (own[-1], own[0])
            round_corner = np.concatenate([np.arange(some.start, some.stop) for some in both])
            yield outline[k], round_corner, False
            own = own[1:-1]
        for run in own:
            yield outline[k], run, False


def _meet_where_they_begin(
    segments: Segments, outlines: Outlines, first: NDArray[Any], last: NDArray[Any]
) -> NDArray[Any]:
    """Tell which outlines are rings whose segments, from ``first`` to ``last``, go through their first point.

    Not any two cuts that fall on one point: the ring's own first corner.
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
    """Yield id, segments, outline and whether closed, for each chain; ``rows`` outlines there are."""
    count: Counter[int] = Counter()
    for outline, indices, closed in chains:
        yield outline + 1 + count[outline] * rows, indices, outline, closed
        count[outline] += 1


def group_of(outlines: Outlines, outline: int) -> str:
    """Return the word by which the obstacles of ``outline`` are grouped."""
    return outlines.semantics[outline].partition(",")[0]


def _obstacle(
    outlines: Outlines,
    segments: Segments,
    heights: NDArray[Any],
    outdoor: NDArray[Any],
    id: int,
    rows: Rows,
    outline: int,
    closed: bool,
) -> Obstacle:
    shape_type = ShapeType(int(outlines.shape_type[outline]))
    return Obstacle(
        id=id,
        shape_type=shape_type if closed else _WHEN_CUT.get(shape_type, shape_type),
        semantics=outlines.semantics[outline],
        a=segments.a[rows],
        b=segments.b[rows],
        height=heights,
        outdoor=outdoor,
        segment_semantics=("",) * len(heights),
        ext=_ext(outlines, outline, cut=not closed and shape_type in CLOSED_TYPES),
    )


def _ext(outlines: Outlines, outline: int, cut: bool) -> dict[str, str]:
    source = outlines.source[outline]
    extras = {"src": source} if source else {}
    if outlines.ext is not None:
        extras.update(outlines.ext[outline])
    if cut:
        extras[CUT] = "1"
    return extras

"""Builds a robot map from outlines (paper 1, section III.B)."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .errors import WindowError
from .model import Border, Obstacle, RobotMap, ShapeType
from .outlines import Outlines
from .segments import Segments, clip, is_closed, oriented_segments, without_vanished
from .usable import closed_rings, usable_outlines
from .window import Window

__all__ = ["Window", "build_map"]

_WHEN_CUT = {
    ShapeType.CLOSED_POLYGON: ShapeType.OPEN_POLYGON,
    ShapeType.CLOSED_CURVE: ShapeType.OPEN_CURVE,
}


def build_map(
    outlines: Outlines, window: Window | None = None, meta: Mapping[str, str] | None = None
) -> RobotMap:
    """Return the map of ``outlines`` inside ``window``, or of all of them.

    An outline that the window cuts becomes open chains, each an obstacle. Obstacles are grouped by the
    first word of their semantics; the id of an outline is its row plus one in every window, further chains
    of it get ids after the last row. ``ext`` names the source. Outlines that are no obstacle (fewer than two
    different points, a ring that encloses nothing, coordinates that are not finite) are left out and rings
    that do not close are closed, each with a warning if it lies in the window or nowhere at all. Raises
    WindowError when there is neither a window nor an outline.
    """
    border = window.border if window is not None else None
    outlines, closed = closed_rings(outlines, border)
    usable, left_out = usable_outlines(outlines, border)
    border = border or _bounds(outlines, usable)
    segments = without_vanished(clip(oriented_segments(outlines, usable), border))
    chains = list(_chains(segments, outlines))
    obstacles = sorted(
        _numbered(chains, len(outlines)), key=lambda item: (_group(outlines, item[2]), item[2], item[0])
    )
    return RobotMap(
        border=border,
        obstacles=tuple(_obstacle(outlines, segments, *item) for item in obstacles),
        meta=dict(meta or {}),
        warnings=(*closed, *left_out),
    )


def _bounds(outlines: Outlines, usable: NDArray[Any]) -> Border:
    row = np.repeat(np.arange(len(outlines)), np.diff(outlines.offsets))
    points = outlines.coordinates[usable[row]]
    if not len(points):
        raise WindowError("window: there is no obstacle to take the extent from; give a window")
    (x_min, y_min), (x_max, y_max) = points.min(axis=0), points.max(axis=0)
    # A single straight wall has no width; the map still needs a border with an inside.
    x_spare, y_spare = max(0.0, 0.5 - (x_max - x_min) / 2), max(0.0, 0.5 - (y_max - y_min) / 2)
    return Window.from_bounds(
        float(x_min - x_spare), float(y_min - y_spare), float(x_max + x_spare), float(y_max + y_spare)
    ).border


def _chains(segments: Segments, outlines: Outlines) -> Iterator[tuple[int, NDArray[Any], bool]]:
    """Yield outline, indices of segments in their order, and whether they close a ring."""
    if not len(segments.outline):
        return
    starts = np.flatnonzero(np.concatenate([[True], np.diff(segments.outline) != 0]))
    closed = is_closed(outlines.shape_type)
    for start, end in zip(starts, [*starts[1:], len(segments.outline)], strict=True):
        outline = int(segments.outline[start])
        if outlines.shape_type[outline] == ShapeType.STAIRS:
            yield outline, np.arange(start, end), False
            continue
        breaks = np.flatnonzero(~segments.joined[start:end]) + start
        runs = np.split(np.arange(start, end), breaks[1:] - start)
        corner = np.round(outlines.coordinates[outlines.offsets[outline]], 2)
        yield from _joined_runs(segments, outline, runs, bool(closed[outline]), corner)


def _joined_runs(
    segments: Segments, outline: int, runs: list[NDArray[Any]], ring: bool, corner: NDArray[Any]
) -> Iterator[tuple[int, NDArray[Any], bool]]:
    """Yield the runs of one outline; in a ring the last may go on in the first."""
    # Not any two cuts that fall on one point: the ring's own first corner.
    ends = np.array([segments.b[runs[-1][-1]], segments.a[runs[0][0]]])
    meets = ring and bool((ends == corner).all())
    if meets and len(runs) == 1:
        yield outline, runs[0], True
        return
    if meets:
        runs = [np.concatenate([runs[-1], runs[0]]), *runs[1:-1]]
    for run in runs:
        yield outline, run, False


def _numbered(
    chains: list[tuple[int, NDArray[Any], bool]], rows: int
) -> Iterator[tuple[int, NDArray[Any], int, bool]]:
    """Yield id, segments, outline and whether closed, for each chain."""
    seen: set[int] = set()
    extra = rows
    for outline, indices, closed in chains:
        if outline in seen:
            extra += 1
            yield extra, indices, outline, closed
        else:
            seen.add(outline)
            yield outline + 1, indices, outline, closed


def _group(outlines: Outlines, outline: int) -> str:
    return outlines.semantics[outline].partition(",")[0]


def _obstacle(
    outlines: Outlines, segments: Segments, id: int, indices: NDArray[Any], outline: int, closed: bool
) -> Obstacle:
    shape_type = ShapeType(int(outlines.shape_type[outline]))
    return Obstacle(
        id=id,
        shape_type=shape_type if closed else _WHEN_CUT.get(shape_type, shape_type),
        semantics=outlines.semantics[outline],
        a=segments.a[indices],
        b=segments.b[indices],
        height=np.round(segments.height[indices], 2),
        outdoor=np.full(len(indices), outlines.outdoor[outline]),
        segment_semantics=("",) * len(indices),
        ext={"src": outlines.source[outline]} if outlines.source[outline] else {},
    )

"""Builds a robot map from outlines (paper 1, section III.B)."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .errors import WindowError
from .model import Border, Obstacle, RobotMap, ShapeType
from .outlines import Outlines
from .segments import Segments, clip, in_centimetres, is_closed, oriented_segments, signed_areas
from .window import Window

__all__ = ["Window", "build_map"]

SMALLEST_AREA = 1e-4
"""m² below which a ring encloses nothing at the precision of a map."""

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
    different points, a ring that encloses nothing, coordinates that are not finite) are left out with a
    warning. Raises WindowError when there is neither a window nor an outline.
    """
    usable, warnings = _usable(outlines)
    border = window.border if window is not None else _bounds(outlines, usable)
    segments = in_centimetres(clip(oriented_segments(outlines, usable), border))
    chains = list(_chains(segments, outlines))
    obstacles = sorted(
        _numbered(chains, len(outlines)), key=lambda item: (_group(outlines, item[2]), item[2], item[0])
    )
    return RobotMap(
        border=border,
        obstacles=tuple(_obstacle(outlines, segments, *item) for item in obstacles),
        meta=dict(meta or {}),
        warnings=tuple(warnings),
    )


def _usable(outlines: Outlines) -> tuple[NDArray[Any], list[str]]:
    lengths = np.diff(outlines.offsets)
    row = np.repeat(np.arange(len(outlines)), lengths)
    finite = np.ones(len(outlines), dtype=bool)
    finite[row[~np.isfinite(outlines.coordinates).all(axis=1)]] = False
    finite &= np.isfinite(outlines.height)
    short = lengths < np.where(is_closed(outlines.shape_type), 4, 2)
    odd = (outlines.shape_type == ShapeType.STAIRS) & (lengths % 2 == 1)
    with np.errstate(invalid="ignore"):
        flat = is_closed(outlines.shape_type) & (np.abs(signed_areas(outlines)) < SMALLEST_AREA)
    reasons = (
        (~finite, "has a coordinate or a height that is not a finite number"),
        (finite & short, "has too few points"),
        (finite & ~short & flat, "is a ring that encloses nothing"),
        (finite & ~short & odd, "is a flight of stairs whose risers are not pairs of points"),
    )
    warnings = [
        f"{outlines.source[k]}: {reason}; it is left out"
        for bad, reason in reasons
        for k in np.flatnonzero(bad)
    ]
    return finite & ~short & ~flat & ~odd, warnings


def _bounds(outlines: Outlines, usable: NDArray[Any]) -> Border:
    row = np.repeat(np.arange(len(outlines)), np.diff(outlines.offsets))
    points = outlines.coordinates[usable[row]]
    if not len(points):
        raise WindowError("window: there is no obstacle to take the extent from; give a window")
    (x_min, y_min), (x_max, y_max) = points.min(axis=0), points.max(axis=0)
    return Window.from_bounds(float(x_min), float(y_min), float(x_max), float(y_max)).border


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
        yield from _joined_runs(segments, outline, runs, bool(closed[outline]))


def _joined_runs(
    segments: Segments, outline: int, runs: list[NDArray[Any]], ring: bool
) -> Iterator[tuple[int, NDArray[Any], bool]]:
    """Yield the runs of one outline; in a ring the last may go on in the first."""
    meets = ring and bool((segments.b[runs[-1][-1]] == segments.a[runs[0][0]]).all())
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
        height=segments.height[indices],
        outdoor=np.full(len(indices), outlines.outdoor[outline]),
        segment_semantics=("",) * len(indices),
        ext={"src": outlines.source[outline]} if outlines.source[outline] else {},
    )

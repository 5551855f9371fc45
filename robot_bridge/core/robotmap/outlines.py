"""Obstacle outlines as arrays: their segments and their validation."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .model import Border, ShapeType

# --- Obstacle outlines as plain arrays: the common input of the map builder


@dataclass(frozen=True)
class Outlines:
    """K outlines (rings, walls, flights of stairs) of one site, in the site frame, metres.

    One row is one ring or one line; a polygon with two courtyards is three rows. Rings repeat their first
    point at the end. The direction of the points does not matter for rings: the builder turns solid
    rings counter-clockwise and courtyards clockwise, so that free space lies to the right of a→b.
    Rows of kind stairs hold one riser after another, bottom first, two points each.
    """

    coordinates: NDArray[Any]
    """(N, 2) float64, x and y of all outlines one after the other."""
    offsets: NDArray[Any]
    """(K + 1,) int64, outline k is ``coordinates[offsets[k]:offsets[k + 1]]``."""
    shape_type: NDArray[Any]
    """(K,) int8, a :class:`ShapeType` each, as the outline is before any clipping."""
    courtyard: NDArray[Any]
    """(K,) bool, true where the free space is inside the ring."""
    height: NDArray[Any]
    """(K,) float64, metres above the ground; 0 if the obstacle has none (ramps)."""
    outdoor: NDArray[Any]
    """(K,) bool."""
    semantics: Sequence[str]
    """K labels, such as ``building,A5``."""
    source: Sequence[str]
    """K names of where the outline comes from, such as ``buildings:12``; used in warnings and in ``ext``."""
    base: NDArray[Any] | None = None
    """(K,) float64, metres above the ground where the obstacle begins; None if all stand on it."""
    ext: Sequence[Mapping[str, str]] | None = None
    """K mappings of further properties of an obstacle, such as a ramp's normal; or None."""

    def __len__(self) -> int:
        return len(self.shape_type)

    @classmethod
    def from_rows(cls, rows: Sequence[OutlineRow]) -> Outlines:
        """Return the outlines of ``rows`` in their order."""
        points = [np.asarray(row.points, dtype=np.float64).reshape(-1, 2) for row in rows]
        lengths = np.array([len(p) for p in points], dtype=np.int64)
        return cls(
            coordinates=np.concatenate(points) if points else np.empty((0, 2)),
            offsets=np.concatenate([np.zeros(1, dtype=np.int64), np.cumsum(lengths, dtype=np.int64)]),
            shape_type=np.array([int(row.shape_type) for row in rows], dtype=np.int8),
            courtyard=np.array([row.courtyard for row in rows], dtype=bool),
            height=np.array([row.height for row in rows], dtype=np.float64),
            outdoor=np.array([row.outdoor for row in rows], dtype=bool),
            semantics=[row.semantics for row in rows],
            source=[row.source for row in rows],
            base=np.array([row.base for row in rows], dtype=np.float64)
            if any(r.base for r in rows)
            else None,
            ext=[row.ext for row in rows] if any(row.ext for row in rows) else None,
        )

    @classmethod
    def joined(cls, parts: Sequence[Outlines]) -> Outlines:
        """Return the outlines of ``parts`` one after the other."""
        if len(parts) == 1:
            return parts[0]
        if not parts:
            return cls.from_rows([])
        starts = np.cumsum([0, *(len(part.coordinates) for part in parts)])
        based = any(part.base is not None for part in parts)
        extended = any(part.ext is not None for part in parts)
        return cls(
            coordinates=np.concatenate([part.coordinates for part in parts]),
            offsets=np.concatenate(
                [
                    *(part.offsets[:-1] + start for part, start in zip(parts, starts, strict=False)),
                    starts[-1:],
                ]
            ),
            shape_type=np.concatenate([part.shape_type for part in parts]),
            courtyard=np.concatenate([part.courtyard for part in parts]),
            height=np.concatenate([part.height for part in parts]),
            outdoor=np.concatenate([part.outdoor for part in parts]),
            semantics=[one for part in parts for one in part.semantics],
            source=[one for part in parts for one in part.source],
            base=np.concatenate([part.bases for part in parts]) if based else None,
            ext=[one for part in parts for one in part.extras] if extended else None,
        )

    @property
    def bases(self) -> NDArray[Any]:
        """(K,) float64, ``base`` of each outline."""
        return self.base if self.base is not None else np.zeros(len(self))

    @property
    def extras(self) -> Sequence[Mapping[str, str]]:
        """K mappings, ``ext`` of each outline."""
        return self.ext if self.ext is not None else [{}] * len(self)

    def points(self, k: int) -> NDArray[Any]:
        """Return the points of outline ``k``, (n, 2)."""
        points: NDArray[Any] = self.coordinates[self.offsets[k] : self.offsets[k + 1]]
        return points

    def chosen(self, rows: NDArray[Any]) -> Outlines:
        """Return the outlines ``rows``, (n,) int64, in that order."""
        starts, places = self.offsets[rows], rows.tolist()
        lengths = self.offsets[rows + 1] - starts
        offsets = np.concatenate([np.zeros(1, dtype=np.int64), np.cumsum(lengths)])
        point = np.repeat(starts - offsets[:-1], lengths) + np.arange(offsets[-1])
        return Outlines(
            coordinates=self.coordinates[point],
            offsets=offsets,
            shape_type=self.shape_type[rows],
            courtyard=self.courtyard[rows],
            height=self.height[rows],
            outdoor=self.outdoor[rows],
            semantics=[self.semantics[k] for k in places],
            source=[self.source[k] for k in places],
            base=None if self.base is None else self.base[rows],
            ext=None if self.ext is None else [self.ext[k] for k in places],
        )

    def row(self, k: int) -> OutlineRow:
        """Return outline ``k`` by itself."""
        return OutlineRow(
            points=self.points(k),
            shape_type=ShapeType(int(self.shape_type[k])),
            height=float(self.height[k]),
            semantics=self.semantics[k],
            source=self.source[k],
            courtyard=bool(self.courtyard[k]),
            outdoor=bool(self.outdoor[k]),
            base=float(self.base[k]) if self.base is not None else 0.0,
            ext=self.ext[k] if self.ext is not None else {},
        )

    def rows(self) -> list[OutlineRow]:
        """Return all outlines one by one."""
        return [self.row(k) for k in range(len(self))]


@dataclass(frozen=True)
class OutlineRow:
    """One outline as input of :class:`Outlines`; ``points`` is (n, 2), metres, site frame."""

    points: NDArray[Any]
    shape_type: ShapeType
    height: float
    semantics: str
    source: str
    courtyard: bool = False
    outdoor: bool = True
    base: float = 0.0
    ext: Mapping[str, str] = field(default_factory=dict)


# --- Conversion of outlines to oriented segments; vectorised ---

CLOSED_TYPES = (ShapeType.CLOSED_POLYGON, ShapeType.CLOSED_CURVE, ShapeType.RAMP)
_IS_CLOSED = np.array([t in [int(closed) for closed in CLOSED_TYPES] for t in range(len(ShapeType) + 1)])


@dataclass(frozen=True)
class Segments:
    """n oriented segments in the order of their outlines.

    ``outline`` is the row each belongs to. ``number`` increases; a segment that continues the one before it
    in its outline has the next number, any other one a larger number. ``cut``, (2, n) bool, flags those cut
    at their beginning, and at their end.
    """

    a: NDArray[Any]
    b: NDArray[Any]
    height: NDArray[Any]
    outline: NDArray[Any]
    number: NDArray[Any]
    cut: NDArray[Any]

    @property
    def joined(self) -> NDArray[Any]:
        """Whether each begins where the one before it in the arrays ends, neither cut there, (n,) bool."""
        joined = np.zeros(len(self.number), dtype=bool)
        joined[1:] = (np.diff(self.number) == 1) & ~self.cut[1, :-1] & ~self.cut[0, 1:]
        return joined


def uncut(
    a: NDArray[Any], b: NDArray[Any], height: NDArray[Any], outline: NDArray[Any], joined: NDArray[Any]
) -> Segments:
    """Return uncut segments; ``joined`` flags those that continue the one before them."""
    return Segments(a, b, height, outline, np.cumsum(2 - joined), np.zeros((2, len(a)), dtype=bool))


def is_closed(shape_type: NDArray[Any]) -> NDArray[Any]:
    """Return which shape types, (K,), are rings."""
    closed: NDArray[Any] = _IS_CLOSED.take(shape_type, mode="clip")
    return closed


def signed_areas(outlines: Outlines) -> NDArray[Any]:
    """Return the area of each outline, (K,) m², positive where its points run counter-clockwise."""
    if not len(outlines.coordinates):
        return np.zeros(len(outlines))
    lengths = np.diff(outlines.offsets)
    row = np.repeat(np.arange(len(outlines)), lengths)
    filled = lengths > 0
    # Relative to each outline's first point: UTM-sized coordinates would cost six digits.
    first = np.zeros((len(outlines), 2))
    first[filled] = outlines.coordinates[outlines.offsets[:-1][filled]]
    x, y = (outlines.coordinates - first[row]).T
    cross = np.zeros(len(x))
    cross[:-1] = x[:-1] * y[1:] - x[1:] * y[:-1]
    cross[outlines.offsets[1:][filled] - 1] = 0.0
    return np.bincount(row, weights=cross, minlength=len(outlines)) / 2


def oriented_segments(outlines: Outlines, usable: NDArray[Any]) -> Segments:
    """Return the segments of the outlines marked in ``usable``, (K,) bool.

    Solid rings run counter-clockwise, courtyards clockwise: free space is to the right of a→b. Lines keep the
    direction they were drawn in. Each riser of stairs is a segment, the last of height 0; the way up is on
    its left, so that it is seen from below (paper 1, section II). Coordinates are rounded to centimetres
    here, before any clipping, so that a corner is the same in every window.
    """
    coordinates = np.round(outlines.coordinates, 2)
    lengths = np.diff(outlines.offsets)
    row = np.repeat(np.arange(len(outlines)), lengths)
    index = np.arange(len(row)) - outlines.offsets[:-1][row]
    stairs = outlines.shape_type == ShapeType.STAIRS
    begins = (index < lengths[row] - 1) & (~stairs[row] | (index % 2 == 0)) & usable[row]
    start = np.flatnonzero(begins)
    a, b, outline = coordinates[start], coordinates[start + 1], row[start]
    height = outlines.height[outline].astype(np.float64)
    height[stairs[outline] & (index[start] >= lengths[outline] - 2)] = 0.0
    joined = np.zeros(len(start), dtype=bool)
    joined[1:] = (outline[1:] == outline[:-1]) & ~stairs[outline[1:]]
    if stairs.any():
        turn = _seen_from_above(outlines, a, b, outline)[:, None]
        a, b = np.where(turn, b, a), np.where(turn, a, b)
    segments = uncut(a, b, height, outline, joined)
    backwards = is_closed(outlines.shape_type) & ((signed_areas(outlines) > 0) == outlines.courtyard)
    return _turned_round(segments, backwards) if backwards.any() else segments


def _seen_from_above(
    outlines: Outlines, a: NDArray[Any], b: NDArray[Any], outline: NDArray[Any]
) -> NDArray[Any]:
    """Return which segments are risers with the way up on their right."""
    stairs = outlines.shape_type[outline] == ShapeType.STAIRS
    first, last = outlines.offsets[outline], outlines.offsets[outline + 1] - 1
    points = outlines.coordinates
    top = points[np.maximum(last - 1, first)] + points[last]
    up, along = top - points[first] - points[np.minimum(first + 1, last)], b - a
    above: NDArray[Any] = stairs & (along[:, 0] * up[:, 1] - along[:, 1] * up[:, 0] < 0)
    return above


def _turned_round(segments: Segments, backwards: NDArray[Any]) -> Segments:
    """Return the segments with those of the outlines in ``backwards`` in the opposite direction and order."""
    turned = np.flatnonzero(backwards[segments.outline])
    ends = np.cumsum(np.bincount(segments.outline, minlength=len(backwards)))
    own = segments.outline[turned]
    first, last = np.concatenate([[0], ends[:-1]])[own], ends[own] - 1
    opposite = first + last - turned
    a, b, height = segments.a.copy(), segments.b.copy(), segments.height.copy()
    a[turned], b[turned], height[turned] = (
        segments.b[opposite],
        segments.a[opposite],
        segments.height[opposite],
    )
    return replace(segments, a=a, b=b, height=height)


def without_vanished(segments: Segments) -> Segments:
    """Return the segments that have a length in centimetres."""
    a, b = segments.a, segments.b
    kept = (a != b).any(axis=1)
    # A chain continues across a vanished segment: its run decides.
    run = np.cumsum(~segments.joined)[kept]
    joined = np.zeros(len(run), dtype=bool)
    joined[1:] = run[1:] == run[:-1]
    return uncut(a[kept], b[kept], segments.height[kept], segments.outline[kept], joined)


# --- Validation of outlines, and notes on those that cannot be obstacles ---

SMALLEST_AREA = 1e-4
"""m² below which a ring encloses nothing at the precision of a map."""


@dataclass(frozen=True)
class OutlineValidation:
    """K outlines whose rings close, which of them can be obstacles, and notes on them.

    ``low`` and ``high``, (K, 2), are the corners of their bounding boxes. Note k is about outline
    ``note_row[k]``; ``note_everywhere`` marks those of outlines without a place. Notes are ordered by kind of
    fault: the first ``note_counts[0]`` are of the first kind, and so on.
    """

    outlines: Outlines
    usable: NDArray[Any]
    low: NDArray[Any]
    high: NDArray[Any]
    notes: tuple[str, ...]
    note_row: NDArray[Any]
    note_everywhere: NDArray[Any]
    note_counts: tuple[int, ...]

    def near(self, border: Border) -> NDArray[Any]:
        """Return which outlines' bounding boxes touch the border's rectangle, (K,) bool."""
        return touching_border(self.low, self.high, border)

    def notes_on(self, near: NDArray[Any]) -> tuple[str, ...]:
        """Return the notes on the outlines marked in ``near``, (K,) bool, and on those without a place."""
        kept = np.flatnonzero(self.note_everywhere | near[self.note_row])
        return tuple(self.notes[k] for k in kept)


def validate_outlines(outlines: Outlines) -> OutlineValidation:
    """Return ``outlines`` with every ring closed, and their faults."""
    outlines, closed = _closed_rings(outlines)
    low, high = _boxes(outlines.coordinates, outlines)
    lengths = np.diff(outlines.offsets)
    finite = _finite(outlines) & np.isfinite(outlines.height)
    ring = is_closed(outlines.shape_type)
    reasons = (
        (~finite, "has a coordinate or a height that is not a finite number"),
        (lengths < np.where(ring, 4, 2), "has too few points"),
        (ring & _flat(outlines), "is a ring that encloses nothing"),
        (
            (outlines.shape_type == ShapeType.STAIRS) & (lengths % 2 == 1),
            "is a flight of stairs whose risers are not pairs of points",
        ),
        (_extent(outlines) < 0.01, "is smaller than a centimetre"),
    )
    usable = np.ones(len(outlines), dtype=bool)
    rows = [closed]
    notes = [f"{outlines.source[k]}: is a ring that does not close; it is closed" for k in closed]
    for bad, reason in reasons:
        rows.append(np.flatnonzero(bad & usable))
        notes += [f"{outlines.source[k]}: {reason}; it is left out" for k in rows[-1]]
        usable &= ~bad
    note_row = np.concatenate(rows)
    everywhere = (~finite | (lengths == 0))[note_row]
    everywhere[: len(closed)] = False
    return OutlineValidation(
        outlines, usable, low, high, tuple(notes), note_row, everywhere, tuple(map(len, rows))
    )


def touching_border(low: NDArray[Any], high: NDArray[Any], border: Border) -> NDArray[Any]:
    """Return which boxes, ``low`` to ``high``, (n, 2) each, touch the border's rectangle, (n,) bool."""
    corner_low, corner_high = (border.x_min, border.y_min), (border.x_max, border.y_max)
    touches: NDArray[Any] = np.all((high >= corner_low) & (low <= corner_high), axis=1)
    return touches


def _closed_rings(outlines: Outlines) -> tuple[Outlines, NDArray[Any]]:
    """Return the outlines with each ring closed by its first point, and the rows of unclosed ones."""
    lengths = np.diff(outlines.offsets)
    ring = np.flatnonzero(is_closed(outlines.shape_type) & (lengths >= 3))
    first, last = outlines.offsets[ring], outlines.offsets[ring + 1] - 1
    ends = outlines.coordinates[[first, last]]
    open_ = ring[((ends[0] != ends[1]) & np.isfinite(ends).all(axis=0)).any(axis=1)] if len(ring) else ring
    if not len(open_):
        return outlines, open_
    added = outlines.coordinates[outlines.offsets[open_]]
    coordinates = np.insert(outlines.coordinates, outlines.offsets[open_ + 1], added, axis=0)
    lengths[open_] += 1
    offsets = np.concatenate([np.zeros(1, dtype=np.int64), np.cumsum(lengths, dtype=np.int64)])
    return replace(outlines, coordinates=coordinates, offsets=offsets), open_


def _finite(outlines: Outlines) -> NDArray[Any]:
    finite = np.ones(len(outlines), dtype=bool)
    finite[_row(outlines)[~np.isfinite(outlines.coordinates).all(axis=1)]] = False
    return finite


def _flat(outlines: Outlines) -> NDArray[Any]:
    with np.errstate(invalid="ignore"):
        flat: NDArray[Any] = np.abs(signed_areas(outlines)) < SMALLEST_AREA
    return flat


def _extent(outlines: Outlines) -> NDArray[Any]:
    """Return the longer side of each outline's bounding box in whole centimetres, (K,) metres."""
    low, high = _boxes(np.round(outlines.coordinates, 2), outlines)
    with np.errstate(invalid="ignore"):
        # A centimetre is a little less than 0.01 in the difference of two large coordinates.
        extent: NDArray[Any] = np.round((high - low).max(axis=1), 2)
    return extent


def _boxes(coordinates: NDArray[Any], outlines: Outlines) -> tuple[NDArray[Any], NDArray[Any]]:
    """Return the lower and upper corners, (K, 2) each, of all outlines; without points, an inverted box."""
    low, high = np.full((len(outlines), 2), np.inf), np.full((len(outlines), 2), -np.inf)
    filled = np.diff(outlines.offsets) > 0
    if filled.any():
        starts = outlines.offsets[:-1][filled]
        low[filled] = np.minimum.reduceat(coordinates, starts)
        high[filled] = np.maximum.reduceat(coordinates, starts)
    return low, high


def _row(outlines: Outlines) -> NDArray[Any]:
    return np.repeat(np.arange(len(outlines)), np.diff(outlines.offsets))

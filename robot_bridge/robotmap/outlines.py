"""Obstacle outlines as plain arrays: what every source of geometry is turned into before a map is built."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .model import ShapeType


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
    """(K,) float64, metres above the ground; 0 where the obstacle has none (ramps)."""
    outdoor: NDArray[Any]
    """(K,) bool."""
    semantics: Sequence[str]
    """K labels, such as ``building,A5``."""
    source: Sequence[str]
    """K names of where the outline comes from, such as ``buildings:12``; used in warnings and in ``ext``."""
    base: NDArray[Any] | None = None
    """(K,) float64, metres above the ground where the obstacle begins; nothing where all stand on it."""
    ext: Sequence[Mapping[str, str]] | None = None
    """K mappings of what else an obstacle has to say, such as a ramp's normal; or nothing."""

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
    """One outline on its way into :class:`Outlines`; ``points`` is (n, 2), metres, site frame."""

    points: NDArray[Any]
    shape_type: ShapeType
    height: float
    semantics: str
    source: str
    courtyard: bool = False
    outdoor: bool = True
    base: float = 0.0
    ext: Mapping[str, str] = field(default_factory=dict)

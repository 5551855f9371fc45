"""Features of one obstacle layer made into outlines, many at a time."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import chain, pairwise
from typing import Any, NamedTuple

import numpy as np
from qgis.core import QgsGeometry

from ...robot_bridge.robotmap.model import ShapeType
from ...robot_bridge.robotmap.outlines import OutlineRow, Outlines
from .feature_values import Values
from .feature_warnings import FeatureWarnings, SomeFeatures
from .parts import FARTHEST_M
from .placing import LayerPlacing
from .ramps import normal_extra
from .roles import RAMP, STAIRS
from .shapes import Shape, shapes_of
from .wkb import Rings

ESTIMATED = {"h": "est"}
"""The extra of an obstacle whose height nobody knows."""

_NO_RINGS = Rings([], [], True)


class ReadFeature(NamedTuple):
    """A feature that counts: its geometry in metres, and what its layer says of it.

    ``rings`` is what the geometry is made of, where that can be told from its bytes and its role wants
    nothing else. ``shapes`` is what it was made into already, such as the template of a point; what there is
    to say of them stands in the notes of ``values``.
    """

    id: int
    geometry: QgsGeometry
    rings: Rings | None
    shapes: Sequence[Shape] | None
    values: Values


class OutlineBatch:
    """Makes the outlines of the layer ``name`` with ``role``; warns of what was repaired or left out.

    ``unknown`` are features whose height nobody knows, ``odd_for_role`` those that such a layer should not
    hold.
    """

    def __init__(self, name: str, role: str, placing: LayerPlacing, warnings: FeatureWarnings) -> None:
        self._name, self._role, self._placing, self._warnings = name, role, placing, warnings
        self.unknown = SomeFeatures()
        self.odd_for_role = SomeFeatures()

    def outlines(self, features: Sequence[ReadFeature]) -> Iterator[Outlines]:
        """Yield the outlines of ``features`` in their order.

        Sound lines and polygons together, which is quick; each of the others by itself.
        """
        if not features:
            return
        table = _RingTable(features)
        changes = np.flatnonzero(table.sound[1:] != table.sound[:-1]) + 1
        edges = [0, *changes.tolist(), len(features)]
        for first, last in pairwise(edges):
            some = features[first:last]
            if table.sound[first]:
                yield self._together(some, *table.slice(first, last))
            else:
                rows = [row for feature in some for row in self._one_by_one(feature)]
                if rows:
                    yield Outlines.from_rows(rows)

    def _together(
        self, features: Sequence[ReadFeature], coordinates: np.ndarray, lengths: np.ndarray
    ) -> Outlines:
        counts = [len(feature.rings.points) for feature in features if feature.rings is not None]
        values = [feature.values for feature in features]
        for feature in features:
            if feature.values.unknown:
                self.unknown.add(feature.id)
            for note in feature.values.notes:
                self._warnings.add(self._name, feature.id, note)
        closed = [feature.rings.closed for feature in features if feature.rings is not None]
        base = np.repeat([one.base for one in values], counts)
        estimated = any(one.estimated for one in values)
        offsets = np.concatenate([[0], np.cumsum(lengths)])
        points = np.array(self._placing.to_site(coordinates))
        # The frame may place the two ends of a ring a rounding error apart.
        rings = np.flatnonzero(np.repeat(closed, counts))
        points[offsets[rings + 1] - 1] = points[offsets[rings]]
        kinds = np.where(closed, int(ShapeType.CLOSED_POLYGON), int(ShapeType.OPEN_POLYGON))
        return Outlines(
            coordinates=points,
            offsets=offsets,
            shape_type=np.repeat(kinds, counts).astype(np.int8),
            courtyard=np.array([one for f in features if f.rings is not None for one in f.rings.inner]),
            height=np.repeat([one.height for one in values], counts),
            outdoor=np.repeat([one.outdoor for one in values], counts),
            semantics=_repeated([one.semantics for one in values], counts),
            source=_repeated([f"{self._name}:{feature.id}" for feature in features], counts),
            base=base if base.any() else None,
            ext=_repeated([ESTIMATED if one.estimated else {} for one in values], counts)
            if estimated
            else None,
        )

    def _one_by_one(self, feature: ReadFeature) -> list[OutlineRow]:
        shapes, notes = feature.shapes, list(feature.values.notes)
        if shapes is None:
            shapes, said = shapes_of(feature.geometry, self._role)
            notes = [*said, *(notes if shapes else [])]
        rows = self._rows(feature, shapes, notes) if shapes else []
        for note in notes:
            self._warnings.add(self._name, feature.id, note)
        return rows

    def _rows(self, feature: ReadFeature, shapes: Sequence[Shape], notes: list[str]) -> list[OutlineRow]:
        values = feature.values
        if values.unknown:
            self.unknown.add(feature.id)
        if any(_odd(shape, self._role) for shape in shapes):
            self.odd_for_role.add(feature.id)
        rows: list[OutlineRow] = []
        ext: dict[str, str] = {}
        for shape in shapes:
            points = np.array(self._placing.to_site(shape.points))
            if shape.closed:
                points[-1] = points[0]
            if not shape.courtyard:
                # A courtyard is in the surface of the ring around it and says the same.
                ext = _extras(shape, points, values.estimated, notes)
            rows.append(
                OutlineRow(
                    points=points,
                    shape_type=shape.shape_type,
                    height=values.height,
                    semantics=values.semantics,
                    source=f"{self._name}:{feature.id}",
                    courtyard=shape.courtyard,
                    outdoor=values.outdoor,
                    base=values.base,
                    ext=ext,
                )
            )
        return rows


class _RingTable:
    """The rings of many features one after the other, and which features are ``sound``, (n,) bool.

    Sound are those that need no repair and no word: closed rings of three corners or more that are valid
    together, lines without repeated points, every coordinate a number on Earth.
    """

    def __init__(self, features: Sequence[ReadFeature]) -> None:
        rings = [feature.rings or _NO_RINGS for feature in features]
        points = list(chain.from_iterable(one.points for one in rings))
        counts = np.array([len(one.points) for one in rings])
        self._coordinates = np.frombuffer(b"".join(points), "<f8").reshape(-1, 2)
        self._lengths = np.array([len(one) for one in points], dtype=np.int64) // 16
        self._first_ring = np.concatenate([[0], np.cumsum(counts)])
        self._first_point = np.concatenate([[0], np.cumsum(self._lengths)])
        closed = np.array([one.closed for one in rings], dtype=bool)
        self.sound = counts > 0
        odd = self._odd_rings(np.repeat(closed, counts))
        self.sound[np.repeat(np.arange(len(rings)), counts)[odd]] = False
        for k in np.flatnonzero(self.sound & closed).tolist():
            self.sound[k] = features[k].shapes is not None or features[k].geometry.isGeosValid()

    def slice(self, first: int, last: int) -> tuple[np.ndarray, np.ndarray]:
        """Return the coordinates, (m, 2), of features ``first`` to ``last``, and the length of each ring."""
        low, high = self._first_ring[first], self._first_ring[last]
        return self._coordinates[self._first_point[low] : self._first_point[high]], self._lengths[low:high]

    def _odd_rings(self, closed: np.ndarray) -> np.ndarray:
        """Tell of each ring whether it needs a closer look; ``closed`` says which of them are no lines."""
        odd: np.ndarray = self._lengths < np.where(closed, 4, 2)
        xy = self._coordinates
        if not len(xy):
            return odd
        last = len(xy) - 1
        starts = np.minimum(self._first_point[:-1], last)
        ends = np.clip(self._first_point[1:] - 1, 0, last)
        odd |= closed & (xy[starts] != xy[ends]).any(axis=1)
        ring = np.repeat(np.arange(len(odd)), self._lengths)
        # So that what is no number is none on Earth either.
        odd[ring[~(np.abs(xy) <= FARTHEST_M).all(axis=1)]] = True
        repeated = (xy[1:] == xy[:-1]).all(axis=1) & (ring[1:] == ring[:-1]) & ~closed[ring[1:]]
        odd[ring[1:][repeated]] = True
        return odd


def _repeated(values: Sequence[Any], counts: Sequence[int]) -> list[Any]:
    return [value for value, count in zip(values, counts, strict=True) for _ in range(count)]


def _extras(shape: Shape, points: np.ndarray, estimated: bool, notes: list[str]) -> dict[str, str]:
    """Return what else ``shape`` has to say, whose ``points`` are (n, 2) in the site frame."""
    if shape.z is not None:
        return normal_extra(points, shape.z, notes)
    return dict(ESTIMATED) if estimated else {}


def _odd(shape: Shape, role: str) -> bool:
    """Tell whether a layer of ``role`` should not hold this shape."""
    return (role == STAIRS and shape.closed) or (role == RAMP and not shape.closed)

"""Points of a layer with the values of their fields, as cones, robots and stores are read."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from qgis.core import NULL, QgsFeature

from ..language import tr
from .errors import LayerReadingError
from .placing import LayerPlacing, PlacingError


@dataclass(frozen=True)
class PointRow:
    """One feature: what it is called in errors, its name, its place (metres, site frame), its values."""

    where: str
    name: str
    x: float
    y: float
    values: dict[str, Any]

    def number(self, field: str, otherwise: float) -> float:
        """Return the number in ``field``; ``otherwise`` where the layer has no such field, or no value.

        :raises LayerReadingError: when it holds something else.
        """
        value = self.values.get(field)
        if value is None or value == "":
            return otherwise
        try:
            number = float(value)
        except (TypeError, ValueError):
            number = math.nan
        if not math.isfinite(number):
            raise LayerReadingError(
                tr(
                    "{layer}: {field} is {value!r}, which is no number; correct it.",
                    layer=self.where,
                    field=field,
                    value=value,
                )
            )
        return number

    def whole(self, field: str, otherwise: float) -> int:
        """Return the whole number in ``field``; raises as :meth:`number`."""
        number = self.number(field, otherwise)
        if number != int(number):
            raise LayerReadingError(
                tr(
                    "{layer}: {field} is {value:g}; give a whole number.",
                    layer=self.where,
                    field=field,
                    value=number,
                )
            )
        return int(number)


def point_rows(
    layer: str, features: Iterable[QgsFeature], placing: LayerPlacing, names: Sequence[str]
) -> Iterator[PointRow]:
    """Yield the features of the layer called ``layer``; the first of the fields ``names`` names each.

    One that none of them names is called by its number in the layer.

    :raises LayerReadingError: at a feature that is not one point with a place on the site.
    """
    for feature in features:
        where = tr("{layer}, feature {id}", layer=layer, id=feature.id())
        x, y = _place(feature, placing, where)
        values = {
            field: None if value == NULL else value
            for field, value in zip(feature.fields().names(), feature.attributes(), strict=True)
        }
        named = (str(values[field]) for field in names if values.get(field) not in (None, ""))
        yield PointRow(where, next(named, str(feature.id())), x, y, values)


def _place(feature: QgsFeature, placing: LayerPlacing, where: str) -> tuple[float, float]:
    try:
        # Named, since its vertices do not keep it alive.
        geometry = placing.to_metres(feature.geometry())
        vertices = [(vertex.x(), vertex.y()) for vertex in geometry.vertices()]
    except PlacingError:
        vertices = []
    if len(vertices) != 1 or not np.isfinite(vertices).all():
        raise LayerReadingError(
            tr("{where} is not one point with a place on the site: correct or delete it.", where=where)
        )
    ((x, y),) = placing.to_site(np.array(vertices)).tolist()
    return x, y

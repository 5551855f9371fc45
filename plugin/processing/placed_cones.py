"""Placed cones, read from what ``robot-bridge placements export`` wrote, and what they come to."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from qgis.core import QgsFeature, QgsProcessingFeatureSource, QgsProcessingFeedback

from ..language import tr
from .errors import ParameterError
from .position_source import seconds

PLACES = ("planned_easting", "planned_northing", "easting", "northing")


@dataclass(frozen=True)
class PlacedCone:
    """One cone: ``planned`` and ``placed`` in CRS metres, ``at`` in seconds since 1970 if known."""

    name: str
    robot: str
    layout: str
    planned: tuple[float, float]
    placed: tuple[float, float]
    at: float | None

    @property
    def off(self) -> tuple[float, float]:
        """How far it stands off its place, in metres east and north."""
        return self.placed[0] - self.planned[0], self.placed[1] - self.planned[1]

    @property
    def deviation(self) -> float:
        """Metres between the two places."""
        # Coordinates of millions of metres leave nothing beyond the micrometre.
        return round(math.hypot(*self.off), 6)


@dataclass(frozen=True)
class Deviations:
    """What the deviations of cones come to, in metres; ``within`` counts those up to the tolerance."""

    count: int
    within: int
    mean: float
    rms: float
    p95: float
    most: float


def deviations(cones: Sequence[PlacedCone], tolerance: float) -> Deviations:
    """Return what the deviations of at least one cone come to."""
    values = values_of(cones)
    return Deviations(
        len(values),
        int((values <= tolerance).sum()),
        float(values.mean()),
        float(np.sqrt((values**2).mean())),
        float(np.percentile(values, 95)),
        float(values.max()),
    )


def values_of(cones: Sequence[PlacedCone]) -> npt.NDArray[np.float64]:
    """Return the deviations of cones."""
    return np.array([cone.deviation for cone in cones])


def read_cones(
    source: QgsProcessingFeatureSource, feedback: QgsProcessingFeedback
) -> tuple[list[PlacedCone], int] | None:
    """Return the cones, and how many features were left out for want of a place; None when cancelled.

    :raises ParameterError: when fields are missing, or there is no cone.
    """
    missing = [name for name in PLACES if name not in source.fields().names()]
    if missing:
        raise ParameterError(
            tr(
                "The placed cones have no field {missing}: give a layer of a GeoPackage, or the CSV, "
                "that 'robot-bridge placements export' wrote.",
                missing=", ".join(missing),
            )
        )
    cones, odd = [], 0
    for feature in source.getFeatures():
        if feedback.isCanceled():
            return None
        cone = _cone(feature)
        if cone is None:
            odd += 1
        else:
            cones.append(cone)
    if not cones:
        raise ParameterError(
            tr(
                "There are no placed cones to report on. Check the filter of the layer, and the options "
                "of 'robot-bridge placements export'."
            )
        )
    return cones, odd


def _cone(feature: QgsFeature) -> PlacedCone | None:
    numbers = [_number(feature.attribute(name)) for name in PLACES]
    if None in numbers:
        return None
    planned_x, planned_y, x, y = numbers
    name = next((t for t in (_text(feature, n) for n in ("label", "cone", "placement")) if t), "")
    return PlacedCone(
        name,
        _text(feature, "robot"),
        _text(feature, "layout"),
        (planned_x, planned_y),
        (x, y),
        seconds(_value(feature, "placed_at")),
    )


def _number(value: object) -> float | None:
    """Return a number, of a CSV's text too; None for what is none."""
    try:
        number = float(value)  # type: ignore[arg-type]
    except (TypeError, ValueError):
        return None
    return number if math.isfinite(number) else None


def _value(feature: QgsFeature, name: str) -> object:
    at = feature.fields().lookupField(name)
    return None if at < 0 else feature.attribute(at)


def _text(feature: QgsFeature, name: str) -> str:
    value = _value(feature, name)
    return "" if value is None or str(value) == "NULL" else str(value)

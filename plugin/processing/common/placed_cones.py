"""Placed cones read from layers, their deviations, and the report's map layers and histogram of them."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from xml.sax.saxutils import escape  # nosec B406 # writes XML, reads none

import numpy as np
import numpy.typing as npt
from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsFeature,
    QgsGeometry,
    QgsLineSymbol,
    QgsMarkerSymbol,
    QgsPalLayerSettings,
    QgsPointXY,
    QgsProcessingFeatureSource,
    QgsProcessingFeedback,
    QgsRectangle,
    QgsSingleSymbolRenderer,
    QgsSymbol,
    QgsVectorLayer,
    QgsVectorLayerSimpleLabeling,
)

from ...layers.layer_source import each_feature, parse_seconds
from ...ui.language import tr
from .algorithm import ParameterError

# --- Placed cones, read from the files of ``robot-bridge placements export``, and their summary ---

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
        """The offset from its planned place, in metres east and north."""
        return self.placed[0] - self.planned[0], self.placed[1] - self.planned[1]

    @property
    def deviation(self) -> float:
        """The distance between the two places in metres."""
        # Coordinates of millions of metres have no precision beyond the micrometre.
        return round(math.hypot(*self.off), 6)


@dataclass(frozen=True)
class ConeDeviations:
    """Summary of the deviations of cones, in metres; ``within`` counts those up to the tolerance."""

    count: int
    within: int
    mean: float
    rms: float
    p95: float
    most: float


def cone_deviations(cones: Sequence[PlacedCone], tolerance: float) -> ConeDeviations:
    """Return the summary of the deviations of at least one cone."""
    values = deviation_values(cones)
    return ConeDeviations(
        len(values),
        int((values <= tolerance).sum()),
        float(values.mean()),
        float(np.sqrt((values**2).mean())),
        float(np.percentile(values, 95)),
        float(values.max()),
    )


def deviation_values(cones: Sequence[PlacedCone]) -> npt.NDArray[np.float64]:
    """Return the deviations of cones."""
    return np.array([cone.deviation for cone in cones])


def read_placed_cones(
    source: QgsProcessingFeatureSource, feedback: QgsProcessingFeedback
) -> tuple[list[PlacedCone], int] | None:
    """Return the cones, and the number of features left out for lack of a place; None if cancelled.

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
    for feature in each_feature(source, feedback):
        cone = _cone(feature)
        if cone is None:
            odd += 1
        else:
            cones.append(cone)
    if feedback.isCanceled():
        return None
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
        parse_seconds(_value(feature, "placed_at")),
    )


def _number(value: object) -> float | None:
    """Return a number, also from a CSV's text; None for anything else."""
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


# --- A histogram of deviations as SVG ---

WIDTH, HEIGHT = 860.0, 400.0
LEFT, RIGHT, TOP, BOTTOM = 70.0, 20.0, 30.0, 62.0
MOST_BARS = 24
WITHIN, BEYOND = "#2a6f97", "#c62828"


def bars(values: npt.NDArray[np.float64], tolerance: float) -> tuple[npt.NDArray, npt.NDArray]:
    """Return counts (k,) and edges (k + 1,) in metres, from 0; the tolerance is one of the edges.

    A value on an edge counts below it, so that a deviation of exactly the tolerance is within it. Values
    beyond the last edge are counted in the last bar.
    """
    most = max(float(values.max()), tolerance)
    step = tolerance / max(1, round(tolerance / _round(most / 12.0)))
    count = min(MOST_BARS, math.ceil(round(most / step, 6)))
    edges = step * np.arange(count + 1)
    below = np.searchsorted(edges, np.round(values, 9), side="left") - 1
    return np.bincount(np.clip(below, 0, count - 1), minlength=count), edges


def histogram(values: npt.NDArray[np.float64], tolerance: float) -> str:
    """Return the histogram of ``values`` in metres, those beyond ``tolerance`` in red."""
    counts, edges = bars(values, tolerance)
    most = int(counts.max())
    x = LEFT + (WIDTH - LEFT - RIGHT) * edges / edges[-1]
    per = (HEIGHT - TOP - BOTTOM) / most
    floor = HEIGHT - BOTTOM
    parts = [_head()]
    for height in ticks(most):
        y = floor - height * per
        parts.append(f'<path d="M{LEFT} {y:.1f}H{WIDTH - RIGHT}" stroke="#ced4da" stroke-width="1"/>')
        parts.append(_svg_text(LEFT - 8, y + 6, str(height), "end"))
    for k, count in enumerate(counts.tolist()):
        colour = WITHIN if edges[k + 1] <= tolerance + 1e-9 else BEYOND
        top, wide = floor - count * per, x[k + 1] - x[k]
        parts.append(
            f'<rect x="{x[k] + 1:.1f}" y="{top:.1f}" width="{max(wide - 2, 1):.1f}" '
            f'height="{count * per:.1f}" fill="{colour}"/>'
        )
    every = max(1, math.ceil(len(edges) / 11))
    parts += [
        _svg_text(x[k], floor + 22, f"{edges[k] * 100:.4g}", "middle") for k in range(0, len(edges), every)
    ]
    if values.max() > edges[-1] + 1e-9:
        parts.append(
            _svg_text(
                WIDTH - RIGHT, HEIGHT - 10, tr("last bar: up to {metres:.2f} m", metres=values.max()), "end"
            )
        )
    at = LEFT + (WIDTH - LEFT - RIGHT) * tolerance / edges[-1]
    line = f'<path d="M{at:.1f} {TOP - 6}V{floor}" stroke="#212529" stroke-width="2" stroke-dasharray="7 5"/>'
    parts += [
        line,
        _svg_text(min(at, WIDTH - 90), TOP - 10, tr("tolerance {cm:.4g} cm", cm=tolerance * 100), "middle"),
    ]
    parts.append(
        f'<path d="M{LEFT} {TOP}V{floor}H{WIDTH - RIGHT}" fill="none" stroke="#212529" stroke-width="1.6"/>'
    )
    parts.append(_svg_text((LEFT + WIDTH - RIGHT) / 2, HEIGHT - 10, tr("deviation in cm"), "middle"))
    upwards = f'<g transform="translate(18 {(TOP + floor) / 2:.1f}) rotate(-90)">'
    parts.append(f"{upwards}{_svg_text(0, 0, tr('cones'), 'middle')}</g>")
    return "\n".join([*parts, "</svg>"])


def _head() -> str:
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH:g}" height="{HEIGHT:g}" '
        f'viewBox="0 0 {WIDTH:g} {HEIGHT:g}" font-family="sans-serif" font-size="17" fill="#212529">'
    )


def _svg_text(x: float, y: float, text: str, anchor: str) -> str:
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}">{escape(text)}</text>'


def _round(step: float) -> float:
    """Return 1, 2 or 5 times a power of ten, no less than ``step`` metres and no less than a millimetre."""
    power = 10.0 ** math.floor(math.log10(max(step, 0.001)))
    return next(power * digit for digit in (1, 2, 5, 10) if power * digit >= max(step, 0.001) - 1e-12)


def ticks(most: int) -> list[int]:
    """Return round numbers of cones from 0 to ``most``, at most six."""
    steps = (digit * 10**power for power in itertools.count() for digit in (1, 2, 5))
    step = next(step for step in steps if most < 6 * step)
    return list(range(0, most + 1, step))


# --- The layers of a report's map: plan, cones, and lines that show deviations enlarged ---

MOST_NAMES = 60
"""Cones up to which names are shown on the map; more names would hide the cones."""
LONGEST_LINE = 0.1
"""Length of the largest deviation as a fraction of the map's width."""
SMALLEST_VIEW = 10.0
"""Metres across."""


def extent_of(cones: Sequence[PlacedCone]) -> QgsRectangle:
    """Return the extent of the map, with a margin."""
    places = np.array([place for cone in cones for place in (cone.planned, cone.placed)])
    (x_min, y_min), (x_max, y_max) = places.min(axis=0), places.max(axis=0)
    extent = QgsRectangle(x_min, y_min, x_max, y_max)
    extent.grow(max(0.08 * max(x_max - x_min, y_max - y_min), (SMALLEST_VIEW - (x_max - x_min)) / 2))
    return extent


def factor_of(cones: Sequence[PlacedCone], width: float) -> int:
    """Return the factor by which deviations are enlarged on a map that is ``width`` metres wide."""
    most = max(cone.deviation for cone in cones)
    factor = LONGEST_LINE * width / most if most > 0 else 1.0
    power = 10.0 ** math.floor(math.log10(max(factor, 1.0)))
    return int(max(1, *(power * digit for digit in (1, 2, 5) if power * digit <= max(factor, 1.0))))


def map_layers(
    cones: Sequence[PlacedCone], crs: QgsCoordinateReferenceSystem, tolerance: float, factor: int
) -> list[QgsVectorLayer]:
    """Return the layers, the uppermost first."""
    good = [cone for cone in cones if cone.deviation <= tolerance]
    bad = [cone for cone in cones if cone.deviation > tolerance]
    plan = {
        "name": "cross2",
        "color": "33,37,41",
        "outline_color": "33,37,41",
        "outline_width": "0.35",
        "size": "2.2",
    }
    layers = [
        _lines("Deviations", crs, cones, factor),
        _points("Planned", crs, cones, True, plan, named=False),
    ]
    for name, those, colour in (("Beyond", bad, "198,40,40"), ("Within", good, "42,111,151")):
        mark = {
            "name": "circle",
            "color": f"{colour},110",
            "outline_color": colour,
            "outline_width": "0.35",
            "size": "2.6",
        }
        layers.append(_points(name, crs, those, False, mark, named=len(cones) <= MOST_NAMES))
    return layers


def _points(
    name: str,
    crs: QgsCoordinateReferenceSystem,
    cones: Sequence[PlacedCone],
    planned: bool,
    mark: dict,
    *,
    named: bool,
) -> QgsVectorLayer:
    shapes = [QgsGeometry.fromPointXY(QgsPointXY(*(c.planned if planned else c.placed))) for c in cones]
    layer = _layer(name, "Point", crs, cones, shapes, QgsMarkerSymbol.createSimple(mark))
    if named:
        settings = QgsPalLayerSettings()
        settings.fieldName = "cone"
        settings.placement, settings.dist = QgsPalLayerSettings.Placement.OrderedPositionsAroundPoint, 1.8
        letters = settings.format()
        letters.setSize(7)
        halo = letters.buffer()
        halo.setEnabled(True)
        halo.setSize(0.6)
        letters.setBuffer(halo)
        settings.setFormat(letters)
        layer.setLabeling(QgsVectorLayerSimpleLabeling(settings))
        layer.setLabelsEnabled(True)
    return layer


def _lines(
    name: str, crs: QgsCoordinateReferenceSystem, cones: Sequence[PlacedCone], factor: int
) -> QgsVectorLayer:
    shapes = []
    for cone in cones:
        (x, y), (east, north) = cone.planned, cone.off
        ends = [QgsPointXY(x, y), QgsPointXY(x + factor * east, y + factor * north)]
        shapes.append(QgsGeometry.fromPolylineXY(ends))
    line = {"line_color": "217,72,15", "line_width": "0.5", "capstyle": "round"}
    return _layer(name, "LineString", crs, cones, shapes, QgsLineSymbol.createSimple(line))


def _layer(
    name: str,
    kind: str,
    crs: QgsCoordinateReferenceSystem,
    cones: Sequence[PlacedCone],
    shapes: list[QgsGeometry],
    symbol: QgsSymbol,
) -> QgsVectorLayer:
    layer = QgsVectorLayer(f"{kind}?field=cone:string", name, "memory")
    layer.setCrs(crs)
    features = []
    for cone, shape in zip(cones, shapes):  # noqa: B905
        feature = QgsFeature(layer.fields())
        feature.setGeometry(shape)
        feature.setAttributes([cone.name])
        features.append(feature)
    layer.dataProvider().addFeatures(features)
    layer.updateExtents()
    layer.setRenderer(QgsSingleSymbolRenderer(symbol))
    return layer

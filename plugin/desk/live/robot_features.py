"""Robots as features: their attributes, geometries, and how they look unless the user styles them."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
from qgis.core import (
    QgsCategorizedSymbolRenderer,
    QgsCoordinateReferenceSystem,
    QgsGeometry,
    QgsMarkerSymbol,
    QgsPalLayerSettings,
    QgsPointXY,
    QgsRendererCategory,
    QgsTextFormat,
    QgsVectorLayer,
    QgsVectorLayerSimpleLabeling,
)

from ....robot_bridge.compass import headings_of
from ....robot_bridge.sites.frame import SiteFrame
from ...language import tr
from ..colours import STATE_COLOURS
from ..picture import STATES, RobotPicture
from ..state_words import ROBOT_STATES

NAME = tr("Robots (live)")
FIELDS = (
    "robot:string",
    "state:string",
    "theta:double",
    "heading_deg:double",
    "v:double",
    "battery:double",
    "status:string",
    "age:double",
    "link:string",
    "command:string",
    "accuracy:double",
)
ALIASES = (
    tr("Robot"),
    tr("State"),
    tr("Theta (rad)"),
    tr("Heading (°)"),
    tr("Speed (m/s)"),
    tr("Battery (0 to 1)"),
    tr("Status"),
    tr("Age (s)"),
    tr("Link"),
    tr("Command"),
    tr("Accuracy (m)"),
)
"""What people read for each of :data:`FIELDS`; expressions go by the fields' names."""
LABEL_OFFSET_MM = 6.5
"""How far below a robot a label is: the live map's arrow and name are above that."""
NAME_AT, STATE_AT, AGE_AT = (FIELDS.index(field) for field in ("robot:string", "state:string", "age:double"))


class RobotFeature(NamedTuple):
    """A robot as the layer shows it: a value for each of :data:`FIELDS`; the place in the site's CRS."""

    values: list[Any]
    place: tuple[float, float] | None

    def since(self, before: RobotFeature) -> dict[int, Any]:
        """Return the values that are others than ``before``, by their fields' places."""
        pairs = zip(self.values, before.values, strict=True)
        return {at: value for at, (value, old) in enumerate(pairs) if value != old}


def made_layer(crs: QgsCoordinateReferenceSystem) -> QgsVectorLayer:
    """Return an empty memory layer in ``crs``."""
    fields = "&".join(f"field={field}" for field in FIELDS)
    layer = QgsVectorLayer(f"Point?{fields}", NAME, "memory")
    layer.setCrs(crs)
    layer.setDisplayExpression('"robot" || \' · \' || "state"')
    layer.setRenderer(_renderer())
    for at, alias in enumerate(ALIASES):
        layer.setFieldAlias(at, alias)
    layer.setLabeling(QgsVectorLayerSimpleLabeling(_labels()))
    layer.setLabelsEnabled(False)
    return layer


def _labels() -> QgsPalLayerSettings:
    """Return how labels look once the user switches them on: legible, and beside what the live map draws."""
    labels = QgsPalLayerSettings()
    labels.fieldName = "state"
    labels.placement = QgsPalLayerSettings.Placement.OverPoint
    labels.yOffset = LABEL_OFFSET_MM
    looks = QgsTextFormat()
    looks.setSize(9)
    around = looks.buffer()
    around.setEnabled(True)
    looks.setBuffer(around)
    labels.setFormat(looks)
    return labels


def features_of(picture: RobotPicture, now: float, rows: slice, frame: SiteFrame) -> list[RobotFeature]:
    """Return what the layer has to say at ``now`` of the robots in ``rows`` of ``picture``."""
    robots = picture.arrays(now, rows)
    turn = frame.theta_to_crs(0.0)
    columns = (
        robots.names,
        [STATES[state].value for state in robots.state.tolist()],
        _or_none(robots.theta),
        _or_none(np.round(headings_of(robots.theta + turn), 2)),
        _or_none(robots.v),
        _or_none(picture.column("battery")[rows]),
        [text or None for text in picture.texts("status", rows)],
        np.round(robots.age, 1).tolist(),
        picture.texts("link", rows),
        [text or None for text in picture.texts("command", rows)],
        _or_none(robots.accuracy),
    )
    on_map = frame.to_crs(robots.xy)
    there = np.isfinite(on_map).all(axis=1).tolist()
    places = [
        tuple(place) if is_there else None for place, is_there in zip(on_map.tolist(), there, strict=True)
    ]
    return [RobotFeature(values, place) for *values, place in zip(*columns, places, strict=True)]


def geometry_at(place: tuple[float, float] | None) -> QgsGeometry:
    """Return a point, or an empty geometry for no place."""
    return QgsGeometry() if place is None else QgsGeometry.fromPointXY(QgsPointXY(*place))


def _or_none(column: npt.NDArray[np.float64]) -> list[float | None]:
    return [None if value != value else value for value in column.tolist()]


def _renderer() -> QgsCategorizedSymbolRenderer:
    """Small dots: the live picture over the map draws the robots themselves."""
    categories = []
    for state in STATES:
        symbol = QgsMarkerSymbol.createSimple(
            {
                "name": "circle",
                "color": STATE_COLOURS[state].name(),
                "outline_color": "#ffffff",
                "outline_width": "0.3",
                "size": "1.6",
            }
        )
        categories.append(QgsRendererCategory(state.value, symbol, ROBOT_STATES[state]))
    return QgsCategorizedSymbolRenderer("state", categories)

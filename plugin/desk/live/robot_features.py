"""Robots as features: their attributes, geometries, and how they look unless the user styles them."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np
from qgis.core import (
    QgsCategorizedSymbolRenderer,
    QgsCoordinateReferenceSystem,
    QgsGeometry,
    QgsMarkerSymbol,
    QgsPointXY,
    QgsRendererCategory,
    QgsVectorLayer,
)

from ....robot_bridge.sites.frame import SiteFrame
from ...language import tr
from ..colours import STATE_COLOURS
from ..picture import STATES, RobotView
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


def made_layer(crs: QgsCoordinateReferenceSystem) -> QgsVectorLayer:
    """Return an empty memory layer in ``crs``."""
    fields = "&".join(f"field={field}" for field in FIELDS)
    layer = QgsVectorLayer(f"Point?{fields}", NAME, "memory")
    layer.setCrs(crs)
    layer.setDisplayExpression('"robot" || \' · \' || "state"')
    # QGIS would ask on closing whether the layer's contents may be lost; they come anew each second.
    layer.setCustomProperty("skipMemoryLayersCheck", 1)
    layer.setRenderer(_renderer())
    return layer


def rows_of(views: Sequence[RobotView], frame: SiteFrame) -> Iterator[tuple[dict[int, object], QgsGeometry]]:
    """Yield the attributes and the geometry of each robot, empty for one without a pose."""
    places = [(view.told["x"], view.told["y"]) if view.has_pose else (0.0, 0.0) for view in views]
    on_map = frame.to_crs(np.array(places, dtype=np.float64).reshape(-1, 2)).tolist()
    turn = frame.heading_to_crs(0.0)
    for view, (x, y) in zip(views, on_map, strict=True):
        told = view.told
        theta = told.get("theta")
        compass = None if theta is None else round((90.0 - math.degrees(theta + turn)) % 360.0, 2)
        values = (
            view.name,
            view.state.value,
            theta,
            compass,
            told.get("v"),
            told.get("battery"),
            told.get("status"),
            round(view.age, 1),
            told.get("link"),
            told.get("command"),
            told.get("accuracy"),
        )
        geometry = QgsGeometry.fromPointXY(QgsPointXY(x, y)) if view.has_pose else QgsGeometry()
        yield dict(enumerate(values)), geometry


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

"""The expression function ``distance_to_robot(robot, geometry, crs)``."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from qgis.core import (
    NULL,
    QgsCoordinateReferenceSystem,
    QgsCoordinateTransform,
    QgsCsException,
    QgsExpression,
    QgsExpressionContext,
    QgsExpressionFunction,
    QgsExpressionNodeFunction,
    QgsFeature,
    QgsGeometry,
    QgsProject,
)

from ..errors import FleetError
from ..language import tr, tr_page
from ..sites.crs_way import check_way
from .place_crs import crs_of_place
from .robots_now import FleetNow

NAME, GROUP = "distance_to_robot", tr("Fleet")
_HELP = tr_page("""
<h3>function distance_to_robot</h3>
<p>Returns how far a robot is from a feature or a geometry, in metres of the site.</p>
<h4>Syntax</h4>
<p><code>distance_to_robot(robot, [geometry], [crs])</code></p>
<h4>Arguments</h4>
<table>
<tr><td><i>robot</i></td><td>its name, as in the Fleet panel</td></tr>
<tr><td><i>geometry</i></td><td>optional; without it, that of the feature that is looked at</td></tr>
<tr><td><i>crs</i></td><td>optional, the CRS of the geometry, such as 'EPSG:4326'; without it, that of the
layer whose feature is looked at, else that of the project</td></tr>
</table>
<h4>Examples</h4>
<ul>
<li><code>distance_to_robot('r1')</code> &rarr; 12.3</li>
<li><code>distance_to_robot('r1', make_point(16.8438, 46.8804), 'EPSG:4326')</code> &rarr; 104.6</li>
<li><code>distance_to_robot('r1') &lt; 5</code> &rarr; true of features near the robot</li>
</ul>
<h4>Notes</h4>
<p>The distance is measured in the plane of the site's CRS; in a polygon it is 0. NULL stands for a robot
whose place is not known, and while this QGIS is connected to no gateway. Places are at most half a second
old; a layer shows them when it is drawn.</p>
""")


class DistanceToRobot(QgsExpressionFunction):
    """Measures from where a robot is now."""

    def __init__(self, fleet: FleetNow):
        parameter = QgsExpressionFunction.Parameter
        parameters = [parameter("robot"), parameter("geometry", True), parameter("crs", True)]
        # Handles NULL itself: an argument that is left out comes as NULL, too.
        super().__init__(NAME, parameters, GROUP, _HELP, lazyEval=False, handlesNull=True)
        self._fleet = fleet

    def isStatic(
        self, _node: QgsExpressionNodeFunction, _parent: QgsExpression, _context: QgsExpressionContext
    ):
        return False

    def usesGeometry(self, _node: QgsExpressionNodeFunction):
        return True

    def referencedColumns(self, _node: QgsExpressionNodeFunction):
        return set()

    def func(
        self,
        values: Sequence[Any],
        context: QgsExpressionContext,
        parent: QgsExpression,
        _node: QgsExpressionNodeFunction,
    ):
        robot, geometry, crs = (None if _is_null(value) else value for value in values)
        robots = self._fleet.robots
        place = None if robots is None or robot is None else robots.place(str(robot))
        if place is None:
            return None
        if geometry is None:
            geometry = context.feature().geometry() if context is not None else None
        if not isinstance(geometry, QgsGeometry):
            parent.setEvalErrorString(
                tr(
                    "{function}: {geometry!r} is no geometry; give one, or a feature that has one",
                    function=NAME,
                    geometry=geometry,
                )
            )
            return None
        if geometry.isNull():
            return None
        try:
            return _placed(geometry, crs, robots.crs, context).distance(QgsGeometry.fromPointXY(place))
        except FleetError as error:
            parent.setEvalErrorString(f"{NAME}: {error}")
        except QgsCsException:
            parent.setEvalErrorString(
                tr("{function}: the geometry has no place in {crs}", function=NAME, crs=robots.crs.authid())
            )
        return None


def _placed(
    geometry: QgsGeometry,
    crs: Any,
    site_crs: QgsCoordinateReferenceSystem,
    context: QgsExpressionContext | None,
) -> QgsGeometry:
    """Return ``geometry`` in ``site_crs``; the way there is looked for once in a context."""
    of_layer = context.variable("layer_crs") if context is not None else None
    key = f"fleet {NAME} {crs} {of_layer} {site_crs.authid()}"
    if context is not None and context.hasCachedValue(key):
        way = context.cachedValue(key)
    else:
        way = QgsCoordinateTransform(crs_of_place(crs, of_layer), site_crs, QgsProject.instance())
        if context is not None:
            context.setCachedValue(key, way)
    check_way(way)
    placed = QgsGeometry(geometry)
    if way.isValid():
        placed.transform(way)
    return placed


def _is_null(value: Any) -> bool:
    return value is None or (not isinstance(value, (QgsGeometry, QgsFeature)) and value == NULL)

"""The expression function ``road_surface(x, y, layer, crs)``."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from qgis.core import (
    NULL,
    QgsExpression,
    QgsExpressionContext,
    QgsExpressionFunction,
    QgsExpressionNodeFunction,
    QgsProject,
    QgsVectorLayer,
)

from ..errors import FleetError
from ..language import tr, tr_page
from ..sites.roles import ROAD_SURFACE
from ..sites.surface_store import SurfaceStore
from .place_crs import crs_of_place

NAME, GROUP = "road_surface", tr("Fleet")
_HELP = tr_page("""
<h3>function road_surface</h3>
<p>Returns the class of the road surface at a place, such as 'asphalt', or NULL where there is none.</p>
<h4>Syntax</h4>
<p><code>road_surface(x, y, [layer], [crs])</code></p>
<h4>Arguments</h4>
<table>
<tr><td><i>x, y</i></td><td>the place; x is the easting or the longitude, whatever the CRS</td></tr>
<tr><td><i>layer</i></td><td>optional, the name or id of a layer of areas; without it, all layers of the
project with the role road surface</td></tr>
<tr><td><i>crs</i></td><td>optional, the CRS of the place, such as 'EPSG:4326'; without it, that of the layer
whose feature is looked at, else that of the project</td></tr>
</table>
<h4>Examples</h4>
<ul>
<li><code>road_surface($x, $y)</code> &rarr; 'asphalt'</li>
<li><code>road_surface(16.8438, 46.8804, crs:='EPSG:4326')</code> &rarr; 'slippery'</li>
<li><code>road_surface($x, $y, 'Road surfaces') IS NULL</code> &rarr; true off the road</li>
</ul>
<h4>Notes</h4>
<p>A place on an edge is on the surface. Where surfaces lie on one another a drawn one counts before a
generated one, then the smaller before the larger.</p>
""")


class RoadSurface(QgsExpressionFunction):
    """Tells the road surface at a place by what ``store`` keeps."""

    def __init__(self, store: SurfaceStore):
        parameter = QgsExpressionFunction.Parameter
        parameters = [parameter("x"), parameter("y"), parameter("layer", True), parameter("crs", True)]
        # Handles NULL itself: an argument that is left out comes as NULL, too.
        super().__init__(NAME, parameters, GROUP, _HELP, lazyEval=False, handlesNull=True)
        self._store = store

    def usesGeometry(self, _node: QgsExpressionNodeFunction):
        return False

    def referencedColumns(self, _node: QgsExpressionNodeFunction):
        return set()

    def func(
        self,
        values: Sequence[Any],
        context: QgsExpressionContext,
        parent: QgsExpression,
        _node: QgsExpressionNodeFunction,
    ):
        x, y, layer, crs = (None if value == NULL else value for value in values)
        if x is None or y is None:
            return None
        try:
            surfaces, way = self._kept(layer, crs, context)
            found = surfaces.at(float(x), float(y), way)
        except (TypeError, ValueError):
            parent.setEvalErrorString(
                tr("{function}: x is {x!r} and y is {y!r}; give two numbers", function=NAME, x=x, y=y)
            )
            return None
        except FleetError as error:
            parent.setEvalErrorString(f"{NAME}: {error}")
            return None
        return None if found is None else found.label

    def _kept(self, layer: Any, crs: Any, context: QgsExpressionContext | None) -> tuple[Any, Any]:
        """Return the surfaces and the way to them, which are looked for once in a context."""
        of_layer = context.variable("layer_crs") if context is not None else None
        key = f"fleet road_surface {_named(layer)} {crs} {of_layer}"
        if context is not None and context.hasCachedValue(key):
            return context.cachedValue(key)
        surfaces = self._store.read(self._layers(layer))
        found = surfaces, surfaces.way_from(crs_of_place(crs, of_layer))
        if context is not None:
            context.setCachedValue(key, found)
        return found

    def _layers(self, layer: Any) -> list[QgsVectorLayer]:
        if layer is None:
            found = self._store.layers()
            if not found:
                raise FleetError(
                    tr(
                        "no layer of the project has the role {role}; set it in Plugins > Fleet Supervisor > "
                        "Layer roles, or name a layer as the third argument",
                        role=ROAD_SURFACE,
                    )
                )
            return found
        if isinstance(layer, QgsVectorLayer):
            return [layer]
        project = QgsProject.instance()
        named = project.mapLayer(str(layer)) or next(iter(project.mapLayersByName(str(layer))), None)
        if not isinstance(named, QgsVectorLayer):
            raise FleetError(tr("no vector layer of the project has the name or id {layer!r}", layer=layer))
        return [named]


def _named(layer: Any) -> str:
    return layer.id() if isinstance(layer, QgsVectorLayer) else str(layer)

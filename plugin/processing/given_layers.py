"""Layers that a parameter names, before they are read."""

from __future__ import annotations

from qgis.core import (
    QgsMapLayer,
    QgsProcessingAlgorithm,
    QgsProcessingContext,
    QgsProcessingFeatureSourceDefinition,
    QgsProcessingUtils,
    QgsProviderRegistry,
    QgsVectorLayer,
    QgsWkbTypes,
)

from ..language import tr
from .fleet_algorithm import Parameters

SHOWN = 6
"""So many layers of a file are named."""


def layer_in(
    algorithm: QgsProcessingAlgorithm, parameters: Parameters, name: str, context: QgsProcessingContext
) -> QgsVectorLayer | None:
    """Return the layer that the parameter ``name`` takes its features from, None where that is none."""
    value = parameters.get(name)
    # What is given with "selected features only" is no layer to parameterAsVectorLayer.
    chosen = value.source.staticValue() if isinstance(value, QgsProcessingFeatureSourceDefinition) else value
    return algorithm.parameterAsVectorLayer({**parameters, name: chosen}, name, context)


def layers_problem(parameters: Parameters, name: str, context: QgsProcessingContext) -> str:
    """Return what is wrong with the first layer in the parameter ``name`` that cannot be read, or nothing.

    Where there are others, Processing itself passes over such a layer in silence; and of a file with several
    it takes the first.
    """
    values = parameters.get(name)
    for value in values if isinstance(values, (list, tuple)) else [values]:
        problem = _problem(name, value, context) if isinstance(value, str) and value else ""
        if problem:
            return problem
    return ""


def _problem(name: str, value: str, context: QgsProcessingContext) -> str:
    layer = QgsProcessingUtils.mapLayerFromString(value, context)
    if layer is None:
        return tr(
            "{name}: the layer {layer} cannot be opened: check the file, and the layer's name after "
            "'|layername='.",
            name=name,
            layer=value,
        )
    project = context.project()
    of_project = project is not None and project.mapLayer(layer.id()) is not None
    inside = [] if of_project else _layers_beside(layer)
    if not inside:
        return ""
    return tr(
        "{name}: the file {file} holds {count} layers ({layers}): say which, as in {file}|layername={first}.",
        name=name,
        file=value,
        count=len(inside),
        layers=", ".join(inside[:SHOWN]) + (", …" if len(inside) > SHOWN else ""),
        first=inside[0],
    )


def _layers_beside(layer: QgsMapLayer) -> list[str]:
    """Return the layers with geometry in the file of ``layer``, none where it is the one or was named."""
    registry = QgsProviderRegistry.instance()
    parts = registry.decodeUri(layer.providerType(), layer.source())
    if layer.providerType() != "ogr" or parts.get("layerName") or parts.get("layerId") is not None:
        return []
    found = registry.providerMetadata("ogr").querySublayers(str(parts.get("path")))
    bare = QgsWkbTypes.Type.NoGeometry
    names = list(dict.fromkeys(sublayer.name() for sublayer in found if sublayer.wkbType() != bare))
    return names if len(names) > 1 else []

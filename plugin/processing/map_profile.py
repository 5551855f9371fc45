"""The parameter PROFILE: what layers are, from a file instead of from the project."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from qgis.core import (
    QgsMapLayer,
    QgsProcessingAlgorithm,
    QgsProcessingContext,
    QgsProcessingFeedback,
    QgsProcessingParameterDefinition,
    QgsProcessingParameterFile,
    QgsProject,
    QgsVectorLayer,
)

from ..language import tr
from ..sites.errors import LayerTypeError
from ..sites.feature_filter import FeatureFilter
from ..sites.obstacle_source import Setups
from ..sites.profile_file import SUFFIXES, find_profile, read_profile
from ..sites.roles import setup_of
from .fleet_algorithm import Parameters
from .given_layers import layer_in

PROFILE = "PROFILE"


def profile_parameter() -> QgsProcessingParameterDefinition:
    """Return the parameter; its value is a path or the name of a profile that comes with the plugin."""
    kinds = " ".join(f"*{suffix}" for suffix in SUFFIXES)
    return QgsProcessingParameterFile(
        PROFILE,
        tr("Map profile: what the layers are, by their names (default: as each layer keeps it)"),
        optional=True,
        # "All files" also lets the name of a shipped profile pass QGIS's check of the value.
        fileFilter=tr("Map profile ({kinds});;All files (*)", kinds=kinds),
    )


def setups_of(
    algorithm: QgsProcessingAlgorithm, parameters: Parameters, context: QgsProcessingContext
) -> Setups:
    """Return what tells the role and the expressions of a layer.

    :raises ProfileError: when the profile cannot be read.
    """
    chosen = algorithm.parameterAsFile(parameters, PROFILE, context)
    return read_profile(find_profile(chosen)).setup_over if chosen else setup_of


def warn_of_profile(
    algorithm: QgsProcessingAlgorithm,
    parameters: Parameters,
    context: QgsProcessingContext,
    layers: Iterable[QgsMapLayer],
    feedback: QgsProcessingFeedback,
) -> None:
    """Say which names the profile looks for, if there is one and it knows none of ``layers``.

    :raises ProfileError: when the profile cannot be read.
    """
    chosen = algorithm.parameterAsFile(parameters, PROFILE, context)
    profile = read_profile(find_profile(chosen)) if chosen else None
    if profile is None or any(profile.setup_for(layer) is not None for layer in layers):
        return
    feedback.pushWarning(
        tr(
            "{name} knows none of these layers. It looks for layers that are named, in their source or "
            "in the project: {sought}.",
            name=profile.name,
            sought=profile.sought(),
        )
    )


def layers_of_project(
    project: QgsProject | None, roles: Sequence[str], setups: Setups
) -> list[QgsVectorLayer]:
    """Return the layers of ``project`` that ``setups`` gives one of ``roles``, sorted by name and id.

    :raises LayerTypeError: naming the first that is no vector layer.
    """
    layers = project.mapLayers().values() if project is not None else ()
    found = [layer for layer in layers if setups(layer).role in roles]
    check_vectors(found)
    return sorted(found, key=lambda layer: (layer.name(), layer.id()))


def check_vectors(layers: Sequence[QgsMapLayer]) -> None:
    """Raise LayerTypeError for the first of ``layers`` that is no vector layer."""
    for layer in layers:
        if not isinstance(layer, QgsVectorLayer):
            raise LayerTypeError(
                tr("The layer {layer} is no vector layer: take its role away.", layer=layer.name())
            )


def filter_in(
    algorithm: QgsProcessingAlgorithm, parameters: Parameters, name: str, context: QgsProcessingContext
) -> FeatureFilter | None:
    """Return which features count of the layer that the parameter ``name`` takes its features from.

    None where that is no layer.

    :raises ExpressionError: when the layer's filter is no expression.
    """
    layer = layer_in(algorithm, parameters, name, context)
    if layer is None:
        return None
    return FeatureFilter.of_layer(layer, algorithm.createExpressionContext(parameters, context))

"""The parameter PROFILE: what layers are, from a file instead of from the project."""

from __future__ import annotations

from qgis.core import (
    QgsProcessingAlgorithm,
    QgsProcessingContext,
    QgsProcessingParameterDefinition,
    QgsProcessingParameterFile,
)

from ..language import tr
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

"""What an export will do, settled and checked before it starts."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

from qgis.core import (
    QgsProcessingAlgorithm,
    QgsProcessingContext,
    QgsProviderRegistry,
    QgsVectorLayer,
)

from ...robot_bridge.robotmap.builder import Window
from ...robot_bridge.robotmap.shaping import Shaping
from ..language import tr
from ..sites.errors import LayerTypeError
from ..sites.obstacle_source import ObstacleSource, obstacle_sources
from ..sites.placing import SitePlacing
from ..sites.reading import check_sources
from ..sites.roles import OBSTACLE_ROLES, LayerExpressions
from .errors import ParameterError
from .fleet_algorithm import Parameters
from .given_layers import layers_problem
from .map_format import MapFormat, format_of
from .map_profile import layers_of_project, setups_of
from .map_shaping import shaping_of
from .map_window import LOCAL, map_window, site_frame
from .site_crs_choice import chosen_crs
from .whole_file import OutputError, check_target

OBSTACLES, OUTPUT = "OBSTACLES", "OUTPUT"
HEIGHT_EXPRESSION, DEFAULT_HEIGHT = "HEIGHT_EXPRESSION", "DEFAULT_HEIGHT"
BASE_EXPRESSION = "BASE_EXPRESSION"
SEMANTICS_EXPRESSION, OUTDOOR_EXPRESSION = "SEMANTICS_EXPRESSION", "OUTDOOR_EXPRESSION"
GENERAL = {
    "height": HEIGHT_EXPRESSION,
    "base": BASE_EXPRESSION,
    "semantics": SEMANTICS_EXPRESSION,
    "outdoor": OUTDOOR_EXPRESSION,
}
"""The parameters whose expressions count for layers that have none of their own."""


@dataclass(frozen=True)
class ObstaclePlan:
    """What is read, where it lies, what is made of it and how it is written; usable from any thread."""

    sources: list[ObstacleSource]
    site: SitePlacing
    default_height: float
    shaping: Shaping
    format: MapFormat

    @property
    def meta(self) -> dict[str, str]:
        """The leading lines of the map, spelled as those of a published site are."""
        frame = self.site.frame
        if not self.site.crs.isValid():
            return {}
        return {
            "crs": frame.crs,
            "origin": f"{frame.origin[0]:.3f},{frame.origin[1]:.3f}",
            "rotation": f"{frame.rotation:.9f}",
        }


@dataclass(frozen=True)
class ExportPlan(ObstaclePlan):
    """Everything that is needed of the parameters and layers to export one window."""

    window: Window
    target: Path


def plan_of(
    algorithm: QgsProcessingAlgorithm, parameters: Parameters, context: QgsProcessingContext
) -> ExportPlan:
    """Return the plan for ``parameters``; to be called in the main thread.

    :raises FleetError: when a parameter or a layer cannot be used.
    :raises WindowError: when the window encloses nothing.
    """
    plan = obstacle_plan_of(algorithm, parameters, context)
    return ExportPlan(
        **vars(plan),
        window=map_window(algorithm, parameters, context, plan.site.crs, plan.site.frame),
        target=_target(algorithm, parameters, context),
    )


def obstacle_plan_of(
    algorithm: QgsProcessingAlgorithm, parameters: Parameters, context: QgsProcessingContext
) -> ObstaclePlan:
    """Return what is read for ``parameters``; to be called in the main thread.

    :raises FleetError: when a parameter or a layer cannot be used.
    :raises RobotMapError: when something asked for needs a package that this Python does not have.
    """
    layers = obstacle_layers(algorithm, parameters, context)
    # As strings: parameterAsExpression replaces what is no expression by the default, in silence.
    general = LayerExpressions(
        **{what: algorithm.parameterAsString(parameters, name, context) for what, name in GENERAL.items()}
    )
    setups = setups_of(algorithm, parameters, context)
    scopes = algorithm.createExpressionContext(parameters, context)
    sources = obstacle_sources(layers, general, scopes, setups)
    crs = chosen_crs(algorithm, parameters, context, [source.crs for source in sources])
    frame = site_frame(algorithm, parameters, context, crs)
    local = algorithm.parameterAsBool(parameters, LOCAL, context)
    site = SitePlacing(crs, frame, context.transformContext(), local)
    check_sources(sources, site)
    shaping = shaping_of(algorithm, parameters, context)
    return ObstaclePlan(
        sources,
        site,
        default_height(algorithm, parameters, context),
        shaping,
        format_of(algorithm, parameters, context),
    )


def obstacle_layers(
    algorithm: QgsProcessingAlgorithm, parameters: Parameters, context: QgsProcessingContext
) -> list[QgsVectorLayer]:
    """Return the layers in OBSTACLES; without any the project's that have a role of obstacles.

    :raises LayerTypeError: naming the first that cannot be read or is no vector layer.
    :raises ParameterError: when there are none.
    """
    if not parameters.get(OBSTACLES):
        setups = setups_of(algorithm, parameters, context)
        found = layers_of_project(context.project(), OBSTACLE_ROLES, setups)
        if not found:
            raise ParameterError(
                tr(
                    "No obstacle layer is given, and no layer of the project has a role of obstacles. Give "
                    "OBSTACLES, roles (Fleet Supervisor > Layer roles), or a PROFILE."
                )
            )
        return found
    problem = layers_problem(parameters, OBSTACLES, context)
    if problem:
        raise LayerTypeError(problem)
    layers = algorithm.parameterAsLayerList(parameters, OBSTACLES, context)
    for layer in layers:
        if not isinstance(layer, QgsVectorLayer):
            raise LayerTypeError(
                tr("The layer {layer} is no vector layer: leave it out.", layer=layer.name())
            )
    return layers


def default_height(
    algorithm: QgsProcessingAlgorithm, parameters: Parameters, context: QgsProcessingContext
) -> float:
    """Return DEFAULT_HEIGHT in metres.

    :raises ParameterError: when it is none.
    """
    height = algorithm.parameterAsDouble(parameters, DEFAULT_HEIGHT, context)
    if not 0 <= height < math.inf:
        raise ParameterError(
            tr("DEFAULT_HEIGHT is {height}: give a number of metres of 0 or more.", height=height)
        )
    return height


def _target(algorithm: QgsProcessingAlgorithm, parameters: Parameters, context: QgsProcessingContext) -> Path:
    target = Path(algorithm.parameterAsFileOutput(parameters, OUTPUT, context))
    check_target(target, tr("The robot map"))
    for layer in obstacle_layers(algorithm, parameters, context):
        path = QgsProviderRegistry.instance().decodeUri(layer.providerType(), layer.source()).get("path")
        if path and target.exists() and Path(path).exists() and target.samefile(path):
            raise OutputError(
                tr(
                    "OUTPUT {target} is the file of the layer {layer}: choose another one.",
                    target=target,
                    layer=layer.name(),
                )
            )
    return target

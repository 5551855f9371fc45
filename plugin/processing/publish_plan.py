"""What a publication will hold, settled and checked before it starts."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsMapLayer,
    QgsProcessingAlgorithm,
    QgsProcessingContext,
    QgsVectorLayer,
)

from ...robot_bridge.sites.settings import (
    SETTINGS_FILE,
    Bounds,
    LivenessLimits,
    SiteSettings,
    earlier_settings,
)
from ...robot_bridge.sites.settings_toml import value_text
from ..language import tr
from ..sites.errors import LayerTypeError
from ..sites.obstacle_source import Setups, obstacle_sources
from ..sites.placing import SitePlacing
from ..sites.publication import check_publication_values, next_version
from ..sites.roles import (
    KEEPOUT,
    OBSTACLE_ROLES,
    ROAD_CENTRELINE,
    ROAD_SURFACE,
    LayerExpressions,
)
from ..sites.site_content import SiteSources, check_content_sources
from ..sites.site_crs import crs_name, is_engineering
from .errors import ParameterError
from .export_plan import default_height
from .fleet_algorithm import Parameters
from .given_layers import layers_problem
from .map_profile import check_vectors, layers_of_project, setups_of
from .map_window import LOCAL, site_frame
from .places import extent_in
from .site_crs_choice import chosen_crs

FOLDER, REPLACE = "FOLDER", "REPLACE"
SITE_ID, SITE_NAME, BOUNDS = "SITE_ID", "SITE_NAME", "BOUNDS"
DEFAULT_WIDTH = "DEFAULT_WIDTH"
TOLERANCE, STALE_AFTER, LOST_AFTER = "REACHED_TOLERANCE", "STALE_AFTER", "LOST_AFTER"

LIMITS = {
    TOLERANCE: ("site", "reached_tolerance_m", SiteSettings.reached_tolerance_m),
    STALE_AFTER: ("liveness", "stale_after_s", LivenessLimits().stale_after_s),
    LOST_AFTER: ("liveness", "lost_after_s", LivenessLimits().lost_after_s),
}
"""Table, key and default of the parameters that, not given, stay as they are in ``site.toml``."""

LAYERS = {
    "OBSTACLES": OBSTACLE_ROLES,
    "ROAD_CENTRELINES": (ROAD_CENTRELINE,),
    "ROAD_SURFACES": (ROAD_SURFACE,),
    "KEEPOUTS": (KEEPOUT,),
}
"""The roles of the layers that each parameter takes from the project when it is empty,
in the order of SiteSources."""

SITE_VARIABLE = "fleet_site"
"""The project variable that holds the id of its site."""

WHERE_NOT_KNOWN = Bounds(0.0, 0.0, 1.0, 1.0)


@dataclass(frozen=True)
class PublishPlan:
    """Everything that is needed of the parameters and layers; usable from any thread.

    The bounds of ``settings`` stand in where ``bounds_given`` is false, until the layers are read. Their
    version is as the folder was when the plan was made; ``replace_other`` lets another site be replaced.
    """

    folder: Path
    settings: SiteSettings
    bounds_given: bool
    replace_other: bool
    sources: SiteSources
    site: SitePlacing
    default_height: float
    default_width: float


def publish_plan(
    algorithm: QgsProcessingAlgorithm, parameters: Parameters, context: QgsProcessingContext
) -> PublishPlan:
    """Return the plan for ``parameters``; to be called in the main thread.

    :raises FleetError: when a parameter, a layer or what is in the folder stands in the way.
    """
    sources = _sources(algorithm, parameters, context)
    if not sources.all():
        raise ParameterError(
            tr(
                "There is nothing to publish: no layer is given and no layer of the project has a role. "
                "Give roles (Fleet Supervisor > Layer roles), a PROFILE, or layers."
            )
        )
    own = [source.crs for source in sources.all()]
    crs = chosen_crs(algorithm, parameters, context, own)
    _check_published_crs(crs)
    frame = site_frame(algorithm, parameters, context, crs)
    local = algorithm.parameterAsBool(parameters, LOCAL, context)
    site = SitePlacing(crs, frame, context.transformContext(), local)
    check_content_sources(sources, site)
    folder = Path(algorithm.parameterAsFileOutput(parameters, FOLDER, context))
    settings, given = _settings(algorithm, parameters, context, site)
    check_publication_values(settings, folder)
    replace_other = algorithm.parameterAsBool(parameters, REPLACE, context)
    return PublishPlan(
        folder=folder,
        settings=next_version(settings, folder, replace_other=replace_other),
        bounds_given=given,
        replace_other=replace_other,
        sources=sources,
        site=site,
        default_height=default_height(algorithm, parameters, context),
        default_width=_above_zero(algorithm, parameters, context, DEFAULT_WIDTH),
    )


def layers_to_publish(
    algorithm: QgsProcessingAlgorithm, parameters: Parameters, context: QgsProcessingContext
) -> list[QgsMapLayer]:
    """Return the layers that are given, and those of the project where some are not given."""
    given = [name for name in LAYERS if parameters.get(name)]
    layers = [layer for name in given for layer in algorithm.parameterAsLayerList(parameters, name, context)]
    project = context.project()
    if len(given) < len(LAYERS) and project is not None:
        layers += project.mapLayers().values()
    return layers


def _sources(
    algorithm: QgsProcessingAlgorithm, parameters: Parameters, context: QgsProcessingContext
) -> SiteSources:
    setups = setups_of(algorithm, parameters, context)
    scopes = algorithm.createExpressionContext(parameters, context)
    found = [_layers(algorithm, parameters, context, name, setups) for name in LAYERS]
    return SiteSources(*(obstacle_sources(layers, LayerExpressions(), scopes, setups) for layers in found))


def _layers(
    algorithm: QgsProcessingAlgorithm,
    parameters: Parameters,
    context: QgsProcessingContext,
    name: str,
    setups: Setups,
) -> list[QgsVectorLayer]:
    if not parameters.get(name):
        return layers_of_project(context.project(), LAYERS[name], setups)
    problem = layers_problem(parameters, name, context)
    if problem:
        raise LayerTypeError(problem)
    layers = algorithm.parameterAsLayerList(parameters, name, context)
    check_vectors(layers)
    return layers


def _check_published_crs(crs: QgsCoordinateReferenceSystem) -> None:
    if crs.isValid() and not is_engineering(crs) and crs.authid() and not crs.authid().startswith("USER:"):
        return
    named = (
        tr("The site's CRS, {crs_name},", crs_name=crs_name(crs))
        if crs.isValid()
        else tr("The site's CRS is not known, and")
    )
    raise ParameterError(
        tr(
            "{named} has no code that a gateway knows it by: choose SITE_CRS such as EPSG:32633. Layers in "
            "local metres can be published with ORIGIN and LOCAL=true.",
            named=named,
        )
    )


def _settings(
    algorithm: QgsProcessingAlgorithm,
    parameters: Parameters,
    context: QgsProcessingContext,
    site: SitePlacing,
) -> tuple[SiteSettings, bool]:
    name, title = _names(algorithm, parameters, context)
    bounds = _bounds(algorithm, parameters, context, site)
    limits = _limits(algorithm, parameters, context, name)
    settings = SiteSettings(
        id=name,
        name=title,
        version=1,
        crs=site.crs.authid(),
        origin=site.frame.origin,
        bounds=bounds or WHERE_NOT_KNOWN,
        rotation_deg=round(math.degrees(site.frame.rotation), 9),
        reached_tolerance_m=limits[TOLERANCE],
        liveness=LivenessLimits(limits[STALE_AFTER], limits[LOST_AFTER]),
    )
    return settings, bounds is not None


def _limits(
    algorithm: QgsProcessingAlgorithm, parameters: Parameters, context: QgsProcessingContext, site: str
) -> dict[str, float]:
    """Return the limits that are given; of the others what the site is published with, else the default."""
    folder = Path(algorithm.parameterAsFileOutput(parameters, FOLDER, context))
    earlier = earlier_settings(folder, site)
    limits = {}
    for name, (table, key, default) in LIMITS.items():
        found = value_text(earlier, table, key)
        if parameters.get(name) is not None:
            limits[name] = algorithm.parameterAsDouble(parameters, name, context)
        else:
            limits[name] = _number(found, f"{folder / SETTINGS_FILE}: {table}.{key}") if found else default
    return limits


def _number(text: str, place: str) -> float:
    try:
        return float(text.replace("_", ""))
    except ValueError:
        raise ParameterError(
            tr("{place} = {text} is no number: correct it there.", place=place, text=text)
        ) from None


def _names(
    algorithm: QgsProcessingAlgorithm, parameters: Parameters, context: QgsProcessingContext
) -> tuple[str, str]:
    project = context.project()
    variables = project.customVariables() if project is not None else {}
    name = algorithm.parameterAsString(parameters, SITE_ID, context) or str(
        variables.get(SITE_VARIABLE) or ""
    )
    if not name:
        raise ParameterError(
            tr(
                "SITE_ID is empty and the project has no variable {site_variable}: give the site an id of "
                "letters, digits, '_', '.' and '-', such as north_yard.",
                site_variable=SITE_VARIABLE,
            )
        )
    title = project.title() if project is not None else ""
    return name, algorithm.parameterAsString(parameters, SITE_NAME, context) or title or name


def _bounds(
    algorithm: QgsProcessingAlgorithm,
    parameters: Parameters,
    context: QgsProcessingContext,
    site: SitePlacing,
) -> Bounds | None:
    if not parameters.get(BOUNDS):
        return None
    corners = site.frame.to_site(extent_in(algorithm, parameters, BOUNDS, context, site.crs))
    low, high = corners.min(axis=0).round(3), corners.max(axis=0).round(3)
    return Bounds(float(low[0]), float(low[1]), float(high[0]), float(high[1]))


def _above_zero(
    algorithm: QgsProcessingAlgorithm, parameters: Parameters, context: QgsProcessingContext, name: str
) -> float:
    value = algorithm.parameterAsDouble(parameters, name, context)
    if not 0 < value < math.inf:
        raise ParameterError(
            tr("{name} is {value}: give a number of metres above 0.", name=name, value=value)
        )
    return value

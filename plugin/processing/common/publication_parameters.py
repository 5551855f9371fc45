"""The parameters of ``fleet:publishsite``, and the publication's plan, checked before it starts."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsMapLayer,
    QgsProcessing,
    QgsProcessingAlgorithm,
    QgsProcessingContext,
    QgsProcessingParameterBoolean,
    QgsProcessingParameterDefinition,
    QgsProcessingParameterExtent,
    QgsProcessingParameterFolderDestination,
    QgsProcessingParameterMultipleLayers,
    QgsProcessingParameterNumber,
    QgsProcessingParameterProviderConnection,
    QgsProcessingParameterString,
    QgsVectorLayer,
)

from ....robot_bridge.core.sites.frame import SiteBounds
from ....robot_bridge.core.sites.settings import SETTINGS_FILE, SiteSettings, earlier_settings
from ....robot_bridge.core.sites.settings_tables import LivenessLimits, value_text
from ...layers.crs import crs_name, is_engineering
from ...layers.layer_source import Setups, obstacle_sources
from ...layers.publishing.postgis import check_site_id, database_address
from ...layers.publishing.publication import check_publication_values, next_version
from ...layers.publishing.site_content import SiteSources, check_content_sources
from ...layers.road_layers import DEFAULT_WIDTH_M
from ...layers.roles import KEEPOUT, OBSTACLE_ROLES, ROAD_CENTRELINE, ROAD_SURFACE, LayerExpressions
from ...layers.site_transform import SiteGeoreference
from ...ui.errors import LayerTypeError
from ...ui.language import tr
from .algorithm import ParameterError, Parameters, advanced, layers_problem
from .export_parameters import DEFAULT_HEIGHT, default_height
from .parameters import (
    LOCAL,
    check_vectors,
    chosen_crs,
    extent_in,
    frame_parameters,
    layers_of_project,
    profile_parameter,
    setups_of,
    site_frame,
)

FOLDER, REPLACE, DATABASE = "FOLDER", "REPLACE", "DATABASE"
SITE_ID, SITE_NAME, BOUNDS = "SITE_ID", "SITE_NAME", "BOUNDS"
DEFAULT_WIDTH = "DEFAULT_WIDTH"
TOLERANCE, STALE_AFTER, LOST_AFTER = "REACHED_TOLERANCE", "STALE_AFTER", "LOST_AFTER"

LIMITS = {
    TOLERANCE: ("site", "reached_tolerance_m", SiteSettings.reached_tolerance_m),
    STALE_AFTER: ("liveness", "stale_after_s", LivenessLimits().stale_after_s),
    LOST_AFTER: ("liveness", "lost_after_s", LivenessLimits().lost_after_s),
}
"""Table, key and default of the parameters that keep their value in ``site.toml`` if not given."""

LAYERS = {
    "OBSTACLES": OBSTACLE_ROLES,
    "ROAD_CENTRELINES": (ROAD_CENTRELINE,),
    "ROAD_SURFACES": (ROAD_SURFACE,),
    "KEEPOUTS": (KEEPOUT,),
}
"""The roles of the project's layers that each parameter uses when it is empty,
in the order of SiteSources."""

SITE_VARIABLE = "fleet_site"
"""The project variable with the id of its site."""

WHERE_NOT_KNOWN = SiteBounds(0.0, 0.0, 1.0, 1.0)


@dataclass(frozen=True)
class PublishParameters:
    """Everything from the parameters and layers that a publication needs; usable from any thread.

    If ``bounds_given`` is false, the bounds of ``settings`` are placeholders until the layers are read. Their
    version, and their limits but for those ``given``, follow the folder when the plan was made;
    ``replace_other`` lets another site be replaced. At least one of ``folder`` and ``database``, an address,
    is given.
    """

    folder: Path | None
    database: str
    settings: SiteSettings
    given: Mapping[str, float]
    bounds_given: bool
    replace_other: bool
    sources: SiteSources
    site: SiteGeoreference
    default_height: float
    default_width: float


def read_publish_parameters(
    algorithm: QgsProcessingAlgorithm, parameters: Parameters, context: QgsProcessingContext
) -> PublishParameters:
    """Return the plan for ``parameters``; must be called in the main thread.

    :raises FleetError: when a parameter, a layer or the content of the folder prevents it.
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
    site = SiteGeoreference(crs, frame, context.transformContext(), local)
    check_content_sources(sources, site)
    folder, database = _targets(algorithm, parameters, context)
    given = _given_limits(algorithm, parameters, context)
    settings, bounds_given = _settings(algorithm, parameters, context, site)
    replace_other = algorithm.parameterAsBool(parameters, REPLACE, context)
    if folder is not None:
        settings = with_limits(settings, given, earlier_settings(folder, settings.id), folder / SETTINGS_FILE)
        check_publication_values(settings, folder)
        settings = next_version(settings, folder, replace_other=replace_other)
    if database:
        check_site_id(settings.id)
    return PublishParameters(
        folder=folder,
        database=database,
        settings=settings,
        given=given,
        bounds_given=bounds_given,
        replace_other=replace_other,
        sources=sources,
        site=site,
        default_height=default_height(algorithm, parameters, context),
        default_width=_above_zero(algorithm, parameters, context, DEFAULT_WIDTH),
    )


def layers_to_publish(
    algorithm: QgsProcessingAlgorithm, parameters: Parameters, context: QgsProcessingContext
) -> list[QgsMapLayer]:
    """Return the layers given, and those of the project for parameters not given."""
    given = [name for name in LAYERS if parameters.get(name)]
    layers = [layer for name in given for layer in algorithm.parameterAsLayerList(parameters, name, context)]
    project = context.project()
    if len(given) < len(LAYERS) and project is not None:
        layers += project.mapLayers().values()
    return layers


def _targets(
    algorithm: QgsProcessingAlgorithm, parameters: Parameters, context: QgsProcessingContext
) -> tuple[Path | None, str]:
    """Return the folder and the address of the database to publish in, at least one of them."""
    folder = algorithm.parameterAsFileOutput(parameters, FOLDER, context)
    database = algorithm.parameterAsConnectionName(parameters, DATABASE, context)
    if not folder and not database:
        raise ParameterError(
            tr(
                "It is not said where to publish: give FOLDER, a folder, or DATABASE, a PostgreSQL "
                "connection of QGIS's."
            )
        )
    return Path(folder) if folder else None, database_address(database) if database else ""


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
    site: SiteGeoreference,
) -> tuple[SiteSettings, bool]:
    name, title = _names(algorithm, parameters, context)
    bounds = _bounds(algorithm, parameters, context, site)
    settings = SiteSettings(
        id=name,
        name=title,
        version=1,
        crs=site.crs.authid(),
        origin=site.frame.origin,
        bounds=bounds or WHERE_NOT_KNOWN,
        rotation_deg=round(math.degrees(site.frame.rotation), 9),
    )
    return settings, bounds is not None


def _given_limits(
    algorithm: QgsProcessingAlgorithm, parameters: Parameters, context: QgsProcessingContext
) -> dict[str, float]:
    return {
        name: algorithm.parameterAsDouble(parameters, name, context)
        for name in LIMITS
        if parameters.get(name) is not None
    }


def with_limits(
    settings: SiteSettings, given: Mapping[str, float], earlier: str, place: Path
) -> SiteSettings:
    """Return ``settings`` with the limits ``given``; the others are those of the ``earlier`` site.toml.

    Limits missing there have their defaults; ``place`` names the site.toml in messages.
    """
    limits = dict(given)
    for name, (table, key, default) in LIMITS.items():
        found = value_text(earlier, table, key)
        if name not in given:
            limits[name] = _number(found, f"{place}: {table}.{key}") if found else default
    return replace(
        settings,
        reached_tolerance_m=limits[TOLERANCE],
        liveness=LivenessLimits(limits[STALE_AFTER], limits[LOST_AFTER]),
    )


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
    site: SiteGeoreference,
) -> SiteBounds | None:
    if not parameters.get(BOUNDS):
        return None
    corners = site.frame.to_site(extent_in(algorithm, parameters, BOUNDS, context, site.crs))
    low, high = corners.min(axis=0).round(3), corners.max(axis=0).round(3)
    return SiteBounds(float(low[0]), float(low[1]), float(high[0]), float(high[1]))


def _above_zero(
    algorithm: QgsProcessingAlgorithm, parameters: Parameters, context: QgsProcessingContext, name: str
) -> float:
    value = algorithm.parameterAsDouble(parameters, name, context)
    if not 0 < value < math.inf:
        raise ParameterError(
            tr("{name} is {value}: give a number of metres above 0.", name=name, value=value)
        )
    return value


# --- The parameters ---

LAYER_TITLES = {
    "OBSTACLES": tr("Obstacle layers, stairs, ramps and furniture (default: the project's with such a role)"),
    "ROAD_CENTRELINES": tr("Road centreline layers (default: the project's with that role)"),
    "ROAD_SURFACES": tr("Road surface layers (default: the project's with that role)"),
    "KEEPOUTS": tr("Keepout layers (default: the project's with that role)"),
}
_REAL = QgsProcessingParameterNumber.Type.Double
_LIMITS = LivenessLimits()


def publication_parameters() -> list[QgsProcessingParameterDefinition]:
    """Return the definitions of all parameters, in the order of the dialog."""
    return [
        *_layer_parameters(),
        profile_parameter(),
        QgsProcessingParameterString(SITE_ID, tr("Site id (default: the project's)"), optional=True),
        QgsProcessingParameterString(
            SITE_NAME, tr("Site name (default: the project's title)"), optional=True
        ),
        QgsProcessingParameterExtent(
            BOUNDS, tr("Where robots may be sent (default: all that is published)"), optional=True
        ),
        *_value_parameters(),
        *frame_parameters(),
        QgsProcessingParameterProviderConnection(
            DATABASE, tr("Database of the published site (PostGIS)"), "postgres", optional=True
        ),
        # Optional for scripts that publish into a database only; a dialog still proposes one.
        QgsProcessingParameterFolderDestination(
            FOLDER, tr("Folder of the published site"), optional=True, createByDefault=True
        ),
    ]


def _layer_parameters() -> list[QgsProcessingParameterDefinition]:
    kind = QgsProcessing.SourceType.TypeVectorAnyGeometry
    return [
        QgsProcessingParameterMultipleLayers(name, title, kind, optional=True)
        for name, title in LAYER_TITLES.items()
    ]


def _value_parameters() -> list[QgsProcessingParameterDefinition]:
    numbers = (
        (DEFAULT_HEIGHT, tr("Height where none is known [m]"), 3.0),
        (DEFAULT_WIDTH, tr("Width of a road where none is known [m]"), DEFAULT_WIDTH_M),
    )
    limits = (
        (TOLERANCE, tr("A target is reached within [m]"), SiteSettings.reached_tolerance_m),
        (STALE_AFTER, tr("A robot is stale without a message for [s]"), _LIMITS.stale_after_s),
        (LOST_AFTER, tr("A robot is lost without a message for [s]"), _LIMITS.lost_after_s),
    )
    parameters: list[QgsProcessingParameterDefinition] = [
        QgsProcessingParameterNumber(name, title, _REAL, default) for name, title, default in numbers
    ]
    parameters += [
        QgsProcessingParameterNumber(
            name,
            tr("{title} (default: as published, at first {default:g})", title=title, default=default),
            _REAL,
            optional=True,
        )
        for name, title, default in limits
    ]
    parameters.append(
        QgsProcessingParameterBoolean(
            REPLACE, tr("Replace the publication of another site"), defaultValue=False
        )
    )
    return [*parameters[:2], *map(advanced, parameters[2:])]

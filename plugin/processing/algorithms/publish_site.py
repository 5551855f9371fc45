"""``fleet:publishsite``: layers by their roles in, the folder or the database that a gateway serves out."""

from __future__ import annotations

import math
from collections.abc import Mapping
from contextlib import ExitStack, nullcontext
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsMapLayer,
    QgsProcessing,
    QgsProcessingAlgorithm,
    QgsProcessingContext,
    QgsProcessingFeedback,
    QgsProcessingOutputNumber,
    QgsProcessingOutputString,
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

from ....robot_bridge.core.sites.settings import SETTINGS_FILE, SiteBounds, SiteSettings, earlier_settings
from ....robot_bridge.core.sites.settings_tables import LivenessLimits, value_text
from ....robot_bridge.core.sites.site_database import view_schema
from ...layers.crs import crs_name, is_engineering
from ...layers.layer_source import Setups, obstacle_sources
from ...layers.publishing.postgis import SiteDatabase, check_site_id, database_address, site_database
from ...layers.publishing.publication import (
    check_publication_values,
    exclusive_publication,
    new_publication,
    next_version,
)
from ...layers.publishing.site_file import SiteContent, SiteSources, check_content_sources
from ...layers.road_layers import DEFAULT_WIDTH_M
from ...layers.roles import KEEPOUT, OBSTACLE_ROLES, ROAD_CENTRELINE, ROAD_SURFACE, LayerExpressions
from ...layers.site_transform import SiteGeoreference
from ...ui.errors import FleetError, LayerTypeError
from ...ui.language import tr, tr_count, tr_page
from ..common.algorithm import FleetAlgorithm, ParameterError, Parameters, advanced, shown_by_processing
from ..common.export_parameters import DEFAULT_HEIGHT, default_height
from ..common.parameters import (
    LOCAL,
    check_vectors,
    chosen_crs,
    extent_in,
    frame_parameters,
    layers_of_project,
    layers_problem,
    profile_parameter,
    setups_of,
    site_frame,
    warn_of_profile,
)

# --- What a publication will hold, settled and checked before it starts ---

FOLDER, REPLACE, DATABASE = "FOLDER", "REPLACE", "DATABASE"
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

WHERE_NOT_KNOWN = SiteBounds(0.0, 0.0, 1.0, 1.0)


@dataclass(frozen=True)
class PublishParameters:
    """Everything that is needed of the parameters and layers; usable from any thread.

    The bounds of ``settings`` stand in where ``bounds_given`` is false, until the layers are read. Their
    version is as the folder was when the plan was made, and so are its limits but for those ``given``;
    ``replace_other`` lets another site be replaced. At least one of ``folder`` and ``database``, an address,
    is there.
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
    site = SiteGeoreference(crs, frame, context.transformContext(), local)
    check_content_sources(sources, site)
    folder, database = _targets(algorithm, parameters, context)
    given = _given_limits(algorithm, parameters, context)
    settings, bounds_given = _settings(algorithm, parameters, context, site)
    replace_other = algorithm.parameterAsBool(parameters, REPLACE, context)
    if folder is not None:
        settings = _with_limits(
            settings, given, earlier_settings(folder, settings.id), folder / SETTINGS_FILE
        )
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
    """Return the layers that are given, and those of the project where some are not given."""
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


def _with_limits(
    settings: SiteSettings, given: Mapping[str, float], earlier: str, place: Path
) -> SiteSettings:
    """Return ``settings`` with the limits ``given``; the others are those of the ``earlier`` site.toml.

    What is not there either has its default; ``place`` names the site.toml in messages.
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


# --- The help of ``fleet:publishsite`` ---

HELP = tr_page("""
<p>Writes the layers of a site into a folder with <i>site.toml</i> and <i>site.gpkg</i>, which
<i>robot-bridge serve --site FOLDER</i> serves.</p>
<p><b>Layers</b>: those of the project by their roles (menu Fleet Supervisor, Layer roles), or by a <b>map
profile</b>, or the layers given here. Which features count, heights, where things begin above the ground,
labels, road widths and shapes of furniture come from the expressions kept with the roles; heights, labels and
widths else from the fields <i>height</i> or <i>height_m</i>, <i>surface</i>, <i>name</i>, <i>width_m</i> or
<i>width</i>.</p>
<p><b>Version</b>: 1 for a new folder, else one more than the version there. A folder that holds another site
is refused unless <b>Replace</b> is ticked.</p>
<p><b>Database</b>: the site goes into PostgreSQL with PostGIS, too, or only there where no folder is given:
the layers as tables, with views of the newest version in the schema <i>site_ID</i>, and all that
<i>robot-bridge serve --site postgresql://account@host/database#ID</i> serves. It is a connection of QGIS's or
such an address.</p>
<p><b>Bounds</b>: the rectangle, along the axes of the site frame, that robots may be sent into. Obstacles are
published up to 100 m beyond it, so that a robot at its edge is told what stands there.</p>
<p><b>Site CRS, origin, rotation</b>: where the robots' (0, 0) is and how their x axis lies. Default: as the
project has it.</p>
<p>An earlier publication is replaced only after the new one is complete; a cancel leaves it as it was. Broken
geometry is repaired where that is safe and left out where it is not, each time with a warning that names the
layer and the feature. One publication into a folder runs at a time.</p>
""")
"""In one line, because QGIS takes every line break for the end of a paragraph."""


# --- ``fleet:publishsite``: layers by their roles in, the folder that a gateway serves out ---

LAYER_TITLES = {
    "OBSTACLES": tr("Obstacle layers, stairs, ramps and furniture (default: the project's with such a role)"),
    "ROAD_CENTRELINES": tr("Road centreline layers (default: the project's with that role)"),
    "ROAD_SURFACES": tr("Road surface layers (default: the project's with that role)"),
    "KEEPOUTS": tr("Keepout layers (default: the project's with that role)"),
}
FAR_ORIGIN_M = 50_000.0
"""Metres from the origin of a site frame to its site above which somebody may have forgotten to give one."""
NUMBERS = {
    "VERSION": tr("Version of the site"),
    "OBSTACLE_COUNT": tr("Obstacle outlines"),
    "CENTRELINE_COUNT": tr("Road centrelines"),
    "SURFACE_COUNT": tr("Road surfaces"),
    "KEEPOUT_COUNT": tr("Keepouts"),
    "WARNING_COUNT": tr("Warnings"),
}
ID, VIEWS = "ID", "SCHEMA"

_REAL = QgsProcessingParameterNumber.Type.Double
_LIMITS = LivenessLimits()


class PublishSite(FleetAlgorithm):
    """Publishes the project's layers as the site that a gateway serves (design, section 3)."""

    GROUP = ("sites", tr("Sites"))
    NAME = "publishsite"
    TITLE = tr("Publish site")
    SUMMARY = tr("Writes the layers of a site, by their roles, into the folder that a gateway serves.")
    HELP = HELP
    ICON = "publish_site.svg"
    TAGS = ("gateway", "site", "publish", "obstacle", "road", "keepout", "qgis_process")

    def initAlgorithm(self, configuration: dict[str, Any] | None = None):
        site = [
            QgsProcessingParameterString(SITE_ID, tr("Site id (default: the project's)"), optional=True),
            QgsProcessingParameterString(
                SITE_NAME, tr("Site name (default: the project's title)"), optional=True
            ),
            QgsProcessingParameterExtent(
                BOUNDS, tr("Where robots may be sent (default: all that is published)"), optional=True
            ),
        ]
        for parameter in (
            *_layer_parameters(),
            profile_parameter(),
            *site,
            *_value_parameters(),
            *frame_parameters(),
            QgsProcessingParameterProviderConnection(
                DATABASE, tr("Database of the published site (PostGIS)"), "postgres", optional=True
            ),
            # Optional for scripts that publish into a database only; a dialog proposes one as before.
            QgsProcessingParameterFolderDestination(
                FOLDER, tr("Folder of the published site"), optional=True, createByDefault=True
            ),
        ):
            self.addParameter(parameter)
        self.addOutput(QgsProcessingOutputString(ID, tr("Id of the site")))
        self.addOutput(QgsProcessingOutputString(VIEWS, tr("Schema of the site's views in the database")))
        for name, description in NUMBERS.items():
            self.addOutput(QgsProcessingOutputNumber(name, description))

    def checkParameterValues(self, parameters: Parameters, context: QgsProcessingContext):
        # Before QGIS's own checks, which say that a value is wrong and not why.
        try:
            read_publish_parameters(self, parameters, context)
        except FleetError as error:
            return False, str(error)
        return super().checkParameterValues(parameters, context)

    def prepareAlgorithm(
        self, parameters: Parameters, context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ):
        with shown_by_processing():
            self._plan = read_publish_parameters(self, parameters, context)
            layers = layers_to_publish(self, parameters, context)
            warn_of_profile(self, parameters, context, layers, feedback)
        return True

    def processAlgorithm(
        self, parameters: Parameters, context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ):
        plan = self._plan
        with shown_by_processing(feedback), ExitStack() as places:
            folder = plan.folder or Path(places.enter_context(TemporaryDirectory(prefix="fleet-site-")))
            places.enter_context(exclusive_publication(folder))
            database = None
            if plan.database:
                database = places.enter_context(site_database(plan.database, plan.settings.id))
            done = _publish(plan, folder, database, feedback)
            if done is None:
                return {}
            if database is not None:
                for schema in database.remove_earlier(done.settings):
                    feedback.pushInfo(
                        tr(
                            "The tables in the schema {schema} of an earlier version are in use: they stay "
                            "until the next publication.",
                            schema=schema,
                        )
                    )
        feedback.setProgress(100)
        settings, counts = done.settings, done.counts
        for place in filter(None, (plan.folder, _views_of(plan))):
            feedback.pushInfo(_report(settings, counts, place))
        results = {
            ID: settings.id,
            **dict(zip(NUMBERS, (settings.version, *counts, done.warnings), strict=True)),
        }
        if plan.folder is not None:
            results[FOLDER] = str(plan.folder)
        if plan.database:
            results[VIEWS] = view_schema(settings.id)
        return results


class _Published(NamedTuple):
    """A publication that is in force: its settings, how much of each layer it holds, and its warnings."""

    settings: SiteSettings
    counts: tuple[int, ...]
    warnings: int


def _publish(
    plan: PublishParameters, folder: Path, database: SiteDatabase | None, feedback: QgsProcessingFeedback
) -> _Published | None:
    """Publish in ``folder`` and ``database``, in both or in none; return None after a cancel."""
    settings, earlier = _following(plan, folder, database)
    content = _content(plan)
    with new_publication(folder, earlier) as publication:
        if not publication.write_layers(content, settings, feedback):
            return None
        if not plan.bounds_given:
            settings = replace(settings, bounds=_all_of(content))
        warnings = [*content.warnings(), *_origin_warnings(plan.site, settings.bounds)]
        for warning in warnings:
            feedback.pushWarning(warning)
        complete = publication.write_settings(settings)
        if feedback.isCanceled():
            return None
        switched = database.new_version(settings, complete, feedback) if database else nullcontext(True)
        with switched as is_whole:
            if not is_whole:
                return None
            publication.replace_earlier()
    return _Published(settings, tuple(content.counts.values()), len(warnings))


def _following(
    plan: PublishParameters, folder: Path, database: SiteDatabase | None
) -> tuple[SiteSettings, str]:
    """Return the settings of the next version, and the text of the site.toml that it follows.

    Again: another publication may have ended since the plan was made. What the operator set in the folder
    goes before what is in the database.
    """
    elsewhere = 0 if database is None else database.version
    settings = next_version(plan.settings, folder, replace_other=plan.replace_other, elsewhere=elsewhere)
    earlier = earlier_settings(folder, settings.id)
    if not earlier and database is not None:
        earlier = database.settings_text
        settings = _with_limits(settings, plan.given, earlier, Path(SETTINGS_FILE))
    return settings, earlier


def _views_of(plan: PublishParameters) -> str:
    if not plan.database:
        return ""
    return tr("the database, schema {schema}", schema=view_schema(plan.settings.id))


def _report(settings: SiteSettings, counts: tuple[int, ...], place: Path | str) -> str:
    return tr(
        "Site {id} version {version} is published in {folder}: {outlines}, "
        "{centrelines}, {surfaces}, {keepouts}; bounds {bounds} m",
        id=settings.id,
        version=settings.version,
        folder=place,
        outlines=tr_count(counts[0], "1 obstacle outline", "%n obstacle outlines"),
        centrelines=tr_count(counts[1], "1 centreline", "%n centrelines"),
        surfaces=tr_count(counts[2], "1 road surface", "%n road surfaces"),
        keepouts=tr_count(counts[3], "1 keepout", "%n keepouts"),
        bounds=", ".join(f"{edge:.10g}" for edge in settings.bounds),
    )


def _origin_warnings(site: SiteGeoreference, bounds: SiteBounds) -> list[str]:
    """Warn of a site frame that begins where its CRS does, which may be thousands of kilometres away."""
    away = math.hypot((bounds[0] + bounds[2]) / 2, (bounds[1] + bounds[3]) / 2)
    if site.local or site.frame.origin != (0.0, 0.0) or away < FAR_ORIGIN_M:
        return []
    return [
        tr(
            "The origin of the site frame is 0,0 of {crs}, {away:.0f} km from the site: robots get positions "
            "of seven digits. Give ORIGIN, a place of the site, unless that is meant.",
            crs=site.crs.authid(),
            away=away / 1000,
        )
    ]


def _content(plan: PublishParameters) -> SiteContent:
    bounds = plan.settings.bounds if plan.bounds_given else None
    return SiteContent(plan.sources, plan.site, bounds, plan.default_height, plan.default_width)


def _all_of(content: SiteContent) -> SiteBounds:
    extent = content.extent
    if extent is None:
        raise ParameterError(
            tr(
                "There is nothing to publish: the layers hold nothing that can be read. See the warnings, "
                "or give BOUNDS to publish an empty site."
            )
        )
    x_min, y_min, x_max, y_max = extent
    x_low, y_low = math.floor(x_min), math.floor(y_min)
    # A single straight wall has no width; a site still needs an inside.
    x_high, y_high = max(math.ceil(x_max), x_low + 1), max(math.ceil(y_max), y_low + 1)
    return SiteBounds(float(x_low), float(y_low), float(x_high), float(y_high))


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

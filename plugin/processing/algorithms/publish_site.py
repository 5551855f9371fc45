"""``fleet:publishsite``: layers by their roles in, a folder or database for a gateway out."""

from __future__ import annotations

import math
from contextlib import ExitStack, nullcontext
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

from qgis.core import (
    QgsProcessingContext,
    QgsProcessingFeedback,
    QgsProcessingOutputNumber,
    QgsProcessingOutputString,
)

from ....robot_bridge.core.sites.frame import SiteBounds
from ....robot_bridge.core.sites.settings import SETTINGS_FILE, SiteSettings, earlier_settings
from ....robot_bridge.core.sites.site_database import view_schema
from ...layers.publishing.postgis import SiteDatabase, site_database
from ...layers.publishing.publication import exclusive_publication, new_publication, next_version
from ...layers.publishing.site_content import SiteContent
from ...layers.site_transform import SiteGeoreference
from ...ui.errors import FleetError
from ...ui.language import tr, tr_count, tr_page
from ..common.algorithm import FleetAlgorithm, ParameterError, Parameters, shown_by_processing
from ..common.parameters import warn_of_profile
from ..common.publication_parameters import (
    FOLDER,
    PublishParameters,
    layers_to_publish,
    publication_parameters,
    read_publish_parameters,
    with_limits,
)

# --- The help ---

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
"""In one line, because QGIS treats every line break as the end of a paragraph."""


# --- The algorithm ---

FAR_ORIGIN_M = 50_000.0
"""Metres from the origin of a site frame to its site above which it was probably forgotten."""
NUMBERS = {
    "VERSION": tr("Version of the site"),
    "OBSTACLE_COUNT": tr("Obstacle outlines"),
    "CENTRELINE_COUNT": tr("Road centrelines"),
    "SURFACE_COUNT": tr("Road surfaces"),
    "KEEPOUT_COUNT": tr("Keepouts"),
    "WARNING_COUNT": tr("Warnings"),
}
ID, VIEWS = "ID", "SCHEMA"


class PublishSite(FleetAlgorithm):
    """Publishes the project's layers as the site that a gateway serves."""

    GROUP = ("sites", tr("Sites"))
    NAME = "publishsite"
    TITLE = tr("Publish site")
    SUMMARY = tr("Writes the layers of a site, by their roles, into the folder that a gateway serves.")
    HELP = HELP
    ICON = "publish_site.svg"
    TAGS = ("gateway", "site", "publish", "obstacle", "road", "keepout", "qgis_process")

    def initAlgorithm(self, configuration: dict[str, Any] | None = None):
        for parameter in publication_parameters():
            self.addParameter(parameter)
        self.addOutput(QgsProcessingOutputString(ID, tr("Id of the site")))
        self.addOutput(QgsProcessingOutputString(VIEWS, tr("Schema of the site's views in the database")))
        for name, description in NUMBERS.items():
            self.addOutput(QgsProcessingOutputNumber(name, description))

    def checkParameterValues(self, parameters: Parameters, context: QgsProcessingContext):
        # Before QGIS's own checks, which report an invalid value without the reason.
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
    """A completed publication: its settings, the number of features per layer, and its warnings."""

    settings: SiteSettings
    counts: tuple[int, ...]
    warnings: int


def _publish(
    plan: PublishParameters, folder: Path, database: SiteDatabase | None, feedback: QgsProcessingFeedback
) -> _Published | None:
    """Publish in ``folder`` and ``database``, in both or in none; return None if cancelled."""
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
    """Return the settings of the next version, and the text of the site.toml before it.

    Read again: another publication may have ended since the plan was made. The operator's settings in the
    folder win over those in the database.
    """
    elsewhere = 0 if database is None else database.version
    settings = next_version(plan.settings, folder, replace_other=plan.replace_other, elsewhere=elsewhere)
    earlier = earlier_settings(folder, settings.id)
    if not earlier and database is not None:
        earlier = database.settings_text
        settings = with_limits(settings, plan.given, earlier, Path(SETTINGS_FILE))
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
    """Warn of a site frame with the origin of its CRS, which may be thousands of kilometres away."""
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
    # A single straight wall has no width; a site still needs an interior.
    x_high, y_high = max(math.ceil(x_max), x_low + 1), max(math.ceil(y_max), y_low + 1)
    return SiteBounds(float(x_low), float(y_low), float(x_high), float(y_high))

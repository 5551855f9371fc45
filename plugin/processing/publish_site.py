"""``fleet:publishsite``: layers by their roles in, the folder that a gateway serves out."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

from qgis.core import (
    QgsProcessing,
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
    QgsProcessingParameterString,
)

from ...robot_bridge.sites.settings import Bounds, LivenessLimits, SiteSettings
from ..errors import FleetError
from ..language import tr, tr_count
from ..sites.ground_reading import DEFAULT_WIDTH_M
from ..sites.placing import SitePlacing
from ..sites.publication import new_publication, next_version
from ..sites.publication_lock import only_publication
from ..sites.site_content import SiteContent
from .errors import ParameterError, shown_by_processing
from .export_plan import DEFAULT_HEIGHT
from .fleet_algorithm import FleetAlgorithm, Parameters
from .map_profile import profile_parameter, warn_of_profile
from .map_window import frame_parameters
from .publish_help import HELP
from .publish_plan import (
    BOUNDS,
    DEFAULT_WIDTH,
    FOLDER,
    LOST_AFTER,
    REPLACE,
    SITE_ID,
    SITE_NAME,
    STALE_AFTER,
    TOLERANCE,
    PublishPlan,
    layers_to_publish,
    publish_plan,
)

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
ID = "ID"

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
            QgsProcessingParameterFolderDestination(FOLDER, tr("Folder of the published site")),
        ):
            self.addParameter(parameter)
        self.addOutput(QgsProcessingOutputString(ID, tr("Id of the site")))
        for name, description in NUMBERS.items():
            self.addOutput(QgsProcessingOutputNumber(name, description))

    def checkParameterValues(self, parameters: Parameters, context: QgsProcessingContext):
        # Before QGIS's own checks, which say that a value is wrong and not why.
        try:
            publish_plan(self, parameters, context)
        except FleetError as error:
            return False, str(error)
        return super().checkParameterValues(parameters, context)

    def prepareAlgorithm(
        self, parameters: Parameters, context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ):
        with shown_by_processing():
            self._plan = publish_plan(self, parameters, context)
            layers = layers_to_publish(self, parameters, context)
            warn_of_profile(self, parameters, context, layers, feedback)
        return True

    def processAlgorithm(
        self, parameters: Parameters, context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ):
        plan = self._plan
        with shown_by_processing(feedback), only_publication(plan.folder):
            # Anew: another publication may have ended since the plan was made.
            settings = next_version(plan.settings, plan.folder, replace_other=plan.replace_other)
            content = _content(plan)
            with new_publication(plan.folder) as publication:
                if not publication.write_layers(content, settings, feedback):
                    return {}
                if not plan.bounds_given:
                    settings = replace(settings, bounds=_all_of(content))
                warnings = [*content.warnings(), *_origin_warnings(plan.site, settings.bounds)]
                for warning in warnings:
                    feedback.pushWarning(warning)
                if not publication.replace_earlier(settings, feedback):
                    return {}
        feedback.setProgress(100)
        figures = (settings.version, *content.counts.values(), len(warnings))
        feedback.pushInfo(
            tr(
                "Site {id} version {version} is published in {folder}: {outlines}, "
                "{centrelines}, {surfaces}, {keepouts}; bounds {bounds} m",
                id=settings.id,
                version=settings.version,
                folder=plan.folder,
                outlines=tr_count(figures[1], "1 obstacle outline", "%n obstacle outlines"),
                centrelines=tr_count(figures[2], "1 centreline", "%n centrelines"),
                surfaces=tr_count(figures[3], "1 road surface", "%n road surfaces"),
                keepouts=tr_count(figures[4], "1 keepout", "%n keepouts"),
                bounds=", ".join(f"{edge:.10g}" for edge in settings.bounds),
            )
        )
        return {FOLDER: str(plan.folder), ID: settings.id, **dict(zip(NUMBERS, figures, strict=True))}


def _origin_warnings(site: SitePlacing, bounds: Bounds) -> list[str]:
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


def _content(plan: PublishPlan) -> SiteContent:
    bounds = plan.settings.bounds if plan.bounds_given else None
    return SiteContent(plan.sources, plan.site, bounds, plan.default_height, plan.default_width)


def _all_of(content: SiteContent) -> Bounds:
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
    return Bounds(float(x_low), float(y_low), float(x_high), float(y_high))


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
    for parameter in parameters[2:]:
        parameter.setFlags(parameter.flags() | QgsProcessingParameterDefinition.Flag.FlagAdvanced)
    return parameters

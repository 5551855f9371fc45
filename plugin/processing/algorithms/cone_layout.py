"""``fleet:conelayout``: a standard layout at a place or along a line, as a layer of cones."""

from __future__ import annotations

from typing import Any

import numpy as np
from qgis.core import (
    QgsFeature,
    QgsFeatureRequest,
    QgsProcessing,
    QgsProcessingContext,
    QgsProcessingFeedback,
    QgsProcessingParameterBoolean,
    QgsProcessingParameterFeatureSource,
    QgsProcessingParameterNumber,
    QgsProcessingParameterPoint,
    QgsProcessingParameterString,
)

from ....robot_bridge.core.geometry import theta_of
from ....robot_bridge.core.layouts.catalogue import LAYOUTS
from ....robot_bridge.core.layouts.layout import Cone, cones_along_line, cones_at_pose
from ...cone_texts import layout_in_words, whole_dimension_in_words
from ...layers.road_layers import lines_of
from ...layers.site_transform import SiteGeoreference
from ...ui.language import tr, tr_page
from ..common.algorithm import FleetAlgorithm, ParameterError, Parameters, enum_parameter, shown_by_processing
from ..common.cone_layers import STYLES, ConeSetup, add_layers, cone_crs_parameter, ground_parameters
from ..common.parameters import point_in

LAYOUT, DIMENSIONS, PREFIX = "LAYOUT", "DIMENSIONS", "PREFIX"
POINT, HEADING, LINE, LINE_ID, START, REVERSE = "POINT", "HEADING", "LINE", "LINE_ID", "START", "REVERSE"
_REAL = QgsProcessingParameterNumber.Type.Double
_WHOLE = QgsProcessingParameterNumber.Type.Integer


class ConeLayout(FleetAlgorithm):
    """Places the cones of a standard layout."""

    GROUP = ("cones", tr("Cones"))
    NAME = "conelayout"
    TITLE = tr("Cone layout")
    SUMMARY = tr(
        "Places a standard cone layout at a point and heading or along a line, and checks every cone."
    )
    ICON = "cone_layout.svg"
    TAGS = ("cone", "slalom", "lane change", "ISO 3888", "ISO 4138", "Formula Student", "skid pad", "moose")
    STYLES = STYLES
    HELP = tr_page("""
    <p>Places a layout of traffic cones, either at a <b>point</b>, turned to a <b>heading</b> (degrees
    clockwise from north), or along a <b>line</b> such as a road's centreline, from <b>start</b> metres after
    its beginning. The layer has an id, the order of placing, the heading of travel, the colour and the role
    of each cone.</p>
    <p><b>Dimensions</b> change the standard's: <code>vehicle_width=1.7; lane_offset=3</code>. The log lists
    those of the layout with their values. A wrong name or value is refused with what there is.</p>
    <p>Every cone is <b>checked</b>: on one of the surfaces (of the allowed classes), away from obstacles and
    from other cones. What is wrong becomes a layer of findings with the cone's id and the reason; the cones
    are placed nevertheless.</p>
    <pre>qgis_process run fleet:conelayout -- LAYOUT=iso3888_1 POINT="640432,5193486.2 [EPSG:32633]"
    HEADING=90 DIMENSIONS="vehicle_width=1.7; exit_length=15" SITE_CRS=EPSG:32633 CONES=cones.gpkg</pre>
    """)

    def initAlgorithm(self, configuration: dict[str, Any] | None = None):
        for parameter in (
            enum_parameter(
                LAYOUT,
                tr("Layout"),
                {name: layout_in_words(kind) for name, kind in LAYOUTS.items()},
                next(iter(LAYOUTS)),
            ),
            QgsProcessingParameterString(
                DIMENSIONS, tr("Dimensions other than the standard's, as name=value; ..."), optional=True
            ),
            QgsProcessingParameterPoint(POINT, tr("Place of the layout's origin"), optional=True),
            QgsProcessingParameterNumber(HEADING, tr("Heading, clockwise from north [degrees]"), _REAL, 0.0),
            QgsProcessingParameterFeatureSource(
                LINE,
                tr("Line to lie along, instead of a place"),
                [QgsProcessing.SourceType.TypeVectorLine],
                optional=True,
            ),
            QgsProcessingParameterNumber(
                LINE_ID, tr("Id of the line's feature (default: the only one)"), _WHOLE, optional=True
            ),
            QgsProcessingParameterNumber(START, tr("Begin so far along the line [m]"), _REAL, 0.0),
            QgsProcessingParameterBoolean(
                REVERSE, tr("Against the direction of the line"), defaultValue=False
            ),
            QgsProcessingParameterString(PREFIX, tr("Ids begin with (default: the layout)"), optional=True),
            *ground_parameters(),
            cone_crs_parameter(),
        ):
            self.addParameter(parameter)
        add_layers(self)

    def checkParameterValues(self, parameters: Parameters, context: QgsProcessingContext):
        given = [name for name in (POINT, LINE) if parameters.get(name) not in (None, "")]
        if len(given) != 1:
            how = tr("Both POINT and LINE are") if given else tr("Neither POINT nor LINE is")
            return False, tr(
                "{how} given: give the place of the layout, or a line that it lies along.", how=how
            )
        return super().checkParameterValues(parameters, context)

    def prepareAlgorithm(
        self, parameters: Parameters, context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ):
        with shown_by_processing():
            self._line = self.parameterAsSource(parameters, LINE, context)
            self._setup = ConeSetup(self, parameters, context, self._line)
        return True

    def processAlgorithm(
        self, parameters: Parameters, context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ):
        with shown_by_processing(feedback):
            kind = LAYOUTS[self.parameterAsEnumString(parameters, LAYOUT, context)]
            layout = kind.of(dimensions_in(self.parameterAsString(parameters, DIMENSIONS, context)))
            feedback.pushInfo(layout_in_words(kind))
            for one in kind.dimensions():
                value = f"{one.name}={getattr(layout, one.name):g} {one.unit}".rstrip()
                feedback.pushInfo(f"  {value}: {whole_dimension_in_words(kind, one)}")
            cones = layout.cones(self.parameterAsString(parameters, PREFIX, context).strip())
            placed_cones = self._placed(cones, parameters, context)
            return self._setup.write(self, parameters, context, placed_cones, kind.NAME, feedback)

    def _placed(self, cones: list[Cone], parameters: Parameters, context: QgsProcessingContext) -> list[Cone]:
        if self._line is None:
            point = point_in(self, parameters, POINT, context, self._setup.crs)
            theta = theta_of(self.parameterAsDouble(parameters, HEADING, context))
            return cones_at_pose(cones, *point, theta)
        points = self._points(parameters, context)
        if self.parameterAsBool(parameters, REVERSE, context):
            points = points[::-1]
        return cones_along_line(cones, points, self.parameterAsDouble(parameters, START, context))

    def _line_feature(self, parameters: Parameters, context: QgsProcessingContext) -> QgsFeature:
        """Return the one feature that the layout lies along."""
        request = QgsFeatureRequest()
        wanted = parameters.get(LINE_ID)
        if wanted not in (None, ""):
            request.setFilterFid(self.parameterAsInt(parameters, LINE_ID, context))
        features = list(self._line.getFeatures(request.setLimit(2)))
        if len(features) != 1:
            found = (
                tr("no feature {wanted}", wanted=wanted)
                if wanted not in (None, "")
                else tr("not exactly one feature")
            )
            raise ParameterError(
                tr(
                    "The layer {sourcename} has {found}: choose one line by LINE_ID, or select it and tick "
                    "'Selected features only'.",
                    sourcename=self._line.sourceName(),
                    found=found,
                )
            )
        return features[0]

    def _points(self, parameters: Parameters, context: QgsProcessingContext) -> np.ndarray:
        """Return the points of the one line, in the site CRS."""
        source, feature = self._line, self._line_feature(parameters, context)
        site = SiteGeoreference.in_crs(self._setup.crs, context.transformContext())
        placing = site.of_layer(source.sourceName(), source.sourceCrs())
        geometry = placing.of_feature(feature, [])
        lines = [] if geometry is None else lines_of(geometry, [])
        if not lines:
            raise ParameterError(
                tr(
                    "The feature {id} of {layer} has no line with a length and a place in the site's CRS: "
                    "correct it, or choose another.",
                    id=feature.id(),
                    layer=source.sourceName(),
                )
            )
        if len(lines) > 1:
            raise ParameterError(
                tr(
                    "The feature {id} of {sourcename} has {lines} lines: split it, or choose one that has "
                    "one.",
                    id=feature.id(),
                    sourcename=source.sourceName(),
                    lines=len(lines),
                )
            )
        return lines[0]


def dimensions_in(text: str) -> dict[str, float]:
    """Return the numbers of ``name=value; name=value``.

    :raises ParameterError: naming the part that is none.
    """
    values = {}
    for part in (part.strip() for part in text.replace(",", ";").split(";")):
        name, _, number = (word.strip() for word in part.partition("="))
        try:
            if part:
                values[name] = float(number)
        except ValueError as error:
            raise ParameterError(
                tr(
                    "DIMENSIONS has {part!r}, which is not name=value with a number: write such as "
                    "spacing=15.",
                    part=part,
                )
            ) from error
    return values

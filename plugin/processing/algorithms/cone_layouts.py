"""``fleet:conelayout`` and ``fleet:importconelayout``: layers of cones, of a standard layout or of a file."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from qgis.core import (
    NULL,
    QgsFeature,
    QgsFeatureRequest,
    QgsProcessing,
    QgsProcessingContext,
    QgsProcessingFeedback,
    QgsProcessingParameterBoolean,
    QgsProcessingParameterFeatureSource,
    QgsProcessingParameterFile,
    QgsProcessingParameterNumber,
    QgsProcessingParameterPoint,
    QgsProcessingParameterString,
    QgsWkbTypes,
)

from ....robot_bridge.core.geometry import theta_of
from ....robot_bridge.core.layouts import cone_files
from ....robot_bridge.core.layouts.catalogue import LAYOUTS
from ....robot_bridge.core.layouts.cone_files import ConeColumns
from ....robot_bridge.core.layouts.layout import Cone, cones_along_line, cones_at_pose
from ...cone_texts import layout_in_words, whole_dimension_in_words
from ...layers.crs import stated_crs
from ...layers.road_layers import lines_of
from ...layers.site_transform import SiteGeoreference
from ...ui.language import tr, tr_page
from ..common import cone_layers
from ..common.algorithm import FleetAlgorithm, ParameterError, Parameters, enum_parameter, shown_by_processing
from ..common.cone_layers import STYLES, ConeSetup
from ..common.parameters import point_in

# --- ``fleet:conelayout``: a standard layout at a place or along a line ---

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
            *cone_layers.ground_parameters(),
            cone_layers.cone_crs_parameter(),
        ):
            self.addParameter(parameter)
        cone_layers.add_layers(self)

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
        """Return the single feature along which the layout is placed."""
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
        """Return the points of the single line, in the site CRS."""
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

    :raises ParameterError: naming the invalid part.
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


# --- ``fleet:importconelayout``: cones from a CSV file or a layer, moved and rotated to their place ---

FILE, INPUT, ORIGIN, ROTATION, NAME = "FILE", "INPUT", "ORIGIN", "ROTATION", "LAYOUT_NAME"
X, Y = "X_FIELD", "Y_FIELD"
SUFFIXES = (".csv", ".txt", ".yaml", ".yml", ".sdf", ".world")
_COLUMNS = {
    X: ("x", tr("Column of x [m]"), "x_m"),
    Y: ("y", tr("Column of y [m]"), "y_m"),
    "ID_FIELD": ("id", tr("Column of ids"), ""),
    "ORDER_FIELD": ("order", tr("Column of the order of placing"), ""),
    "HEADING_FIELD": ("heading", tr("Column of headings, clockwise from the y axis [degrees]"), ""),
    "COLOUR_FIELD": ("colour", tr("Column of colours"), ""),
    "ROLE_FIELD": ("role", tr("Column of roles"), ""),
    "LAYOUT_FIELD": ("layout", tr("Column that names the layout of each row"), ""),
    "LAYOUT": ("only", tr("The one layout to take, by that column"), ""),
}


class ImportConeLayout(FleetAlgorithm):
    """Makes a layer of cones from a table or another layer."""

    GROUP = ("cones", tr("Cones"))
    NAME = "importconelayout"
    TITLE = tr("Import cone layout")
    SUMMARY = tr(
        "Places the cones of a CSV file or a layer, turned and moved to their place, and checks them."
    )
    ICON = "import_cone_layout.svg"
    TAGS = ("cone", "layout", "CSV", "import")
    STYLES = STYLES
    HELP = tr_page("""
    <p>Reads cones from a <b>CSV file</b> in UTF-8, from a <b>track</b> of Formula Student, or from a
    <b>layer</b>. Tracks are YAML with <i>cones_left</i>, <i>cones_right</i>, <i>cones_orange</i> and
    <i>cones_orange_big</i>, SDF with models of cones, CSV with columns such as <i>blue_x</i> and
    <i>blue_y</i> for each colour, or CSV without a head line: colour, x, y. Of other tables the columns are
    named by parameters; only those of x and y are needed, and not even those for a layer of points with a
    CRS, which is taken as it lies. A file or layer with several layouts gives one of them, by
    <b>LAYOUT_FIELD</b> and <b>LAYOUT</b>.</p>
    <p>Metres of a table are turned by <b>rotation</b> (degrees, counter-clockwise) and then moved to the
    <b>origin</b>. A row that cannot be read is named with its column, and nothing is placed.</p>
    <p>Every cone is <b>checked</b> as those of <i>Cone layout</i> are.</p>
    <pre>qgis_process run fleet:importconelayout -- FILE=cone_layouts.csv COLOUR_FIELD=colour
    LAYOUT_FIELD=track LAYOUT=eufs_skidpad ORIGIN="640520,5193530 [EPSG:32633]" ROTATION=90
    SITE_CRS=EPSG:32633 CONES=cones.gpkg</pre>
    """)

    def initAlgorithm(self, configuration: dict[str, Any] | None = None):
        real = QgsProcessingParameterNumber.Type.Double
        for parameter in (
            QgsProcessingParameterFile(
                FILE,
                tr("CSV file, or track of Formula Student (YAML, SDF)"),
                optional=True,
                # "All files" lets every file reach the check below, which reports what is accepted.
                fileFilter=tr(
                    "Cone layouts ({kinds});;All files (*)", kinds=" ".join(f"*{s}" for s in SUFFIXES)
                ),
            ),
            QgsProcessingParameterFeatureSource(
                INPUT, tr("Layer, instead of a file"), [QgsProcessing.SourceType.TypeVector], optional=True
            ),
            *(
                QgsProcessingParameterString(name, title, default, optional=True)
                for name, (_, title, default) in _COLUMNS.items()
            ),
            QgsProcessingParameterPoint(ORIGIN, tr("Where the table's 0,0 goes"), optional=True),
            QgsProcessingParameterNumber(ROTATION, tr("Rotation, counter-clockwise [degrees]"), real, 0.0),
            QgsProcessingParameterString(
                NAME, tr("Name (default: the layout's, else the file's)"), optional=True
            ),
            *cone_layers.ground_parameters(),
            cone_layers.cone_crs_parameter(),
        ):
            self.addParameter(parameter)
        cone_layers.add_layers(self)

    def checkParameterValues(self, parameters: Parameters, context: QgsProcessingContext):
        given = [name for name in (FILE, INPUT) if parameters.get(name) not in (None, "")]
        if len(given) != 1:
            how = tr("Both FILE and INPUT are") if given else tr("Neither FILE nor INPUT is")
            return False, tr("{how} given: give a CSV file, or a layer.", how=how)
        problem = _file_problem(parameters)
        return (False, problem) if problem else super().checkParameterValues(parameters, context)

    def prepareAlgorithm(
        self, parameters: Parameters, context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ):
        with shown_by_processing():
            self._source = self.parameterAsSource(parameters, INPUT, context)
            self._setup = ConeSetup(self, parameters, context, self._source)
        return True

    def processAlgorithm(
        self, parameters: Parameters, context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ):
        columns = ConeColumns(
            **{
                field: self.parameterAsString(parameters, name, context).strip()
                for name, (field, _, _) in _COLUMNS.items()
            }
        )
        with shown_by_processing(feedback):
            name = self._name(parameters, context, columns)
            if self._lies():
                cones = self._as_it_lies(columns, name, context)
            else:
                cones = self._moved(self._table(columns, name, parameters, context), parameters, context)
            return self._setup.write(self, parameters, context, cones, name, feedback)

    def _lies(self) -> bool:
        """Whether the cones come from points that are already in place."""
        source = self._source
        if source is None or not stated_crs(source.sourceCrs()).isValid():
            return False
        return QgsWkbTypes.geometryType(source.wkbType()) == QgsWkbTypes.GeometryType.PointGeometry

    def _name(self, parameters: Parameters, context: QgsProcessingContext, columns: ConeColumns) -> str:
        given = self.parameterAsString(parameters, NAME, context).strip() or columns.only
        if given:
            return given
        file = self.parameterAsFile(parameters, FILE, context)
        return self._source.sourceName() if self._source is not None else Path(file).stem

    def _table(
        self, columns: ConeColumns, name: str, parameters: Parameters, context: QgsProcessingContext
    ) -> list[Cone]:
        if self._source is None:
            return _cones_in(Path(self.parameterAsFile(parameters, FILE, context)), columns, name)
        rows = [_attributes(feature) for feature in self._source.getFeatures()]
        return cone_files.cones_of(rows, self._source.fields().names(), columns, name, first=1)

    def _as_it_lies(self, columns: ConeColumns, name: str, context: QgsProcessingContext) -> list[Cone]:
        """Return the cones of the layer's points, in the site CRS."""
        source = self._source
        site = SiteGeoreference.in_crs(self._setup.crs, context.transformContext())
        placing = site.of_layer(source.sourceName(), source.sourceCrs())
        points = cone_layers.point_rows(source.sourceName(), source.getFeatures(), placing, ())
        rows = [{**point.values, "$x": point.x, "$y": point.y} for point in points]
        head = [*source.fields().names(), "$x", "$y"]
        return cone_files.cones_of(rows, head, replace(columns, x="$x", y="$y"), name, first=1)

    def _moved(self, cones: list[Cone], parameters: Parameters, context: QgsProcessingContext) -> list[Cone]:
        if parameters.get(ORIGIN) in (None, ""):
            raise ParameterError(tr("ORIGIN is not given: say where the table's 0,0 goes."))
        origin = point_in(self, parameters, ORIGIN, context, self._setup.crs)
        turn = math.radians(self.parameterAsDouble(parameters, ROTATION, context))
        return cones_at_pose(cones, *origin, turn)


def _file_problem(parameters: Parameters) -> str:
    """Return the error in the file parameter before it is opened, or an empty text."""
    file = parameters.get(FILE)
    if not isinstance(file, (str, Path)) or not str(file):
        return ""
    if Path(file).suffix.lower() not in SUFFIXES:
        return tr(
            "FILE {file} is none that is read: give one of {kinds}.", file=file, kinds=", ".join(SUFFIXES)
        )
    try:
        Path(file).stat()
    except OSError as error:
        return tr("{file} cannot be read: {error}", file=file, error=error.strerror)
    return ""


def _cones_in(file: Path, columns: ConeColumns, name: str) -> list[Cone]:
    """Return the cones of a table or a track, in its own metres."""
    of_track = ConeColumns(colour=cone_files.COLOUR)
    if cone_files.is_track(file):
        return cone_files.cones_of(cone_files.read_track(file), cone_files.HEAD, of_track, name, first=1)
    if (rows := cone_files.headless_rows(file)) is not None:
        return cone_files.cones_of(rows, cone_files.HEAD, of_track, name, first=1)
    head, table = cone_files.read_csv(file)
    if columns.x not in head and (rows := cone_files.colour_table(head, table)) is not None:
        return cone_files.cones_of(rows, cone_files.HEAD, of_track, name, first=1)
    return cone_files.cones_of(table, head, columns, name)


def _attributes(feature: QgsFeature) -> dict[str, Any]:
    """Return the attributes by name, None where there is none."""
    values = (None if value == NULL else value for value in feature.attributes())
    return dict(zip(feature.fields().names(), values, strict=True))

"""``fleet:importconelayout``: cones from a CSV file or a layer, moved and turned to their place."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

from qgis.core import (
    NULL,
    QgsFeature,
    QgsProcessing,
    QgsProcessingContext,
    QgsProcessingFeedback,
    QgsProcessingParameterFeatureSource,
    QgsProcessingParameterFile,
    QgsProcessingParameterNumber,
    QgsProcessingParameterPoint,
    QgsProcessingParameterString,
    QgsWkbTypes,
)

from ....robot_bridge.core.layouts.cone_files import (
    COLOUR,
    HEAD,
    ConeColumns,
    colour_table,
    cones_of,
    headless_rows,
    is_track,
    read_csv,
    read_track,
)
from ....robot_bridge.core.layouts.layout import Cone, cones_at_pose
from ...layers.crs import stated_crs
from ...layers.site_transform import SiteGeoreference
from ...ui.language import tr, tr_page
from ..common.algorithm import FleetAlgorithm, ParameterError, Parameters, shown_by_processing
from ..common.cone_layers import (
    STYLES,
    ConeSetup,
    add_layers,
    cone_crs_parameter,
    ground_parameters,
    point_rows,
)
from ..common.parameters import point_in

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
    """Makes a layer of cones of a table or of another layer."""

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
                # "All files" has every file reach the check below, which says what is accepted.
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
            *ground_parameters(),
            cone_crs_parameter(),
        ):
            self.addParameter(parameter)
        add_layers(self)

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
        """Whether the cones come from points that have a place already."""
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
        return cones_of(rows, self._source.fields().names(), columns, name, first=1)

    def _as_it_lies(self, columns: ConeColumns, name: str, context: QgsProcessingContext) -> list[Cone]:
        """Return the cones of the layer's points, in the site CRS."""
        source = self._source
        site = SiteGeoreference.in_crs(self._setup.crs, context.transformContext())
        placing = site.of_layer(source.sourceName(), source.sourceCrs())
        points = point_rows(source.sourceName(), source.getFeatures(), placing, ())
        rows = [{**point.values, "$x": point.x, "$y": point.y} for point in points]
        head = [*source.fields().names(), "$x", "$y"]
        return cones_of(rows, head, replace(columns, x="$x", y="$y"), name, first=1)

    def _moved(self, cones: list[Cone], parameters: Parameters, context: QgsProcessingContext) -> list[Cone]:
        if parameters.get(ORIGIN) in (None, ""):
            raise ParameterError(tr("ORIGIN is not given: say where the table's 0,0 goes."))
        origin = point_in(self, parameters, ORIGIN, context, self._setup.crs)
        turn = math.radians(self.parameterAsDouble(parameters, ROTATION, context))
        return cones_at_pose(cones, *origin, turn)


def _file_problem(parameters: Parameters) -> str:
    """Return what is wrong with the file before it is opened, or nothing."""
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
    of_track = ConeColumns(colour=COLOUR)
    if is_track(file):
        return cones_of(read_track(file), HEAD, of_track, name, first=1)
    if (rows := headless_rows(file)) is not None:
        return cones_of(rows, HEAD, of_track, name, first=1)
    head, table = read_csv(file)
    if columns.x not in head and (rows := colour_table(head, table)) is not None:
        return cones_of(rows, HEAD, of_track, name, first=1)
    return cones_of(table, head, columns, name)


def _attributes(feature: QgsFeature) -> dict[str, Any]:
    """Return the attributes by name, None where there is none."""
    values = (None if value == NULL else value for value in feature.attributes())
    return dict(zip(feature.fields().names(), values, strict=True))

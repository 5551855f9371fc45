"""``fleet:exportnavigationmap``: a robot map in, maps for common robots out."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from qgis.core import (
    QgsFeatureRequest,
    QgsProcessing,
    QgsProcessingContext,
    QgsProcessingFeatureSource,
    QgsProcessingFeedback,
    QgsProcessingOutputFile,
    QgsProcessingOutputNumber,
    QgsProcessingParameterDefinition,
    QgsProcessingParameterExpression,
    QgsProcessingParameterFeatureSource,
    QgsProcessingParameterFolderDestination,
    QgsProcessingParameterNumber,
    QgsProcessingParameterString,
)

from ...layers.layer_expressions import FeatureFilter
from ...ui.language import tr, tr_page
from ..common.algorithm import FleetAlgorithm, ParameterError, Parameters, enum_parameter, shown_by_processing
from ..common.map_files import MAP, PlacedMap, file_problem, map_parameters, map_place, read_map_file
from ..common.navigation_files import FORMAT_WRITERS as MADE
from ..common.navigation_files import Files, NavigationExport, areas_of, speed_by
from ..common.outputs import OutputError, WholeFolder
from ..common.parameters import filter_in

# --- The help of ``fleet:exportnavigationmap`` ---

HELP = tr_page("""
<p>Writes a robot map as other robots and people read it.</p>
<p><b>Robot map</b>: a file of <i>fleet:exportrobotmap</i> or of the gateway, text or binary.</p>
<p><b>Formats</b>, several at once:</p>
<ul>
<li><i>occupancy</i>: occupancy grid for Nav2 (PGM and YAML). What a wall touches is occupied, so thin walls
have no gap; courtyards are free; the inside of obstacles is unknown, or occupied on request. The frame of the
grid is the site frame.</li>
<li><i>keepout</i>: mask for Nav2's keepout filter, from the keepout layer, with the filter's parameters.</li>
<li><i>speed</i>: mask for Nav2's speed filter, from the speed layer and its expression in m/s. A limit is
never rounded up; where areas overlap the lower one holds.</li>
<li><i>geojson</i>: obstacles and segments in WGS 84 (RFC 7946).</li>
<li><i>geopackage</i>: the same in the site's CRS.</li>
<li><i>svg</i>, <i>png</i>: a picture for people.</li>
</ul>
<p><b>Keepout and speed layers</b> are polygons in any CRS. Where the map's place is not known, layers
are taken to be in its own metres, and a warning says so; <i>SITE_CRS</i>, <i>ORIGIN</i> and <i>ROTATION</i>
give it one.</p>
<p><b>Robots drive over</b> obstacles that are lower: 0 keeps every kerb. Ramps are always driven on, stairs
are obstacles, also from the side.</p>
<p>Existing files are replaced, each in one step, after all of them could be made. docs/navigation-maps.md
says what is in each.</p>
<p>From a script, with no display:</p>
<pre>qgis_process run fleet:exportnavigationmap --
  MAP=campus.txt FORMATS=occupancy FORMATS=svg RESOLUTION=0.05 OUTPUT=campus</pre>
""")


# --- ``fleet:exportnavigationmap``: a robot map in, maps for common robots out ---

FORMATS, NAME, OUTPUT = "FORMATS", "NAME", "OUTPUT"
RESOLUTION, INSIDE, DRIVES_OVER = "RESOLUTION", "INSIDE", "DRIVES_OVER"
KEEPOUTS, SPEED_AREAS, SPEED = "KEEPOUTS", "SPEED_AREAS", "SPEED"
UNKNOWN, OCCUPIED = "unknown", "occupied"
FORMAT_NAMES = {
    "occupancy": tr("Nav2 occupancy grid"),
    "keepout": tr("Nav2 keepout mask"),
    "speed": tr("Nav2 speed mask"),
    "geojson": "GeoJSON",
    "geopackage": "GeoPackage",
    "svg": "SVG",
    "png": "PNG",
}

_REAL = QgsProcessingParameterNumber.Type.Double
_POLYGONS = [QgsProcessing.SourceType.TypeVectorPolygon]


_PLACED = frozenset(("keepout", "speed", "geojson", "geopackage"))
"""Formats for which the map's place on the Earth matters."""


class _Collector(QgsProcessingFeedback):
    """Keeps warnings for later, so that they are counted with the others."""

    def __init__(self, warnings: list[str]):
        super().__init__(False)
        self._warnings = warnings

    def pushWarning(self, warning: str | None):
        self._warnings.append(warning)


class ExportNavigationMap(FleetAlgorithm):
    """Writes a robot map as Nav2 grids and masks, GeoJSON, GeoPackage and pictures."""

    NAME = "exportnavigationmap"
    TITLE = tr("Export navigation map")
    SUMMARY = tr("Writes a robot map as Nav2 occupancy grid and masks, GeoJSON, GeoPackage, SVG or PNG.")
    HELP = HELP
    ICON = "export_navigation_map.svg"
    TAGS = (
        "nav2",
        "ros",
        "occupancy grid",
        "pgm",
        "costmap",
        "keepout",
        "speed",
        "mask",
        "geojson",
        "geopackage",
        "svg",
        "png",
    )

    def initAlgorithm(self, configuration: dict[str, Any] | None = None):
        for parameter in _parameters():
            self.addParameter(parameter)
        for name in MADE:
            self.addOutput(QgsProcessingOutputFile(name.upper(), tr("File of format {name}", name=name)))
        self.addOutput(QgsProcessingOutputNumber("FILE_COUNT", tr("Files")))
        self.addOutput(QgsProcessingOutputNumber("WARNING_COUNT", tr("Warnings")))

    def checkParameterValues(self, parameters: Parameters, context: QgsProcessingContext):
        # Before QGIS's own checks, which report an invalid value without the reason.
        problem = (
            file_problem(parameters)
            or _format_problem(parameters)
            or _number_problem(parameters)
            or self._choice_problem(parameters, context)
        )
        return (False, problem) if problem else super().checkParameterValues(parameters, context)

    def processAlgorithm(
        self, parameters: Parameters, context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ):
        formats = self.parameterAsEnumStrings(parameters, FORMATS, context)
        source = Path(self.parameterAsFile(parameters, MAP, context))
        folder = Path(self.parameterAsString(parameters, OUTPUT, context))
        with shown_by_processing(feedback):
            export = self._plan(source, formats, parameters, context)
            self._read_areas(export, formats, parameters, context, feedback)
            made: dict[str, Files] = {}
            for number, format in enumerate(formats):
                if feedback.isCanceled():
                    return {}
                feedback.setProgressText(tr("Making {format}", format=format))
                made[format] = export.files(format)
                feedback.setProgress(90.0 * (number + 1) / len(formats))
            if feedback.isCanceled():
                return {}
            _write(made, folder, source, feedback)
        for warning in export.warnings:
            feedback.pushWarning(warning)
        feedback.setProgress(100)
        return _results(made, folder, len(export.warnings))

    def _plan(
        self, source: Path, formats: Sequence[str], parameters: Parameters, context: QgsProcessingContext
    ) -> NavigationExport:
        robot_map = read_map_file(source)
        warnings = list(robot_map.warnings)
        # Grids and pictures stay in the site's metres, wherever those are.
        noted = warnings if _PLACED.intersection(formats) else []
        place = map_place(self, parameters, context, robot_map.meta, _Collector(noted))
        return NavigationExport(
            robot_map=robot_map,
            place=PlacedMap(place, context.transformContext()),
            name=_name(self.parameterAsString(parameters, NAME, context), source),
            resolution=self.parameterAsDouble(parameters, RESOLUTION, context),
            inside=self.parameterAsEnumString(parameters, INSIDE, context),
            drives_over=self.parameterAsDouble(parameters, DRIVES_OVER, context),
            warnings=warnings,
        )

    def _read_areas(
        self,
        export: NavigationExport,
        formats: Sequence[str],
        parameters: Parameters,
        context: QgsProcessingContext,
        feedback: QgsProcessingFeedback,
    ) -> None:
        """Read the layers of the requested masks."""
        site = export.place.layers
        kinds = [name for name in ("keepout", "speed") if name in formats]
        if kinds and export.place.is_local:
            export.warnings.append(
                tr("The coordinates of the keepout and speed layers are taken as the map's own metres.")
            )
        if "keepout" in kinds:
            source, counted = self._layer(parameters, KEEPOUTS, context)
            export.keepouts, warnings = areas_of(source, site, counted, feedback)
            export.warnings += warnings
        if "speed" in kinds:
            source, counted = self._layer(parameters, SPEED_AREAS, context)
            expression = self.createExpressionContext(parameters, context, source)
            speed = speed_by(self.parameterAsString(parameters, SPEED, context), source, expression)
            export.speed_areas, warnings = areas_of(source, site, counted, feedback, speed)
            export.warnings += warnings

    def _layer(
        self, parameters: Parameters, name: str, context: QgsProcessingContext
    ) -> tuple[QgsProcessingFeatureSource, FeatureFilter | None]:
        source = self.parameterAsSource(parameters, name, context)
        if source is None:
            raise ParameterError(
                tr(
                    "{parameter} {layer} cannot be opened: check the file and the layer's name.",
                    parameter=name,
                    layer=parameters.get(name),
                )
            )
        # They are repaired here, with a warning each: QGIS would leave them out of the mask, or stop there.
        source.setInvalidGeometryCheck(QgsFeatureRequest.InvalidGeometryCheck.GeometryNoCheck)
        return source, filter_in(self, parameters, name, context)

    def _choice_problem(self, parameters: Parameters, context: QgsProcessingContext) -> str:
        """Return which input of the formats is missing, or an empty text."""
        formats = self.parameterAsEnumStrings(parameters, FORMATS, context)
        needed = {"keepout": (KEEPOUTS,), "speed": (SPEED_AREAS, SPEED)}
        for format, names in needed.items():
            for name in names:
                if format in formats and not parameters.get(name):
                    return tr(
                        "FORMATS has {format}, which needs {name}: give it, or leave {format} out.",
                        format=format,
                        name=name,
                    )
        return ""


def _parameters() -> list[QgsProcessingParameterDefinition]:
    robot_map, *place = map_parameters()
    return [
        robot_map,
        enum_parameter(FORMATS, tr("Formats"), FORMAT_NAMES, ["occupancy"], several=True),
        QgsProcessingParameterNumber(RESOLUTION, tr("Side of a cell of grid and masks [m]"), _REAL, 0.05),
        enum_parameter(
            INSIDE,
            tr("Inside of obstacles in the occupancy grid"),
            {UNKNOWN: tr("unknown"), OCCUPIED: tr("occupied")},
            UNKNOWN,
        ),
        QgsProcessingParameterNumber(DRIVES_OVER, tr("Robots drive over what is lower than [m]"), _REAL, 0.0),
        QgsProcessingParameterFeatureSource(KEEPOUTS, tr("Keepout areas"), _POLYGONS, optional=True),
        QgsProcessingParameterFeatureSource(
            SPEED_AREAS, tr("Areas with a speed limit"), _POLYGONS, optional=True
        ),
        QgsProcessingParameterExpression(
            SPEED, tr("Speed limit of each area [m/s]"), parentLayerParameterName=SPEED_AREAS, optional=True
        ),
        QgsProcessingParameterString(NAME, tr("Name of the files (default: the robot map's)"), optional=True),
        *place,
        QgsProcessingParameterFolderDestination(OUTPUT, tr("Folder")),
    ]


def _format_problem(parameters: Parameters) -> str:
    """Return the invalid format, or an empty text."""
    value = parameters.get(FORMATS)
    given = value.split(",") if isinstance(value, str) else value
    if not isinstance(given, (list, tuple)):
        return ""
    unknown = [name for name in given if name not in MADE]
    if unknown or not given:
        return tr(
            "FORMATS is {formats}: choose of {known}.",
            formats=", ".join(map(str, unknown)) or tr("empty"),
            known=", ".join(MADE),
        )
    return ""


def _number_problem(parameters: Parameters) -> str:
    """Return the invalid number and the reason, or an empty text."""
    for name, positive in ((RESOLUTION, True), (DRIVES_OVER, False)):
        value = parameters.get(name)
        if value is None:
            continue
        try:
            number = float(value)
        except (TypeError, ValueError):
            if not isinstance(value, str):
                continue
            number = math.nan
        if not math.isfinite(number) or number < 0 or (positive and number == 0):
            wanted = tr("above 0, such as 0.05") if positive else tr("of 0 or more")
            return tr(
                "{name} is {value}: give a number of metres {wanted}.",
                name=name,
                value=value,
                wanted=wanted,
            )
    return ""


def _name(given: str, source: Path) -> str:
    name = given.strip() or source.stem
    if Path(name).name != name or name.startswith("."):
        raise ParameterError(
            tr("NAME {name!r} is no file's name: leave out folders and leading dots.", name=name)
        )
    return name


def _write(made: Mapping[str, Files], folder: Path, source: Path, feedback: QgsProcessingFeedback) -> None:
    """Write all files into the folder or none, and none over the robot map."""
    files = {name: content for part in made.values() for name, content in part.items()}
    for name in files:
        target = folder / name
        if target.exists() and target.samefile(source):
            raise OutputError(
                tr("{target} is the robot map itself: choose another NAME or OUTPUT.", target=target)
            )
    with WholeFolder(folder, tr("The navigation map")) as whole:
        for name, content in files.items():
            whole.add(name, content)
        whole.publish()
    for name, content in files.items():
        feedback.pushInfo(tr("{target}: {content} bytes", target=folder / name, content=len(content)))


def _results(made: Mapping[str, Files], folder: Path, warnings: int) -> dict[str, Any]:
    return {
        OUTPUT: str(folder),
        "FILE_COUNT": sum(len(files) for files in made.values()),
        "WARNING_COUNT": warnings,
        **{format.upper(): str(folder / _to_open(files)) for format, files in made.items()},
    }


def _to_open(files: Files) -> str:
    """Return the file to open in a program: of a grid the YAML, which names its image."""
    names = list(files)
    return next((name for name in names if name.endswith(".yaml")), names[0])

"""Parameters of a robot map: format, simplification, obstacles, checked before an export; and its input."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from qgis.core import (
    QgsProcessing,
    QgsProcessingAlgorithm,
    QgsProcessingContext,
    QgsProcessingFeedback,
    QgsProcessingMultiStepFeedback,
    QgsProcessingParameterBoolean,
    QgsProcessingParameterDefinition,
    QgsProcessingParameterMultipleLayers,
    QgsProcessingParameterNumber,
    QgsProviderRegistry,
    QgsVectorLayer,
)

from ....robot_bridge.core.errors import MapCancelledError
from ....robot_bridge.core.robotmap.binary import CODEC_COLUMNS, CODEC_TEXT, encode
from ....robot_bridge.core.robotmap.builder import build_map
from ....robot_bridge.core.robotmap.model import Border, RobotMap, Window
from ....robot_bridge.core.robotmap.outlines import Outlines
from ....robot_bridge.core.robotmap.shaping import Shaping, shaped, shapely_module
from ....robot_bridge.core.robotmap.text_format import write_text
from ...layers.layer_source import ObstacleSource, obstacle_sources
from ...layers.obstacle_layers import ObstacleReading, check_sources, read_outlines
from ...layers.roles import OBSTACLE_ROLES, LayerExpressions
from ...layers.site_transform import SiteGeoreference
from ...ui.errors import LayerTypeError
from ...ui.language import first_of, tr
from .algorithm import ParameterError, Parameters, advanced, enum_parameter, layers_problem
from .map_files import obstacles_in_words
from .outputs import OutputError, check_target
from .parameters import (
    LOCAL,
    chosen_crs,
    layers_of_project,
    map_window,
    setups_of,
    site_frame,
)

# --- The parameters of a map's format: text, or one of the two binary codecs ---

_REAL = QgsProcessingParameterNumber.Type.Double
FORMAT, STRICT = "FORMAT", "STRICT"
# No comma in a choice: QGIS would split it in two.
TEXT, BINARY, COMPACT = "text", "binary", "compact"
_CODECS = {TEXT: None, BINARY: CODEC_TEXT, COMPACT: CODEC_COLUMNS}
_NAMES = {
    TEXT: tr("text"),
    BINARY: tr("binary: the text compressed"),
    COMPACT: tr("compact: binary in columns"),
}
_NOTHING = RobotMap(Border(0.0, 0.0, 1.0, 1.0), ())


@dataclass(frozen=True)
class MapFormat:
    """The format of a map; ``codec`` is empty for text."""

    codec: int | None = None
    strict: bool = False

    @property
    def suffix(self) -> str:
        """The suffix of a file name."""
        return "txt" if self.codec is None else "rmap"

    def written(self, robot_map: RobotMap) -> tuple[str, bytes]:
        """Return the map's text, and the bytes of its file.

        :raises RobotMapError: when it cannot be written in this format, or a package for it is missing.
        """
        text = write_text(robot_map, strict=self.strict)
        if self.codec is None:
            return text, text.encode()
        whole = self.codec == CODEC_COLUMNS and not self.strict
        return text, encode(robot_map if whole else text, self.codec)


def format_parameters() -> list[QgsProcessingParameterDefinition]:
    """Return the parameters."""
    title = tr("Format (compact: binary in columns, about a third of binary)")
    how = enum_parameter(FORMAT, title, _NAMES, TEXT)
    how.setHelp(
        tr(
            "text: lines that people and scripts read. binary: that text compressed, with a check sum. "
            "compact: the same map in columns of centimetres, also with a check sum (codec 2)."
        )
    )
    strict = QgsProcessingParameterBoolean(
        STRICT, tr("Bare map: no leading lines, no extras"), defaultValue=False
    )
    return [how, strict]


def read_map_format(
    algorithm: QgsProcessingAlgorithm, parameters: Parameters, context: QgsProcessingContext
) -> MapFormat:
    """Return the chosen format.

    :raises MissingCodecError: when it needs a package that this Python does not have.
    """
    codec = _CODECS[algorithm.parameterAsEnumString(parameters, FORMAT, context)]
    chosen = MapFormat(codec, algorithm.parameterAsBool(parameters, STRICT, context))
    # Before the run: otherwise a city would be read in vain if its map cannot be written.
    chosen.written(_NOTHING)
    return chosen


# --- The parameters that simplify outlines for a robot, before a map is built of them ---

PLANE_LOW, PLANE_HIGH, HEIGHT_STEP = "PLANE_LOW", "PLANE_HIGH", "HEIGHT_STEP"
DISSOLVE, CHAIN, TOLERANCE, SHORTEST = "DISSOLVE", "CHAIN", "TOLERANCE", "SHORTEST"

_HEIGHTS = {
    PLANE_LOW: (
        tr("Robot's plane from [m above the ground]"),
        tr(
            "What is not higher than this is left out: the robot drives over it. Stairs and ramps stay. "
            "Give the lower and the upper height together, or neither."
        ),
    ),
    PLANE_HIGH: (
        tr("Robot's plane up to [m above the ground]"),
        tr(
            "What begins at this height or above it is left out: the robot drives under it. Where things "
            "begin is said by the layers or by the parameter BASE_EXPRESSION."
        ),
    ),
}
_FLAGS = {
    DISSOLVE: (
        tr("Leave out walls that no robot outside can meet"),
        tr(
            "Those between buildings that touch, and lines inside or along buildings. What stays keeps its "
            "height and its source. Needs the Python package shapely 2."
        ),
    ),
    CHAIN: (
        tr("Join lines that meet end to end into one obstacle"),
        tr(
            "Only lines that are alike in height, label and all else. The source of a joined line is that "
            "of its first part and how many others are in it, such as walls:3+7."
        ),
    ),
}
_LENGTHS = {
    TOLERANCE: (
        tr("Fewer corners: how far an outline may then be from the drawn one [m]"),
        tr(
            "0 is off. An outline that would cross itself stays as it is. Needs the Python package shapely 2."
        ),
    ),
    SHORTEST: (
        tr("Shortest segment: corners nearer than this to the one before are left out [m]"),
        tr("0 is off. Ends of lines stay and rings keep three corners. Needs the Python package shapely 2."),
    ),
    HEIGHT_STEP: (
        tr("Heights are rounded up to a multiple of this [m]"),
        tr("0 is off. Half a metre makes a compact map smaller still, and no obstacle lower than it is."),
    ),
}


def shaping_parameters() -> list[QgsProcessingParameterDefinition]:
    """Return the parameters: advanced, each off by default."""
    described: list[tuple[QgsProcessingParameterDefinition, str]] = [
        *((QgsProcessingParameterNumber(n, t, _REAL, optional=True), h) for n, (t, h) in _HEIGHTS.items()),
        *((QgsProcessingParameterBoolean(n, t, defaultValue=False), h) for n, (t, h) in _FLAGS.items()),
        *((QgsProcessingParameterNumber(n, t, _REAL, 0.0), h) for n, (t, h) in _LENGTHS.items()),
    ]
    for parameter, help in described:
        parameter.setHelp(help)
    return [advanced(parameter) for parameter, _ in described]


def read_shaping(
    algorithm: QgsProcessingAlgorithm, parameters: Parameters, context: QgsProcessingContext
) -> Shaping | None:
    """Return the requested simplification, None for none.

    :raises ParameterError: when a value cannot be used.
    :raises MissingGeometryError: when a requested step needs a package that this Python does not have.
    """
    lengths = {name: algorithm.parameterAsDouble(parameters, name, context) for name in _LENGTHS}
    for name, value in lengths.items():
        if not 0 <= value < math.inf:
            raise ParameterError(
                tr("{name} is {value:g}: give a number of metres of 0 or more.", name=name, value=value)
            )
    dissolve, chain = (algorithm.parameterAsBool(parameters, name, context) for name in _FLAGS)
    if dissolve or lengths[TOLERANCE] or lengths[SHORTEST]:
        _check_shapely()
    plane = _plane(algorithm, parameters, context)
    if plane is None and not (dissolve or chain or any(lengths.values())):
        return None
    return Shaping(
        plane=plane,
        height_step=lengths[HEIGHT_STEP],
        dissolve=dissolve,
        chain=chain,
        tolerance=lengths[TOLERANCE],
        shortest=lengths[SHORTEST],
    )


def _plane(
    algorithm: QgsProcessingAlgorithm, parameters: Parameters, context: QgsProcessingContext
) -> tuple[float, float] | None:
    given = [parameters.get(name) not in (None, "") for name in _HEIGHTS]
    if not any(given):
        return None
    if not all(given):
        missing, other = (PLANE_HIGH, PLANE_LOW) if given[0] else (PLANE_LOW, PLANE_HIGH)
        raise ParameterError(
            tr(
                "{other} is given and {missing} is not: give both heights in metres, or none.",
                other=other,
                missing=missing,
            )
        )
    low, high = (algorithm.parameterAsDouble(parameters, name, context) for name in _HEIGHTS)
    if not -math.inf < low < high < math.inf:
        raise ParameterError(
            tr(
                "PLANE_LOW is {low:g} and PLANE_HIGH {high:g}: give the lower and the upper height in "
                "metres.",
                low=low,
                high=high,
            )
        )
    return low, high


def _check_shapely() -> None:
    version = shapely_module().__version__
    if int(version.partition(".")[0]) < 2:
        raise ParameterError(
            tr(
                "DISSOLVE, TOLERANCE and SHORTEST need the Python package shapely 2, and {version} is "
                "installed here: install a newer one (python3 -m pip install 'shapely>=2'), or leave them "
                "off.",
                version=version,
            )
        )


# --- The plan of an export, checked before it starts ---

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
"""The parameters whose expressions apply to layers without their own."""


@dataclass(frozen=True)
class ObstacleParameters:
    """Input, georeference, simplification and format; usable from any thread."""

    sources: list[ObstacleSource]
    site: SiteGeoreference
    default_height: float
    shaping: Shaping | None
    format: MapFormat

    @property
    def meta(self) -> dict[str, str]:
        """The leading lines of the map, spelled like those of a published site."""
        frame = self.site.frame
        if not self.site.crs.isValid():
            return {}
        return {
            "crs": frame.crs,
            "origin": f"{frame.origin[0]:.3f},{frame.origin[1]:.3f}",
            "rotation": f"{frame.rotation:.9f}",
        }


@dataclass(frozen=True)
class ExportParameters(ObstacleParameters):
    """Everything from the parameters and layers that the export of one window needs."""

    window: Window
    target: Path


def read_export_parameters(
    algorithm: QgsProcessingAlgorithm, parameters: Parameters, context: QgsProcessingContext
) -> ExportParameters:
    """Return the plan for ``parameters``; must be called in the main thread.

    :raises FleetError: when a parameter or a layer cannot be used.
    :raises WindowError: when the window encloses nothing.
    """
    plan = read_obstacle_parameters(algorithm, parameters, context)
    return ExportParameters(
        **vars(plan),
        window=map_window(algorithm, parameters, context, plan.site.crs, plan.site.frame),
        target=_target(algorithm, parameters, context),
    )


def read_obstacle_parameters(
    algorithm: QgsProcessingAlgorithm, parameters: Parameters, context: QgsProcessingContext
) -> ObstacleParameters:
    """Return the input for ``parameters``; must be called in the main thread.

    :raises FleetError: when a parameter or a layer cannot be used.
    :raises RobotMapError: when a requested step needs a package that this Python does not have.
    """
    layers = obstacle_layers(algorithm, parameters, context)
    # As strings: parameterAsExpression silently replaces an invalid expression by the default.
    general = LayerExpressions(
        **{what: algorithm.parameterAsString(parameters, name, context) for what, name in GENERAL.items()}
    )
    setups = setups_of(algorithm, parameters, context)
    scopes = algorithm.createExpressionContext(parameters, context)
    sources = obstacle_sources(layers, general, scopes, setups)
    crs = chosen_crs(algorithm, parameters, context, [source.crs for source in sources])
    frame = site_frame(algorithm, parameters, context, crs)
    local = algorithm.parameterAsBool(parameters, LOCAL, context)
    site = SiteGeoreference(crs, frame, context.transformContext(), local)
    check_sources(sources, site)
    shaping = read_shaping(algorithm, parameters, context)
    return ObstacleParameters(
        sources,
        site,
        default_height(algorithm, parameters, context),
        shaping,
        read_map_format(algorithm, parameters, context),
    )


def obstacles_parameter() -> QgsProcessingParameterDefinition:
    """Return the parameter of the layers that are read."""
    return QgsProcessingParameterMultipleLayers(
        OBSTACLES,
        tr("Obstacle layers (default: those of the project with such a role)"),
        QgsProcessing.SourceType.TypeVectorAnyGeometry,
        optional=True,
    )


def obstacle_layers(
    algorithm: QgsProcessingAlgorithm, parameters: Parameters, context: QgsProcessingContext
) -> list[QgsVectorLayer]:
    """Return the layers in OBSTACLES; if empty, the project's with a role of obstacles.

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

    :raises ParameterError: when it is invalid.
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


# --- The obstacles of an export: read from their layers, then simplified as requested ---


def obstacle_outlines(
    plan: ObstacleParameters, area: Window, feedback: QgsProcessingFeedback
) -> tuple[ObstacleReading, Outlines, RobotMap | None] | None:
    """Return the outlines read in ``area`` and those of which maps are built; None if cancelled.

    Last comes the map of ``area``, where it was built to report the reduction.

    :raises LayerReadingError: when a layer cannot be read.
    :raises MissingGeometryError: when a package is missing.
    """
    steps = QgsProcessingMultiStepFeedback(1 if plan.shaping is None else 2, feedback)
    reading = read_outlines(plan.sources, plan.site, area.border, plan.default_height, steps)
    if not reading.complete:
        return None
    if plan.shaping is None:
        return reading, reading.outlines(), None
    steps.setCurrentStep(1)
    made = _reduced(reading.outlines(), plan, plan.shaping, area, steps)
    return None if made is None else (reading, *made)


def _reduced(
    outlines: Outlines,
    plan: ObstacleParameters,
    shaping: Shaping,
    area: Window,
    feedback: QgsProcessingFeedback,
) -> tuple[Outlines, RobotMap] | None:
    """Return the reduced outlines and their map of ``area``, None if cancelled; report the differences."""
    feedback.setProgressText(tr("Reducing obstacles"))
    try:
        made = shaped(outlines, shaping, lambda share: feedback.setProgress(100 * share), feedback.isCanceled)
    except MapCancelledError:
        return None
    before, after = build_map(outlines, area), build_map(made, area, plan.meta)
    # Fewer walls can be more obstacles: the rest of a ring is open chains.
    feedback.pushInfo(
        tr(
            "{before} became {after}",
            before=obstacles_in_words(len(before.obstacles), before.segment_count),
            after=obstacles_in_words(len(after.obstacles), after.segment_count),
        )
    )
    return made, after


def surrounding_note(sources: Sequence[str]) -> list[str]:
    """Return a warning where there are ``sources`` of obstacles that contain a whole map."""
    if not sources:
        return []
    return [
        tr(
            "A whole map lies inside of {sources} and has no wall of it: maps hold walls alone, and do not "
            "say that a robot is in there. Choose a larger window or larger tiles.",
            sources=", ".join(first_of(sources)),
        )
    ]

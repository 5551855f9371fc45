"""Base class of the algorithms: errors, help, validation of parameters, labels, order of result layers."""

from __future__ import annotations

import functools
import html
import math
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from qgis.core import (
    QgsApplication,
    QgsFields,
    QgsLayerTreeGroup,
    QgsLayerTreeLayer,
    QgsLayerTreeNode,
    QgsMapLayer,
    QgsProcessingAlgorithm,
    QgsProcessingContext,
    QgsProcessingException,
    QgsProcessingFeatureSourceDefinition,
    QgsProcessingFeedback,
    QgsProcessingLayerPostProcessorInterface,
    QgsProcessingParameterDefinition,
    QgsProcessingParameterEnum,
    QgsProcessingUtils,
    QgsProject,
    QgsProviderRegistry,
    QgsVectorLayer,
    QgsWkbTypes,
)
from qgis.PyQt import sip
from qgis.PyQt.QtGui import QIcon

from ....robot_bridge.core.errors import AssignmentError, LayoutsError, RoadsError, RobotMapError
from ...ui.errors import FleetError
from ...ui.language import tr

# --- Errors reported to the user of an algorithm ---


class ParameterError(FleetError):
    """A parameter of an algorithm cannot be used."""


@contextmanager
def shown_by_processing(feedback: QgsProcessingFeedback | None = None) -> Iterator[None]:
    """Convert errors of the plugin and of the bridge into what Processing shows without a traceback.

    With the ``feedback`` of a run also a cancel in ``qgis_process``, whose exit status would otherwise mean
    success to a script.
    """
    try:
        yield
    except (FleetError, RobotMapError, RoadsError, LayoutsError, AssignmentError) as error:
        raise QgsProcessingException(str(error)) from error
    if feedback is not None and feedback.isCanceled() and QgsApplication.platform() == "qgis_process":
        raise QgsProcessingException(tr("It was cancelled before its end."))


# --- Labels of parameters, short enough for an algorithm's dialog as QGIS opens it ---
# QGIS makes the dialog's page as wide as its longest label, and scrolls sideways to the buttons beside the
# fields. The rest of a label goes into the help of the parameter: its tool tip, and ``qgis_process help``.

ROOM = 54
"""Letters that fit, including those of the word [optional], which QGIS appends."""
OPTIONAL = 11
_IN_BRACKETS = re.compile(r"^(?P<label>.+?) \((?P<note>.+)\)$")
_AFTER_COLON = re.compile(r"^(?P<label>.+?): (?P<note>.+?)(?P<unit> \[[^]]+\])?$")
_AFTER_COMMA = re.compile(r"^(?P<label>.+?), (?P<note>.+?)(?P<unit> \[[^]]+\])?$")


def fit_label(parameter: QgsProcessingParameterDefinition) -> None:
    """Shorten the label of ``parameter`` where it is too long; the rest is put in front of its help."""
    if len(parameter.description()) <= ROOM - OPTIONAL:  # nearly all: the rest is not asked for
        return
    is_optional = bool(parameter.flags() & QgsProcessingParameterDefinition.Flag.FlagOptional)
    label, notes = shortened_label(parameter.description(), ROOM - OPTIONAL * is_optional)
    if notes:
        parameter.setDescription(label)
        parameter.setHelp(" ".join(filter(None, (*notes, parameter.help()))))


def shortened_label(text: str, room: int) -> tuple[str, list[str]]:
    """Return a label of at most ``room`` letters, if possible, and the omitted parts, as sentences.

    Its remark in brackets is omitted first, then the part after a colon or a comma; a unit stays.
    """
    notes: list[str] = []
    for pattern in (_IN_BRACKETS, _AFTER_COLON, _AFTER_COMMA):
        if len(text) > room and (found := pattern.match(text)):
            note = found["note"]
            notes.insert(0, f"{note[0].upper()}{note[1:]}.")
            text = found["label"] + (found.groupdict().get("unit") or "")
    return text, notes


# --- Choices among fixed values: scripts give a value, dialogs show its name ---


def enum_parameter(
    name: str, title: str, names: Mapping[str, str], default: str | Sequence[str], *, several: bool = False
) -> QgsProcessingParameterEnum:
    """Return the parameter ``name`` whose values are the keys of ``names``, shown by their names.

    QGIS stores the value, in its history and in models, too: it is the same in every language.
    """
    choice = QgsProcessingParameterEnum(
        name,
        title,
        options=list(names),
        allowMultiple=several,
        defaultValue=default,
        usesStaticStrings=True,
    )
    # By its path: only a dialog may load widgets.
    widget = f"{__package__}.choice_widget.ChoiceWidget"
    choice.setMetadata({"widget_wrapper": {"class": widget, "names": dict(names)}})
    return choice


def advanced(parameter: QgsProcessingParameterDefinition) -> QgsProcessingParameterDefinition:
    """Return ``parameter``, marked as advanced: dialogs fold it away."""
    parameter.setFlags(parameter.flags() | QgsProcessingParameterDefinition.Flag.FlagAdvanced)
    return parameter


# --- Parameters in messages: dialogs show labels, scripts use names ---

_NAME = re.compile(r"\b[A-Z][A-Z_]+\b")
_ASIDE = re.compile(r"\s*[(\[].*$")
"""The remark of a label in brackets: a unit, a default."""


def with_labels(text: str, definitions: Sequence[QgsProcessingParameterDefinition]) -> str:
    """Return ``text`` with the label of each parameter in place of its name: a dialog shows no names."""
    labels = {one.name(): _ASIDE.sub("", one.description()).strip(" :,") for one in definitions}
    return _NAME.sub(lambda name: f"“{labels[name[0]]}”" if labels.get(name[0]) else name[0], text)


def is_in_a_dialog() -> bool:
    """Return whether algorithms are run by dialogs here, and not by the names of parameters."""
    return bool(QgsApplication.platform() == "desktop")


def problems_with_labels(check: Callable[..., tuple[bool, str]]) -> Callable[..., tuple[bool, str]]:
    """Make the problem that ``checkParameterValues`` returns name parameters as the dialog does."""

    @functools.wraps(check)
    def checked(algorithm: Any, *arguments: Any) -> tuple[bool, str]:
        fine, problem = check(algorithm, *arguments)
        if problem and is_in_a_dialog():
            problem = with_labels(problem, algorithm.parameterDefinitions())
        return fine, problem

    return checked


def errors_with_labels(work: Callable[..., Any]) -> Callable[..., Any]:
    """Make the errors of a step of an algorithm name parameters as the dialog does."""

    @functools.wraps(work)
    def worked(algorithm: Any, *arguments: Any) -> Any:
        try:
            return work(algorithm, *arguments)
        except QgsProcessingException as error:
            if not is_in_a_dialog():
                raise
            raise QgsProcessingException(with_labels(str(error), algorithm.parameterDefinitions())) from error

    return worked


# --- Values in scripts that QGIS would silently misread ---
# QGIS ignores unknown parameters, takes any word but "false" for true, and a word for a missing
# number where a number may be left out.

_TRUTHS = ("true", "false", "1", "0")


def value_problem(
    definitions: Sequence[QgsProcessingParameterDefinition],
    parameters: Mapping[str, Any],
    context: QgsProcessingContext,
) -> str:
    """Return the error of the first value that QGIS would misread, or an empty text."""
    known = {definition.name(): definition for definition in definitions}
    for name, value in parameters.items():
        if name not in known:
            return tr(
                "There is no parameter {name}: correct it or leave it out. There are: {names}.",
                name=name,
                names=", ".join(known),
            )
        if known[name].type() in _LAYER_TYPES and (problem := layers_problem(parameters, name, context)):
            return problem
        wanted = _expected(known[name], value, context)
        if wanted:
            return tr("{name} is {value}: give {wanted}.", name=name, value=value, wanted=wanted)
    return ""


def _expected(definition: QgsProcessingParameterDefinition, value: Any, context: QgsProcessingContext) -> str:
    """Return the value expected in place of ``value``, empty where it is valid or QGIS reports it."""
    if not isinstance(value, str) or not value:
        return ""
    kind = definition.type()
    if kind == "boolean":
        return "" if value.lower() in _TRUTHS else tr("true or false")
    if kind in ("number", "distance"):
        return "" if _is_number(value) else tr("a number")
    if definition.checkValueIsAcceptable(value, context):
        return ""
    if isinstance(definition, QgsProcessingParameterEnum):
        return tr("one of {options}", options=", ".join(definition.options()))
    if kind == "point":
        return tr("'x,y', or 'x,y [EPSG:4326]' in another CRS")
    return tr("'xmin,xmax,ymin,ymax'") if kind == "extent" else ""


def _is_number(value: str) -> bool:
    try:
        # Python accepts 1_000 as a number, QGIS does not.
        return math.isfinite(float(value)) and "_" not in value
    except ValueError:
        return False


# --- Layers of a parameter, before they are read ---

_LAYER_TYPES = ("source", "vector", "multilayer")
SHOWN = 6
"""Number of layers of a file that are named."""


def layers_problem(parameters: Parameters, name: str, context: QgsProcessingContext) -> str:
    """Return the error of the first layer in the parameter ``name`` that cannot be read, or an empty text.

    Where there are others, Processing itself silently ignores such a layer; and of a file with several
    layers it takes the first.
    """
    values = parameters.get(name)
    for value in values if isinstance(values, (list, tuple)) else [values]:
        if isinstance(value, QgsProcessingFeatureSourceDefinition):
            value = value.source.staticValue()
        problem = _problem(name, value, context) if isinstance(value, str) and value else ""
        if problem:
            return problem
    return ""


def _problem(name: str, value: str, context: QgsProcessingContext) -> str:
    layer = QgsProcessingUtils.mapLayerFromString(value, context)
    if layer is None:
        return tr(
            "{name}: the layer {layer} cannot be opened: check the file, and the layer's name after "
            "'|layername='.",
            name=name,
            layer=value,
        )
    project = context.project()
    of_project = project is not None and project.mapLayer(layer.id()) is not None
    inside = [] if of_project else _layers_beside(layer)
    if not inside:
        return ""
    return tr(
        "{name}: the file {file} holds {count} layers ({layers}): say which, as in {file}|layername={first}.",
        name=name,
        file=value,
        count=len(inside),
        layers=", ".join(inside[:SHOWN]) + (", …" if len(inside) > SHOWN else ""),
        first=inside[0],
    )


def _layers_beside(layer: QgsMapLayer) -> list[str]:
    """Return the layers with geometry in the file of ``layer``, empty where it is the only one or named."""
    registry = QgsProviderRegistry.instance()
    parts = registry.decodeUri(layer.providerType(), layer.source())
    if layer.providerType() != "ogr" or parts.get("layerName") or parts.get("layerId") is not None:
        return []
    found = registry.providerMetadata("ogr").querySublayers(str(parts.get("path")))
    bare = QgsWkbTypes.Type.NoGeometry
    names = list(dict.fromkeys(sublayer.name() for sublayer in found if sublayer.wkbType() != bare))
    return names if len(names) > 1 else []


# --- The place of results in the layer tree: above layers that would cover them ---

_AREAS = QgsWkbTypes.GeometryType.PolygonGeometry


def put_above_areas(sources: Sequence[str], context: QgsProcessingContext) -> None:
    """Have QGIS put the layers ``sources``, from top to bottom, above all polygons and pictures.

    QGIS puts a result above the current layer, where an aerial photo or buildings may
    cover it. ``context`` must load all of them.
    """
    layers = [QgsProcessingUtils.mapLayerFromString(one, context) for one in sources]
    order = _Order([layer.id() for layer in layers if layer is not None])
    for source in sources:
        raising = _Raising(order)
        context.layerToLoadOnCompletionDetails(source).setPostProcessor(raising)
        # The context deletes it, but does not keep it alive; its owner does until then.
        sip.transferto(raising, raising)


@dataclass
class _Order:
    """The ids of the layers of one run from top to bottom, and of those that are in the layer tree."""

    ids: list[str]
    loaded: set[str] = field(default_factory=set)


class _Raising(QgsProcessingLayerPostProcessorInterface):
    """Puts a layer in its place, once QGIS has loaded it."""

    def __init__(self, order: _Order) -> None:
        super().__init__()
        self._order = order

    def postProcessLayer(
        self, layer: QgsMapLayer, context: QgsProcessingContext, feedback: QgsProcessingFeedback
    ):
        project = context.project()
        if project is None or project.layerTreeRoot().findLayer(layer.id()) is None:
            return
        self._order.loaded.add(layer.id())
        ids = [one for one in self._order.ids if one in self._order.loaded]
        _raise_in_tree(project.layerTreeRoot(), ids)
        _raise_in_custom_order(project, ids)


def _raise_in_tree(root: QgsLayerTreeGroup, ids: Sequence[str]) -> None:
    nodes = [node for node in (root.findLayer(one) for one in ids) if node is not None]
    children = root.children()
    place = next((k for k, child in enumerate(children) if _covers(child, ids)), len(children))
    # Before the old ones go: QGIS removes a layer from the project that is nowhere in the tree.
    root.insertChildNodes(place, [node.clone() for node in nodes])
    for node in nodes:
        parent = node.parent()
        if isinstance(parent, QgsLayerTreeGroup):
            parent.removeChildNode(node)


def _raise_in_custom_order(project: QgsProject, ids: Sequence[str]) -> None:
    root = project.layerTreeRoot()
    if not root.hasCustomLayerOrder():
        return
    others = [layer for layer in root.customLayerOrder() if layer.id() not in ids]
    place = next((k for k, layer in enumerate(others) if _is_opaque(layer)), len(others))
    raised = [layer for layer in (project.mapLayer(one) for one in ids) if layer is not None]
    root.setCustomLayerOrder([*others[:place], *raised, *others[place:]])


def _covers(node: QgsLayerTreeNode, ids: Sequence[str]) -> bool:
    """Return whether ``node`` is or contains a layer, except ``ids``, that may cover layers below it."""
    if isinstance(node, QgsLayerTreeGroup):
        return any(_covers(child, ids) for child in node.children())
    return isinstance(node, QgsLayerTreeLayer) and node.layerId() not in ids and _is_opaque(node.layer())


def _is_opaque(layer: QgsMapLayer | None) -> bool:
    """Return whether ``layer`` may cover layers below it, as all do but points, lines and tables."""
    if isinstance(layer, QgsVectorLayer):
        return bool(layer.geometryType() == _AREAS)
    return layer is not None


# --- The algorithms' common base: their place in the toolbox, their help, styled results ---

RESOURCES = Path(__file__).parents[3] / "resources"

Parameters = Mapping[str, Any]
"""The input of an algorithm: the user's choices by the names of its parameters."""


_AS_SHOWN = {
    "<b>": "<strong>",
    "</b>": "</strong>",
    "<pre>": '<p style="white-space: pre-wrap; font-family: monospace">',
    "</pre>": "</p>",
}


_WITH_LABELS = {
    "checkParameterValues": problems_with_labels,
    "prepareAlgorithm": errors_with_labels,
    "processAlgorithm": errors_with_labels,
}
"""The methods that report on parameters, and the wrapper that makes each use the dialog's labels."""


class FleetAlgorithm(QgsProcessingAlgorithm):
    """Base class of the provider's algorithms; subclasses set the class attributes."""

    GROUP = ("robotmaps", tr("Robot maps"))
    """Id and title of its group in the toolbox."""
    NAME = ""
    TITLE = ""
    SUMMARY = ""
    HELP = ""
    ICON = ""
    TAGS: tuple[str, ...] = ()
    STYLES: dict[str, str] = {}  # noqa: RUF012
    """The style, in resources/styles, of each output layer."""
    ABOVE_AREAS: tuple[str, ...] = ()
    """Output layers that are put above all areas, from top to bottom."""

    def __init_subclass__(cls, **more: Any) -> None:
        super().__init_subclass__(**more)
        for name, dressed in _WITH_LABELS.items():
            if name in vars(cls):
                setattr(cls, name, dressed(vars(cls)[name]))

    def name(self):
        return self.NAME

    def displayName(self):
        return self.TITLE

    def group(self):
        return self.GROUP[1]

    def groupId(self):
        return self.GROUP[0]

    def tags(self):
        return ["robot", "map", *self.TAGS]

    def shortDescription(self):
        return self.SUMMARY

    def shortHelpString(self):
        text = self.HELP
        if QgsApplication.platform() == "qgis_process":
            return plain_text(text)
        # QGIS shows <b> in a dark grey, hardly visible in its dark themes; it does not wrap <pre>.
        for written, shown in _AS_SHOWN.items():
            text = text.replace(written, shown)
        return text

    def icon(self):
        return QIcon(self.svgIconPath())

    def svgIconPath(self):
        return str(RESOURCES / "icons" / self.ICON)

    def addParameter(self, parameter: QgsProcessingParameterDefinition, createOutput: bool = True):
        fit_label(parameter)
        return super().addParameter(parameter, createOutput)

    def createInstance(self):
        return type(self)()

    def checkParameterValues(self, parameters: Parameters, context: QgsProcessingContext):
        problem = value_problem(self.parameterDefinitions(), parameters, context)
        return (False, problem) if problem else super().checkParameterValues(parameters, context)

    def remember(self, layers: dict[str, str]) -> None:
        """Record the layers made, by the names of their outputs, to style them when they are loaded."""
        self._made = layers

    def postProcessAlgorithm(self, context: QgsProcessingContext, feedback: QgsProcessingFeedback):
        made = getattr(self, "_made", {})
        loaded = {name: source for name, source in made.items() if context.willLoadLayerOnCompletion(source)}
        for name, style in self.STYLES.items():
            if name in loaded:
                layer = QgsProcessingUtils.mapLayerFromString(loaded[name], context)
                if layer is not None:
                    layer.loadNamedStyle(str(RESOURCES / "styles" / style))
        put_above_areas([loaded[name] for name in self.ABOVE_AREAS if name in loaded], context)
        return {}


def plain_text(page: str) -> str:
    """Return a help text for a terminal: a blank line between paragraphs, no tags."""
    text = re.sub(r"\s+", " ", page)
    text = re.sub(r"\s*<li>", "\n- ", text)
    text = re.sub(r"\s*</?(?:p|pre|ul|table|tr)>\s*", "\n\n", text)
    text = re.sub(r"<[^<>]+>", "", text)
    return html.unescape(re.sub(r"\n{3,}", "\n\n", text)).strip()


def fields_of(columns: dict[str, str]) -> QgsFields:
    """Return fields by name and kind, named as in memory layers; must be called in the main thread.

    This way of creating fields is the same on Qt 5 and Qt 6.
    """
    named = "".join(f"&field={name}:{kind}" for name, kind in columns.items())
    return QgsVectorLayer(f"NoGeometry?{named[1:]}", "fields", "memory").fields()

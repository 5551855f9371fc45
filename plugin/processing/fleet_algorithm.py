"""What the algorithms have in common: their place in the toolbox, their help, styled results."""

from __future__ import annotations

import html
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from qgis.core import (
    QgsApplication,
    QgsFields,
    QgsProcessingAlgorithm,
    QgsProcessingContext,
    QgsProcessingFeedback,
    QgsProcessingParameterDefinition,
    QgsProcessingUtils,
    QgsVectorLayer,
)
from qgis.PyQt.QtGui import QIcon

from ..language import tr
from .label_room import fit_label
from .parameter_labels import errors_with_labels, problems_with_labels
from .tree_order import put_above_areas
from .value_spelling import spelling_problem

RESOURCES = Path(__file__).parents[2] / "resources"

Parameters = Mapping[str, Any]
"""What an algorithm is given: by the names of its parameters what the user chose."""


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
"""What tells people of parameters, and what has it name them as their dialog does."""


class FleetAlgorithm(QgsProcessingAlgorithm):
    """An algorithm of the provider; subclasses say who they are in their class attributes."""

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
    """Output layers that are put where no area covers them, from top to bottom."""

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
        # QGIS shows <b> in a dark grey, which its dark themes swallow; <pre> it does not break into lines.
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
        problem = spelling_problem(self.parameterDefinitions(), parameters, context)
        return (False, problem) if problem else super().checkParameterValues(parameters, context)

    def remember(self, layers: dict[str, str]) -> None:
        """Keep which layers were made, by the names of their outputs, to be styled when they are loaded."""
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
    """Return a help as a terminal shows it: a blank line between paragraphs, no tags."""
    text = re.sub(r"\s+", " ", page)
    text = re.sub(r"\s*<li>", "\n- ", text)
    text = re.sub(r"\s*</?(?:p|pre|ul|table|tr)>\s*", "\n\n", text)
    text = re.sub(r"<[^<>]+>", "", text)
    return html.unescape(re.sub(r"\n{3,}", "\n\n", text)).strip()


def fields_of(columns: dict[str, str]) -> QgsFields:
    """Return fields by name and kind, as a layer in memory spells kinds; to be called in the main thread.

    The way to make fields that is the same on Qt 5 and Qt 6.
    """
    named = "".join(f"&field={name}:{kind}" for name, kind in columns.items())
    return QgsVectorLayer(f"NoGeometry?{named[1:]}", "fields", "memory").fields()

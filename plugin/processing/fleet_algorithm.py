"""What the algorithms have in common: their place in the toolbox, their help, styled results."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from qgis.core import (
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
        for name, style in self.STYLES.items():
            source = getattr(self, "_made", {}).get(name)
            if source and context.willLoadLayerOnCompletion(source):
                layer = QgsProcessingUtils.mapLayerFromString(source, context)
                if layer is not None:
                    layer.loadNamedStyle(str(RESOURCES / "styles" / style))
        return {}


def fields_of(columns: dict[str, str]) -> QgsFields:
    """Return fields by name and kind, as a layer in memory spells kinds; to be called in the main thread.

    The way to make fields that is the same on Qt 5 and Qt 6.
    """
    named = "".join(f"&field={name}:{kind}" for name, kind in columns.items())
    return QgsVectorLayer(f"NoGeometry?{named[1:]}", "fields", "memory").fields()

"""The parameters that say how a map is written: as text, or in one of the two binary codecs."""

from __future__ import annotations

from dataclasses import dataclass

from qgis.core import (
    QgsProcessingAlgorithm,
    QgsProcessingContext,
    QgsProcessingParameterBoolean,
    QgsProcessingParameterDefinition,
)

from ...robot_bridge.robotmap.binary import CODEC_COLUMNS, CODEC_TEXT, encode
from ...robot_bridge.robotmap.model import Border, RobotMap
from ...robot_bridge.robotmap.text import write_text
from ..language import tr
from .fleet_algorithm import Parameters
from .named_choice import named_choice

FORMAT, STRICT = "FORMAT", "STRICT"
# No comma in a choice: QGIS would take it for two.
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
    """How a map is written; ``codec`` is nothing for text."""

    codec: int | None = None
    strict: bool = False

    @property
    def suffix(self) -> str:
        """The end of a file's name."""
        return "txt" if self.codec is None else "rmap"

    def written(self, robot_map: RobotMap) -> tuple[str, bytes]:
        """Return the map's text, and the bytes of its file.

        :raises RobotMapError: when it cannot be written so, or a package for it is missing.
        """
        text = write_text(robot_map, strict=self.strict)
        if self.codec is None:
            return text, text.encode()
        whole = self.codec == CODEC_COLUMNS and not self.strict
        return text, encode(robot_map if whole else text, self.codec)


def format_parameters() -> list[QgsProcessingParameterDefinition]:
    """Return the parameters."""
    title = tr("Format (compact: binary in columns, about a third of binary)")
    how = named_choice(FORMAT, title, _NAMES, TEXT)
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


def format_of(
    algorithm: QgsProcessingAlgorithm, parameters: Parameters, context: QgsProcessingContext
) -> MapFormat:
    """Return the chosen format.

    :raises MissingCodecError: when it needs a package that this Python does not have.
    """
    codec = _CODECS[algorithm.parameterAsEnumString(parameters, FORMAT, context)]
    chosen = MapFormat(codec, algorithm.parameterAsBool(parameters, STRICT, context))
    # Before the run: a city is read for nothing where its map cannot be written.
    chosen.written(_NOTHING)
    return chosen

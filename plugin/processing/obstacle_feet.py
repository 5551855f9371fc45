"""The parameter BASE_EXPRESSION: how high above the ground obstacles begin, such as arches and signs."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from qgis.core import QgsFeedback, QgsProcessingParameterDefinition, QgsProcessingParameterExpression

from ..sites.layer_rules import LayerRules, as_metres
from ..sites.obstacle_source import ObstacleSource
from ..sites.reading import Reading

BASE_EXPRESSION = "BASE_EXPRESSION"


def feet_parameter() -> QgsProcessingParameterDefinition:
    """Return the parameter; it matters to the robot's plane alone."""
    parameter = QgsProcessingParameterExpression(
        BASE_EXPRESSION,
        "Robot's plane: where each feature begins above the ground [m] (default: on it)",
        optional=True,
    )
    parameter.setHelp(
        'Such as "clearance" of arches, or 2.2 for signs. The height of a feature counts from there. Without '
        "it all stands on the ground, and the upper height of the plane leaves nothing out."
    )
    return parameter


def check_feet(sources: Sequence[ObstacleSource], expression: str) -> None:
    """Raise ExpressionError where ``expression`` is none, without reading."""
    for source in sources:
        LayerRules(source.name, source.fields, source.context).rule("base", expression)


def raise_feet(
    reading: Reading, sources: Sequence[ObstacleSource], expression: str, feedback: QgsFeedback
) -> None:
    """Give the rows of ``reading`` the height of their foot, metres; what is not understood is warned of.

    After a cancel ``reading`` is not complete.
    """
    read, bases = {row.source for row in reading.rows}, {}
    for source in sources:
        rules = LayerRules(source.name, source.fields, source.context)
        rule = rules.rule("base", expression)
        reading.warnings.extend(rules.warnings)
        for feature in source.features.getFeatures() if rule is not None else ():
            if feedback.isCanceled():
                reading.complete = False
                return
            name = f"{source.name}:{feature.id()}"
            if name not in read:
                continue
            rules.at(feature)
            notes: list[str] = []
            bases[name] = _metres(rules.value("base", rule, notes), notes)
            reading.warnings.extend(f"Layer {source.name}, feature {feature.id()}: {note}" for note in notes)
    reading.rows = [replace(row, base=bases.get(row.source, 0.0)) for row in reading.rows]


def _metres(value, notes: list[str]) -> float:
    if value is None or value == "":
        return 0.0
    metres = as_metres(value)
    if metres is None:
        notes.append(f"its base {value!r} is not a number of metres; it is taken to stand on the ground")
        return 0.0
    return metres

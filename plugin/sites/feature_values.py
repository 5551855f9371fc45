"""Height, label and outdoor flag of each feature, by expression."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, field
from typing import Any

from qgis.core import NULL, QgsExpression, QgsExpressionContext, QgsFeature, QgsFields

from .errors import ExpressionError
from .roles import RAMP, LayerExpressions

HEIGHT_FIELDS = ("height", "height_m")
"""Fields that hold a height in metres where no expression says otherwise."""

_METRES = re.compile(r"\s*([+-]?\d+(?:[.,]\d+)?)\s*m?\s*", re.ASCII)
_FLAGS = {"1": True, "true": True, "yes": True, "0": False, "false": False, "no": False}


@dataclass(frozen=True)
class Values:
    """What a robot map says of one feature; ``estimated`` where ``height`` is the default."""

    height: float
    estimated: bool
    semantics: str
    outdoor: bool
    notes: list[str] = field(default_factory=list)


class FeatureValues:
    """Evaluates the expressions of one layer.

    ``warnings`` are about the layer as a whole. Ramps have no height (paper 1, section II).
    """

    def __init__(
        self,
        layer: str,
        fields: QgsFields,
        role: str,
        expressions: LayerExpressions,
        default_height: float,
        context: QgsExpressionContext,
    ):
        self._layer = layer
        self._is_ramp = role == RAMP
        self._default_height = default_height
        self._context = QgsExpressionContext(context)
        self._context.setFields(fields)
        self.warnings: list[str] = []
        self._height = self._rule("height", expressions.height or _height_column(fields), fields)
        self._semantics = self._rule("semantics", expressions.semantics, fields)
        self._outdoor = self._rule("outdoor", expressions.outdoor, fields)

    def of(self, feature: QgsFeature) -> Values:
        """Return the values of ``feature``; what is missing or not understood gets the default and a note."""
        self._context.setFeature(feature)
        notes: list[str] = []
        height = 0.0 if self._is_ramp else self._height_of(notes)
        return Values(
            height=self._default_height if height is None else height,
            estimated=height is None,
            semantics=self._semantics_of(notes),
            outdoor=self._outdoor_of(notes),
            notes=notes,
        )

    def _rule(self, what: str, text: str, fields: QgsFields) -> QgsExpression | None:
        """Return the prepared expression, None for an empty one or one about fields the layer lacks.

        :raises ExpressionError: when ``text`` is no expression.
        """
        if not text.strip():
            return None
        expression = QgsExpression(text)
        if expression.hasParserError():
            raise ExpressionError(
                f"The {what} expression {text!r} for the layer {self._layer} is not one: "
                f"{expression.parserErrorString().strip()}. Correct it."
            )
        names = {name.lower() for name in fields.names()}
        columns = expression.referencedColumns() - {"#!allattributes!#"}
        missing = sorted(name for name in columns if name.lower() not in names)
        if missing:
            self.warnings.append(
                f"Layer {self._layer}: it has no field {', '.join(missing)}, which the {what} expression "
                f"{text!r} reads; the default is used for all its features"
            )
            return None
        expression.prepare(self._context)
        return expression

    def _value(self, what: str, expression: QgsExpression | None, notes: list[str]) -> Any:
        if expression is None:
            return None
        value = expression.evaluate(self._context)
        if expression.hasEvalError():
            notes.append(f"the {what} expression fails: {expression.evalErrorString()}; the default is used")
            return None
        return None if value is None or value == NULL else value

    def _height_of(self, notes: list[str]) -> float | None:
        value = self._value("height", self._height, notes)
        if value is None or value == "":
            return None
        height = _as_metres(value)
        if height is None or height < 0:
            notes.append(f"its height {value!r} is not a number of metres of 0 or more; the default is used")
            return None
        return height

    def _semantics_of(self, notes: list[str]) -> str:
        value = self._value("semantics", self._semantics, notes)
        return self._layer if value is None else str(value)

    def _outdoor_of(self, notes: list[str]) -> bool:
        value = self._value("outdoor", self._outdoor, notes)
        if value is None:
            return True
        flag = _FLAGS.get(str(value).strip().lower())
        if flag is None:
            notes.append(f"its outdoor flag {value!r} is neither true nor false; true is used")
        return flag is not False


def _height_column(fields: QgsFields) -> str:
    for name in HEIGHT_FIELDS:
        index = fields.lookupField(name)
        if index >= 0:
            return QgsExpression.quotedColumnRef(fields.at(index).name())
    return ""


def _as_metres(value: Any) -> float | None:
    """Return a number of metres, also from text such as ``12,5 m``."""
    if isinstance(value, str):
        match = _METRES.fullmatch(value)
        return float(match[1].replace(",", ".")) if match else None
    try:
        number = float(value)
    except (TypeError, ValueError):
        return None
    return number if math.isfinite(number) else None

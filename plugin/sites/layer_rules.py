"""The expressions of one layer, checked once and evaluated for each feature."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from typing import Any

from qgis.core import NULL, QgsExpression, QgsExpressionContext, QgsFeature, QgsFeatureRequest, QgsFields

from ..language import tr
from .errors import ExpressionError
from .feature_tags import TaggedFields

_PLAIN = (float, str, int)
_FLAGS = {"1": True, "true": True, "yes": True, "0": False, "false": False, "no": False}
DEFAULT_IS_USED = tr("the default is used")
_METRES = re.compile(r"\s*([+-]?\d+(?:[.,]\d+)?)\s*m?\s*", re.ASCII)
_NUMBER = r"(\d+(?:[.,]\d+)?)"
_FEET = re.compile(rf"""\s*(?:{_NUMBER}\s*(?:'|ft|feet))?\s*(?:{_NUMBER}\s*(?:"|''|in))?\s*""", re.ASCII)
FOOT_M, INCH_M = 0.3048, 0.0254


class LayerRules:
    """Prepares and evaluates the expressions of ``layer``; ``warnings`` are about the layer as a whole."""

    def __init__(self, layer: str, fields: QgsFields, context: QgsExpressionContext):
        self._layer = layer
        self._tagged = TaggedFields(fields)
        self._fields = self._tagged.fields
        self._context = QgsExpressionContext(context)
        self._context.setFields(self._fields)
        self.warnings: list[str] = []

    def rule(self, what: str, text: str) -> QgsExpression | None:
        """Return the prepared expression, None for an empty one or one about fields the layer lacks.

        :raises ExpressionError: when ``text`` is no expression.
        """
        if not text.strip():
            return None
        expression = self._parsed(what, text)
        missing = self._missing(expression)
        if missing:
            self.warnings.append(
                tr(
                    "Layer {layer}: it has no field {missing}, which the {what} expression {text!r} reads; "
                    "the default is used for all its features",
                    layer=self._layer,
                    missing=missing,
                    what=what,
                    text=text,
                )
            )
            return None
        expression.prepare(self._context)
        return expression

    def needed_rule(self, what: str, text: str) -> QgsExpression | None:
        """Return the prepared expression, None for an empty one.

        :raises ExpressionError: when ``text`` is no expression, or is about fields that the layer lacks.
        """
        if not text.strip():
            return None
        expression = self._parsed(what, text)
        missing = self._missing(expression)
        if missing:
            raise ExpressionError(
                tr(
                    "The {what} expression {text!r} for the layer {layer} reads the field {missing}, which "
                    "the layer does not have. Correct it, or write attribute('...') for a field that some "
                    "layers lack.",
                    what=what,
                    text=text,
                    layer=self._layer,
                    missing=missing,
                )
            )
        expression.prepare(self._context)
        return expression

    def at(self, feature: QgsFeature) -> None:
        """Let :meth:`value` speak of ``feature`` from now on."""
        self._context.setFeature(self._tagged.feature(feature))

    def value(
        self,
        what: str,
        expression: QgsExpression | None,
        notes: list[str],
        otherwise: str = DEFAULT_IS_USED,
    ) -> Any:
        """Return what ``expression`` says of the feature, None for nothing; a failure becomes a note."""
        if expression is None:
            return None
        value = expression.evaluate(self._context)
        if expression.hasEvalError():
            notes.append(
                tr(
                    "the {what} expression fails: {error}; {otherwise}",
                    what=what,
                    error=expression.evalErrorString(),
                    otherwise=otherwise,
                )
            )
            return None
        # Numbers and texts first: to compare them with NULL takes longer than to evaluate most expressions.
        return None if value is None or (not isinstance(value, _PLAIN) and value == NULL) else value

    def metres(self, what: str, expression: QgsExpression | None, notes: list[str]) -> float | None:
        """Return the metres above 0 that ``expression`` says of the feature, None where it says none.

        What is no such number becomes a note.
        """
        value = self.value(what, expression, notes)
        if value is None or value == "":
            return None
        metres = as_metres(value)
        if metres is None or metres <= 0:
            notes.append(
                tr(
                    "its {what} {value!r} is not a number of metres above 0; the default is used",
                    what=what,
                    value=value,
                )
            )
            return None
        return metres

    def column(self, *names: str) -> str:
        """Return the expression that reads the first of the fields ``names`` that is there, else nothing.

        Fields of the layer come before tags in one of its fields.
        """
        return self.own_column(*names) or self._column(names)

    def own_column(self, *names: str) -> str:
        """Return as :meth:`column`, without the tags."""
        return self._column(names, self._tagged.own_count)

    def warn_of_layer(self, note: str) -> None:
        """Add a warning about the layer as a whole."""
        self.warnings.append(tr("Layer {layer}: {note}", layer=self._layer, note=note))

    def _column(self, names: Sequence[str], count: int | None = None) -> str:
        for name in names:
            index = self._fields.lookupField(name)
            if index >= 0 and (count is None or index < count):
                return QgsExpression.quotedColumnRef(self._fields.at(index).name())
        return ""

    def _parsed(self, what: str, text: str) -> QgsExpression:
        expression = QgsExpression(text)
        if expression.hasParserError():
            raise ExpressionError(
                tr(
                    "The {what} expression {text!r} for the layer {layer} is not one: {error}. Correct it.",
                    what=what,
                    text=text,
                    layer=self._layer,
                    error=expression.parserErrorString().strip(),
                )
            )
        return expression

    def _missing(self, expression: QgsExpression) -> str:
        """Return the fields that ``expression`` reads and the layer lacks, nothing where there are none."""
        names = {name.lower() for name in self._fields.names()}
        columns = expression.referencedColumns() - {QgsFeatureRequest.ALL_ATTRIBUTES}
        return ", ".join(sorted(name for name in columns if name.lower() not in names))


def as_flag(value: Any) -> bool | None:
    """Return whether ``value`` says true, also as text such as ``yes``; None where it is neither."""
    return _FLAGS.get(str(value).strip().lower())


def as_metres(value: Any) -> float | None:
    """Return a number of metres, also from text such as ``12,5 m``, ``25'8"`` and ``30 ft``."""
    if isinstance(value, str):
        match = _METRES.fullmatch(value)
        return _number(match[1]) if match else _from_feet(value)
    try:
        number = float(value)
    except (TypeError, ValueError):
        return None
    return number if math.isfinite(number) else None


def _from_feet(text: str) -> float | None:
    match = _FEET.fullmatch(text)
    if match is None or (match[1] is None and match[2] is None):
        return None
    return _number(match[1] or "0") * FOOT_M + _number(match[2] or "0") * INCH_M


def _number(text: str) -> float:
    return float(text.replace(",", "."))

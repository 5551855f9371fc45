"""Height, foot, label and outdoor flag of each feature, by expression."""

from __future__ import annotations

import sys
from typing import NamedTuple

from qgis.core import QgsExpression, QgsFeature

from ..language import tr
from .layer_rules import LayerRules, as_flag, as_metres
from .roles import RAMP, LayerExpressions

HEIGHT_FIELDS = ("height", "height_m")
"""Fields that hold a height in metres where no expression says otherwise."""


class Values(NamedTuple):
    """What a robot map says of one feature.

    ``height`` is ``estimated`` where it is not told, and ``unknown`` where nothing but the default is left.
    ``base`` is how many metres above the ground it begins; ``height`` counts from there.
    """

    height: float
    estimated: bool
    unknown: bool
    base: float
    semantics: str
    outdoor: bool
    notes: list[str]


class FeatureValues:
    """Evaluates the expressions of one layer of obstacles. Ramps have no height (paper 1, section II).

    :raises ExpressionError: when one of the expressions is none.
    """

    def __init__(
        self,
        layer: str,
        role: str,
        expressions: LayerExpressions,
        default_height: float,
        rules: LayerRules,
    ):
        self._layer = layer
        self._is_ramp = role == RAMP
        self._default_height = default_height
        self._rules = rules
        self._height = rules.rule("height", expressions.height or rules.column(*HEIGHT_FIELDS))
        self._estimate = rules.rule("estimate", expressions.estimate)
        self._semantics = rules.rule("semantics", expressions.semantics)
        self._outdoor = rules.rule("outdoor", expressions.outdoor)
        self._base = rules.rule("base", expressions.base)
        # Once: to translate a text takes longer than to evaluate most expressions.
        self._default_is_used = tr("the default is used")
        self._no_height = tr("the estimate is used") if self._estimate is not None else self._default_is_used

    def of(self, feature: QgsFeature) -> Values:
        """Return the values of ``feature``; what is missing or not understood gets the default and a note."""
        self._rules.at(feature)
        notes: list[str] = []
        height = 0.0 if self._is_ramp else self._height_of("height", self._height, notes)
        estimate = self._height_of("estimate", self._estimate, notes) if height is None else None
        known = estimate if height is None else height
        return Values(
            height=self._default_height if known is None else known,
            estimated=height is None,
            unknown=known is None,
            base=self._base_of(notes),
            semantics=self._semantics_of(notes),
            outdoor=self._outdoor_of(notes),
            notes=notes,
        )

    def _height_of(self, what: str, rule: QgsExpression | None, notes: list[str]) -> float | None:
        otherwise = self._no_height if rule is self._height else self._default_is_used
        value = self._rules.value(what, rule, notes, otherwise=otherwise)
        if value is None or value == "":
            return None
        height = as_metres(value)
        if height is None or height < 0:
            notes.append(
                tr(
                    "its {what} {value!r} is not a number of metres of 0 or more; {otherwise}",
                    what=what,
                    value=value,
                    otherwise=otherwise,
                )
            )
            return None
        return height

    def _base_of(self, notes: list[str]) -> float:
        value = self._rules.value("base", self._base, notes)
        if value is None or value == "":
            return 0.0
        metres = as_metres(value)
        if metres is None:
            notes.append(
                tr(
                    "its base {value!r} is not a number of metres; it is taken to stand on the ground",
                    value=value,
                )
            )
            return 0.0
        return metres

    def _semantics_of(self, notes: list[str]) -> str:
        value = self._rules.value("semantics", self._semantics, notes)
        # A city has few different labels, and keeps each once.
        return self._layer if value is None else sys.intern(str(value))

    def _outdoor_of(self, notes: list[str]) -> bool:
        value = self._rules.value("outdoor", self._outdoor, notes)
        if value is None:
            return True
        flag = as_flag(value)
        if flag is None:
            notes.append(
                tr("its outdoor flag {value!r} is neither true nor false; true is used", value=value)
            )
        return flag is not False

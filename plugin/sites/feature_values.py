"""Height, label and outdoor flag of each feature, by expression."""

from __future__ import annotations

from dataclasses import dataclass, field

from qgis.core import QgsExpressionContext, QgsFeature, QgsFields

from .layer_rules import LayerRules, as_metres
from .roles import RAMP, LayerExpressions

HEIGHT_FIELDS = ("height", "height_m")
"""Fields that hold a height in metres where no expression says otherwise."""

POST_ACROSS_M = 0.5
"""How far across a piece of furniture is that is drawn as a point and says nothing of its size."""

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
    """Evaluates the expressions of one layer of obstacles.

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
        self._rules = rules = LayerRules(layer, fields, context)
        self._height = rules.rule("height", expressions.height or rules.column(*HEIGHT_FIELDS))
        self._semantics = rules.rule("semantics", expressions.semantics)
        self._outdoor = rules.rule("outdoor", expressions.outdoor)
        self._across = rules.rule("width", expressions.width)
        self.warnings = rules.warnings

    def of(self, feature: QgsFeature) -> Values:
        """Return the values of ``feature``; what is missing or not understood gets the default and a note."""
        self._rules.at(feature)
        notes: list[str] = []
        height = 0.0 if self._is_ramp else self._height_of(notes)
        return Values(
            height=self._default_height if height is None else height,
            estimated=height is None,
            semantics=self._semantics_of(notes),
            outdoor=self._outdoor_of(notes),
            notes=notes,
        )

    def across(self, feature: QgsFeature, notes: list[str]) -> float:
        """Return how many metres the point ``feature`` stands for are across."""
        self._rules.at(feature)
        value = self._rules.value("width", self._across, notes)
        if value is None or value == "":
            return POST_ACROSS_M
        metres = as_metres(value)
        if metres is None or metres <= 0:
            notes.append(f"its width {value!r} is not a number of metres above 0; {POST_ACROSS_M:g} is used")
            return POST_ACROSS_M
        return metres

    def _height_of(self, notes: list[str]) -> float | None:
        value = self._rules.value("height", self._height, notes)
        if value is None or value == "":
            return None
        height = as_metres(value)
        if height is None or height < 0:
            notes.append(f"its height {value!r} is not a number of metres of 0 or more; the default is used")
            return None
        return height

    def _semantics_of(self, notes: list[str]) -> str:
        value = self._rules.value("semantics", self._semantics, notes)
        return self._layer if value is None else str(value)

    def _outdoor_of(self, notes: list[str]) -> bool:
        value = self._rules.value("outdoor", self._outdoor, notes)
        if value is None:
            return True
        flag = _FLAGS.get(str(value).strip().lower())
        if flag is None:
            notes.append(f"its outdoor flag {value!r} is neither true nor false; true is used")
        return flag is not False

"""Which features of a layer count: those that its filter is true of."""

from __future__ import annotations

from qgis.core import QgsExpressionContext, QgsExpressionContextUtils, QgsFeature, QgsFields, QgsVectorLayer

from ..language import tr
from .layer_rules import LayerRules, as_flag
from .roles import expressions_of


class FeatureFilter:
    """The filter ``text`` of the layer called ``layer``; an empty one keeps every feature.

    :raises ExpressionError: when ``text`` is no expression, or is about fields that the layer lacks.
    """

    def __init__(self, layer: str, fields: QgsFields, text: str, context: QgsExpressionContext):
        self._rules = LayerRules(layer, fields, context)
        self._rule = self._rules.needed_rule("filter", text)

    @classmethod
    def of_layer(cls, layer: QgsVectorLayer, context: QgsExpressionContext) -> FeatureFilter:
        """Return the filter that ``layer`` keeps itself; ``context`` is what it sees besides the layer."""
        scoped = QgsExpressionContext(context)
        scoped.appendScope(QgsExpressionContextUtils.layerScope(layer))
        return cls(layer.name(), layer.fields(), expressions_of(layer).filter, scoped)

    def keeps(self, feature: QgsFeature, notes: list[str]) -> bool:
        """Tell whether ``feature`` counts; one that the filter cannot tell of does not, with a note."""
        if self._rule is None:
            return True
        self._rules.at(feature)
        value = self._rules.value("filter", self._rule, notes, otherwise=tr("it is left out"))
        if value is None:
            return False
        flag = as_flag(value)
        if flag is None:
            notes.append(
                tr("its filter gives {value!r}, which is neither true nor false; it is left out", value=value)
            )
        return flag is True

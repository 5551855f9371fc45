"""Expressions of a layer are evaluated once for the same values, and anew wherever they may say another."""

from __future__ import annotations

import pytest
from fleet_supervisor.plugin.layers.layer_expressions import FeatureValues, LayerRules
from fleet_supervisor.plugin.layers.roles import LayerExpressions
from qgis.core import NULL, QgsExpressionContext, QgsFeature, QgsField, QgsFields
from qgis.PyQt.QtCore import QVariant


@pytest.fixture
def said(qgis_app):
    """Return what an expression says of features with these values, by one rule and by one for each."""

    def run(text, *values):
        fields = QgsFields()
        fields.append(QgsField("a", QVariant.Double))
        fields.append(QgsField("b", QVariant.String))

        def each(rules, rule):
            for number, some in enumerate(values):
                feature = QgsFeature(fields, number)
                feature.setAttributes(list(some))
                rules.at(feature)
                yield rules.value("test", rule, [])

        together = LayerRules("layer", fields, QgsExpressionContext())
        rule = together.needed_rule("test", text)
        apart = []
        for one in range(len(values)):
            fresh = LayerRules("layer", fields, QgsExpressionContext())
            apart.append(list(each(fresh, fresh.needed_rule("test", text)))[one])
        return rule.is_pure, list(each(together, rule)), apart

    return run


def test_the_same_is_said_of_the_same_values_and_nothing_else(said):
    values = [
        (1.5, "x"),
        (0.0, "x"),
        (-0.0, "x"),
        (1.5, "x"),
        (NULL, "x"),
        (True, "y"),
        (1, "y"),
        (NULL, NULL),
    ]
    for text in ('"a" || \',\' || "b"', 'coalesce("a", -1) * 2', '"a"', 'upper("b")'):
        is_pure, together, apart = said(text, *values)
        assert is_pure
        assert [(type(one), str(one)) for one in together] == [(type(one), str(one)) for one in apart], text


@pytest.mark.parametrize("text", ["$id", '"a" * $id', "attribute('a')", 'rand(1, 9) + "a"', '@row || "b"'])
def test_what_depends_on_more_than_fields_is_never_remembered(said, text):
    is_pure, _, _ = said(text, (1.0, "x"))
    assert not is_pure


def test_what_fails_fails_each_time(qgis_app):
    fields = QgsFields()
    fields.append(QgsField("b", QVariant.String))
    rules, notes = LayerRules("layer", fields, QgsExpressionContext()), []
    rule = rules.needed_rule("test", 'to_real("b")')
    for number in range(2):
        feature = QgsFeature(fields, number)
        feature.setAttributes(["high"])
        rules.at(feature)
        assert rules.value("test", rule, notes) is None
    assert len(notes) == 2


@pytest.mark.parametrize("estimate", ['"a" * 3', "$id"])
def test_what_is_said_of_a_feature_is_that_of_its_own_values(qgis_app, estimate):
    fields = QgsFields()
    for name, kind in (("height", QVariant.Double), ("a", QVariant.Double), ("b", QVariant.String)):
        fields.append(QgsField(name, kind))
    some = [(h, a, b) for h in (NULL, 2.0, -1.0) for a in (NULL, 0.0, 1.0, 1, True) for b in (NULL, "x", "y")]
    expressions = LayerExpressions(semantics='"b" || "a"', estimate=estimate, base='"a"')

    def values():
        return FeatureValues(
            "layer", "", expressions, 3.0, LayerRules("layer", fields, QgsExpressionContext())
        )

    def feature(number):
        made = QgsFeature(fields, number)
        made.setAttributes(list(some[number % len(some)]))
        return made

    together = values()
    for number in range(2 * len(some)):
        apart = values().of(feature(number))
        assert repr(together.of(feature(number))) == repr(apart)

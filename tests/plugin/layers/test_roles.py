"""Roles and expressions stay with the layer in the project file."""

from __future__ import annotations

import pytest
from fleet_supervisor.plugin.layers.roles import (
    EXPRESSIONS,
    OBSTACLE,
    STAIRS,
    LayerExpressions,
    expressions_of,
    layers_with_role,
    role_of,
    set_expressions,
    set_role,
)
from qgis.core import QgsProject


def test_a_role_and_expressions_survive_saving_and_opening_the_project(make_layer, tmp_path):
    project = QgsProject()
    kept = LayerExpressions(**{name: f"'{name}' || 1" for name in EXPRESSIONS})
    steps, plain = make_layer("steps"), make_layer("plain")
    set_role(steps, STAIRS)
    set_expressions(steps, kept)
    project.addMapLayers([steps, plain])
    assert project.write(str(tmp_path / "site.qgz"))

    opened = QgsProject()
    assert opened.read(str(tmp_path / "site.qgz"))
    (found,) = layers_with_role(opened, OBSTACLE, STAIRS)
    assert (found.name(), role_of(found), expressions_of(found)) == ("steps", STAIRS, kept)


def test_taking_a_role_away_leaves_no_property_behind(make_layer):
    layer = make_layer()
    set_role(layer, OBSTACLE)
    set_expressions(layer, LayerExpressions(**dict.fromkeys(EXPRESSIONS, "1")))
    set_role(layer, "")
    set_expressions(layer, LayerExpressions())
    assert role_of(layer) == ""
    assert layer.customPropertyKeys() == []


def test_an_unknown_role_is_refused_on_writing_and_none_on_reading(make_layer):
    layer = make_layer()
    with pytest.raises(ValueError, match="'lake' is not a layer role; choose one of obstacle, stairs"):
        set_role(layer, "lake")
    layer.setCustomProperty("fleet/role", "lake")
    assert role_of(layer) == ""

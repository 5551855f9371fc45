"""Warnings about many features: one a kind, with the first features, and none lost."""

import pytest
from fleet_supervisor.plugin.layers.layer_source import MOST_KINDS, FeatureWarnings


@pytest.fixture
def warnings(qgis_app):
    return FeatureWarnings()


def test_one_feature_is_named_with_its_note(warnings):
    warnings.add("walls", 7, "has no geometry")
    assert warnings.texts() == ["Layer walls, feature 7: has no geometry"]


def test_features_with_the_same_note_are_one_warning_with_the_first_five(warnings):
    for feature in range(1, 1284):
        warnings.add("walls", feature, "has no geometry")
    assert warnings.texts() == ["Layer walls, features 1, 2, 3, 4, 5 and 1278 more: has no geometry"]


def test_notes_that_differ_in_numbers_and_values_are_told_one_by_one_only_where_they_are_few(warnings):
    for feature in range(1, 6):
        warnings.add("walls", feature, f"its height '{'x' * feature}' at ({feature}.50 1e-{feature}) is odd")
    assert len(warnings.texts()) == 5
    assert warnings.texts()[4] == "Layer walls, feature 5: its height 'xxxxx' at (5.50 1e-5) is odd"
    warnings.add("walls", 6, "its height 'y' at (6.00 2) is odd")
    assert warnings.texts() == [
        "Layer walls, features 1, 2, 3, 4, 5 and 1 more; of the first: its height 'x' at (1.50 1e-1) is odd"
    ]


def test_a_later_feature_that_differs_is_not_told_to_be_like_the_first(warnings):
    for feature in range(1, 10):
        warnings.add("walls", feature, f"line {1 + feature // 9} is short")
    assert warnings.texts() == [
        "Layer walls, features 1, 2, 3, 4, 5 and 4 more; of the first: line 1 is short"
    ]


def test_layers_and_kinds_stay_apart_in_the_order_of_their_first(warnings):
    warnings.add("walls", 1, "is bent")
    warnings.add_text("Layer walls: as a whole")
    warnings.add("gates", 1, "is bent")
    warnings.add("walls", 2, "is flat")
    warnings.add("walls", 3, "is bent")
    assert warnings.texts() == [
        "Layer walls, features 1, 3: is bent",
        "Layer walls: as a whole",
        "Layer gates, feature 1: is bent",
        "Layer walls, feature 2: is flat",
    ]


def test_kinds_beyond_the_most_are_counted(warnings):
    for feature in range(MOST_KINDS + 3):
        warnings.add("walls", feature, "is " + "a" * feature)
    *_, last = warnings.texts()
    assert len(warnings.texts()) == MOST_KINDS + 1
    assert last == "Layer walls: warnings of more kinds about features 50, 51, 52"

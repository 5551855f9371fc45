"""Every cone layout has words for the operator: in English those of the bridge, in other languages others."""

from __future__ import annotations

import math

import pytest
from fleet_supervisor.plugin.cone_texts import (
    DIMENSION_CHOICES,
    LAYOUT_DIMENSIONS,
    LAYOUT_STANDARDS,
    LAYOUT_TITLES,
    dimension_in_words,
    fault_in_words,
    standard_in_words,
    whole_dimension_in_words,
)
from fleet_supervisor.plugin.ui.language import Language, tr
from fleet_supervisor.robot_bridge.core.layouts.catalogue import LAYOUTS

EVERY = [(kind, one) for kind in LAYOUTS.values() for one in kind.dimensions()]


def test_in_english_the_words_are_the_bridges():
    assert {name: kind.TITLE for name, kind in LAYOUTS.items()} == LAYOUT_TITLES
    assert [standard_in_words(kind) for kind in LAYOUTS.values()] == [
        one.STANDARD for one in LAYOUTS.values()
    ]
    assert set(LAYOUT_STANDARDS) <= set(LAYOUTS)
    wrong = [(kind.NAME, one.name) for kind, one in EVERY if dimension_in_words(kind, one) != one.text]
    assert wrong == []
    wrong = [one for kind, one in EVERY if whole_dimension_in_words(kind, one) != one.whole_text]
    assert wrong == []
    assert set(DIMENSION_CHOICES) == {name for _, one in EVERY for name in one.choices.values()}


def test_no_words_are_left_of_dimensions_that_are_gone():
    named = {one.name for _, one in EVERY} | {f"{kind.NAME}.{one.name}" for kind, one in EVERY}
    assert set(LAYOUT_DIMENSIONS) <= named


def test_what_is_wrong_is_said_as_the_bridge_says_it():
    said = set()
    for _, one in EVERY:
        for value in (math.nan, -1e9, one.least + 0.5, one.least - 0.5, 0.25):
            fault = one.fault(value)
            words = "" if fault is None else fault_in_words(one, fault)
            assert words == one.problem(value)
            said.add(fault)
    assert len(said) == 5, "every fault, and none"


@pytest.mark.parametrize("locale", ["hu", "ca", "es"])
def test_each_dimension_has_words_in_each_language(qgis_app, locale):
    language = Language(locale)
    try:
        # Proper names may be the same; whole sentences may not.
        same = [
            text for text in (*LAYOUT_DIMENSIONS.values(), *DIMENSION_CHOICES.values()) if tr(text) == text
        ]
    finally:
        language.remove()
    assert same == []

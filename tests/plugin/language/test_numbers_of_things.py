"""A number of things is told in the right number: "1 cone", "2 cones", in every language."""

from __future__ import annotations

import ast
import functools
import re
from pathlib import Path

import pytest
from fleet_supervisor.plugin.ui.language import first_of

from tools.syntax import tree_of

ROOT = Path(__file__).parents[3]
THINGS = (
    "alarms|bytes|centrelines|commands|cones|edges|features|files|keepouts|layers|lines|metres|nodes|obstacles"
    "|outlines|parts|points|positions|repairs|roads|robots|rows|segments|sites|steps|surfaces|tasks|tiles"
    "|trips|warnings|ways"
)
COUNTED = re.compile(rf"\{{\w+\}}(?: of \{{\w+\}})? (?:(?!has\b)\w+ )?(?:{THINGS})\b")
NEVER_ONE = {
    "route of {number} points": "a path has two points or more",
    "Route for {robot}: {points} points, {length:.1f} m{along_roads}": "a path has two points or more",
    ", a path of {path_points} points": "a path has two points or more",
    "{off} of {points} points are not on a road surface.": "one point is told with its place",
    "The feature {id} of {sourcename} has {lines} lines: split it, or choose one that has one.": "not one",
    "The layer {layer} has {count} features and a queue takes {longest_queue}: select those that are meant.":
        "more than a queue takes",
    "The layer {layer} has {places} points selected and a queue takes {longest_queue}: select fewer.":
        "more than a queue takes",
    "The line that is selected in {layer} has {parts} parts, and a robot cannot leap from one to the next: "
    "make it one line.": "not one",
    "Only the first {count} positions were fetched. Choose less time, or fewer robots.": "a large number",
    "{name}: the file {file} holds {count} layers ({layers}): say which, as in {file}|layername={first}.":
        "one layer is taken without asking",
    "That would be {count} tiles, and {most_tiles} are the most: choose larger tiles, less overlap or a "
    "smaller area.": "more than the most",
    "The file {path} has {size} bytes, and a robot map at most {largest_text}: choose a map.":
        "a large number",
    "This desk is told of {known} of {all} robots: those in view, selected, or with an alarm.":
        "all are thousands",
    "{target}: {content} bytes": "a file has more",
    "{size} bytes in binary, {ratio:.3g} bytes/m²": "a file has more",
    "{size} bytes of text, {ratio:.3g} bytes/m² (paper 1: about 3 bytes/m² as text)": "a file has more",
    "{tiles}, {segments}, {size} bytes": "a file has more",
}  # fmt: skip
"""Texts that are never said of one thing, and why."""


@functools.cache
def _texts() -> dict[str, str]:
    """Return the texts of the plugin that ``tr`` takes, with the file that has each."""
    found = {}
    for path in sorted((ROOT / "plugin").rglob("*.py")):
        if "vendor" in path.parts:
            continue
        for node in ast.walk(tree_of(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Call) and getattr(node.func, "id", "") == "tr":
                text = getattr(node.args[0], "value", None)
                if isinstance(text, str):
                    found[text] = path.relative_to(ROOT).as_posix()
    return found


@pytest.mark.parametrize("text", ["{cones} cones", "{done} of {cones} cones", "{old} road surfaces"])
def test_a_text_that_says_1_cones_is_found(text):
    assert COUNTED.search(text)


def test_no_text_says_1_cones():
    wrong = {text: file for text, file in _texts().items() if COUNTED.search(text)}
    assert {text: wrong[text] for text in wrong.keys() - NEVER_ONE.keys()} == {}, "tell them by tr_count"


def test_no_exception_is_for_what_is_gone():
    assert NEVER_ONE.keys() - _texts().keys() == set()


def test_of_many_texts_the_first_are_told_and_how_many_more_there_are():
    assert first_of(["a", "b", "c"]) == ["a", "b", "c"]
    assert first_of(["a", "b", "c", "d", "e"]) == ["a", "b", "c", "and 2 more"]
    assert first_of(("a", "b"), 1) == ["a", "and 1 more"]
    assert first_of([]) == []

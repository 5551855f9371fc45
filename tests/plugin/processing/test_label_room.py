"""Labels of parameters fit into an algorithm's dialog as QGIS opens it; what they lose is in their help."""

from __future__ import annotations

import xml.etree.ElementTree as ET

import pytest
from fleet_supervisor.plugin.processing.common.algorithm import OPTIONAL, ROOM, shortened_label
from qgis.core import QgsProcessingParameterDefinition

LEEWAY = 6
"""Letters by which a label may be longer where its letters are narrow."""


def flags(parameter):
    return parameter.flags() & QgsProcessingParameterDefinition.Flag.FlagOptional


@pytest.mark.parametrize(
    ("text", "room", "label", "notes"),
    [
        ("Site CRS (default: the layer's)", 40, "Site CRS (default: the layer's)", []),
        ("Site CRS (default: the layer's)", 20, "Site CRS", ["Default: the layer's."]),
        ("Repair: close gaps, cut ends", 20, "Repair", ["Close gaps, cut ends."]),
        ("Height where none is known, estimated [m]", 35, "Height where none is known [m]", ["Estimated."]),
        ("Profile: what layers are (default: none)", 10, "Profile", ["What layers are.", "Default: none."]),
        ("Nothing that could be left out", 10, "Nothing that could be left out", []),
    ],
)
def test_a_label_loses_its_remark_first_and_keeps_its_unit(text, room, label, notes):
    assert shortened_label(text, room) == (label, notes)


def test_every_label_fits_and_what_it_lost_is_in_the_help(provider):
    parameters = [one for algorithm in provider.algorithms() for one in algorithm.parameterDefinitions()]
    for one in parameters:
        needed = len(one.description()) + OPTIONAL * bool(flags(one))
        assert needed <= ROOM + LEEWAY, one.description()
    profile = next(one for one in parameters if one.name() == "PROFILE")
    assert profile.description() == "Map profile"
    assert profile.help() == "What the layers are, by their names. Default: as each layer keeps it."


@pytest.mark.parametrize("language", ["hu", "ca", "es"])
def test_every_label_fits_in_each_language(provider, root, language):
    file = root / "resources" / "translations" / f"fleet_supervisor_{language}.ts"
    said = {one.findtext("source"): one.findtext("translation") for one in ET.parse(file).iter("message")}
    parameters = [one for algorithm in provider.algorithms() for one in algorithm.parameterDefinitions()]
    labels = {(one.description(), ROOM - OPTIONAL * bool(flags(one))) for one in parameters}
    looked_at = 0
    for room in {room for _, room in labels}:
        for text, words in said.items():
            if words and (shortened_label(text, room)[0], room) in labels:
                assert len(shortened_label(words, room)[0]) <= room + LEEWAY, (text, words)
                looked_at += 1
    assert looked_at > 100

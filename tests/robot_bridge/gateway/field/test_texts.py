"""Every text of the field page in its four languages."""

from __future__ import annotations

import re

import pytest

from robot_bridge.gateway.field import page

ASSETS = page.resources.files(page.__package__) / "assets"
TEXTS = (ASSETS / "texts.js").read_text("utf-8")
STRING = r'"((?:[^"\\]|\\.)*)"'
ENTRY = re.compile(rf"^  {STRING}: \[\s*((?:{STRING},?\s*)+)\],$", re.M)
TABLE = {found[1]: re.findall(STRING, found[2]) for found in ENTRY.finditer(TEXTS)}
PAGE = (ASSETS / "index.html").read_text("utf-8")
SCRIPTS = "".join(file.read_text("utf-8") for file in ASSETS.glob("*.js") if file.name != "leaflet.js")
USED = {*re.findall(rf"data-text={STRING}", PAGE), *re.findall(rf"tr\({STRING}", SCRIPTS)}


def test_every_text_that_is_used_is_translated():
    assert len(TABLE) > 80
    assert USED - TABLE.keys() == set()


@pytest.mark.parametrize("text", sorted(TABLE))
def test_translations_keep_the_places_of_values(text):
    translations = TABLE[text]
    assert len(translations) == 3 and all(translations)
    values = sorted(re.findall(r"\{\w+\}", text))
    assert [sorted(re.findall(r"\{\w+\}", one)) for one in translations] == [values] * 3

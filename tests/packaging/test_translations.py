"""What the plugin says, in every language that it speaks."""

from __future__ import annotations

import shutil
import string
import xml.etree.ElementTree as ET

import pytest

from tools import translations
from tools.plugin_files import plugin_files

LANGUAGES = sorted(translations.FORMS)
PLAIN = "<p>{one} of {two:.1f} {three!r}</p>"


@pytest.fixture(scope="module")
def wanted():
    return translations.texts()


def messages(language):
    for message in ET.parse(translations.ts_file(language)).iter("message"):
        translation = message.find("translation")
        forms = [form.text or "" for form in translation.iter("numerusform")]
        yield message.findtext("source"), translation, forms or [translation.text or ""]


def placeholders(text):
    """The placeholders of a text, with their formats; text that is no template has none."""
    try:
        parts = [part[1:] for part in string.Formatter().parse(text) if part[1] is not None]
    except ValueError:
        return text.count("{")
    return sorted(set(parts), key=str), text.count("%n")


def test_placeholders_are_told_apart_by_their_formats():
    assert placeholders(PLAIN) == placeholders("{three!r} {two:.1f} {one}")
    assert placeholders(PLAIN) != placeholders(PLAIN.replace(".1f", ".2f"))
    assert placeholders("%n robots") != placeholders("robots")


@pytest.mark.parametrize("language", LANGUAGES)
def test_every_text_is_there_and_none_besides(language, wanted):
    assert {source for source, *_ in messages(language)} == set(wanted), "run: make translations"


@pytest.mark.parametrize("language", LANGUAGES)
def test_every_text_is_translated_with_its_placeholders(language, wanted):
    for source, translation, forms in messages(language):
        assert translation.get("type") is None, f"unfinished: {source}"
        assert len(forms) == (translations.FORMS[language] if wanted[source].counted else 1), source
        for form in forms:
            assert form.strip(), source
            assert placeholders(form) == placeholders(source), f"{source!r}: {form!r}"


@pytest.mark.parametrize("language", LANGUAGES)
def test_what_qgis_reads_is_made_of_what_is_written(language, tmp_path):
    if shutil.which("lrelease") is None:
        pytest.skip("Qt's Linguist tools are not on this machine; on Debian 12 they come with QGIS")
    made = tmp_path / "made.qm"
    translations.release(translations.ts_file(language), made)
    kept = translations.ts_file(language).with_suffix(".qm")
    assert made.read_bytes() == kept.read_bytes(), "run: make translations"
    assert f"resources/translations/{kept.name}" in plugin_files()

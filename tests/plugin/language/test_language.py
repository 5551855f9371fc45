"""The plugin in other languages, in a real QGIS process and in this one."""

from __future__ import annotations

import shutil

import pytest
from fleet_supervisor.plugin.ui.language import CONTEXT, FOLDER, Language, tr, tr_count
from qgis.PyQt.QtCore import QCoreApplication


@pytest.fixture
def speak(qgis_app):
    made = []

    def begin(locale, folder=FOLDER):
        made.append(Language(locale, folder))
        return made[-1]

    yield begin
    for language in made:
        language.remove()


@pytest.mark.parametrize(
    ("locale", "said"),
    [
        ("hu", "Robottérkép exportálása"),
        ("ca", "Exporta el mapa de robots"),
        ("ca_ES", "Exporta el mapa de robots"),
        ("es_MX", "Exportar mapa de robots"),
    ],
)
def test_texts_follow_the_language_and_its_regions(speak, locale, said):
    assert speak(locale).found
    assert QCoreApplication.translate(CONTEXT, "Export robot map") == said


def test_a_language_that_is_not_there_leaves_english(speak):
    assert not speak("fi").found
    assert QCoreApplication.translate(CONTEXT, "Export robot map") == "Export robot map"


def test_a_file_that_is_written_into_while_it_is_in_use_changes_nothing(speak, tmp_path):
    file = tmp_path / "fleet_supervisor_es.qm"
    shutil.copy(FOLDER / file.name, file)
    assert speak("es", tmp_path).found
    with file.open("r+b") as texts:
        texts.write(bytes(file.stat().st_size))
    assert QCoreApplication.translate(CONTEXT, "Export robot map") == "Exportar mapa de robots"


def test_a_removed_language_says_nothing_any_more(speak):
    speak("es").remove()
    assert QCoreApplication.translate(CONTEXT, "Export robot map") == "Export robot map"


def test_values_go_into_the_translation(speak):
    speak("es")
    assert tr("{robot} is lost or offline", robot="r1") == "r1 está perdido o sin conexión"


def test_numbers_of_things_have_their_forms(speak):
    assert tr_count(1, "1 task", "%n tasks") == "1 task"
    assert tr_count(2, "1 task", "%n tasks") == "2 tasks"
    speak("es")
    assert [tr_count(number, "1 task", "%n tasks") for number in (1, 5)] == ["1 tarea", "5 tareas"]
    speak("hu")
    assert [tr_count(number, "1 task", "%n tasks") for number in (1, 5)] == ["1 feladat", "5 feladat"]

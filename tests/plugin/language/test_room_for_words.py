"""Every panel, dialog and page has room for its words, in long languages and in QGIS's themes.

Looked at in processes of their own (desk_in_words.py): what a module calls things is settled when it is
imported.
"""

from __future__ import annotations

import json
import subprocess
import sys

import pytest
from qgis.PyQt.QtCore import QSize, QStringListModel, Qt
from qgis.PyQt.QtWidgets import (
    QComboBox,
    QDialog,
    QHeaderView,
    QLabel,
    QLineEdit,
    QPushButton,
    QScrollArea,
    QTabBar,
    QToolButton,
    QWidget,
)

from tests.plugin.language.stretched import stretched
from tests.support.inside_qgis.cut_off import cut_off, too_large

LONG = "a text that is much longer than its place"


DESKS = (
    ("stretched", 12, None),
    ("hu", 12, "Night Mapping"),
    ("ca", 12, "Blend of Gray"),
    ("es", 12, None),
    ("hu", 10, None),
)
"""Language, size of the font and theme: what has room in the larger font has it in the smaller one too."""
ALWAYS = 2
"""How many of them are opened in every run; longer than the stretched texts is hardly any translation."""


@pytest.fixture(scope="module")
def faults(request, tmp_path_factory, root):
    """What is wrong with each desk."""
    folder = tmp_path_factory.mktemp("desks")
    desks = DESKS if request.config.getoption("--release") else DESKS[:ALWAYS]
    words = []
    for number, (language, points, theme) in enumerate(desks):
        words += ["and"] if words else []
        words += [language, str(folder / f"{number}.json"), "--points", str(points)]
        words += ["--theme", theme] if theme else []
    command = [sys.executable, "-m", "tests.plugin.language.desk_in_words", *words]
    ran = subprocess.run(command, cwd=root, capture_output=True, text=True)
    assert ran.returncode == 0, ran.stderr
    files = [folder / f"{number}.json" for number in range(len(desks))]
    return dict(zip(desks, (json.loads(file.read_text(encoding="utf-8")) for file in files), strict=True))


MORE = [pytest.param(desk, marks=pytest.mark.again("the stretched texts")) for desk in DESKS[ALWAYS:]]


@pytest.mark.parametrize("desk", [*DESKS[:ALWAYS], *MORE])
def test_nothing_is_cut_off_on_the_smallest_screen(faults, desk):
    assert faults[desk] == {}


def test_a_stretched_text_keeps_its_markup():
    for text in (
        "Send",
        "&Height",
        "{robots} robots of {site}",
        "<p>All of <b>it</b></p>",
        "%n tasks",
        "Export…",
    ):
        longer = stretched(text)
        assert len(longer) >= 1.3 * len(text) - 3, longer
        assert [longer.count(mark) for mark in "&{}<>%…"] == [text.count(mark) for mark in "&{}<>%…"]


def too_narrow(widget: QWidget, width: int = 40) -> QWidget:
    """Return a window that leaves ``widget`` only ``width`` pixels."""
    window = QDialog()
    widget.setParent(window)
    widget.setGeometry(0, 0, width, 30)
    window.resize(200, 100)
    window.show()
    return window


def of_tabs() -> QTabBar:
    bar = QTabBar()
    bar.addTab(LONG)
    return bar


def of_choices() -> QComboBox:
    box = QComboBox()
    box.addItem(LONG)
    return box


def of_hint() -> QLineEdit:
    line = QLineEdit()
    line.setPlaceholderText(LONG)
    return line


def of_tool() -> QToolButton:
    button = QToolButton()
    button.setText(LONG)
    return button


def of_lines() -> QLabel:
    label = QLabel(LONG)
    label.setWordWrap(True)
    return label


class Heads(QStringListModel):
    def headerData(self, section, orientation, role=0):
        return LONG if role == 0 else None


def of_heads() -> QHeaderView:
    heads = QHeaderView(Qt.Orientation.Horizontal)
    heads.kept = Heads(["x"])
    heads.setModel(heads.kept)
    return heads


@pytest.mark.parametrize(
    "make",
    [
        lambda: QPushButton(LONG),
        lambda: QLabel(LONG),
        of_tabs,
        of_choices,
        of_hint,
        of_tool,
        of_lines,
        of_heads,
    ],
)
def test_what_is_too_small_for_its_words_is_found(qgis_app, make):
    window = too_narrow(make())
    assert cut_off(window)
    window.close()


def test_what_ends_beyond_its_view_is_found(qgis_app):
    area = QScrollArea()
    area.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
    content = QWidget()
    content.resize(400, 20)
    QPushButton("ok", content).setGeometry(350, 0, 50, 20)
    area.setWidget(content)
    area.resize(200, 50)
    area.show()
    assert any("beyond" in fault for fault in cut_off(area))
    area.close()


def test_a_window_that_needs_more_than_the_screen_is_found(qgis_app):
    window = QDialog()
    window.setMinimumSize(1300, 100)
    assert too_large(window, QSize(1280, 800))
    assert not too_large(window, QSize(1300, 800))

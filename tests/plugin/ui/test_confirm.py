"""Whoever presses Enter or Escape without reading a question has done nothing by it."""

from __future__ import annotations

import re

import pytest
from fleet_supervisor.plugin.ui.dialogs import confirm
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import QApplication, QPushButton, QWidget


@pytest.fixture
def asked(qgis_app):
    """An open question and how often it was confirmed."""
    window, done = QWidget(), []
    box = confirm(window, "question", "Really?", ("yes", "Yes"), "No", lambda: done.append(1))
    window.show()
    box.open()
    QApplication.processEvents()
    yield box, done
    window.close()


@pytest.mark.parametrize("key", [Qt.Key.Key_Return, Qt.Key.Key_Enter, Qt.Key.Key_Escape])
def test_enter_and_escape_leave_all_as_it_is(asked, key):
    box, done = asked
    QTest.keyClick(box, key)
    assert not box.isVisible()
    assert done == []


def test_the_default_says_that_nothing_is_done(asked):
    box, _ = asked
    assert box.defaultButton().text() == "No"
    assert box.defaultButton() is box.escapeButton()


def test_closing_the_window_leaves_all_as_it_is(asked):
    box, done = asked
    box.close()
    assert done == []


def test_the_button_that_says_so_does_it_once(asked):
    box, done = asked
    QTest.mouseClick(box.findChild(QPushButton, "yes"), Qt.MouseButton.LeftButton)
    assert done == [1]
    assert not box.isVisible()


def test_every_message_box_of_the_plugin_is_such_a_question(root):
    made = re.compile(r"QMessageBox\s*[.(]\s*(?!Icon|ButtonRole|StandardButton)")
    files = [
        path.relative_to(root).as_posix()
        for path in sorted((root / "plugin").rglob("*.py"))
        if made.search(path.read_text(encoding="utf-8"))
    ]
    assert files == ["plugin/ui/dialogs.py"]

"""The names that the plugin asks of Qt are there in Qt 6, held against PyQt6; types: see test_qgis4.py."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

CHECK = Path(__file__).with_name("qt6_names.py")


def missing_names(*paths: Path) -> str:
    """What the check prints; it runs by itself, because PyQt5 and PyQt6 do not belong in one process."""
    done = subprocess.run([sys.executable, CHECK, *paths], capture_output=True, text=True, check=True)
    return done.stdout


def test_all_that_the_plugin_asks_of_qt_is_there(root):
    parts = [path for part in ("plugin", "resources") for path in sorted((root / part).rglob("*.py"))]
    assert missing_names(root / "__init__.py", *parts) == ""


@pytest.mark.parametrize(
    ("statement", "text"),
    [
        ("from qgis.PyQt.QtCore import QRegExp", "PyQt6.QtCore has no QRegExp"),
        ("from qgis.PyQt.QtCore import Qt\nQt.LeftButton", "PyQt6 has no Qt.LeftButton"),
        ("from qgis.PyQt import QtGui\nQtGui.QPainter.Antialiasing", "has no QtGui.QPainter.Antialiasing"),
        ("from qgis.PyQt.QtCore import QVariant\nQVariant.Int", "PyQt6 has no QVariant.Int"),
        ("from qgis.PyQt.QtWidgets import QDesktopWidget", "PyQt6.QtWidgets has no QDesktopWidget"),
        ("dialog.exec_()", ".exec_ is gone"),
        ("event.globalPos()", ".globalPos is gone"),
    ],
)
def test_what_is_not_there_is_found(tmp_path, statement, text):
    (tmp_path / "tool.py").write_text(statement + "\n", encoding="utf-8")
    assert text in missing_names(tmp_path / "tool.py")


@pytest.mark.parametrize(
    "statement",
    [
        "from qgis.PyQt.QtCore import Qt\nQt.MouseButton.LeftButton",
        "from qgis.PyQt.QtWidgets import QAction\nQAction.triggered",
        "from qgis.PyQt.QtGui import QColor\nQColor('red').name().strip",
        "dialog.exec()",
    ],
)
def test_what_is_there_is_not_named(tmp_path, statement):
    (tmp_path / "tool.py").write_text(statement + "\n", encoding="utf-8")
    assert missing_names(tmp_path / "tool.py") == ""

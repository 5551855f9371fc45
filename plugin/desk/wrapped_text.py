"""Text of several lines in a dialog."""

from __future__ import annotations

from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtWidgets import QLabel

MARGINS = 30
"""Pixels of a dialog's width that are not its text's."""


def wrapped_text(text: str, dialog_width: int) -> QLabel:
    """Return ``text`` as a label that is shown whole in a dialog of at least ``dialog_width`` pixels.

    A dialog does not ask its wrapped labels how high they become.
    """
    label = QLabel(text)
    label.setTextFormat(Qt.TextFormat.PlainText)
    label.setWordWrap(True)
    label.setMinimumHeight(label.heightForWidth(dialog_width - MARGINS))
    return label

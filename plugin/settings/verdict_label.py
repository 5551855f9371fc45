"""A line beneath fields that says what became of what was asked."""

from __future__ import annotations

from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtWidgets import QLabel, QWidget

GOOD, BAD = "✔", "✘"


class VerdictLabel(QLabel):
    """Empty until something is told; its mark tells good from bad without colour."""

    def __init__(self, parent: QWidget | None = None):
        super().__init__(parent)
        self.setObjectName("fleet_verdict")
        self.setWordWrap(True)
        self.setTextFormat(Qt.TextFormat.PlainText)
        self.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)

    def tell(self, good: bool, text: str) -> None:
        """Show how it ended."""
        self.setText(f"{GOOD if good else BAD} {text}")

    def wait(self, text: str) -> None:
        """Show that it is under way."""
        self.setText(text)

"""What is an alarm: the operator's settings."""

from __future__ import annotations

from qgis.PyQt.QtCore import pyqtSignal
from qgis.PyQt.QtWidgets import QDialog, QDialogButtonBox, QVBoxLayout, QWidget

from ...language import tr
from .thresholds import Thresholds
from .thresholds_form import ThresholdsForm


class ThresholdsDialog(QDialog):
    """The fields, and what to do with them."""

    chosen = pyqtSignal(object)
    """The Thresholds, when OK was pressed."""

    def __init__(self, limits: Thresholds, parent: QWidget | None = None):
        super().__init__(parent)
        self.setObjectName("fleet_thresholds")
        self.setWindowTitle(tr("Alarm settings"))
        self._form = ThresholdsForm()
        self._buttons = QDialogButtonBox(
            QDialogButtonBox.StandardButton.Ok
            | QDialogButtonBox.StandardButton.Cancel
            | QDialogButtonBox.StandardButton.RestoreDefaults
        )
        self._buttons.accepted.connect(self._accept)
        self._buttons.rejected.connect(self.reject)
        defaults = self._buttons.button(QDialogButtonBox.StandardButton.RestoreDefaults)
        defaults.clicked.connect(lambda: self._form.show_limits(Thresholds()))
        rows = QVBoxLayout(self)
        rows.addWidget(self._form)
        rows.addWidget(self._buttons)
        self._form.show_limits(limits)

    def _accept(self) -> None:
        self.chosen.emit(self._form.limits())
        self.accept()

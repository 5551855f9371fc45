"""Asks whether an emergency stop is really to be cleared."""

from __future__ import annotations

from qgis.PyQt.QtCore import Qt, pyqtSignal
from qgis.PyQt.QtWidgets import QDialog, QDialogButtonBox, QLineEdit, QVBoxLayout, QWidget

from ...robot_bridge.messages import EmergencyReport
from ..language import tr
from .emergency_banner import in_words
from .whole_text import WholeText

WIDTH = 440


class ClearDialog(QDialog):
    """Shows how the stop stands and asks for a reason; ``confirmed`` tells the stop's id and the reason."""

    confirmed = pyqtSignal(str, str)

    def __init__(self, report: EmergencyReport, parent: QWidget | None = None):
        super().__init__(parent)
        self.setObjectName("fleet_clear_dialog")
        self.setWindowTitle(tr("Clear the emergency stop?"))
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self._stop = report.stop or ""
        self._reason = QLineEdit()
        self._reason.setObjectName("fleet_clear_reason")
        hint = tr("Why robots may drive again, for the log")
        self._reason.setPlaceholderText(hint)
        self._reason.setToolTip(hint)
        self._reason.setMaxLength(500)
        buttons = QDialogButtonBox()
        clear = buttons.addButton(tr("Clear emergency stop"), QDialogButtonBox.ButtonRole.AcceptRole)
        clear.setObjectName("fleet_clear_confirm")
        clear.setAutoDefault(False)
        keep = buttons.addButton(tr("Keep it in force"), QDialogButtonBox.ButtonRole.RejectRole)
        keep.setObjectName("fleet_clear_keep")
        keep.setDefault(True)
        buttons.accepted.connect(self.accept)
        buttons.rejected.connect(self.reject)
        self.accepted.connect(lambda: self.confirmed.emit(self._stop, self._reason.text().strip()))
        rows = QVBoxLayout(self)
        for text in (
            in_words(report, asked=False, connected=True),
            tr(
                "Cleared, robots can be sent again. None sets off by itself: what they were doing was "
                "aborted."
            ),
        ):
            rows.addWidget(WholeText(text))
        rows.addWidget(self._reason)
        rows.addWidget(buttons)
        self.setMinimumWidth(WIDTH)

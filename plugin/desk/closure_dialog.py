"""Asks why a road is to be closed and for how long."""

from __future__ import annotations

from qgis.PyQt.QtCore import Qt, pyqtSignal
from qgis.PyQt.QtWidgets import QComboBox, QDialog, QDialogButtonBox, QFormLayout, QLineEdit, QWidget

from ..language import tr
from .whole_text import WholeText

TIMES = (
    (tr("until it is opened"), None),
    (tr("for 15 minutes"), 900.0),
    (tr("for 1 hour"), 3600.0),
    (tr("for 4 hours"), 14_400.0),
    (tr("for 1 day"), 86_400.0),
)
LONGEST_REASON = 200
WIDTH = 440


class ClosureDialog(QDialog):
    """Closes nothing by itself: ``confirmed`` carries the reason and the seconds, None for no end."""

    confirmed = pyqtSignal(str, object)

    def __init__(self, parent: QWidget | None = None):
        super().__init__(parent)
        self.setObjectName("fleet_closure_dialog")
        self.setWindowTitle(tr("Close road"))
        self.setMinimumWidth(WIDTH)
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        text = WholeText(
            tr(
                "The road is closed for every robot from this junction to the next. Robots whose way leads "
                "along it get another way; one that has no other way is stopped, unless the site's settings "
                "say otherwise."
            )
        )
        self._reason = QLineEdit()
        self._reason.setObjectName("fleet_closure_reason")
        self._reason.setMaxLength(LONGEST_REASON)
        self._reason.setPlaceholderText(tr("such as: tree on the road"))
        self._time = QComboBox()
        self._time.setObjectName("fleet_closure_time")
        for words, seconds in TIMES:
            self._time.addItem(words, seconds)
        buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Cancel)
        close = buttons.addButton(tr("Close road"), QDialogButtonBox.ButtonRole.AcceptRole)
        close.setObjectName("fleet_closure_confirm")
        buttons.accepted.connect(self._confirm)
        buttons.rejected.connect(self.reject)
        rows = QFormLayout(self)
        rows.addRow(text)
        rows.addRow(tr("Reason"), self._reason)
        rows.addRow(tr("Closed"), self._time)
        rows.addRow(buttons)

    def _confirm(self) -> None:
        self.confirmed.emit(self._reason.text().strip(), self._time.currentData())
        self.accept()

"""Asks whether an emergency stop is really to be cleared."""

from __future__ import annotations

from qgis.PyQt.QtCore import pyqtSignal
from qgis.PyQt.QtWidgets import QWidget

from ...robot_bridge.messages import EmergencyReport
from ..language import tr
from .emergency_banner import in_words
from .question_dialog import QuestionDialog

LONGEST_REASON = 500


class ClearDialog(QuestionDialog):
    """Shows how the stop stands and asks for a reason; ``confirmed`` tells the stop's id and the reason."""

    confirmed = pyqtSignal(str, str)

    def __init__(self, report: EmergencyReport, parent: QWidget):
        super().__init__(
            "fleet_clear_dialog",
            tr("Clear the emergency stop?"),
            ("fleet_clear_confirm", tr("Clear emergency stop")),
            ("fleet_clear_keep", tr("Keep it in force")),
            is_safe=True,
            parent=parent,
        )
        self.add_text(in_words(report, asked=False, connected=True))
        self.add_text(
            tr(
                "Cleared, robots can be sent again. None sets off by itself: what they were doing was "
                "aborted."
            )
        )
        reason = self.add_reason(
            tr("Why robots may drive again, for the log"), LONGEST_REASON, "fleet_clear_reason"
        )
        self.lay_out()
        stop = report.stop or ""
        self.accepted.connect(lambda: self.confirmed.emit(stop, reason.text().strip()))

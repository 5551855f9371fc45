"""Asks why a road is to be closed and for how long."""

from __future__ import annotations

from qgis.PyQt.QtCore import pyqtSignal
from qgis.PyQt.QtWidgets import QLineEdit, QWidget

from ..language import tr
from .question_dialog import QuestionDialog

TIMES = (
    (tr("until it is opened"), None),
    (tr("for 15 minutes"), 900.0),
    (tr("for 1 hour"), 3600.0),
    (tr("for 4 hours"), 14_400.0),
    (tr("for 1 day"), 86_400.0),
)
LONGEST_REASON = 200


class ClosureDialog(QuestionDialog):
    """``confirmed`` carries the reason and the seconds, None for no end."""

    confirmed = pyqtSignal(str, object)

    def __init__(self, parent: QWidget):
        super().__init__(
            "fleet_closure_dialog",
            tr("Close road"),
            ("fleet_closure_confirm", tr("Close road")),
            is_safe=False,
            parent=parent,
        )
        self.add_text(
            tr(
                "The road is closed for every robot from this junction to the next. Robots whose way leads "
                "along it get another way; one that has no other way is stopped, unless the site's settings "
                "say otherwise."
            )
        )
        reason = QLineEdit()
        reason.setMaxLength(LONGEST_REASON)
        reason.setPlaceholderText(tr("such as: tree on the road"))
        self.add_field(tr("Reason"), reason, "fleet_closure_reason")
        time = self.add_choice(tr("Closed"), TIMES, "fleet_closure_time")
        self.lay_out()
        self.accepted.connect(lambda: self.confirmed.emit(reason.text().strip(), time.currentData()))

"""Which time is to be replayed, and of whom."""

from __future__ import annotations

import time

from qgis.PyQt.QtCore import QDateTime, Qt, pyqtSignal
from qgis.PyQt.QtWidgets import QCheckBox, QComboBox, QDateTimeEdit, QGridLayout, QWidget

from ...language import tr
from ..fixed_size import SteadyPushButton
from .clockwork import local

LAST = {
    tr("the last 5 minutes"): 300,
    tr("the last 15 minutes"): 900,
    tr("the last hour"): 3600,
    tr("the last 8 hours"): 28800,
}
FORMAT = "yyyy-MM-dd HH:mm:ss"


class StretchForm(QWidget):
    """``wanted`` asks for the time in the form, ``stop_wanted`` for no more of it."""

    wanted = pyqtSignal()
    stop_wanted = pyqtSignal()

    def __init__(self, parent: QWidget | None = None):
        super().__init__(parent)
        self.last = QComboBox()
        self.last.setObjectName("fleet_replay_last")
        self.last.addItems([*LAST, tr("from … to …")])
        self.since = _time("fleet_replay_since")
        self.until = _time("fleet_replay_until")
        self.selected = QCheckBox(tr("Selected only"))
        self.selected.setObjectName("fleet_replay_selected")
        self.selected.setToolTip(tr("Load what the selected robots did, not what all did"))
        self.since.setToolTip(tr("From when on"))
        self.until.setToolTip(tr("Until when"))
        self.load = SteadyPushButton("fleet_replay_load", (tr("Load"), tr("Stop")))
        self._is_busy = False
        self._lay_out()
        self.last.currentIndexChanged.connect(self._last_changed)
        self.since.dateTimeChanged.connect(self._by_hand)
        self.until.dateTimeChanged.connect(self._by_hand)
        self.load.clicked.connect(lambda: (self.stop_wanted if self._is_busy else self.wanted).emit())
        self._last_changed()

    def stretch(self) -> tuple[float, float]:
        """Return the time to be replayed, in seconds since 1970; "the last" ones end now."""
        self._last_changed()
        return tuple(box.dateTime().toMSecsSinceEpoch() / 1000.0 for box in (self.since, self.until))

    def show_busy(self, busy: bool) -> None:
        """Offer to stop while positions are on their way."""
        self._is_busy = busy
        self.load.setText(tr("Stop") if busy else tr("Load"))

    def _lay_out(self) -> None:
        grid = QGridLayout(self)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setSpacing(4)
        grid.addWidget(self.last, 0, 0)
        grid.addWidget(self.load, 0, 1)
        grid.addWidget(self.since, 1, 0)
        grid.addWidget(self.until, 2, 0)
        grid.addWidget(self.selected, 3, 0, 1, 2, Qt.AlignmentFlag.AlignLeft)
        grid.setColumnStretch(0, 1)

    def _last_changed(self, *_: object) -> None:
        seconds = LAST.get(self.last.currentText())
        if seconds is None:
            return
        now = time.time()
        for box, at in ((self.since, now - seconds), (self.until, now)):
            box.blockSignals(True)
            box.setDateTime(local(at))
            box.blockSignals(False)

    def _by_hand(self, _at: QDateTime) -> None:
        self.last.setCurrentIndex(len(LAST))


def _time(name: str) -> QDateTimeEdit:
    box = QDateTimeEdit()
    box.setObjectName(name)
    box.setDisplayFormat(FORMAT)
    box.setCalendarPopup(True)
    return box

"""The red banner of an emergency stop: asked for, in force, and who has stopped."""

from __future__ import annotations

from qgis.PyQt.QtCore import Qt, pyqtSignal
from qgis.PyQt.QtWidgets import QAction, QFrame, QHBoxLayout, QToolButton, QWidget

from ...robot_bridge.messages import EmergencyReport
from ..language import first_of, tr, tr_count
from ..wire.status import Phase
from .desk import Desk
from .fixed_size import ScrollingText
from .wall_clock import time_of_day

STYLE = (
    "QFrame#fleet_emergency_banner { background: #B00020; border: 2px solid #FFC400; border-radius: 4px; }"
    "QLabel { color: white; background: transparent; }"
    # QGIS's dark themes give every widget a ground of its own.
    "QScrollArea, QScrollArea > QWidget { background: transparent; }"
)
MOST_NAMES = 6
LINES = 3
"""Lines that are seen at once."""


class EmergencyBanner(QFrame):
    """Hidden as long as all is well. What stands in it is what the gateway said, never what is hoped for.

    It is as high whatever it says.
    """

    toggled = pyqtSignal()
    """It came or went."""

    def __init__(self, desk: Desk, clear: QAction, parent: QWidget | None = None):
        super().__init__(parent)
        self.setObjectName("fleet_emergency_banner")
        self.setStyleSheet(STYLE)
        self._desk = desk
        self._text = ScrollingText("fleet_emergency_text", LINES)
        self._clear = QToolButton()
        self._clear.setObjectName("fleet_clear_emergency_button")
        self._clear.setText(tr("Clear…"))
        self._clear.setAccessibleName(clear.text())
        self._clear.setToolTip(f"{clear.text()}\n{clear.toolTip()}")
        self._clear.clicked.connect(lambda _=False: clear.trigger())
        columns = QHBoxLayout(self)
        columns.setContentsMargins(6, 3, 4, 3)
        columns.addWidget(self._text, 1)
        columns.addWidget(self._clear, 0, Qt.AlignmentFlag.AlignVCenter)
        self.hide()
        desk.emergency_changed.connect(self.refresh)
        desk.link_changed.connect(self.refresh)
        self.refresh()

    def text(self) -> str:
        """Return what stands in it."""
        return self._text.text()

    def refresh(self) -> None:
        """Show how things stand."""
        report = self._desk.emergency
        in_force = report is not None and report.in_force
        asked = self._desk.orders.awaits_stop
        self._clear.setEnabled(in_force)
        connected = self._desk.link.phase is Phase.CONNECTED
        text = in_words(report, asked, connected)
        self._text.setText(text)
        if self.isHidden() is (in_force or asked):
            self.setVisible(in_force or asked)
            self.toggled.emit()


def in_words(report: EmergencyReport | None, asked: bool, connected: bool) -> str:
    """Return what is to be known of a stop: asked for and not confirmed, or in force, and by whom."""
    lines = []
    if asked:
        lines.append(
            tr(
                "EMERGENCY STOP asked for. The gateway has not confirmed it yet: watch the robots, and use "
                "their own emergency stops."
            )
        )
    if report is not None and report.in_force:
        since = (
            tr(
                " since {time}",
                time=time_of_day(report.at),
            )
            if report.at
            else ""
        )
        reason = f" ({report.reason})" if report.reason else ""
        lines.append(
            tr(
                "EMERGENCY STOP in force{since}, by {by}{reason}",
                since=since,
                by=report.by,
                reason=reason,
            )
        )
        lines += _counts(report)
        if not connected:
            lines.append(tr("The link to the gateway is down: this is what it said last."))
    return "\n".join(lines)


def _counts(report: EmergencyReport) -> list[str]:
    lines = [
        tr_count(
            report.robots,
            "{acknowledged} of 1 robot acknowledged, {standing} seen to stand",
            "{acknowledged} of %n robots acknowledged, {standing} seen to stand",
            acknowledged=report.acknowledged,
            standing=report.standing,
        )
    ]
    if report.waiting:
        # The gateway names some fifty at most, and counts all of them.
        silent = report.robots - report.acknowledged - len(report.refused)
        names = ", ".join(first_of(report.waiting, MOST_NAMES, silent))
        lines.append(tr("No answer from {names}", names=names))
    if report.refused:
        refusing = report.robots - report.acknowledged if not report.waiting else 0
        names = ", ".join(first_of(report.refused, MOST_NAMES, refusing))
        lines.append(tr("REFUSED by {names}", names=names))
    if not report.stored:
        lines.append(
            tr("Not stored yet: the gateway cannot write its database, so robots on SQL are not told.")
        )
    return lines

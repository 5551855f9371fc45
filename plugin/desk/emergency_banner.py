"""The red banner of an emergency stop: asked for, in force, and who has stopped."""

from __future__ import annotations

from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtWidgets import QAction, QFrame, QGridLayout, QLabel, QToolButton, QWidget

from ...robot_bridge.messages import EmergencyReport
from ..language import first_of, tr, tr_count
from ..wire.status import Phase
from .desk import Desk
from .wall_clock import time_of_day

STYLE = (
    "QFrame#fleet_emergency_banner { background: #B00020; border: 2px solid #FFC400; border-radius: 4px; }"
    "QLabel { color: white; background: transparent; }"
)
MOST_NAMES = 6


class EmergencyBanner(QFrame):
    """Hidden as long as all is well. What stands in it is what the gateway said, never what is hoped for."""

    def __init__(self, desk: Desk, clear: QAction, parent: QWidget | None = None):
        super().__init__(parent)
        self.setObjectName("fleet_emergency_banner")
        self.setStyleSheet(STYLE)
        self._desk = desk
        self._text = QLabel()
        self._text.setObjectName("fleet_emergency_text")
        self._text.setWordWrap(True)
        self._text.setTextFormat(Qt.TextFormat.PlainText)
        self._text.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        self._clear = QToolButton()
        self._clear.setObjectName("fleet_clear_emergency_button")
        self._clear.setDefaultAction(clear)
        self._clear.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
        grid = QGridLayout(self)
        grid.setContentsMargins(8, 6, 8, 6)
        grid.addWidget(self._text, 0, 0)
        grid.addWidget(self._clear, 1, 0, Qt.AlignmentFlag.AlignRight)
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
        self.setVisible(in_force or asked)
        self._clear.setVisible(in_force)
        connected = self._desk.link.phase is Phase.CONNECTED
        text = in_words(report, asked, connected)
        if text != self._text.text():
            self._text.setText(text)


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
        lines.append(tr("No answer from {names}", names=_names(report.waiting)))
    if report.refused:
        lines.append(tr("REFUSED by {names}", names=_names(report.refused)))
    if not report.stored:
        lines.append(
            tr("Not stored yet: the gateway cannot write its database, so robots on SQL are not told.")
        )
    return lines


def _names(names: list[str]) -> str:
    return ", ".join(first_of(names, MOST_NAMES))

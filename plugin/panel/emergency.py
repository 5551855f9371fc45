"""Emergency stop: banner, shortcut, and the dialog that clears it."""

from __future__ import annotations

from qgis.core import QgsApplication
from qgis.PyQt.QtCore import QEvent, QObject, Qt, pyqtSignal
from qgis.PyQt.QtWidgets import QAction, QApplication, QFrame, QHBoxLayout, QToolButton, QWidget

from ...robot_bridge.core.messages.safety import EmergencyReport
from ..control.fleet_controller import FleetController
from ..gateway_client.connection_status import ConnectionPhase
from ..ui.actions import EMERGENCY_KEYS
from ..ui.dialogs import QuestionDialog
from ..ui.language import first_of, time_of_day, tr, tr_count
from ..ui.steady_widgets import ScrollingText

KEY_EVENTS = (QEvent.Type.ShortcutOverride, QEvent.Type.KeyPress)
BARE = (Qt.KeyboardModifier.NoModifier, Qt.KeyboardModifier.KeypadModifier)


class EmergencyKey(QObject):
    """Triggers ``action`` by its keys in ``window``, and in any other that is active, before any shortcut.

    Qt calls a key ambiguous that another action has as well, and then performs neither; and it disables the
    shortcuts of a window that a dialog blocks. Windows are watched, and not the application: Python cannot
    hold each object that QGIS sends events to while it starts, and QGIS would end.
    """

    def __init__(self, action: QAction, window: QWidget, parent: QObject):
        super().__init__(parent)
        self._action = action
        self._keys = [getattr(Qt.Key, f"Key_{key}") for key in EMERGENCY_KEYS]
        self._is_removed = False
        window.installEventFilter(self)
        QgsApplication.instance().focusWindowChanged.connect(self._watch_active)

    def remove(self) -> None:
        """Leave the keys to others."""
        self._is_removed = True
        QgsApplication.instance().focusWindowChanged.disconnect(self._watch_active)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        kind = event.type()
        if self._is_removed or kind not in KEY_EVENTS:
            return False
        if event.key() not in self._keys or event.modifiers() not in BARE:
            return False
        # The first of the two, accepted, keeps the key from all shortcuts: it comes again as the second.
        event.accept()
        if kind == QEvent.Type.ShortcutOverride and not event.isAutoRepeat():
            self._action.trigger()
        return True

    def _watch_active(self) -> None:
        for window in (QApplication.activeModalWidget(), QApplication.activeWindow()):
            if window is not None:
                window.installEventFilter(self)


STYLE = (
    "QFrame#fleet_emergency_banner { background: #B00020; border: 2px solid #FFC400; border-radius: 4px; }"
    "QLabel { color: white; background: transparent; }"
    # QGIS's dark themes give every widget its own background.
    "QScrollArea, QScrollArea > QWidget { background: transparent; }"
)
MOST_NAMES = 6
LINES = 3
"""Lines that are visible at once."""
SILENT_AFTER = 4.0
"""Seconds after which a gateway's report of a stop is outdated: it is repeated every second."""


class EmergencyBanner(QFrame):
    """Hidden while there is no stop. It shows only what the gateway has reported.

    Its height is the same whatever its text.
    """

    toggled = pyqtSignal()
    """It was shown or hidden."""
    changed = pyqtSignal(str)
    """Its text, whenever that may have changed."""

    def __init__(self, desk: FleetController, clear: QAction, parent: QWidget | None = None):
        super().__init__(parent)
        self.setObjectName("fleet_emergency_banner")
        self.setStyleSheet(STYLE)
        self._desk = desk
        self._text = ScrollingText("fleet_emergency_text", LINES)
        self._shown_silence: int | None = None
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
        desk.state.link_changed.connect(self.refresh)
        desk.state.updated.connect(self._age)
        self.refresh()

    def text(self) -> str:
        """Return its text."""
        return self._text.text()

    def refresh(self) -> None:
        """Show the current state."""
        report = self._desk.state.emergency
        in_force = report is not None and report.in_force
        pending = self._desk.orders.awaits_stop
        self._clear.setEnabled(in_force)
        self._shown_silence = self._silence()
        text = in_words(report, pending, self._shown_silence)
        self._text.setText(text)
        self.changed.emit(text)
        if self.isHidden() is (in_force or pending):
            self.setVisible(in_force or pending)
            self.toggled.emit()

    def _silence(self) -> int | None:
        """Return the seconds for which the gateway has been silent, None while it is not."""
        state = self._desk.state
        silence = state.clock.steady() - state.heard_at
        is_silent = silence > SILENT_AFTER or state.link.phase is not ConnectionPhase.CONNECTED
        return int(silence) if is_silent else None

    def _age(self) -> None:
        if not self.isHidden() and self._silence() != self._shown_silence:
            self.refresh()


def in_words(report: EmergencyReport | None, pending: bool, silence: int | None) -> str:
    """Return the state of a stop: requested and not confirmed, or in force, and by whom.

    ``silence`` is the seconds for which the gateway has been silent, None while it is not.
    """
    lines = []
    if pending:
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
        if silence is not None:
            # Above the counts, which are read first.
            lines.append(
                tr(
                    "The gateway has said nothing for {seconds} s: robots may move. It said last:",
                    seconds=silence,
                )
            )
        lines += _counts(report)
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
    if report.moving:
        moving = len(report.moving) + report.moving_more
        names = ", ".join(first_of(report.moving, MOST_NAMES, moving))
        lines.append(tr("MOVING: {names}", names=names))
    if report.unheard:
        unheard = len(report.unheard) + report.unheard_more
        names = ", ".join(first_of(report.unheard, MOST_NAMES, unheard))
        lines.append(tr("Not heard now, may move: {names}", names=names))
    if report.gateways is not None:
        at = report.gateways
        lines.append(tr("In force at {reached} of {of} gateways", reached=at.reached, of=at.of))
        if at.missing:
            names = ", ".join(first_of(at.missing, MOST_NAMES, at.of - at.reached))
            lines.append(tr("NOT REACHED: gateways {names}. Watch their robots", names=names))
    if report.waiting:
        # The gateway names fifty or so at most, and counts all of them.
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


LONGEST_REASON = 500


class ClearDialog(QuestionDialog):
    """Shows the state of the stop and asks for a reason; ``confirmed`` signals the stop's id and the reason.

    The state is updated while it is open: robots may begin to move meanwhile.
    """

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
        self._state = self.add_text(in_words(report, pending=False, silence=None))
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

    def show_state(self, text: str) -> None:
        """Show the present state of the stop; the last one stays shown where it is no longer in force."""
        if text:
            self._state.setText(text)

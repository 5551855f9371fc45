"""The desk's actions: one for each thing that the operator can do, for toolbar, menu and dock alike."""

from __future__ import annotations

from pathlib import Path

from qgis.PyQt.QtCore import QObject, Qt
from qgis.PyQt.QtGui import QIcon, QKeySequence
from qgis.PyQt.QtWidgets import QAction

ICONS = Path(__file__).parents[2] / "resources" / "icons"
EMERGENCY_KEYS = ("F10", "Pause")
"""Either is enough; QGIS uses neither."""


class Actions(QObject):
    """Actions by the object names that scripts find them by; what they do is connected elsewhere."""

    def __init__(self, parent: QObject):
        super().__init__(parent)
        self.panel = self._made("fleet_panel", "Fleet panel", "fleet.svg", checkable=True)
        self.connect = self._made("fleet_connect", "Connect", "connect.svg", checkable=True)
        self.select = self._made("fleet_select", "Select robot", "select.svg", checkable=True)
        self.cone = self._made("fleet_cone_target", "Cone target", "cone.svg", checkable=True)
        self.route = self._made("fleet_draw_route", "Draw route", "route.svg", checkable=True)
        self.send = self._made("fleet_send", "Send", "send.svg")
        self.cancel = self._made("fleet_cancel", "Cancel", "cancel.svg")
        self.follow = self._made("fleet_follow", "Follow", "follow.svg", checkable=True)
        self.abort = self._made("fleet_abort", "Abort robot", "abort.svg")
        self.abort_all = self._made("fleet_abort_all", "ABORT ALL", "abort_all.svg")
        self.emergency = self._made("fleet_emergency_stop", "EMERGENCY STOP", "emergency_stop.svg")
        self.emergency.setShortcuts([QKeySequence(key) for key in EMERGENCY_KEYS])
        self.emergency.setShortcutContext(Qt.ShortcutContext.ApplicationShortcut)
        self.emergency.setAutoRepeat(False)
        self.clear_emergency = self._made("fleet_clear_emergency", "Clear emergency stop …", "cancel.svg")
        self._explain()

    def all(self) -> list[QAction]:
        """Return every action, in the order of the toolbar."""
        return [
            self.panel,
            self.connect,
            self.select,
            self.cone,
            self.route,
            self.send,
            self.cancel,
            self.follow,
            self.abort,
            self.abort_all,
            self.emergency,
        ]

    def _made(self, name: str, text: str, icon: str, *, checkable: bool = False) -> QAction:
        action = QAction(QIcon(str(ICONS / icon)), text, self)
        action.setObjectName(name)
        action.setCheckable(checkable)
        return action

    def _explain(self) -> None:
        self.panel.setToolTip("Show or hide the fleet panel")
        self.connect.setToolTip("Connect to the gateway, or disconnect")
        self.select.setToolTip("Select a robot by a click on the map")
        self.cone.setToolTip(
            "Set a cone target for the selected robot: click, then Enter or Send; Esc cancels"
        )
        self.route.setToolTip(
            "Draw a route for the selected robot: click its points, Backspace takes the last one back, "
            "Enter or Send sends, Esc cancels"
        )
        self.send.setToolTip("Send what is drawn on the map to its robot")
        self.cancel.setToolTip("Take what is drawn off the map; nothing is sent")
        self.follow.setToolTip("Keep the selected robot in view")
        self.abort.setToolTip("The selected robot gives up its task at once")
        self.abort_all.setToolTip("Every robot gives up its task, at once and without a question")
        self.emergency.setToolTip(
            f"Every robot stops now, and none can be sent anywhere until a supervisor clears it "
            f"({' or '.join(EMERGENCY_KEYS)})"
        )
        self.clear_emergency.setToolTip("Let robots be sent again; takes a supervisor, and asks first")

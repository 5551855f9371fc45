"""Keys for what the desk can do, in QGIS's own list of keyboard shortcuts, where the user can change them."""

from __future__ import annotations

from collections.abc import Sequence

from qgis.gui import QgsGui
from qgis.PyQt.QtWidgets import QAction, QShortcut, QWidget

KEYS = {
    "fleet_panel": "F9",
    "fleet_connect": "Ctrl+F9",
    "fleet_select": "Shift+F9",
    "fleet_follow": "Alt+F9",
    "fleet_follow_all": "Alt+Shift+F9",
    "fleet_cone_target": "F8",
    "fleet_road_route": "Shift+F8",
    "fleet_draw_route": "Ctrl+F8",
    "fleet_start_position": "Alt+Shift+F8",
    "fleet_close_road": "Alt+F8",
    "fleet_send": "Ctrl+Shift+F8",
    "fleet_enqueue": "Ctrl+Shift+F9",
    "fleet_pause_robot": "Alt+F10",
    "fleet_continue": "Alt+Shift+F10",
    "fleet_abort": "Ctrl+F10",
    "fleet_abort_all": "Ctrl+Shift+F10",
    "fleet_coordinates": "Shift+F11",
    "fleet_from_layer": "Shift+F12",
    "fleet_override": "Ctrl+F12",
    "fleet_plan_panel": "Alt+F12",
    "fleet_observations": "Ctrl+Shift+F12",
    "fleet_replay": "Alt+Shift+F12",
}
"""By an action's object name. Function keys: with Ctrl+Alt, keyboards of many countries write letters."""
KEPT = ("fleet_emergency_stop",)
"""What has keys of its own that no user changes."""
OURS = "fleet_"
"""What the object names of the plugin's actions begin with."""


class Shortcuts:
    """The keys as long as the plugin is loaded. :meth:`remove` undoes the constructor.

    Every action of the plugin's menu is in the list, with a key or without. A key that something else in QGIS
    has stays with that. The keys of the emergency stop are not in the list: nobody shall take them away.
    """

    def __init__(self, window: QWidget, actions: Sequence[QAction]):
        self._window, self._manager = window, QgsGui.shortcutsManager()
        taken = _keys_in(window)
        for action in actions:
            if action.objectName() not in KEPT:
                key = KEYS.get(action.objectName(), "")
                self._manager.registerAction(action, "" if key in taken else key)

    def remove(self) -> None:
        """Take the plugin's actions out of QGIS's list; what the user has changed is kept for the next time.

        QGIS lists actions of the window by itself when it starts, and does not notice that one is deleted:
        it would end abruptly when it looks through its list the next time.
        """
        for action in self._window.findChildren(QAction):
            if action.objectName().startswith(OURS):
                self._manager.unregisterAction(action)


def _keys_in(window: QWidget) -> set[str]:
    """Return the keys that something in ``window`` has."""
    keys = [key for action in window.findChildren(QAction) for key in action.shortcuts()]
    keys += [shortcut.key() for shortcut in window.findChildren(QShortcut)]
    return {key.toString() for key in keys}

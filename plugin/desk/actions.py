"""The desk's actions: one for each thing that the operator can do, for toolbar, menu and dock alike."""

from __future__ import annotations

from pathlib import Path

from qgis.PyQt.QtCore import QObject, Qt
from qgis.PyQt.QtGui import QIcon, QKeySequence
from qgis.PyQt.QtWidgets import QAction

from ..language import tr

ICONS = Path(__file__).parents[2] / "resources" / "icons"
EMERGENCY_KEYS = ("F10", "Pause")
"""Either is enough; QGIS uses neither. Qt reads their names in English only: they are not translated."""


class Actions(QObject):
    """Actions by the object names that scripts find them by; what they do is connected elsewhere."""

    def __init__(self, parent: QObject):
        super().__init__(parent)
        self._make_for_window()
        self._make_for_choosing()
        self._make_for_drafts()
        self._make_for_roads()
        self._make_for_stopping()
        self.off_toolbar = (
            self.way_wishes,
            self.undo,
            self.redo,
            self.reverse,
            self.override,
            self.send_map,
            self.clear_emergency,
        )
        """In the menu, and beside the draft or the emergency stop where they belong to it."""
        self.for_drafts = (
            self.cone,
            self.road_route,
            self.way_wishes,
            self.route,
            self.start,
            self.coordinates,
            self.from_layer,
            self.undo,
            self.redo,
            self.reverse,
            self.send,
            self.enqueue,
            self.override,
            self.cancel,
        )
        """What makes, changes and sends drafts: in a menu of its own, since one for all is too long for a
        screen."""

    def all(self) -> list[QAction]:
        """Return every action, in the order of the toolbar."""
        return [
            self.panel,
            self.connect,
            self.select,
            *self.for_drafts,
            self.send_map,
            self.closures,
            self.follow,
            self.follow_all,
            self.pause,
            self.go_on,
            self.abort,
            self.abort_all,
            self.emergency,
            self.clear_emergency,
        ]

    def _make_for_window(self) -> None:
        self.panel = self._made(
            "fleet_panel", tr("Fleet panel"), "fleet.svg", tr("Show or hide the fleet panel"), checkable=True
        )
        self.connect = self._made(
            "fleet_connect",
            tr("Connect"),
            "connect.svg",
            tr("Connect to the gateway, or disconnect"),
            checkable=True,
        )
        self.follow = self._made(
            "fleet_follow",
            tr("Follow"),
            "follow.svg",
            tr("Keep the selected robots in view"),
            checkable=True,
        )
        self.follow_all = self._made(
            "fleet_follow_all",
            tr("Keep all in view"),
            "follow_all.svg",
            tr("Keep every robot in view"),
            checkable=True,
        )

    def _make_for_choosing(self) -> None:
        """Make the tools that a click on the map is for: a robot, or where it is to go."""
        self.select = self._made(
            "fleet_select",
            tr("Select robot"),
            "select.svg",
            tr(
                "Select robots on the map: click one or drag a rectangle, with Shift to add, with Ctrl to "
                "take away; double click goes there"
            ),
            checkable=True,
        )
        self.cone = self._made(
            "fleet_cone_target",
            tr("Cone target"),
            "cone.svg",
            tr("Set a cone target for the selected robot: click, then Enter or Send; Esc cancels"),
            checkable=True,
        )
        self.route = self._made(
            "fleet_draw_route",
            tr("Draw route"),
            "route.svg",
            tr(
                "Draw a route for the selected robot: click its points, right click ends drawing, drag "
                "points or lines to change it, Backspace takes the last one back, Enter or Send sends, Esc "
                "cancels"
            ),
            checkable=True,
        )
        self.start = self._made(
            "fleet_start_position",
            tr("Start position"),
            "start.svg",
            tr(
                "Tell the selected robot where it stands: click, or drag to where it points; then Enter or "
                "Send"
            ),
            checkable=True,
        )

    def _make_for_drafts(self) -> None:
        self.coordinates = self._made(
            "fleet_coordinates",
            tr("Coordinates…"),
            "coordinates.svg",
            tr("Type or paste coordinates in any CRS in place of a click"),
        )
        self.from_layer = self._made(
            "fleet_from_layer",
            tr("Take from layer"),
            "from_layer.svg",
            tr("Make the draft of what is selected in the active layer: a point, a line, or many points"),
        )
        self._make_for_changes()
        tip = tr("Send what is drawn on the map to its robot")
        self.send = self._made("fleet_send", tr("Send"), "send.svg", tip)
        tip = tr("Put what is drawn at the end of its robot's queue, instead of sending it")
        self.enqueue = self._made("fleet_enqueue", tr("Add to queue"), "enqueue.svg", tip)
        tip = tr("Let a draft be sent in spite of what the checks found; asks why")
        self.override = self._made("fleet_override", tr("Override…"), "override.svg", tip)
        tip = tr("Take what is drawn off the map; nothing is sent")
        self.cancel = self._made("fleet_cancel", tr("Cancel"), "cancel.svg", tip)
        tip = tr("Send the selected robots the map of the whole site now")
        self.send_map = self._made("fleet_send_map", tr("Send map"), "send_map.svg", tip)

    def _make_for_changes(self) -> None:
        tip = tr("Take the last change of the draft back (Ctrl+Z over the map)")
        self.undo = self._made("fleet_undo", tr("Undo"), "undo.svg", tip)
        tip = tr("Make the change again that was taken back (Ctrl+Shift+Z over the map)")
        self.redo = self._made("fleet_redo", tr("Redo"), "redo.svg", tip)
        tip = tr("Let the route begin at its end (R over the map)")
        self.reverse = self._made("fleet_reverse_route", tr("Turn route round"), "reverse.svg", tip)

    def _make_for_roads(self) -> None:
        self.road_route = self._made(
            "fleet_road_route",
            tr("Route on roads"),
            "route_on_roads.svg",
            tr(
                "Route along the roads for the selected robot: the way to the mouse is shown, a click takes "
                "it, right click ends drawing; Backspace takes the last leg back, Enter or Send sends, Esc "
                "cancels"
            ),
            checkable=True,
        )
        self.way_wishes = self._made(
            "fleet_way_wishes",
            tr("Ways on roads…"),
            "route_on_roads.svg",
            tr(
                "Say how Route on roads is to lead: shortest or fastest, on which surfaces, off the roads of "
                "other robots"
            ),
        )
        self.closures = self._made(
            "fleet_close_road",
            tr("Close road"),
            "close_road.svg",
            tr("Close a road for every robot by a click on it, or open a closed one again"),
            checkable=True,
        )

    def _make_for_stopping(self) -> None:
        tip = tr(
            "Every selected robot stands at once and keeps its task, until it is let go on with Continue"
        )
        self.pause = self._made("fleet_pause_robot", tr("Pause robot"), "pause_robot.svg", tip)
        tip = tr("Let the selected robots that are paused go on with their tasks, from where they stand")
        self.go_on = self._made("fleet_continue", tr("Continue"), "continue.svg", tip)
        tip = tr("Every selected robot gives up its task at once")
        self.abort = self._made("fleet_abort", tr("Abort robot"), "abort.svg", tip)
        tip = tr("Every robot gives up its task, at once and without a question")
        self.abort_all = self._made("fleet_abort_all", tr("ABORT ALL"), "abort_all.svg", tip)
        self.emergency = self._made(
            "fleet_emergency_stop",
            tr("EMERGENCY STOP"),
            "emergency_stop.svg",
            tr(
                "Every robot stops now, and none can be sent anywhere until a supervisor clears it "
                "({emergency_keys})",
                emergency_keys=" or ".join(EMERGENCY_KEYS),
            ),
        )
        self.emergency.setShortcuts([QKeySequence(key) for key in EMERGENCY_KEYS])
        self.emergency.setShortcutContext(Qt.ShortcutContext.ApplicationShortcut)
        self.emergency.setAutoRepeat(False)
        tip = tr("Let robots be sent again; takes a supervisor, and asks first")
        self.clear_emergency = self._made(
            "fleet_clear_emergency", tr("Clear emergency stop…"), "cancel.svg", tip
        )

    def _made(self, name: str, text: str, icon: str, tip: str, *, checkable: bool = False) -> QAction:
        action = QAction(QIcon(str(ICONS / icon)), text, self)
        action.setObjectName(name)
        action.setCheckable(checkable)
        action.setToolTip(tip)
        return action

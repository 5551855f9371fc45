"""Actions of the operator: icons, texts, shortcuts, docks, and the plugin's menu."""

from __future__ import annotations

import functools
from collections.abc import Mapping, Sequence
from pathlib import Path

from qgis.core import QgsSettings
from qgis.gui import QgisInterface, QgsDockWidget, QgsGui, QgsMapCanvas
from qgis.PyQt.QtCore import QByteArray, QObject, Qt
from qgis.PyQt.QtGui import QIcon, QKeySequence
from qgis.PyQt.QtWidgets import QAction, QDockWidget, QMainWindow, QMenu, QShortcut, QWidget

from .language import tr

ICONS = Path(__file__).parents[2] / "resources" / "icons"
EMERGENCY_KEYS = ("F10", "Pause")
"""Either works; QGIS uses neither. Qt reads their names in English only: they are not translated."""


class Actions(QObject):
    """Actions by the object names under which scripts find them; they are connected elsewhere."""

    def __init__(self, parent: QObject):
        super().__init__(parent)
        self._make_for_window()
        self._make_for_choosing()
        self._make_for_drafts()
        self._make_for_roads()
        self._make_for_stopping()
        self.off_toolbar = (
            self.route_preferences,
            self.undo,
            self.redo,
            self.reverse,
            self.override,
            self.send_map,
            self.clear_emergency,
        )
        """In the menu, and beside the draft or the emergency stop where they belong."""
        self.for_drafts = (
            self.cone,
            self.road_route,
            self.route_preferences,
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
        """Actions that make, change and send drafts: in a menu of their own, since one for all is too long
        for a screen."""

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
        """Make the tools used by clicks on the map: on a robot, or on its goal."""
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
        tip = tr("Take the last change of the draft back; Ctrl+Z over the map does so too")
        self.undo = self._made("fleet_undo", tr("Undo"), "undo.svg", tip)
        tip = tr("Make the change again that was taken back; Ctrl+Shift+Z over the map does so too")
        self.redo = self._made("fleet_redo", tr("Redo"), "redo.svg", tip)
        tip = tr("Let the route begin at its end; R over the map does so too")
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
        self.route_preferences = self._made(
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
                "({one_key} or {other_key})",
                one_key=EMERGENCY_KEYS[0],
                other_key=EMERGENCY_KEYS[1],
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
        # No parentheses in a tip: QGIS takes them for the shortcut, and replaces them by it.
        action = QAction(QIcon(str(ICONS / icon)), text, self)
        action.setObjectName(name)
        action.setCheckable(checkable)
        action.setToolTip(tip)
        return action


AREA = Qt.DockWidgetArea.LeftDockWidgetArea
BROWSER = "Browser"
"""QGIS's name for its panel of files and services."""


class ActionDock(QgsDockWidget):
    """A panel of the main window that a :class:`DockAction` shows.

    It is in the window from the beginning, so that QGIS lists it, and opens it if it was open in the last
    session. Its parts are built when it is first shown or something has come for it: QGIS starts
    without them.
    """

    def __init__(self, title: str, name: str, parent: QWidget | None = None):
        super().__init__(title, parent)
        self.setObjectName(name)
        self._is_placed = self._is_built = False

    def settle(self, iface: QgisInterface) -> None:
        """Add the panel to the window, closed; when shown from now on, it builds its parts."""
        # QGIS shows every panel that is added.
        iface.addDockWidget(AREA, self)
        self.hide()
        self._is_placed = True

    def setVisible(self, visible: bool) -> None:
        # The one way by which Qt opens a panel, be it for an action or from a saved arrangement.
        if visible and self._is_placed:
            self.build()
        super().setVisible(visible)

    def build(self) -> None:
        """Build the missing parts of the panel; they show the current state."""
        if not self._is_built:
            self._is_built = True
            self._build()

    def remove(self) -> None:
        """Remove what the panel added elsewhere, before it is removed itself."""
        if self._is_built:
            self._remove_parts()

    def _build(self) -> None:
        raise NotImplementedError

    def _remove_parts(self) -> None:
        raise NotImplementedError


class DockAction:
    """An entry of ``menu`` and the panel that it shows. :meth:`remove` undoes the constructor.

    When first opened, the panel is a tab beside QGIS's browser: beneath browser and layers a window
    of 800 pixels has no room for its parts. If the user drags it elsewhere, QGIS restores that the next time.
    """

    def __init__(
        self,
        iface: QgisInterface,
        menu: str,
        dock: ActionDock,
        *,
        icon: str,
        text: str,
        name: str,
        tip: str,
    ):
        self._iface, self._menu, self.dock = iface, menu, dock
        self.action = QAction(QIcon(str(ICONS / icon)), text, iface.mainWindow())
        self.action.setObjectName(name)
        self.action.setCheckable(True)
        self.action.setToolTip(tip)
        self._is_placed = self._lacks_height = False
        dock.settle(iface)
        # Before the panel is shown. During QGIS's start would be too soon: it arranges its panels after that.
        self.action.toggled.connect(self._place)
        dock.setToggleVisibilityAction(self.action)
        self.action.triggered.connect(self._make_room)
        self.action.triggered.connect(self._focus_opened)
        iface.addPluginToMenu(menu, self.action)

    def _place(self, opened: bool) -> None:
        if self._is_placed or not opened:
            return
        self._is_placed = True
        window: QMainWindow = self._iface.mainWindow()
        browser = window.findChild(QDockWidget, BROWSER)
        if browser is None or self._is_known_to_qgis():
            return
        if window.dockWidgetArea(browser) == AREA and not browser.isFloating():
            window.tabifyDockWidget(browser, self.dock)
            self._lacks_height = True

    def _is_known_to_qgis(self) -> bool:
        """Return whether QGIS has restored the panel's last place."""
        arrangement = bytes(QgsSettings().value("UI/state", QByteArray()) or b"")
        return self.dock.objectName().encode("utf-16-be") in arrangement

    def _make_room(self, opened: bool) -> None:
        """Give a panel that is new beside the browser half of the column: layers would leave it a strip."""
        if opened and self._lacks_height:
            self._lacks_height = False
            window: QMainWindow = self._iface.mainWindow()
            window.resizeDocks([self.dock], [self.dock.sizeHint().height()], Qt.Orientation.Vertical)

    def _focus_opened(self, opened: bool) -> None:
        """Set the focus in the panel when it was opened by its shortcut."""
        if opened:
            self.dock.setFocus(Qt.FocusReason.ShortcutFocusReason)

    def remove(self) -> None:
        """Remove panel, layers and entry."""
        self.dock.remove()
        self._iface.removeDockWidget(self.dock)
        self.dock.deleteLater()
        self._iface.removePluginMenu(self._menu, self.action)
        self.action.deleteLater()


class FailedStart:
    """Restores QGIS's window and its map where the plugin's start fails half-way.

    A part that fails in its constructor is known to nobody, and what it has added already has a parent.
    Connections that it has made are not undone.
    """

    def __init__(self, window: QMainWindow, canvas: QgsMapCanvas):
        self._window, self._canvas = window, canvas
        self._before = (*window.children(), *canvas.children(), *canvas.scene().items())
        self._is_over = False

    def finish(self) -> None:
        """Note that every part was built, and is removed by itself."""
        self._is_over, self._before = True, ()

    def remove(self) -> None:
        """Remove everything that was added, unless every part was built."""
        if self._is_over:
            return
        scene = self._canvas.scene()
        for item in scene.items():
            if item not in self._before:
                scene.removeItem(item)
        for child in (*self._window.children(), *self._canvas.children()):
            if child not in self._before:
                if isinstance(child, QDockWidget):
                    self._window.removeDockWidget(child)
                child.deleteLater()


class PluginMenu:
    """The menu ``title`` of ``window``. :meth:`remove` must be called when every entry has been removed."""

    def __init__(self, window: QWidget, title: str):
        self._window, self._title = window, title

    def remove(self) -> None:
        """Delete the menu, which QGIS only unlists: each loading would add another one to the window."""
        for menu in self._window.findChildren(QMenu, options=Qt.FindChildOption.FindDirectChildrenOnly):
            if menu.title() == self._title and menu.isEmpty():
                menu.deleteLater()


class MenuLetters(QObject):
    """Keeps a unique access key for each entry of a menu. :meth:`remove` ends that.

    Translations define none: uniqueness depends on all texts of a menu. Buttons show an action's
    text without its access key.
    """

    def __init__(self, actions: Sequence[QAction], parent: QObject | None = None):
        super().__init__(parent)
        self._actions = list(actions)
        self._plain: list[str] = []
        self._is_renewing = False
        for action in self._actions:
            action.changed.connect(self._renew)
        self._renew()

    def remove(self) -> None:
        """Stop watching the entries; they are about to be removed."""
        for action in self._actions:
            action.changed.disconnect(self._renew)
        self._actions = []
        self.deleteLater()

    def _renew(self) -> None:
        if self._is_renewing:  # what changes are the letters
            return
        plain = [action.text().replace("&", "") for action in self._actions]
        if plain == self._plain:
            return
        self._plain = plain
        self._is_renewing = True
        for action, text in zip(self._actions, with_letters(plain), strict=True):
            action.setText(text)
        self._is_renewing = False


def with_letters(texts: Sequence[str]) -> list[str]:
    """Return ``texts``, each with ``&`` before a letter that no other uses.

    A text gets none where letters run out: earlier texts take precedence, and first letters of words.
    """
    places = [_places(text) for text in texts]
    taken: dict[str, int] = {}
    for number in range(len(texts)):
        _give_letter(number, places, taken, set())
    letters = {number: letter for letter, number in taken.items()}
    return [
        text[: places[number][letters[number]]] + "&" + text[places[number][letters[number]] :]
        if number in letters
        else text
        for number, text in enumerate(texts)
    ]


@functools.lru_cache(maxsize=256)
def _places(text: str) -> Mapping[str, int]:
    """Return the position of each letter of a text, first letters of words in front."""
    found = [k for k, letter in enumerate(text) if letter.isalpha()]
    found.sort(key=lambda k: k > 0 and text[k - 1].isalpha())
    places: dict[str, int] = {}
    for k in found:
        places.setdefault(text[k].casefold(), k)
    return places


def _give_letter(
    number: int, places: list[Mapping[str, int]], taken: dict[str, int], tried: set[str]
) -> bool:
    """Find a letter for a text, if necessary by reassigning those of others (augmenting paths)."""
    for letter in places[number]:
        if letter not in taken:
            taken[letter] = number
            return True
    for letter in places[number]:
        if letter not in tried:
            tried.add(letter)
            if _give_letter(taken[letter], places, taken, tried):
                taken[letter] = number
                return True
    return False


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
"""By an action's object name. Function keys: with Ctrl+Alt, many countries' keyboards type letters."""
KEPT = ("fleet_emergency_stop",)
"""Actions with fixed keys that no user can change."""
OURS = "fleet_"
"""Prefix of the object names of the plugin's actions."""


class Shortcuts:
    """The shortcuts while the plugin is loaded. :meth:`remove` undoes the constructor.

    Every action of the plugin's menu is in QGIS's list, with a key or without. A key already used in QGIS
    is left there. The keys of the emergency stop are not in the list: they must not be taken away.
    """

    def __init__(self, window: QWidget, actions: Sequence[QAction], taken: Mapping[str, str]):
        """``taken`` are the keys that :func:`keys_in` finds in ``window`` before the plugin is in it."""
        self._window, self._manager = window, QgsGui.shortcutsManager()
        self._actions = list(actions)
        for action in self._actions:
            if action.objectName() not in KEPT:
                key = KEYS.get(action.objectName(), "")
                self._manager.registerAction(action, "" if key in taken else key)

    def remove(self) -> None:
        """Remove the plugin's actions from QGIS's list; the user's changes are kept for the next time.

        QGIS lists actions of the window by itself when it starts, and does not notice that one is deleted:
        it would crash when it iterates over its list the next time.
        """
        # QGIS lists the children of the window and not theirs.
        listed = self._window.findChildren(QAction, options=Qt.FindChildOption.FindDirectChildrenOnly)
        for action in (*self._actions, *listed):
            if action.objectName().startswith(OURS):
                self._manager.unregisterAction(action)
        self._actions = []


def keys_in(window: QWidget) -> dict[str, str]:
    """Return the keys in use in ``window``, each with the text of what has it."""
    # Both at once: PyQt makes an object for each child that it visits.
    having = window.findChildren((QAction, QShortcut))
    actions = [one for one in having if isinstance(one, QAction)]
    keys = {one.key().toString(): one.objectName() or "?" for one in having if isinstance(one, QShortcut)}
    return keys | {key.toString(): one.text().replace("&", "") for one in actions for key in one.shortcuts()}


def emergency_keys_in(taken: Mapping[str, str]) -> list[str]:
    """Return a warning for each key of the emergency stop that is in ``taken``, from :func:`keys_in`."""
    return [
        tr(
            "{key} is the key of the EMERGENCY STOP and does not perform {action}. Give that another key in "
            "Settings > Keyboard Shortcuts.",
            key=key,
            action=taken[key],
        )
        for key in EMERGENCY_KEYS
        if key in taken
    ]

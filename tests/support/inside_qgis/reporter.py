"""Tells a program outside where things are on the screen and what they show; it does nothing to them."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import asdict
from typing import Any

from qgis.core import (
    Qgis,
    QgsApplication,
    QgsCoordinateReferenceSystem,
    QgsCoordinateTransform,
    QgsPointXY,
    QgsProject,
    QgsTemporalNavigationObject,
    QgsVectorLayer,
)
from qgis.PyQt.QtCore import QModelIndex, QObject, QPoint, QRect, Qt
from qgis.PyQt.QtNetwork import QLocalServer, QLocalSocket
from qgis.PyQt.QtWidgets import (
    QAbstractButton,
    QAbstractItemView,
    QAbstractSpinBox,
    QApplication,
    QComboBox,
    QDockWidget,
    QLabel,
    QLineEdit,
    QMenu,
    QMenuBar,
    QProgressBar,
    QPushButton,
    QTabBar,
    QTabWidget,
    QToolButton,
    QWidget,
)
from qgis.PyQt.sip import unwrapinstance
from qgis.utils import iface, plugins

from tests.support.inside_qgis.desk_view import DeskView, FoundAgain, NotHappenedError
from tests.support.inside_qgis.out_of_sight import what_is_out_of_sight

PLUGIN = "fleet_supervisor"
PYTHON = "Python"
"""What the tags of QGIS's messages on exceptions begin with."""

UNSEEN = {"there": True, **dict.fromkeys(("visible", "enabled", "on_top", "checked", "focus"), False)}
"""How a widget stands that is not to be seen."""
DROPPED = (Qt.CursorShape.DragCopyCursor, Qt.CursorShape.DragMoveCursor, Qt.CursorShape.DragLinkCursor)


class Reporter(QObject):
    """Answers questions on a local socket, a JSON object on each line: ``answer`` or ``error``."""

    def __init__(self, path: str, parent: QObject | None = None):
        super().__init__(parent)
        self._complaints: list[str] = []
        self._view, self._found = DeskView(iface), FoundAgain()
        self._socket: QLocalSocket | None = None
        QgsApplication.messageLog().messageReceived.connect(self._logged)
        self._questions: dict[str, Callable[..., Any]] = {
            "window": _window,
            "widget": self._widget,
            "entry": _entry,
            "button": _button,
            "buttons": self._buttons,
            "field": _field,
            "tab": self._tab,
            "panel_tab": _panel_tab,
            "row": self._row,
            "panel": self._panel,
            "place": _place,
            "desk": lambda: _desk(self._view),
            "layers": _layers,
            "counts": _counts,
            "map": _map,
            "labels": _labels,
            "time": _time,
            "messages": _messages,
            "drag": _drag,
            "out_of_sight": what_is_out_of_sight,
            "complaints": lambda: self._complaints,
        }
        self._server = QLocalServer(self)
        self._server.newConnection.connect(self._greet)
        if not self._server.listen(path):
            raise NotHappenedError(f"QGIS cannot listen at {path}: {self._server.errorString()}")

    def _greet(self) -> None:
        self._socket = self._server.nextPendingConnection()
        self._socket.readyRead.connect(self._read)

    def _read(self) -> None:
        while self._socket.canReadLine():
            question = json.loads(bytes(self._socket.readLine()))
            try:
                answer = {"answer": self._questions[question.pop("ask")](**question)}
            except NotHappenedError as error:
                answer = {"error": str(error)}
            self._socket.write(json.dumps(answer).encode() + b"\n")

    def _widget(self, name: str) -> dict[str, Any]:
        """A widget by its object name, or its C++ class: where it can be clicked, and what it shows."""
        widget = self._found.get(name, search=lambda: _widget(name), holds=_is_first)
        return {**UNSEEN, "there": False} if widget is None else _how_it_stands(widget)

    def _buttons(self, name: str) -> dict[str, Any]:
        """Where a panel is, and each button that is seen in it: its name and place by what it is known by."""
        panel = self._find(QWidget, name)
        # A conflict's buttons bear the names of its robots, which change: the widget is the same.
        seen = [one for one in panel.findChildren(QAbstractButton) if not one.visibleRegion().isEmpty()]
        buttons = {
            str(unwrapinstance(one)): [one.objectName() or one.text(), _on_screen(one, one.rect())]
            for one in seen
            if isinstance(one, (QPushButton, QToolButton)) and not isinstance(one.parent(), QLineEdit)
        }
        return {"rect": _on_screen(panel, panel.rect()), "buttons": buttons}

    def _tab(self, name: str, text: str) -> list[int] | None:
        """Where the tab is that begins with ``text``; ``name`` is the object name of its tab widget."""
        tabs = self._find(QTabWidget, name).tabBar()
        return _tab_of(tabs, text)

    def _row(self, name: str, path: list[str], column: int = 0) -> list[int] | None:
        """Where a cell of a table, tree or list is, by what the first column reads from the root on.

        ``name`` is the view's object name, or that of what holds it: QGIS names not all of its views.
        """
        view = self._item_view(name)
        if view is None:
            return None
        index = QModelIndex()
        for text in path:
            rows = range(view.model().rowCount(index))
            children = (view.model().index(row, 0, index) for row in rows)
            found = next((child for child in children if str(child.data()).strip() == text), None)
            if found is None:
                return None
            index = found
        cell = index.sibling(index.row(), column)
        seen = view.visualRect(cell) & view.viewport().rect()
        return _on_screen(view.viewport(), seen) if not seen.isEmpty() else None

    def _item_view(self, name: str) -> QAbstractItemView | None:
        """Return the view that is called so or lies in what is called so, None while it is not to be seen."""
        holder = self._find(QWidget, name)
        views = [holder, *holder.findChildren(QAbstractItemView)]
        return next((one for one in views if isinstance(one, QAbstractItemView) and one.isVisible()), None)

    def _panel(self, name: str) -> dict[str, Any]:
        """Where a panel is, and the cross that closes it."""
        dock = self._find(QDockWidget, name)
        cross = dock.findChild(QAbstractButton, "qt_dockwidget_closebutton")
        seen = cross is not None and cross.isVisible()
        return {
            "rect": _on_screen(dock, dock.rect()),
            "cross": _on_screen(cross, cross.rect()) if seen else None,
        }

    def _find(self, kind: type, name: str) -> Any:
        found = self._found.get((kind, name), search=lambda: _find(kind, name), holds=QWidget.isVisible)
        if found is None:
            raise NotHappenedError(f"the window has no {kind.__name__} named {name}")
        return found

    def _logged(self, text: str, tag: str, level: Qgis.MessageLevel) -> None:
        if tag.startswith(PYTHON) and level in (Qgis.MessageLevel.Warning, Qgis.MessageLevel.Critical):
            self._complaints.append(f"{tag}: {text}")


def _window() -> dict[str, Any]:
    """The main window and the one over it, if any, by X's numbers for them."""
    over = _over()
    return {"main": int(iface.mainWindow().winId()), "dialog": int(over.winId()) if over else None}


def _over() -> QWidget | None:
    """Return the dialog that blocks the others, or else a window beside the main one."""
    kinds = (Qt.WindowType.Dialog, Qt.WindowType.Window)
    beside = (
        window
        for window in QApplication.topLevelWidgets()
        if window.isVisible() and window.windowType() in kinds and window is not iface.mainWindow()
    )
    return QApplication.activeModalWidget() or next(beside, None)


def _widget(name: str) -> QWidget | None:
    """Return a widget by its object name, or its C++ class: of several, one that can be seen.

    One in a dialog that blocks the others comes before those beneath it.
    """
    widgets = QApplication.allWidgets()
    found = [one for one in widgets if name in (one.objectName(), one.metaObject().className())]
    over = QApplication.activeModalWidget()
    return max(
        found, key=lambda one: (one.isVisible(), over is not None and over.isAncestorOf(one)), default=None
    )


def _is_first(widget: QWidget) -> bool:
    """Tell whether no other of its name comes before it."""
    over = QApplication.activeModalWidget()
    return widget.isVisible() and (over is None or over.isAncestorOf(widget))


def _how_it_stands(widget: QWidget) -> dict[str, Any]:
    if not widget.isVisible():
        return UNSEEN
    seen = widget.visibleRegion().boundingRect()
    under = QApplication.widgetAt(widget.mapToGlobal(seen.center()))
    return {
        "there": True,
        "visible": True,
        "enabled": widget.isEnabled(),
        "on_top": under is not None and (under is widget or widget.isAncestorOf(under)),
        "rect": _on_screen(widget, seen),
        "checked": _said(widget, "isChecked"),
        "focus": widget.hasFocus(),
        "text": _text(widget),
        "tip": widget.toolTip(),
    }


def _button(text: str) -> list[int] | None:
    """Where the button is that reads ``text``, in the window over the main one or else in that."""
    window = _over() or iface.mainWindow()
    for button in window.findChildren(QAbstractButton):
        if button.text().replace("&", "") == text and button.isVisible() and button.isEnabled():
            return _on_screen(button, button.rect())
    return None


def _field(label: str, of: str) -> dict[str, Any] | None:
    """The field of a dialog beneath the label that begins so, or the button beside it (``of`` "button").

    None while it is not to be seen. QGIS gives none of the fields of an algorithm a name.
    """
    kinds = (QToolButton,) if of == "button" else (QLineEdit, QAbstractSpinBox, QComboBox)
    for words in (_over() or iface.mainWindow()).findChildren(QLabel):
        if not words.text().startswith(label) or not words.isVisible():
            continue
        rows = words.parentWidget().layout()
        beneath = rows.itemAt(rows.indexOf(words) + 1).widget()
        parts = [part for part in [beneath, *beneath.findChildren(QWidget)] if isinstance(part, kinds)]
        if parts and not parts[-1 if of == "button" else 0].visibleRegion().isEmpty():
            part = parts[-1 if of == "button" else 0]
            return {"rect": _on_screen(part, part.visibleRegion().boundingRect()), "text": _text(part)}
    return None


def _entry(text: str) -> list[int] | None:
    """Where an entry of the menu bar, or of a menu that is open, is; None while it is not to be seen."""
    window = _over() or iface.mainWindow()
    bars = [bar for bar in window.findChildren(QMenuBar) if bar.isVisible()]
    menus = [menu for menu in QApplication.topLevelWidgets() if isinstance(menu, QMenu) and menu.isVisible()]
    for menu in [*menus, *bars]:
        for action in menu.actions():
            if action.isVisible() and action.text().replace("&", "") == text:
                return _on_screen(menu, menu.actionGeometry(action))
    return None


def _panel_tab(text: str) -> list[int] | None:
    """Where the tab of a panel is that lies over others, in the window over the main one or else in that."""
    bars = [bar for bar in (_over() or iface.mainWindow()).findChildren(QTabBar) if bar.isVisible()]
    return next(filter(None, (_tab_of(bar, text) for bar in bars)), None)


def _tab_of(tabs: QTabBar, text: str) -> list[int] | None:
    for number in range(tabs.count()):
        if tabs.tabText(number).replace("&", "").startswith(text):
            return _on_screen(tabs, tabs.tabRect(number))
    return None


def _place(x: float, y: float, crs: str) -> dict[str, Any]:
    """Where a place is on the screen, and whether the map that is shown has it."""
    canvas = iface.mapCanvas()
    settings = canvas.mapSettings()
    to_map = QgsCoordinateTransform(
        QgsCoordinateReferenceSystem(crs), settings.destinationCrs(), QgsProject.instance()
    )
    at = settings.mapToPixel().transform(to_map.transform(QgsPointXY(x, y)))
    pixel = QPoint(round(at.x()), round(at.y()))
    there = canvas.viewport().mapToGlobal(pixel)
    under = QApplication.widgetAt(there)
    return {"at": [there.x(), there.y()], "shown": under is canvas.viewport()}


def _map() -> dict[str, Any]:
    """The map: whether it is there and being drawn, how many times smaller than the world, and where."""
    canvas = iface.mapCanvas()
    bars = iface.mainWindow().statusBar().findChildren(QProgressBar)
    return {
        "visible": canvas.isVisible(),
        "drawing": canvas.isDrawing() or any(bar.isVisible() for bar in bars),
        "scale": canvas.scale(),
        "rect": _on_screen(canvas, canvas.rect()),
    }


def _labels() -> list[str]:
    """What the labels on the map read, those of the live map left out."""
    results = iface.mapCanvas().labelingResults()
    return [label.labelText for label in results.allLabels()] if results is not None else []


def _messages() -> list[str]:
    """What stands in the window's message bar, as it is written there."""
    return [item.text() for item in iface.messageBar().items()]


def _drag() -> bool:
    """Whether something is dragged, over something that takes it: the mouse's picture says so."""
    cursor = QApplication.overrideCursor()
    return cursor is not None and cursor.shape() in DROPPED


def _time() -> dict[str, Any]:
    """Which moment QGIS's temporal controller shows, in seconds since 1970, and whether it plays."""
    controller = iface.mapCanvas().temporalController()
    begin = controller.dateTimeRangeForFrameNumber(controller.currentFrameNumber()).begin()
    plays = controller.animationState() != QgsTemporalNavigationObject.AnimationState.Idle
    return {"at": begin.toMSecsSinceEpoch() / 1000.0, "plays": plays}


def _layers() -> dict[str, int]:
    """The vector layers of the project by name, with how many of their features are selected."""
    return {layer.name(): layer.selectedFeatureCount() for layer in _vector_layers()}


def _counts() -> dict[str, int]:
    """The vector layers of the project by name, with how many features they have."""
    return {layer.name(): layer.featureCount() for layer in _vector_layers()}


def _vector_layers() -> list[QgsVectorLayer]:
    layers = QgsProject.instance().mapLayers().values()
    return [layer for layer in layers if isinstance(layer, QgsVectorLayer)]


def _desk(view: DeskView) -> dict[str, Any]:
    """What the plugin's panel shows, and the draft that is drawn on the map, with the way to a target."""
    draft = plugins[PLUGIN].window.desk.drafts.draft
    return {
        "link": view.link_state(),
        "draft": view.draft_text(),
        "points": list(draft.points) if draft is not None else [],
        "way": list(draft.way.line) if draft is not None else [],
        "robots": view.robots(),
        "selected": view.selected_robots(),
        "commands": [asdict(command) for command in view.commands()],
    }


def _find(kind: type, name: str) -> QWidget | None:
    """Return a widget by its object name; QGIS gives none to some, which are found by their C++ class."""
    widgets = [widget for widget in QApplication.allWidgets() if isinstance(widget, kind)]
    found = [widget for widget in widgets if name in (widget.objectName(), widget.metaObject().className())]
    return next((widget for widget in found if widget.isVisible()), next(iter(found), None))


def _text(widget: QWidget) -> str:
    """What a widget says, whatever kind it is."""
    return next(filter(None, (_said(widget, ask) for ask in ("text", "currentText", "toPlainText"))), "")


def _said(widget: QWidget, question: str) -> Any:
    asked = getattr(widget, question, None)
    return asked() if callable(asked) else None


def _on_screen(widget: QWidget, rect: QRect) -> list[int]:
    corner = widget.mapToGlobal(rect.topLeft())
    return [corner.x(), corner.y(), rect.width(), rect.height()]

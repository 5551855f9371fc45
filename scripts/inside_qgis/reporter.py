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
)
from qgis.PyQt.QtCore import QObject, QPoint, QRect
from qgis.PyQt.QtNetwork import QLocalServer, QLocalSocket
from qgis.PyQt.QtWidgets import (
    QAbstractButton,
    QAbstractItemView,
    QApplication,
    QDockWidget,
    QMenu,
    QMenuBar,
    QProgressBar,
    QTabBar,
    QTabWidget,
    QWidget,
)
from qgis.utils import iface, plugins

from .desk_view import DeskView, NotHappenedError
from .out_of_sight import what_is_out_of_sight

PLUGIN = "fleet_supervisor"
PYTHON = "Python"
"""What the tags of QGIS's messages on exceptions begin with."""


class Reporter(QObject):
    """Answers questions on a local socket, a JSON object on each line: ``answer`` or ``error``."""

    def __init__(self, path: str, parent: QObject | None = None):
        super().__init__(parent)
        self._complaints: list[str] = []
        self._socket: QLocalSocket | None = None
        QgsApplication.messageLog().messageReceived.connect(self._logged)
        self._questions: dict[str, Callable[..., Any]] = {
            "window": _window,
            "widget": _widget,
            "entry": _entry,
            "tab": _tab,
            "cell": _cell,
            "panel": _panel,
            "place": _place,
            "desk": _desk,
            "map": _map,
            "time": _time,
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

    def _logged(self, text: str, tag: str, level: Qgis.MessageLevel) -> None:
        if tag.startswith(PYTHON) and level in (Qgis.MessageLevel.Warning, Qgis.MessageLevel.Critical):
            self._complaints.append(f"{tag}: {text}")


def _window() -> dict[str, Any]:
    """The main window and the dialog over it, if any, by X's numbers for them."""
    dialog = QApplication.activeModalWidget()
    return {"main": int(iface.mainWindow().winId()), "dialog": int(dialog.winId()) if dialog else None}


def _widget(name: str) -> dict[str, Any]:
    """A widget by its object name: where it can be clicked, and what it shows."""
    found = [widget for widget in QApplication.allWidgets() if widget.objectName() == name]
    if not found:
        return {"there": False, "visible": False}
    widget = next((each for each in found if each.isVisible()), found[0])
    if not widget.isVisible():
        return {"there": True, "visible": False}
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
        "text": _said(widget, "text") or _said(widget, "currentText") or "",
    }


def _entry(text: str) -> list[int] | None:
    """Where an entry of the menu bar, or of a menu that is open, is; None while it is not to be seen."""
    bars = [bar for bar in iface.mainWindow().findChildren(QMenuBar) if bar.isVisible()]
    menus = [menu for menu in QApplication.topLevelWidgets() if isinstance(menu, QMenu) and menu.isVisible()]
    for menu in [*menus, *bars]:
        for action in menu.actions():
            if action.isVisible() and action.text().replace("&", "") == text:
                return _on_screen(menu, menu.actionGeometry(action))
    return None


def _tab(name: str, text: str) -> list[int] | None:
    """Where the tab is that begins with ``text``; ``name`` is the object name of its tab widget."""
    tabs = _find(QTabWidget, name).tabBar()
    return _tab_of(tabs, text)


def _tab_of(tabs: QTabBar, text: str) -> list[int] | None:
    for number in range(tabs.count()):
        if tabs.tabText(number).replace("&", "").startswith(text):
            return _on_screen(tabs, tabs.tabRect(number))
    return None


def _cell(name: str, text: str) -> list[int] | None:
    """Where the first row of a table, tree or list is whose first column reads ``text``."""
    view = _find(QAbstractItemView, name)
    model = view.model()
    for row in range(model.rowCount()):
        index = model.index(row, 0)
        if index.data() == text:
            seen = view.visualRect(index) & view.viewport().rect()
            return _on_screen(view.viewport(), seen) if not seen.isEmpty() else None
    return None


def _panel(name: str) -> dict[str, Any]:
    """Where a panel is, and the cross that closes it."""
    dock = _find(QDockWidget, name)
    cross = dock.findChild(QAbstractButton, "qt_dockwidget_closebutton")
    seen = cross is not None and cross.isVisible()
    return {"rect": _on_screen(dock, dock.rect()), "cross": _on_screen(cross, cross.rect()) if seen else None}


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
    """How the map stands: whether it is being drawn, and how many times smaller than the world it is."""
    canvas = iface.mapCanvas()
    bars = iface.mainWindow().statusBar().findChildren(QProgressBar)
    return {"drawing": canvas.isDrawing() or any(bar.isVisible() for bar in bars), "scale": canvas.scale()}


def _time() -> dict[str, Any]:
    """Which moment QGIS's temporal controller shows, in seconds since 1970, and whether it plays."""
    controller = iface.mapCanvas().temporalController()
    begin = controller.dateTimeRangeForFrameNumber(controller.currentFrameNumber()).begin()
    plays = controller.animationState() != QgsTemporalNavigationObject.AnimationState.Idle
    return {"at": begin.toMSecsSinceEpoch() / 1000.0, "plays": plays}


def _desk() -> dict[str, Any]:
    """What the plugin's panel shows, and the draft that is drawn on the map."""
    view = DeskView(iface)
    draft = plugins[PLUGIN].window.desk.drafts.draft
    return {
        "link": view.link_state(),
        "draft": view.draft_text(),
        "points": list(draft.points) if draft is not None else [],
        "robots": view.robots(),
        "selected": view.selected_robots(),
        "commands": [asdict(command) for command in view.commands()],
    }


def _find(kind: type, name: str):
    found = [widget for widget in QApplication.allWidgets() if widget.objectName() == name]
    found = [widget for widget in found if isinstance(widget, kind)]
    if not found:
        raise NotHappenedError(f"the window has no {kind.__name__} named {name}")
    return next((widget for widget in found if widget.isVisible()), found[0])


def _said(widget: QWidget, question: str) -> Any:
    asked = getattr(widget, question, None)
    return asked() if callable(asked) else None


def _on_screen(widget: QWidget, rect: QRect) -> list[int]:
    corner = widget.mapToGlobal(rect.topLeft())
    return [corner.x(), corner.y(), rect.width(), rect.height()]

"""The desk as it stands in the QGIS window: live map, Fleet panel with the robot table, alarms, toolbar."""

from __future__ import annotations

import importlib
from typing import Any

from qgis.core import QgsProject
from qgis.gui import QgsApplicationExitBlockerInterface, QgsMapCanvas, QgsMessageBar
from qgis.PyQt.QtWidgets import QAction, QMainWindow, QToolBar, QWidget

from benchmarks.desk_canvas import WINDOW, Stage, site_of, watch_live
from tools.plugin_files import register_plugin

PANEL = 440
"""Pixels beside the map for the Fleet panel."""


class BareWindow:
    """What the desk asks of QGIS's window, around one canvas."""

    def __init__(self, canvas: QgsMapCanvas) -> None:
        self._window = QMainWindow()
        self._canvas = canvas
        self._bar = QgsMessageBar(self._window)
        canvas.setFixedSize(*WINDOW)
        self._window.setCentralWidget(canvas)
        self._window.resize(WINDOW[0] + PANEL, WINDOW[1] + 80)

    def mainWindow(self) -> QMainWindow:  # noqa: N802
        return self._window

    def mapCanvas(self) -> QgsMapCanvas:  # noqa: N802
        return self._canvas

    def messageBar(self) -> QgsMessageBar:  # noqa: N802
        return self._bar

    def addToolBar(self, title: str) -> QToolBar:  # noqa: N802
        return self._window.addToolBar(title)

    def addDockWidget(self, area: Any, dock: QWidget) -> None:  # noqa: N802
        self._window.addDockWidget(area, dock)
        dock.show()

    def addPluginToMenu(self, menu: str, action: QAction) -> None:  # noqa: N802
        self._window.addAction(action)

    def registerApplicationExitBlocker(self, guard: QgsApplicationExitBlockerInterface) -> None:  # noqa: N802 # QGIS
        """Accept a guard of QGIS's exit; nobody leaves here."""


def live(data: str, number: int, rate: float) -> None:
    """Print frames a second, what one takes, and the milliseconds from sending to painting."""
    stage = Stage(data, number)
    watch_live(stage, open_window(stage), number, rate)


def open_window(stage: Stage) -> tuple[Any, Any, Any]:
    """Return the desk of a whole window that knows its site, its live view, and the site."""
    register_plugin()
    plugin = "fleet_supervisor.plugin"
    bare = BareWindow(stage.canvas)
    window = importlib.import_module(f"{plugin}.panel.window").FleetWindow(bare)
    surfaces = importlib.import_module(f"{plugin}.layers.road_surfaces").SurfaceStore
    watched = importlib.import_module(f"{plugin}.panel.window").WindowAlarms
    window.alarms = watched(bare, window, surfaces(QgsProject.instance()))
    bare.mainWindow().show()
    # Python would take both for garbage: nothing else holds them.
    stage.window = bare, window
    site = site_of(stage)
    window.desk.state.merge_site(site, "")
    stage.canvas.setLayers([window.view.layer.layer, *stage.layers])
    stage.run(0.2)
    stage.wait(lambda: not stage.canvas.isDrawing())
    return window.desk, window.view, site

"""What a plugin could leave in a QGIS window."""

from __future__ import annotations

import gc
from pathlib import Path

from qgis.core import QgsApplication, QgsProject
from qgis.PyQt.QtCore import QCoreApplication, QEvent, QThread, QTimer
from qgis.PyQt.QtWidgets import QAction, QApplication, QDockWidget, QToolBar


def left_behind(iface):
    """Return how many things of each kind there are in the window and in QGIS."""
    QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
    QApplication.processEvents()
    gc.collect()
    return {
        "docks": len(iface.findChildren(QDockWidget)),
        "toolbars": len(iface.findChildren(QToolBar)),
        "actions": len(iface.findChildren(QAction)),
        "menu entries": len(iface.plugins.actions()),
        "timers": len(iface.findChildren(QTimer)),
        "canvas items": len(iface.canvas.scene().items()),
        "layers": len(QgsProject.instance().mapLayers()),
        "groups": len(QgsProject.instance().layerTreeRoot().children()),
        "threads": len([t for t in gc.get_objects() if isinstance(t, QThread) and t.isRunning()]),
        "named threads": len([p for p in Path("/proc/self/task").glob("*/comm") if "fleet" in p.read_text()]),
        "notices": len(iface.texts()),
        "providers": len(QgsApplication.processingRegistry().providers()),
        "children": len(iface.children()),
    }

"""The plugin loaded again and again: nothing of it is in QGIS twice, and nothing is left."""

from __future__ import annotations

import gc
import threading

from fleet_supervisor.plugin.plugin import FleetPlugin
from qgis.core import QgsApplication, QgsExpression, QgsProject
from qgis.gui import QgsGui
from qgis.PyQt.QtCore import QCoreApplication, QEvent, QThread
from qgis.PyQt.QtWidgets import QApplication, QLineEdit

TIMES = 3
"""What is left of one time is there at the second, and what that leaves at the third."""


def registered(iface, others):
    """What of the plugin QGIS knows, by kind."""
    QApplication.processEvents()
    gc.collect()
    manager = QgsGui.shortcutsManager()
    return {
        "locator filters": len(iface.locator.filters()),
        "options pages": len(iface.options_pages),
        "drop handlers": len(iface.drop_handlers),
        "help entries": len(iface.plugin_help.actions()),
        "menu entries": len(iface.plugins.actions()),
        "shortcuts": len(manager.listActions()),
        "expression functions": len(QgsExpression.Functions()),
        "providers": len(QgsApplication.processingRegistry().providers()),
        "layers": len(QgsProject.instance().mapLayers()),
        "groups": len(QgsProject.instance().layerTreeRoot().children()),
        "canvas items": len(iface.canvas.scene().items()),
        "message bar": len(iface.texts()),
        "threads": len(set(threading.enumerate()) - others),
        "Qt threads": len([one for one in gc.get_objects() if isinstance(one, QThread) and one.isRunning()]),
    }


def test_loaded_again_and_again_nothing_is_doubled_and_nothing_left(iface, gateway, make_robot, wait):
    gateway.show(make_robot("r1"))
    # As QGIS does when it starts, with the actions of plugins that are there by then.
    manager = QgsGui.shortcutsManager()
    manager.registerAllChildren(iface)
    # Those of earlier tests may end meanwhile.
    others = set(threading.enumerate())
    before, loaded = registered(iface, others), None
    for _ in range(TIMES):
        plugin = FleetPlugin(iface)
        plugin.initGui()
        plugin.window.dock.findChild(QLineEdit, "fleet_url").setText(gateway.url)
        plugin.window.actions.connect.trigger()
        wait(lambda plugin=plugin: plugin.window.view.layer.layer is not None)
        manager.registerAllChildren(iface)
        now = registered(iface, others)
        loaded = loaded or now
        assert now == loaded
        plugin.unload()
        QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
        assert registered(iface, others) == before
    for kind in ("locator filters", "options pages", "drop handlers", "help entries", "shortcuts"):
        assert loaded[kind] > before[kind]

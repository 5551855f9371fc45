"""What a plugin could leave in a QGIS window."""

from __future__ import annotations

import gc
from collections import Counter
from pathlib import Path
from types import FunctionType

from qgis.core import QgsApplication, QgsProject
from qgis.PyQt.QtCore import QCoreApplication, QEvent, QMetaMethod, QThread, QTimer
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
        "exit blockers": len(iface.exit_blockers),
        "providers": len(QgsApplication.processingRegistry().providers()),
        "children": len(iface.children()),
    }


def connected_to(*objects):
    """Return how many receivers each signal of ``objects`` has, as in ``QgsProject.readProject``.

    Of those that last longer than the plugin each keeps what was connected and not disconnected, also when
    the receiver is long gone.
    """
    QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
    QApplication.processEvents()
    gc.collect()
    found = Counter()
    for one in objects:
        kind = one.metaObject()
        methods = map(kind.method, range(kind.methodCount()))
        names = {bytes(m.name()).decode() for m in methods if m.methodType() == QMetaMethod.MethodType.Signal}
        for name in names:
            try:
                signal = getattr(one, name, None)
            except TypeError:
                # Of an argument that Python does not know: nothing of a plugin is connected to it.
                continue
            # Python does not know every signal, and some have the name of a method.
            if hasattr(signal, "emit"):
                found[f"{kind.className()}.{name}"] += one.receivers(signal)
    return found


def slots_that_hold(sender):
    """Return the closures that are connected to signals of ``sender`` and hold it themselves.

    Where Python collects the two together, it may empty the closure before PyQt disconnects it. A sender
    that lives on in C++, as a task of QGIS's does, then calls what is left, and the program crashes.
    """
    slots = [one for one in gc.get_referents(sender) if isinstance(one, FunctionType)]
    return [one for one in slots if any(cell.cell_contents is sender for cell in one.__closure__ or ())]

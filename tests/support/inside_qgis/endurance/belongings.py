"""What there is in QGIS that a plugin could have put there, to see that it takes all of it away again."""

from __future__ import annotations

import gc
import sys
import threading
from collections import Counter
from collections.abc import Iterable
from enum import Enum
from pathlib import Path

from qgis.core import QgsApplication, QgsExpression, QgsLocatorFilter, QgsProject
from qgis.gui import QgsMapCanvas
from qgis.PyQt.QtCore import QObject, QTimer
from qgis.PyQt.QtWidgets import QAction, QDockWidget, QMainWindow, QMenu, QShortcut, QToolBar

PACKAGE = "fleet_supervisor"
THREADS = "fleet"
"""What the names of the plugin's threads begin with."""

Belongings = dict[str, Counter[str]]
"""By kind: names, and how many there are of each."""


def belongings(window: QMainWindow, canvas: QgsMapCanvas) -> Belongings:
    """Return what there is now in the main ``window`` of QGIS, on its map ``canvas``, and around both."""
    gc.collect()
    return {
        "layers": Counter(layer.name() for layer in QgsProject.instance().mapLayers().values()),
        "groups": Counter(group.name() for group in QgsProject.instance().layerTreeRoot().findGroups()),
        "map items": Counter(type(item).__name__ for item in canvas.scene().items()),
        "map tools and more of the map": _names(canvas.children()),
        "children of the window": _names(window.children()),
        "docks": _names(window.findChildren(QDockWidget)),
        "toolbars": _names(window.findChildren(QToolBar)),
        "menus": _names(window.findChildren(QMenu)),
        "actions": Counter(map(_action, filter(_is_named, window.findChildren(QAction)))),
        "shortcuts": Counter(s.key().toString() for s in window.findChildren(QShortcut)),
        "timers": _names(window.findChildren(QTimer)),
        "locator filters": Counter(one.name() for one in window.findChildren(QgsLocatorFilter)),
        "providers": Counter(p.id() for p in QgsApplication.processingRegistry().providers()),
        "expression functions": Counter(one.name() for one in QgsExpression.Functions()),
        "Python threads": Counter(thread.name for thread in threading.enumerate()),
        "threads of the plugin": Counter(name for name in thread_names() if name.startswith(THREADS)),
        "objects of the plugin": objects_of(PACKAGE),
        "modules of the plugin": Counter(name for name in sys.modules if _is_of(PACKAGE, name)),
    }


def left_over(before: Belongings, after: Belongings) -> list[str]:
    """Return what there is more of in ``after``: ``2 × docks: fleet_dock``."""
    more = {kind: after[kind] - before[kind] for kind in after}
    return [f"{n} × {kind}: {name}" for kind, names in more.items() for name, n in sorted(names.items())]


def objects_of(package: str) -> Counter[str]:
    """Return the living objects of classes that ``package`` defines, by class, and older copies of those.

    One copy of a class may stay: Python keeps overloaded functions until the same ones are loaded again.
    """
    found: Counter[str] = Counter()
    for one in gc.get_objects():
        kind = type(one)
        # Members of an enumeration are there as long as it is.
        if _is_of(package, kind.__module__) and not issubclass(kind, Enum):
            found[f"{kind.__module__}.{kind.__qualname__}"] += 1
    classes = Counter(f"class {one.__module__}.{one.__qualname__}" for one in classes_of(package))
    return found + Counter({name: number - 1 for name, number in classes.items()})


def classes_of(package: str) -> list[type]:
    """Return the classes that ``package`` defines, those of every version of it that still live."""
    return [
        one
        for one in gc.get_objects()
        if isinstance(one, type) and _is_of(package, one.__dict__.get("__module__"))
    ]


def running_threads() -> int:
    """Return how many threads this process has."""
    return len(list(Path("/proc/self/task").iterdir()))


def thread_names() -> list[str]:
    """Return the names of this process's threads, as the system knows them (15 letters)."""
    names = []
    for task in Path("/proc/self/task").iterdir():
        try:
            names.append((task / "comm").read_text(encoding="utf-8").strip())
        except FileNotFoundError:
            # It ended since the list was made.
            continue
    return names


def _names(objects: Iterable[QObject]) -> Counter[str]:
    return Counter(f"{type(one).__name__} {one.objectName()}".strip() for one in objects)


def _is_named(action: QAction) -> bool:
    """Tell whether an action is not one of QGIS's own separators, of which it leaves some in its menus."""
    return bool(action.objectName() or action.text())


def _action(action: QAction) -> str:
    parent = action.parent()
    where = f"{type(parent).__name__} {parent.objectName()}".strip()
    return f"{action.objectName() or action.text()} in {where}"


def _is_of(package: str, module: object) -> bool:
    return isinstance(module, str) and (module == package or module.startswith(f"{package}."))

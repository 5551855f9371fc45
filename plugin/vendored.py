"""The packages that a release brings along in ``plugin/vendor``, as pure Python, unchanged.

They are imported under their full names inside the plugin: ``sys.path`` stays as it is, and a copy that is
installed for other programs is neither hidden nor replaced. In a checkout the installed one is taken.
"""

from __future__ import annotations

import importlib.util
import sys
from types import ModuleType


def vendored_package(name: str, *modules: str) -> ModuleType | None:
    """Return a package and ``modules`` of it: the plugin's own copy, else the installed one, else None."""
    return _package(f"{__package__}.vendor.{name}", modules) or _package(name, modules)


def _package(name: str, modules: tuple[str, ...]) -> ModuleType | None:
    try:
        found = importlib.util.find_spec(name)
    except ModuleNotFoundError:
        return None
    # A folder without __init__.py is found too, as a namespace, and is no library.
    if found is None or not found.origin:
        return None
    # Not by importlib: QGIS forgets with a plugin what it saw imported, and it sees no more than this.
    __import__(name, fromlist=modules)
    return sys.modules[name]

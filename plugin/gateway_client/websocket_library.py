"""Where the plugin takes the package ``websockets`` from.

A release carries its own copy in ``plugin/vendor/websockets``, as pure Python, so that a stock QGIS needs
nothing more. It is imported under its full name inside the plugin: ``sys.path`` stays as it is, and a
copy that is installed for other programs is neither hidden nor replaced.
"""

from __future__ import annotations

import importlib
import importlib.util
import sys
from types import ModuleType

from ..ui.errors import LibraryMissingError
from ..ui.language import tr

OLDEST = 14
"""The first version whose ``asyncio`` client has the interface that the connection uses."""


def websocket_library() -> ModuleType:
    """Return the package ``websockets``: the plugin's own copy if it has one, else the installed one.

    ``connect`` and ``exceptions`` can be used on what is returned.

    :raises LibraryMissingError: when there is none, or the installed one is older than :data:`OLDEST`.
    """
    plugin = __package__.rpartition(".")[0]
    library = _package(f"{plugin}.vendor.websockets") or _package("websockets")
    if library is None:
        raise LibraryMissingError(
            tr(
                "The Python package websockets is missing, which the connection to the gateway needs. "
                "Install the plugin from its release zip, which contains it, or run 'python3 -m pip install "
                "websockets' with the Python that QGIS uses, and restart QGIS."
            )
        )
    version = importlib.import_module(".version", library.__name__).version
    if int(version.split(".")[0]) < OLDEST:
        raise LibraryMissingError(
            tr(
                "The Python package websockets {version} in {path} is too old for the connection to the "
                "gateway. Install the plugin from its release zip, which contains a newer one, or run "
                "'python3 -m pip install \"websockets>={oldest}\"' with the Python that QGIS uses, and "
                "restart QGIS.",
                version=version,
                path=library.__path__[0],
                oldest=OLDEST,
            )
        )
    importlib.import_module(".exceptions", library.__name__)
    return library


def _package(name: str) -> ModuleType | None:
    try:
        found = importlib.util.find_spec(name)
    except ModuleNotFoundError:
        return None
    # A folder without __init__.py is found too, as a namespace, and is no library.
    if found is None or not found.origin:
        return None
    # Not by importlib: QGIS forgets with a plugin what it saw imported, and it sees no more than this.
    __import__(name, fromlist=["asyncio"])
    return sys.modules[name]

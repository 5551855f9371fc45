"""Where the plugin takes the package ``websockets`` from: a release brings it along."""

from __future__ import annotations

import importlib
from types import ModuleType

from ..ui.errors import LibraryMissingError
from ..ui.language import tr
from ..vendored import vendored_package

OLDEST = 14
"""The first version whose ``asyncio`` client has the interface that the connection uses."""


def websocket_library() -> ModuleType:
    """Return the package ``websockets``: the plugin's own copy if it has one, else the installed one.

    ``connect`` and ``exceptions`` can be used on what is returned.

    :raises LibraryMissingError: when there is none, or the installed one is older than :data:`OLDEST`.
    """
    library = vendored_package("websockets", "asyncio")
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

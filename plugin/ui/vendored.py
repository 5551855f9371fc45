"""The packages that a release contains in ``plugin/vendor``, as pure Python, unchanged.

They are imported under their full names inside the plugin: ``sys.path`` stays unchanged, and a copy
installed for other programs is neither hidden nor replaced. In a checkout the installed one is used.
"""

from __future__ import annotations

import importlib
import importlib.util
import sys
from types import ModuleType

from .errors import LibraryMissingError
from .language import tr

_PLUGIN = (__package__ or "").rpartition(".")[0]


def vendored_package(name: str, *modules: str) -> ModuleType | None:
    """Return a package and its ``modules``: the plugin's own copy, else the installed one, else None."""
    return _package(f"{_PLUGIN}.vendor.{name}", modules) or _package(name, modules)


def _package(name: str, modules: tuple[str, ...]) -> ModuleType | None:
    try:
        found = importlib.util.find_spec(name)
    except ModuleNotFoundError:
        return None
    # A folder without __init__.py is found too, as a namespace, and is no library.
    if found is None or not found.origin:
        return None
    # Not by importlib: QGIS unloads with a plugin the modules whose import it saw, and it sees only this.
    __import__(name, fromlist=modules)
    return sys.modules[name]


# --- The source of the package ``websockets``: a release contains it ---

OLDEST = 14
"""The first version whose ``asyncio`` client has the interface that the connection uses."""


def websocket_library() -> ModuleType:
    """Return the package ``websockets``: the plugin's own copy if it has one, else the installed one.

    ``connect`` and ``exceptions`` are available on the result.

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

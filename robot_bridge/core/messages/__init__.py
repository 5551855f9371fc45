"""The messages of the bridge: one definition for every wire, each in the module of its subject.

:mod:`.robots` holds the paper's: what robots ask and what the server answers. The other modules hold what
operators ask and are told; :mod:`.base` says what each request declares. With any of them all
are loaded, so that the table of requests is whole.
Positions are metres in the site frame, angles radians counter-clockwise from its x axis, times seconds since
1970-01-01 UTC. Nothing here is imported but the standard library, so that QGIS can load it.
"""

from __future__ import annotations

from types import ModuleType
from typing import Any

from . import (  # noqa: F401 # found among the names of this module
    administration,
    base,
    commands,
    links,
    plans,
    positions,
    queues,
    records,
    roads,
    robots,
    safety,
)

_MODULES = [value for value in list(globals().values()) if isinstance(value, ModuleType)]


def __getattr__(name: str) -> Any:
    """Return what one of the modules has under ``name``, for programs that import it from here."""
    for module in _MODULES:
        if not name.startswith("_") and hasattr(module, name):
            return getattr(module, name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")

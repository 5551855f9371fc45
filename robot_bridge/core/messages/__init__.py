"""The messages of the bridge: one definition for every wire, each in a module by subject.

:mod:`.robots` holds those of the paper: requests of robots and answers of the server. The other modules hold
requests of operators and reports to them; :mod:`.base` defines what each request declares. Importing any of
them loads all, so that the table of requests is complete. Positions are metres in the site frame, angles
radians counter-clockwise from its x axis, times seconds since 1970-01-01 UTC. Only the standard library is
imported here, so that QGIS can load it.
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
    """Return the attribute ``name`` of one of the modules, for programs that import it from here."""
    for module in _MODULES:
        if not name.startswith("_") and hasattr(module, name):
            return getattr(module, name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")

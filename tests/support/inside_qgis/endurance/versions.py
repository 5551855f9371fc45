"""The versions of a plugin that QGIS has loaded one after the other: what lives on of those that it unloaded.

As long as anything holds one class, function or object of a version, most of that version stays in memory.
"""

from __future__ import annotations

import gc
import weakref

from tests.support.inside_qgis.endurance.belongings import classes_of


class Versions:
    """Knows the classes of each version of ``package`` by identity, and keeps none of them alive."""

    def __init__(self, package: str) -> None:
        self._package = package
        self._classes: list[list[weakref.ref[type]]] = []

    def note(self) -> int:
        """Take what is loaded now for a version of its own; return how many classes it has."""
        gc.collect()
        known = {id(one) for seen in self._classes for ref in seen if (one := ref()) is not None}
        new = [weakref.ref(one) for one in classes_of(self._package) if id(one) not in known]
        self._classes.append(new)
        return len(new)

    def living(self) -> list[list[str]]:
        """Return for each version the names of its classes that still live."""
        gc.collect()
        return [sorted(_name(one) for ref in seen if (one := ref()) is not None) for seen in self._classes]


def _name(kind: type) -> str:
    return f"{kind.__module__}.{kind.__qualname__}"

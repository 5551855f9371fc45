"""Widgets that were found before: to search all of QGIS's window takes its only thread 20 ms."""

from __future__ import annotations

import weakref
from collections.abc import Callable, Hashable

from qgis.PyQt.QtCore import QObject
from qgis.PyQt.sip import isdeleted


class FoundAgain:
    """Remembers what each search found, for as long as that is there; nothing stays because of it.

    What was made in C++ is searched for each time: nothing holds what Python knows it by.
    """

    def __init__(self) -> None:
        self._found: dict[Hashable, weakref.ref[QObject]] = {}

    def get(
        self, sought: Hashable, search: Callable[[], QObject | None], holds: Callable[[QObject], bool]
    ) -> QObject | None:
        """Return what was found for ``sought`` if it still ``holds``, and else what ``search`` finds now."""
        found = self._found[sought]() if sought in self._found else None
        if found is None or isdeleted(found) or not holds(found):
            found = search()
            if found is not None:
                self._found[sought] = weakref.ref(found)
        return found

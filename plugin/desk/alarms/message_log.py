"""Alarms in QGIS's message log: only some of them, since QGIS keeps each line for as long as it is open."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from qgis.core import Qgis, QgsMessageLog

from ...language import tr_count
from ..notices import TITLE
from .alarm import Alarm

MOST_LINES = 20
"""Alarms that are written within :data:`WITHIN`: a fleet that loses its radio again and again would otherwise
take megabytes an hour. The log of alarms has all of them."""
WITHIN = 600.0
"""Seconds."""


class AlarmMessages:
    """Writes what began. ``clock`` returns seconds that only ever go on."""

    def __init__(self, clock: Callable[[], float]):
        self._clock = clock
        self._until = -math.inf
        self._left = 0
        self._counted = 0

    def write(self, began: Sequence[Alarm]) -> None:
        """Write these as far as there is room; of others at once how many, and the rest when there is room.

        To be called with nothing as well, again and again.
        """
        if self._clock() >= self._until:
            self._begin_anew()
        for alarm in began[: self._left]:
            _write(alarm.text)
        more = max(0, len(began) - self._left)
        if more and self._left:
            _count(more)
        else:
            self._counted += more
        self._left = max(0, self._left - len(began))

    def _begin_anew(self) -> None:
        if self._counted:
            _count(self._counted)
        self._until, self._left, self._counted = self._clock() + WITHIN, MOST_LINES, 0


def _count(more: int) -> None:
    _write(
        tr_count(
            more,
            "and 1 more alarm: see the log of alarms in the Fleet panel",
            "and %n more alarms: see the log of alarms in the Fleet panel",
        )
    )


def _write(text: str) -> None:
    QgsMessageLog.logMessage(text, TITLE, Qgis.MessageLevel.Warning, False)

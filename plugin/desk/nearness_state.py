"""What the gateway told last of people and vehicles near robots."""

from __future__ import annotations

from collections.abc import Callable

from ...robot_bridge.messages import Nearness, NearnessAlarm
from ..language import tr

SILENT_AFTER = 5.0
"""Seconds without a word after which nobody is near: as long as somebody is, it is told every second."""


class NearnessState:
    """Keeps the newest report; ``clock`` returns seconds that only ever go on."""

    def __init__(self, clock: Callable[[], float]):
        self._clock = clock
        self._report: Nearness | None = None
        self._since = clock()

    def update(self, report: Nearness) -> None:
        """Take in what the gateway told."""
        self._report, self._since = report, self._clock()

    def clear(self) -> None:
        """Forget everything."""
        self._report = None

    @property
    def alarms(self) -> list[NearnessAlarm]:
        """Who is near which robot now, or will be soon."""
        report = self._current()
        return [] if report is None else report.alarms

    def why_not(self) -> str:
        """Return why nothing is watched, empty when it is."""
        report = self._current()
        if report is None or not report.fault:
            return ""
        return tr("People near robots are not watched: {why}.", why=report.fault.rstrip("."))

    def _current(self) -> Nearness | None:
        return None if self._clock() - self._since > SILENT_AFTER else self._report

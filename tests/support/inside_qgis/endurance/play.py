"""Plays a script on QGIS's own event loop, so that between two steps nothing of it is in the way.

A script that waits in a loop of its own keeps alive what was given up to be deleted later: that goes when the
loop has come back to where it was given up.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Generator
from dataclasses import dataclass
from typing import ClassVar

from qgis.PyQt.QtCore import QTimer

from tests.support.inside_qgis.operator_at_desk import NotHappenedError

LOOK_EVERY = 0.05
"""Seconds between two looks whether something has happened."""


@dataclass(frozen=True)
class Until:
    """Something to wait for: ``holds`` is asked until it is true, at most for ``seconds``.

    ``found`` says what there was instead.
    """

    what: str
    holds: Callable[[], object]
    seconds: float
    found: Callable[[], str]


Script = Generator["float | Until", None, None]
"""Yields seconds to wait, or what to wait for."""


class Player:
    """Goes through ``script``; ``done`` is called with None at its end, or with what went wrong."""

    under_way: ClassVar[list[Player]] = []
    """Between two steps nothing else holds a player, and Python would take it for garbage."""

    def __init__(self, script: Script, done: Callable[[Exception | None], None]) -> None:
        self._script, self._done = script, done
        self._until: Until | None = None
        self._latest = 0.0
        self._timer = QTimer()
        self._timer.setSingleShot(True)
        self._timer.timeout.connect(self._go_on)

    def begin(self) -> None:
        """Do the first step as soon as QGIS has time."""
        self.under_way.append(self)
        self._timer.start(0)

    def _end(self, error: Exception | None) -> None:
        self.under_way.remove(self)
        self._done(error)

    def _go_on(self) -> None:
        try:
            if self._until is not None and not self._has_happened(self._until):
                self._timer.start(round(LOOK_EVERY * 1000))
                return
            self._until = None
            wanted = next(self._script)
        except StopIteration:
            self._end(None)
        except Exception as error:
            self._end(error)
        else:
            self._wait(wanted)

    def _wait(self, wanted: float | Until) -> None:
        if isinstance(wanted, Until):
            self._until, self._latest = wanted, time.monotonic() + wanted.seconds
            self._timer.start(0)
        else:
            self._timer.start(round(wanted * 1000))

    def _has_happened(self, until: Until) -> bool:
        if until.holds():
            return True
        if time.monotonic() > self._latest:
            text = f"{until.what} did not happen within {until.seconds:.0f} s; there was {until.found()}"
            raise NotHappenedError(text)
        return False

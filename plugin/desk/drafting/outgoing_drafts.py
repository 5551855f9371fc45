"""Drafts that were sent before their check had ended, and that another draft has taken the place of since."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import NamedTuple

from qgis.PyQt.QtCore import QObject, pyqtSignal

from ...errors import FleetError
from ..drafts import Draft
from ..time_slices import TimeSlices
from .draft_checker import Work

Then = Callable[[Draft], None]


class Outgoing(NamedTuple):
    """A draft, and what is done with it once it has been checked."""

    draft: Draft
    then: Then


class OutgoingDrafts(QObject):
    """Checks them afresh one after the other, in the order of the presses, beside the draft on the map.

    The next one is checked when the one before has been sent: its target counts for the others.
    """

    changed = pyqtSignal()
    """One was added, has gone, or its check went on."""
    failed = pyqtSignal(object, str)
    """A draft cannot be checked: the Draft, and why."""

    def __init__(self, work: Work, parent: QObject | None = None):
        super().__init__(parent)
        self._work = work
        self._waiting: deque[Outgoing] = deque()
        self._slices = TimeSlices(self)

    def __len__(self) -> int:
        return len(self._waiting)

    @property
    def first(self) -> Draft | None:
        """The draft that is being checked; None for none."""
        return self._waiting[0].draft if self._waiting else None

    @property
    def share(self) -> float:
        """How much of its check is done, 0 to 1."""
        return self._slices.share

    def add(self, draft: Draft, then: Then) -> None:
        """Check ``draft`` after those that wait already, then do ``then`` with it."""
        self._waiting.append(Outgoing(draft, then))
        if len(self._waiting) == 1:
            self._check_first()
        self.changed.emit()

    def begin_anew(self) -> None:
        """Give up what was found so far: a layer has changed under the check."""
        if self._waiting:
            self._check_first()

    def withdraw(self) -> list[Draft]:
        """Do nothing with any of them, and return them."""
        self._slices.stop()
        drafts = [one.draft for one in self._waiting]
        self._waiting.clear()
        if drafts:
            self.changed.emit()
        return drafts

    def _check_first(self) -> None:
        # Never in the press that added it: what is on the map then is not settled yet.
        work = self._work(self._waiting[0].draft, True)
        self._slices.begin_soon(work, self._checked, self._cannot_be_checked)

    def _checked(self, draft: Draft) -> None:
        self._waiting.popleft().then(draft)
        self._go_on()

    def _cannot_be_checked(self, error: FleetError) -> None:
        self.failed.emit(self._waiting.popleft().draft, str(error))
        self._go_on()

    def _go_on(self) -> None:
        if self._waiting:
            self._check_first()
        self.changed.emit()

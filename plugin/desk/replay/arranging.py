"""Keeps the commands of the desk in the order in which a replay asks for them."""

from __future__ import annotations

from qgis.PyQt.QtCore import QObject, pyqtSignal

from ..command_book import CommandBook
from ..time_slices import TimeSlices
from .past_commands import PastCommands, arranged


class Arranging(QObject):
    """Looks through a book beside what else the window does, and again when there was news meanwhile."""

    done = pyqtSignal(object)
    """:attr:`commands` are others now: those before."""

    def __init__(self, book: CommandBook, parent: QObject | None = None):
        super().__init__(parent)
        self._book = book
        self._slices = TimeSlices(self)
        self._is_outdated = False
        self.commands = PastCommands()

    @property
    def is_busy(self) -> bool:
        """Whether what is known by now is still being looked through."""
        return self._slices.is_busy

    def renew(self) -> None:
        """Have in :attr:`commands` soon what the book knows now."""
        # News that comes faster than one look takes would otherwise never be seen.
        self._is_outdated = self._slices.is_busy
        if not self._is_outdated:
            self._slices.begin_soon(arranged(list(self._book)), self._take)

    def forget(self) -> None:
        """Have no commands any more."""
        self._slices.stop()
        self.commands = PastCommands()

    def _take(self, commands: PastCommands) -> None:
        before, self.commands = self.commands, commands
        if self._is_outdated:
            self.renew()
        self.done.emit(before)

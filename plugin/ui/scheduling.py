"""Scheduling: long work in slices of the window's thread, in threads and tasks, and slots for updates."""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Callable, Generator
from typing import Any, Generic, Protocol, TypeVar

from qgis.core import QgsTask
from qgis.PyQt.QtCore import QObject, QTimer, pyqtSignal

from ...robot_bridge.core.clock import Clock
from .errors import FleetError

# Long work of the window's thread is done in slices between which the window paints and answers the mouse.
# QGIS's own tasks are no help where a click waits for the result: in QGIS 3.22 they wait until the map is
# drawn, and what they call of QGIS keeps Python to itself as long as it takes.

T = TypeVar("T")
T_co = TypeVar("T_co", covariant=True)
Steps = Generator[float, None, T]
"""Work that yields, as often as it can, the share of it that is done: 0 to 1. It returns the result."""

WAITING = math.nan
"""Yielded in place of a share by work that waits for another thread: its slice ends, the window goes on."""

SLICE_SECONDS = 0.008
ONE_STEP = 0.0
"""Seconds for a slice of one step, however short that is: for steps that take most of a slice each."""
REST_MS = 4
"""Between two slices, for the window."""


def _nothing(*_: object) -> None:
    """Be what is called where nobody wants to be told."""


def _raise(error: FleetError) -> None:
    """Let a fault be seen that nobody expects."""
    raise error


class CooperativeTask(QObject):
    """Does one piece of work at a time, in slices of ``seconds`` on ``clock``."""

    def __init__(
        self,
        parent: QObject | None = None,
        seconds: float | None = None,
        clock: Clock | None = None,
    ):
        super().__init__(parent)
        self._clock = Clock() if clock is None else clock
        self._seconds = seconds
        self._work: Steps[Any] | None = None
        self._goes_on: Callable[[], None] = _nothing
        self._done: Callable[[Any], None] = _nothing
        self._failed: Callable[[FleetError], None] = _raise
        self.share = 0.0
        """How much is done, 0 to 1."""
        self._is_waiting = False
        self._timer = QTimer(self)
        self._timer.setSingleShot(True)
        self._timer.setInterval(REST_MS)
        self._timer.timeout.connect(self._next)

    @property
    def is_busy(self) -> bool:
        """Whether some of the work is still to be done."""
        return self._work is not None

    def begin(
        self,
        work: Steps[T],
        goes_on: Callable[[], None] = _nothing,
        done: Callable[[T], None] = _nothing,
        failed: Callable[[FleetError], None] = _raise,
    ) -> T | None:
        """Do the first slice of ``work`` at once: return what it returns if that was enough, else None.

        ``goes_on`` is called after each later slice, then ``done`` with what it returns or ``failed`` with
        what it raised. What was under way before is given up.

        :raises FleetError: what the first slice raises; ``failed`` is not called then.
        """
        self._take(work, goes_on, done, failed)
        return self._slice()[1]

    def begin_soon(
        self,
        work: Steps[T],
        done: Callable[[T], None] = _nothing,
        failed: Callable[[FleetError], None] = _raise,
    ) -> None:
        """Do all of ``work`` in slices that come when the window has had time for what is under way now.

        ``done`` or ``failed`` is called as by :meth:`begin`. What was under way before is given up.
        """
        self._take(work, _nothing, done, failed)
        self._timer.start()

    def finish(self) -> None:
        """Do at once all that is left, and call ``done`` or ``failed`` for it.

        Work that begins other work in its place has that done as well.
        """
        while self._work is not None:
            self._timer.stop()
            self._next()

    def stop(self) -> None:
        """Give up what is under way; nothing is called for it any more."""
        self._timer.stop()
        work, self._work = self._work, None
        self.share = 0.0
        # What it does may be why it is to stop; it is not gone on with then.
        if work is not None and not work.gi_running:
            work.close()

    def _take(
        self,
        work: Steps[T],
        goes_on: Callable[[], None],
        done: Callable[[T], None],
        failed: Callable[[FleetError], None],
    ) -> None:
        self.stop()
        self._work, self._goes_on, self._done, self._failed = work, goes_on, done, failed

    def _next(self) -> None:
        try:
            is_done, result = self._slice()
        except FleetError as error:
            self._failed(error)
            return
        if is_done:
            self._done(result)
        elif self._work is not None and not self._is_waiting:
            self._goes_on()

    def _slice(self) -> tuple[bool, Any]:
        work = self._work
        assert work is not None
        until = self._clock.steady() + (SLICE_SECONDS if self._seconds is None else self._seconds)
        try:
            while True:
                share = next(work)
                if self._work is not work:
                    return False, None
                self._is_waiting = math.isnan(share)
                if self._is_waiting:
                    break
                self.share = share
                if self._clock.steady() >= until:
                    break
        except StopIteration as end:
            is_selected = self._work is work
            if is_selected:
                self.stop()
            return is_selected, end.value
        except BaseException:
            if self._work is work:
                self.stop()
            raise
        self._timer.start()
        return False, None


def run_to_end(work: Steps[T]) -> T:
    """Do all of ``work`` at once, which is for other threads than the window's."""
    while True:
        try:
            next(work)
        except StopIteration as end:
            return end.value


def scaled_progress(work: Steps[T], before: int, parts: int) -> Steps[T]:
    """Do ``work`` as one of so many ``parts``, after ``before`` of them."""
    while True:
        try:
            share = next(work)
        except StopIteration as end:
            return end.value
        yield (before + share) / parts


STALLED_AFTER = 5.0
"""Seconds without a sign of progress after which nobody waits for a thread any longer."""
_AT_ONCE_SECONDS = 0.002
"""Seconds that the window waits for a thread, so that what is small is done in the slice that began it."""


class StalledError(Exception):
    """A thread has made no progress for as long as anybody waits for it."""


class Reader(Protocol[T_co]):
    """Reads something in a thread of its own."""

    def read(self, go_on: Callable[[], bool]) -> T_co:
        """Return what was read; ``go_on`` is called for each part, and the reading ends when it says no."""


class ReadingThread(threading.Thread, Generic[T]):
    """Has a reader read what may hang for ever: a database, a share, a server.

    A thread of its own and no task of QGIS: those share their few threads with the drawing of the map, where
    the layers of a server that hangs keep all of them.
    """

    def __init__(self, reader: Reader[T]):
        # QGIS can be closed while it hangs.
        super().__init__(name="fleet reading", daemon=True)
        self._reader = reader
        self._progress_at = time.monotonic()
        self._ended = threading.Event()
        self._is_cancelled = False
        self._result: T | None = None
        self._error: Exception | None = None

    @property
    def is_reading(self) -> bool:
        """Whether it has not come to its end, whoever waits for it."""
        return not self._ended.is_set()

    @property
    def is_stalled(self) -> bool:
        """Whether nothing has been read for :data:`STALLED_AFTER` seconds."""
        return self.is_reading and time.monotonic() - self._progress_at > STALLED_AFTER

    def cancel(self) -> None:
        """Have the reading end with the part that it is at."""
        self._is_cancelled = True

    def wait(self, seconds: float) -> None:
        """Wait until it has ended, but no longer than that."""
        self._ended.wait(seconds)

    def run(self) -> None:
        try:
            self._result = self._reader.read(self._progressed)
        except Exception as error:  # raised again by whoever waits
            self._error = error
        finally:
            self._ended.set()

    def wait_for_end(self) -> Steps[None]:
        """Wait until it has ended.

        :raises StalledError: when nothing has been read for :data:`STALLED_AFTER` seconds.
        """
        if self._ended.wait(_AT_ONCE_SECONDS):
            return
        while self.is_reading:
            if self.is_stalled:
                raise StalledError
            yield WAITING

    def result(self) -> Steps[T]:
        """Wait for what is read, and return it; who gives up the wait ends the reading.

        :raises StalledError: as :meth:`wait_for_end`.
        :raises Exception: what the reading raised.
        """
        try:
            yield from self.wait_for_end()
        finally:
            self.cancel()
        if self._error is not None:
            raise self._error
        return self._result  # type: ignore[return-value] # it has ended without an error

    def _progressed(self) -> bool:
        self._progress_at = time.monotonic()
        return not self._is_cancelled


class ReadingTurns:
    """Has readers read for steps of the window's thread, in one thread after the other."""

    def __init__(self) -> None:
        self._thread: ReadingThread[Any] | None = None

    def read(self, reader: Reader[T]) -> Steps[T]:
        """Return what ``reader`` reads, once the one before has left its source; raises as a thread does."""
        while self._thread is not None and self._thread.is_reading:
            yield from self._thread.wait_for_end()
        self._thread = thread = ReadingThread(reader)
        thread.start()
        return (yield from thread.result())


_LOOK_EVERY_MS = 20


class BackgroundReading(QObject, Generic[T]):
    """Has one reader after the other read in a thread, of which nobody waits for the end.

    No more than one thread reads at a time: the next reader has its turn when the one before has left its
    source, which it never does where that hangs.
    """

    ended = pyqtSignal()
    """What was asked for last has been read, or cannot be: :meth:`result` says which."""

    def __init__(self, parent: QObject | None = None):
        super().__init__(parent)
        self._thread: ReadingThread[T] | None = None
        self._next: Reader[T] | None = None
        self._began_at = 0.0
        self._timer = QTimer(self)
        self._timer.setInterval(_LOOK_EVERY_MS)
        self._timer.timeout.connect(self._advance)

    @property
    def is_under_way(self) -> bool:
        """Whether something is still to be read."""
        return self._timer.isActive()

    def begin(self, reader: Reader[T]) -> None:
        """Have ``reader`` read soon; what was under way is given up."""
        self.stop()
        self._next, self._began_at = reader, time.monotonic()
        self._timer.start()
        self._advance()

    def stop(self) -> None:
        """Give up what is under way; its thread ends when its source lets go of it."""
        self._timer.stop()
        self._next = None
        if self._thread is not None:
            self._thread.cancel()

    def wait(self, seconds: float) -> None:
        """Wait for the end, but no longer than so many seconds after the beginning."""
        until = self._began_at + seconds
        while self.is_under_way and (left := until - time.monotonic()) > 0:
            if self._thread is not None:
                self._thread.wait(left)
            self._advance()

    def result(self) -> T:
        """Return what was read; raises what the reading raised."""
        assert self._thread is not None
        return run_to_end(self._thread.result())

    def _advance(self) -> None:
        if self._thread is not None and self._thread.is_reading:
            return
        if self._next is None:
            self._timer.stop()
            self.ended.emit()
            return
        self._thread, self._next = ReadingThread(self._next), None
        self._thread.start()


PULL_EVERY_MS = 50
PULLS_IN_HALF_A_SECOND = 500 // PULL_EVERY_MS
_STRIDE = 3
"""Pulls between the turns of two who asked one after the other: ten of them have a pull each."""


class SignallingTask(QgsTask):
    """A task of which ``ended`` has the task itself, in the window's thread, and whether it was done.

    So no closure that holds the task need be connected to its signals. Where nothing else holds it, Python
    collects the two together, Qt calls what is left of the closure, and QGIS crashes. ``ended`` comes before
    ``taskCompleted`` and ``taskTerminated``, and also where the task was cancelled.
    """

    ended = pyqtSignal(object, bool)

    def finished(self, done: bool) -> None:
        self.ended.emit(self, done)


class UpdateScheduler:
    """Counts the desk's pulls.

    What is read by people need not change more than twice a second; but if all of it changed in the same
    pull, the window would stand still for as long as all of it takes.
    """

    def __init__(self) -> None:
        self.pulls = 0
        self._turns = 0

    def advance(self) -> None:
        """Count an update."""
        self.pulls += 1

    def turn(self) -> UpdateSlot:
        """Return a turn in which nobody else comes, as far as there are enough pulls."""
        self._turns += 1
        return UpdateSlot(self, self._turns * _STRIDE)


class UpdateSlot:
    """Comes in one pull of each half second, from ``first`` on."""

    def __init__(self, beat: UpdateScheduler, first: int) -> None:
        self._beat = beat
        self._first = first

    def is_due(self, half_seconds: int = 1) -> bool:
        """Tell whether it comes in this pull, if it is to come once in so many half seconds."""
        return (self._beat.pulls - self._first) % (half_seconds * PULLS_IN_HALF_A_SECOND) == 0

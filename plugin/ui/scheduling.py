"""Scheduling: long work in slices of the window's thread, in threads and tasks, and slots for updates."""

from __future__ import annotations

import math
import threading
import time
import traceback
from collections.abc import Callable, Generator
from typing import Any, Generic, Protocol, TypeVar

from qgis.core import Qgis, QgsMessageLog, QgsTask
from qgis.PyQt.QtCore import QObject, QTimer, pyqtSignal

from ...robot_bridge.core.clock import Clock
from .errors import FleetError
from .language import tr

# Long work in the window's thread is done in slices between which the window paints and handles the mouse.
# QGIS's own tasks are no help where a click waits for the result: in QGIS 3.22 they wait until the map is
# drawn, and the functions of QGIS that they call hold the GIL as long as they run.

T = TypeVar("T")
T_co = TypeVar("T_co", covariant=True)
Steps = Generator[float, None, T]
"""Work that yields, as often as it can, the share of it that is done: 0 to 1. It returns the result."""

WAITING = math.nan
"""Yielded in place of a share by work that waits for another thread: its slice ends, the window continues."""

SLICE_SECONDS = 0.008
ONE_STEP = 0.0
"""Slice length in seconds for one step per slice: for steps that take most of a slice each."""
REST_MS = 4
"""Pause between two slices, for the window."""


def _nothing(*_: object) -> None:
    """Do nothing; the default for callbacks."""


def _raise(error: FleetError) -> None:
    """Raise an error that no callback handles."""
    raise error


def _unexpected(error: Exception) -> FleetError:
    """Return an error for the operator in place of one that the work should not raise, and log that one."""
    trace = "".join(traceback.format_exception(error))
    QgsMessageLog.logMessage(trace, "Fleet Supervisor", Qgis.MessageLevel.Critical)
    text = tr(
        "a fault of the plugin: {error}. View > Panels > Log Messages says where: report it.",
        error=f"{type(error).__name__} {error}".strip(),
    )
    return FleetError(text)


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
        """The share that is done, 0 to 1."""
        self._is_waiting = False
        self._timer = QTimer(self)
        self._timer.setSingleShot(True)
        self._timer.setInterval(REST_MS)
        self._timer.timeout.connect(self._next)

    @property
    def is_busy(self) -> bool:
        """Whether there is work left to do."""
        return self._work is not None

    def begin(
        self,
        work: Steps[T],
        goes_on: Callable[[], None] = _nothing,
        done: Callable[[T], None] = _nothing,
        failed: Callable[[FleetError], None] = _raise,
    ) -> T | None:
        """Run the first slice of ``work`` at once: return its result if that was enough, else None.

        ``goes_on`` is called after each later slice, then ``done`` with the result or ``failed`` with
        the error raised. Work under way before is given up.

        :raises FleetError: an error in the first slice; ``failed`` is not called then. Any other exception
            of the work is logged and becomes one.
        """
        self._set_work(work, goes_on, done, failed)
        return self._slice()[1]

    def begin_soon(
        self,
        work: Steps[T],
        done: Callable[[T], None] = _nothing,
        failed: Callable[[FleetError], None] = _raise,
    ) -> None:
        """Run all of ``work`` in slices, the first one after the window's current event.

        ``done`` or ``failed`` is called as by :meth:`begin`. Work under way before is given up.
        """
        self._set_work(work, _nothing, done, failed)
        self._timer.start()

    def finish(self) -> None:
        """Run the rest at once, and call ``done`` or ``failed`` for it.

        If that begins other work, this is finished as well.
        """
        while self._work is not None:
            self._timer.stop()
            self._next()

    def stop(self) -> None:
        """Give up the work under way; nothing is called for it any more."""
        self._timer.stop()
        work, self._work = self._work, None
        self.share = 0.0
        # The work itself may be the caller; it is not continued then.
        if work is not None and not work.gi_running:
            work.close()

    def _set_work(
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
        except BaseException as error:
            if self._work is work:
                self.stop()
            if isinstance(error, FleetError) or not isinstance(error, Exception):
                raise
            raise _unexpected(error) from error
        self._timer.start()
        return False, None


def run_to_end(work: Steps[T]) -> T:
    """Run all of ``work`` at once, for threads other than the window's."""
    while True:
        try:
            next(work)
        except StopIteration as end:
            return end.value


def scaled_progress(work: Steps[T], before: int, parts: int) -> Steps[T]:
    """Run ``work`` as one of so many ``parts``, after ``before`` of them."""
    while True:
        try:
            share = next(work)
        except StopIteration as end:
            return end.value
        yield (before + share) / parts


STALLED_AFTER = 5.0
"""Seconds without progress after which nobody waits for a thread any longer."""
_AT_ONCE_SECONDS = 0.002
"""Seconds that the window waits for a thread, so that small work is done in the slice that began it."""


class StalledError(Exception):
    """A thread has made no progress within the time limit."""


class Reader(Protocol[T_co]):
    """A reader that runs in a thread of its own."""

    def read(self, go_on: Callable[[], bool]) -> T_co:
        """Return the result; ``go_on`` is called for each part, and reading ends when it returns false."""


class ReadingThread(threading.Thread, Generic[T]):
    """Runs a reader that may hang for ever: on a database, a share, a server.

    A thread of its own and no task of QGIS: those share their few threads with the drawing of the map, where
    the layers of a server that hangs block all of them.
    """

    def __init__(self, reader: Reader[T]):
        # A daemon, so that QGIS can be closed while it hangs.
        super().__init__(name="fleet reading", daemon=True)
        self._reader = reader
        self._progress_at = time.monotonic()
        self._ended = threading.Event()
        self._is_cancelled = False
        self._result: T | None = None
        self._error: Exception | None = None

    @property
    def is_reading(self) -> bool:
        """Whether it has not ended, even if nobody waits for it."""
        return not self._ended.is_set()

    @property
    def is_stalled(self) -> bool:
        """Whether nothing has been read for :data:`STALLED_AFTER` seconds."""
        return self.is_reading and time.monotonic() - self._progress_at > STALLED_AFTER

    def cancel(self) -> None:
        """End the reading after its present part."""
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
        """Wait for the result, and return it; giving up the wait cancels the reading.

        :raises StalledError: as :meth:`wait_for_end`.
        :raises Exception: the error raised by the reader.
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
    """Runs readers for steps of the window's thread, in one thread after the other."""

    def __init__(self) -> None:
        self._thread: ReadingThread[Any] | None = None

    def read(self, reader: Reader[T]) -> Steps[T]:
        """Return the result of ``reader``, run once the one before has ended; raises as a thread does."""
        while self._thread is not None and self._thread.is_reading:
            yield from self._thread.wait_for_end()
        self._thread = thread = ReadingThread(reader)
        thread.start()
        return (yield from thread.result())


_LOOK_EVERY_MS = 20


class BackgroundReading(QObject, Generic[T]):
    """Runs one reader after the other in a thread, without waiting for the end.

    No more than one thread reads at a time: the next reader starts when the one before has released its
    source, which never happens where that hangs.
    """

    ended = pyqtSignal()
    """The reading requested last has ended or failed: :meth:`result` returns or raises."""

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
        """Whether a reading is pending or under way."""
        return self._timer.isActive()

    def begin(self, reader: Reader[T]) -> None:
        """Run ``reader`` soon; a reading under way is given up."""
        self.stop()
        self._next, self._began_at = reader, time.monotonic()
        self._timer.start()
        self._advance()

    def stop(self) -> None:
        """Give up the reading under way; its thread ends when its source releases it."""
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
        """Return the result; raises the error of the reader."""
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
"""Updates between two successive slots: ten of them have an update each."""


class SignallingTask(QgsTask):
    """A task whose signal ``ended`` carries the task, in the window's thread, and whether it succeeded.

    So no closure that holds the task need be connected to its signals. Where nothing else holds it, Python
    collects the two together, Qt calls what is left of the closure, and QGIS crashes. ``ended`` comes before
    ``taskCompleted`` and ``taskTerminated``, and also where the task was cancelled.
    """

    ended = pyqtSignal(object, bool)

    def finished(self, done: bool) -> None:
        self.ended.emit(self, done)


class UpdateScheduler:
    """Counts the desk's updates.

    Texts for people need not change more than twice a second; but if all of them changed in the same
    update, the window would be blocked for the sum of their times.
    """

    def __init__(self) -> None:
        self.pulls = 0
        self._turns = 0

    def advance(self) -> None:
        """Count an update."""
        self.pulls += 1

    def turn(self) -> UpdateSlot:
        """Return a slot that no other one shares, as far as there are enough updates."""
        self._turns += 1
        return UpdateSlot(self, self._turns * _STRIDE)


class UpdateSlot:
    """Is due in one update of each half second, from ``first`` on."""

    def __init__(self, beat: UpdateScheduler, first: int) -> None:
        self._beat = beat
        self._first = first

    def is_due(self, half_seconds: int = 1) -> bool:
        """Return whether it is due in this update, if it is due once in so many half seconds."""
        return (self._beat.pulls - self._first) % (half_seconds * PULLS_IN_HALF_A_SECOND) == 0

"""Fetches a stretch of stored positions from the gateway, page by page."""

from __future__ import annotations

from qgis.core import QgsApplication, QgsTask
from qgis.PyQt.QtCore import QObject, pyqtSignal

from ....robot_bridge.messages import GetCommands, GetTrajectory
from ...errors import FleetError
from ...language import tr
from ...wire.outbox import Answer
from ..desk import Desk
from .history import History

PAGE = 1000
"""Positions taken in at once: a few milliseconds of the window's time."""
MOST = 1_000_000
"""Positions that are held; with more the rest is left out and that is said."""
COMMANDS = 1000
"""The newest commands, which the time line shows besides those that the desk knows already."""


class Fetching(QObject):
    """One stretch after the other; the live link goes on beside it."""

    progressed = pyqtSignal()
    ended = pyqtSignal(str)
    """All is there (an empty text), or not all, and why."""

    def __init__(self, desk: Desk, parent: QObject | None = None):
        super().__init__(parent)
        self._desk = desk
        self._key = ""
        self._wanted: GetTrajectory | None = None
        self._task: ArrangeTask | None = None
        self.history = History()
        self.reached = 0.0
        """The time of the newest position that is there."""
        desk.answered.connect(self._answered)

    @property
    def is_busy(self) -> bool:
        """Whether a page is on its way, or what came is being put in order."""
        return bool(self._key) or self._task is not None

    def begin(self, since: float, until: float, robots: list[str]) -> None:
        """Fetch what robots (none named: all) did from ``since`` up to ``until``; forget what was there.

        :raises NotSentError: when it cannot be asked for; what was there stays.
        """
        wanted = GetTrajectory(robots=robots, since=since, until=until, limit=PAGE)
        self._desk.inquire(GetCommands(limit=COMMANDS))
        self._key = self._desk.inquire(wanted)
        self._wanted = wanted
        self._drop_task()
        self.history, self.reached = History(), since

    def stop(self) -> None:
        """Ask for no more; what is there stays."""
        if self._key:
            self._end(tr("Stopped: the rest of the time was not fetched."))

    def forget(self) -> None:
        """Hold nothing: it is another site's."""
        self._drop_task()
        self._key, self._wanted, self.history = "", None, History()

    def _answered(self, answer: Answer) -> None:
        if not self._key or answer.order.key != self._key:
            return
        if answer.error is not None:
            self._end(tr("The rest of the time was not fetched: {error}", error=answer.error))
            return
        result = answer.result or {}
        places = result.get("places") or []
        try:
            self.history.add(places)
        except ValueError as error:
            self._end(tr("The gateway's answer cannot be used: {error}.", error=error))
            return
        if places:
            self.reached = float(places[-1][1])
        following = result.get("next")
        if not following:
            self._end("")
        elif len(self.history) >= MOST:
            self._end(
                tr(
                    "Only the first {count} positions were fetched. Choose less time, or fewer robots.",
                    count=len(self.history),
                )
            )
        else:
            self._go_on(str(following))

    def _go_on(self, after: str) -> None:
        wanted = self._wanted
        try:
            request = GetTrajectory(wanted.robots, wanted.since, wanted.until, after=after, limit=PAGE)
            self._key = self._desk.inquire(request)
        except FleetError as error:
            self._end(tr("The rest of the time was not fetched: {error}", error=error))
            return
        self.progressed.emit()

    def _end(self, text: str) -> None:
        self._key = ""
        self._drop_task()
        task = self._task = ArrangeTask(self.history)
        task.taskCompleted.connect(lambda: self._arranged(task, text))
        task.taskTerminated.connect(lambda: self._arranged(task, tr("What came could not be put in order.")))
        QgsApplication.taskManager().addTask(task)

    def _arranged(self, task: ArrangeTask, text: str) -> None:
        if task is self._task:
            self._task = None
            self.ended.emit(text)

    def _drop_task(self) -> None:
        task, self._task = self._task, None
        if task is not None:
            task.cancel()


class ArrangeTask(QgsTask):
    """Puts a history in order beside the window; nobody else touches it meanwhile."""

    def __init__(self, history: History):
        super().__init__(tr("Putting positions in order"), QgsTask.Flag.CanCancel)
        self._history = history

    def run(self) -> bool:
        return len(self._history.table) == len(self._history)

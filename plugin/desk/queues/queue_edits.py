"""What the operator changes in the robots' queues, from the press of a button to the gateway's answer."""

from __future__ import annotations

from collections.abc import Sequence

from qgis.PyQt.QtCore import QObject, pyqtSignal

from ....robot_bridge.messages import (
    AddTasks,
    MakeCurrent,
    MoveTask,
    PauseQueue,
    PauseRobot,
    QueueReport,
    QueueTask,
    RemoveTask,
    ResumeQueue,
)
from ...errors import FleetError
from ...language import tr
from ...wire.outbox import Answer
from ..desk import Desk
from ..drafts import Draft
from ..messages import QueueStand, Topic, draft_topic, queue_topic
from .task_words import task_in_words

Request = AddTasks | MoveTask | RemoveTask | MakeCurrent | PauseQueue | PauseRobot | ResumeQueue

CHANGED_MEANWHILE = tr("Not done: the queue has changed since you saw it. This is how it stands now.")


class QueueEdits(QObject):
    """Asks for changes at the revision that is shown, so that none of another operator's is undone unseen.

    Each method returns the order's key, None when it could not be sent: then the desk has said why.
    """

    changed = pyqtSignal()
    """Something was asked for, or the gateway answered."""

    def __init__(self, desk: Desk, parent: QObject | None = None):
        super().__init__(parent)
        self._desk = desk
        self._asked: dict[str, str] = {}
        self._conflicts: dict[str, str] = {}
        desk.answered.connect(self._answered)
        desk.site_changed.connect(self._clear)

    def is_asked(self, robot: str) -> bool:
        """Tell whether the gateway has not answered yet what was asked of this queue."""
        return robot in self._asked.values()

    def conflict(self, robot: str) -> str:
        """Return what became of a change that came too late; empty after the next one."""
        return self._conflicts.get(robot, "")

    def add(
        self,
        robot: str,
        tasks: Sequence[QueueTask],
        words: str,
        override: str | None = None,
        draft: Draft | None = None,
    ) -> str | None:
        """Put tasks at the end of a robot's queue; ``words`` say what they are, ``override`` as AddTasks.

        The ``draft`` that they were made of comes back with a refusal.
        """
        request = AddTasks(robot, self._revision(robot), list(tasks), override=override)
        return self._change(request, words, draft=draft)

    def move(self, robot: str, task: str, before: str | None) -> str | None:
        """Move a task in front of task ``before``, or to the end."""
        request = MoveTask(robot, self._revision(robot), task, before)
        return self._change(request, tr("Moving a task of {robot}", robot=robot), self._waiting(robot, task))

    def remove(self, robot: str, task: str) -> str | None:
        """Take a task out of a queue."""
        request = RemoveTask(robot, self._revision(robot), task)
        words = tr("Removing a task of {robot}", robot=robot)
        return self._change(request, words, self._waiting(robot, task))

    def make_current(self, robot: str, task: str) -> str | None:
        """Let a task be done first, at once unless the queue is paused."""
        request = MakeCurrent(robot, self._revision(robot), task)
        return self._change(request, tr("A task of {robot} first", robot=robot), self._waiting(robot, task))

    def pause(self, robot: str) -> str | None:
        """Send a robot no further task."""
        words = tr("Pausing the queue of {robot}", robot=robot)
        return self._change(PauseQueue(robot), words, self._state(robot))

    def pause_robot(self, robot: str) -> str | None:
        """Let a robot stand, and keep what it is doing."""
        return self._change(PauseRobot(robot), tr("Pause of {robot}", robot=robot), self._state(robot))

    def go_on(self, queue: QueueReport) -> str | None:
        """Let a robot go on with what is at the head of its queue, which is told."""
        words = tr("{robot} continues", robot=queue.robot)
        if queue.tasks:
            words = tr("{robot} continues with {task}", robot=queue.robot, task=task_in_words(queue.tasks[0]))
        return self._change(ResumeQueue(queue.robot, queue.revision), words, self._state(queue.robot))

    def resume(self, robot: str) -> str | None:
        """Let a queue that is paused go on."""
        words = tr("Resuming the queue of {robot}", robot=robot)
        return self._change(ResumeQueue(robot, self._revision(robot)), words, self._state(robot))

    def _revision(self, robot: str) -> int:
        return self._desk.queues.revision(robot)

    def _state(self, robot: str) -> Topic:
        queue = self._desk.queues.get(robot)
        return queue_topic(QueueStand(robot, state="" if queue is None else queue.state.value))

    def _waiting(self, robot: str, task: str) -> Topic:
        return queue_topic(QueueStand(robot, task=task))

    def _change(self, request: Request, words: str, *topics: Topic, draft: Draft | None = None) -> str | None:
        try:
            key = self._desk.ask(request, words, *topics, draft=draft)
        except FleetError as error:
            about = () if draft is None else (draft_topic(draft.place),)
            self._desk.report_failure(str(error), *error.topics, *about)
            return None
        self._asked[key] = request.robot
        self._conflicts.pop(request.robot, None)
        self.changed.emit()
        return key

    def _answered(self, answer: Answer) -> None:
        robot = self._asked.pop(answer.order.key, None)
        if robot is None:
            return
        if answer.outdated:
            self._conflicts[robot] = CHANGED_MEANWHILE
        self.changed.emit()

    def _clear(self) -> None:
        self._asked.clear()
        self._conflicts.clear()
        self.changed.emit()

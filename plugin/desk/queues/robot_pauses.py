"""Robots that stand for a while and then go on: the actions *Pause robot* and *Continue*."""

from __future__ import annotations

from qgis.PyQt.QtCore import QObject

from ....robot_bridge.messages import QueueReport, QueueState
from ...language import tr
from ..actions import Actions
from ..desk import Desk
from .queue_edits import QueueEdits


class RobotPauses(QObject):
    """Wires both actions to the selected robots.

    *Pause robot* is never greyed out, as nothing is that stops robots; *Continue* is where none of them has a
    queue that is paused.
    """

    def __init__(self, desk: Desk, edits: QueueEdits, actions: Actions, parent: QObject):
        super().__init__(parent)
        self._desk = desk
        self._edits = edits
        self._go_on = actions.go_on
        actions.pause.triggered.connect(self._pause)
        actions.go_on.triggered.connect(self._continue)
        desk.selection_changed.connect(self._enable)
        desk.queues_changed.connect(self._enable)
        desk.site_changed.connect(self._enable)
        self._enable()

    def _pause(self) -> None:
        if not self._desk.selection:
            self._desk.complained.emit(
                tr("No robot is selected, so none was paused. Select it in the table or on the map.")
            )
        for robot in self._desk.selection:
            self._edits.pause_robot(robot)
        self._desk.sending.withdraw()

    def _continue(self) -> None:
        for queue in self._paused():
            self._edits.go_on(queue)

    def _paused(self) -> list[QueueReport]:
        queues = (self._desk.queues.get(robot) for robot in self._desk.selection)
        return [queue for queue in queues if queue is not None and queue.state is QueueState.PAUSED]

    def _enable(self, *_: object) -> None:
        self._go_on.setEnabled(bool(self._paused()))

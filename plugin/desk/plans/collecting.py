"""Asks the gateway what stands of a layout, and plans who collects it."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

from qgis.PyQt.QtCore import QObject, pyqtSignal

from ....robot_bridge.messages import CollectLayout, MessageError, QueueTask, TaskKind
from ...errors import FleetError
from ...language import tr
from ...wire.outbox import Answer
from ..desk import Desk
from .draft_plan import DraftPlan


class Collecting(QObject):
    """Makes a draft of the answer. Nothing is sent to robots."""

    refused = pyqtSignal(str)

    def __init__(self, desk: Desk, drafts: DraftPlan, parent: QObject | None = None):
        super().__init__(parent)
        self._desk, self._drafts = desk, drafts
        self._key: str | None = None
        desk.answered.connect(self._answered)

    def ask(self, request: CollectLayout) -> None:
        """Ask what is to be collected; raises NotSentError when that cannot be asked."""
        self._key = self._desk.ask(request, tr("What is to be collected"))

    def _answered(self, answer: Answer) -> None:
        if answer.order.key != self._key:
            return
        self._key = None
        if answer.error is not None or answer.result is None:
            return
        queued = int(answer.result.get("in_queues") or 0)
        try:
            tasks = [_task(values) for values in answer.result.get("tasks", [])]
            if not tasks:
                self.refused.emit(_nothing(answer.order.params.get("layout"), queued))
                return
            self._drafts.make_collecting(tasks, preview=False)
        except (FleetError, MessageError, KeyError, TypeError, ValueError) as error:
            self.refused.emit(tr("Collecting cannot be planned: {error}", error=error))


def _nothing(layout: str | None, queued: int) -> str:
    also = tr("; {queued} are in queues already", queued=queued) if queued else ""
    if layout:
        return tr(
            "No cone of layout {layout} stands that could be collected{also}.", layout=layout, also=also
        )
    return tr("No cone stands that could be collected{also}.", also=also)


def _task(values: dict[str, Any]) -> QueueTask:
    known = {field.name for field in fields(QueueTask)}
    given = {name: value for name, value in values.items() if name in known}
    return QueueTask(**{**given, "kind": TaskKind(given["kind"])})

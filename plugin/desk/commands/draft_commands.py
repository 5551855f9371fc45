"""What can be done with the draft by buttons, and where it can come from besides clicks."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from qgis.core import QgsPointXY
from qgis.PyQt.QtCore import QObject, QPointF, Qt
from qgis.PyQt.QtWidgets import QWidget

from ....robot_bridge.messages import SendMap
from ...errors import FleetError, NotSentError
from ...language import tr
from ..actions import Actions
from ..desk import Desk
from ..draft_tool import DraftTool
from ..drafting.route_editing import turned_round
from ..drafting.tasks import tasks_of
from ..drafts import ROUTE, Draft
from ..queues.queue_edits import QueueEdits
from .coordinates_dialog import CoordinatesDialog
from .layer_drafts import draft_of_layer
from .override_dialog import OverrideDialog


class DraftCommands(QObject):
    """Wires the actions of drafts. None of them sends a draft but ``enqueue``, to its robot's queue."""

    def __init__(self, desk: Desk, edits: QueueEdits, actions: Actions, window: QWidget):
        super().__init__(window)
        self._desk = desk
        self._edits = edits
        self._actions = actions
        self._window = window
        self._coordinates: CoordinatesDialog | None = None
        actions.undo.triggered.connect(lambda: desk.drafts.undo())
        actions.redo.triggered.connect(lambda: desk.drafts.redo())
        actions.reverse.triggered.connect(lambda: self._try(self._reverse))
        actions.enqueue.triggered.connect(lambda: self._try(self._enqueue))
        actions.override.triggered.connect(lambda: self._try(self._override))
        actions.from_layer.triggered.connect(lambda: self._try(self._take_from_layer))
        actions.coordinates.triggered.connect(self._ask_for_coordinates)
        actions.send_map.triggered.connect(lambda: self._try(self._send_maps))
        desk.drafts.changed.connect(self._enable)
        self._enable()

    def remove(self) -> None:
        """Close what is open and let the window go."""
        if self._coordinates is not None:
            self._coordinates.close()
            self._coordinates.deleteLater()
        self.deleteLater()

    def _enable(self) -> None:
        drafts, actions = self._desk.drafts, self._actions
        draft = drafts.draft
        actions.undo.setEnabled(drafts.can_undo)
        actions.redo.setEnabled(drafts.can_redo)
        actions.reverse.setEnabled(draft is not None and draft.kind == ROUTE and len(draft.points) > 1)
        actions.override.setEnabled(draft is not None and draft.override is None and draft.can_be_overridden)

    def _reverse(self) -> None:
        self._desk.put_draft(turned_round(self._draft()))

    def _enqueue(self) -> None:
        """Put the draft at the end of its robot's queue.

        :raises FleetError: when it must not or cannot be; it stays on the map then.
        """
        if self._desk.sending.is_second_press():
            return
        self._draft()
        self._desk.sending.order(lambda draft: self._try(lambda: self._add(draft)))

    def _add(self, draft: Draft) -> None:
        draft = draft.as_task()
        if draft.fault:
            raise NotSentError(
                tr(
                    "{in_words} was not put into the queue: {fault}",
                    in_words=draft.in_words(),
                    fault=draft.fault,
                )
            )
        if self._edits.is_asked(draft.robot):
            raise NotSentError(
                tr(
                    "The gateway has not answered yet what was asked of the queue of {robot} before. Try "
                    "again in a moment.",
                    robot=draft.robot,
                )
            )
        words = tr("{in_words}, into the queue", in_words=draft.in_words())
        if self._edits.add(draft.robot, tasks_of(draft), words, draft.override, draft) is not None:
            self._desk.sending.clear(draft)

    def _override(self) -> None:
        draft = self._draft()
        if not draft.can_be_overridden:
            raise NotSentError(
                tr(
                    "{in_words}: there is nothing here that an override would help.",
                    in_words=draft.in_words(),
                )
            )
        then = tr("Nothing is sent yet.")
        found = draft.findings.overridable
        dialog = OverrideDialog(draft.in_words(), found, then, self._window, is_safe=False)
        dialog.confirmed.connect(lambda why: self._overridden(draft, why))
        dialog.open()

    def _overridden(self, draft: Draft, text: str) -> None:
        if self._desk.drafts.draft is not draft:
            self._desk.complained.emit(
                tr(
                    "The draft has changed since it was looked at, so nothing was overridden. Press "
                    "Override again."
                )
            )
            return
        self._desk.drafts.renew(replace(draft, override=text))

    def _take_from_layer(self) -> None:
        self._check_free()
        draft = draft_of_layer(self._desk.canvas.currentLayer(), self._desk)
        self._desk.put_draft(draft)
        self._show(draft.points)

    def _ask_for_coordinates(self) -> None:
        if self._coordinates is None:
            self._coordinates = CoordinatesDialog(self._desk, self._window)
            self._coordinates.chosen.connect(self._chosen)
        self._coordinates.ask()

    def _chosen(self, x: float, y: float) -> None:
        if not isinstance(self._desk.canvas.mapTool(), DraftTool):
            self._actions.cone.trigger()
        tool: DraftTool = self._desk.canvas.mapTool()
        tool.take((x, y))
        self._try(lambda: self._show(((x, y),)))

    def _send_maps(self) -> None:
        if not self._desk.selection:
            raise NotSentError(tr("No robot is selected, so none was sent the map. Select it first."))
        for robot in self._desk.selection:
            self._desk.ask(SendMap(robot), tr("Map for {robot}", robot=robot))

    def _draft(self) -> Draft:
        draft = self._desk.drafts.draft
        if draft is None:
            raise NotSentError(
                tr("There is no draft on the map. Select a robot, then set a cone target or draw a route.")
            )
        return draft

    def _check_free(self) -> None:
        draft = self._desk.drafts.draft
        if draft is not None and not self._desk.checks.has_order:
            raise NotSentError(
                tr(
                    "{in_words} is still on the map. Send it (Enter) or cancel it (Esc) first.",
                    in_words=draft.in_words(),
                )
            )

    def _show(self, points: tuple[tuple[float, float], ...]) -> None:
        """Move the map where none of ``points`` is on it."""
        canvas = self._desk.canvas
        places = self._desk.placement().to_map(np.array(points))
        # Of a rotated map the extent also has corners that are not on the screen.
        seen, rule = canvas.mapSettings().visiblePolygon(), Qt.FillRule.OddEvenFill
        if not any(seen.containsPoint(QPointF(x, y), rule) for x, y in places.tolist()):
            canvas.setCenter(QgsPointXY(*places[0]))
            canvas.refresh()

    def _try(self, action: Callable[[], object]) -> None:
        try:
            action()
        except FleetError as error:
            self._desk.failed.emit(str(error))

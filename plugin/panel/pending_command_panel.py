"""Panel and actions of the pending command, and the dialog that overrides findings."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from qgis.core import Qgis, QgsMessageLog, QgsPointXY
from qgis.PyQt.QtCore import QObject, QPointF, Qt, QTimer, pyqtSignal
from qgis.PyQt.QtWidgets import QAction, QHBoxLayout, QSizePolicy, QToolButton, QVBoxLayout, QWidget

from ...robot_bridge.core.messages.commands import CommandReport, CommandState, SendMap
from ..control.fleet_controller import FleetController
from ..control.messages import TITLE
from ..control.pending_command import ROUTE, TARGETS, PendingCommand, in_brief, queue_tasks, turned_round
from ..gateway_client.command_cache import command_state_in_words
from ..gateway_client.state_words import COMMAND_STATES
from ..map.tools.drawing_tools import DrawingTool
from ..ui.actions import Actions
from ..ui.dialogs import QuestionDialog
from ..ui.errors import FleetError, NotSentError
from ..ui.glyphs import WRONG_STYLE
from ..ui.language import tr
from ..ui.scheduling import CooperativeTask
from ..ui.steady_widgets import ScrollingText
from .command_sources import CoordinatesDialog, command_from_layer
from .queue import QueueEdits

NOTHING = tr("Select a robot, choose Cone target or Draw route, and click on the map.")

LINES = 3
"""Lines of the draft's text that are visible at once."""
REMARK_MS = 60_000
"""Time for which a remark is shown: for a command, its newest state is shown longer."""
GAP = 4
"""Pixels between two parts."""


class PendingCommandPanel(QWidget):
    """The draft in words; the last event when there is no draft. Its buttons never move."""

    def __init__(self, desk: FleetController, actions: Actions, parent: QWidget | None = None):
        super().__init__(parent)
        self._desk = desk
        self._remark = ""
        self._old = QTimer(self)
        self._old.setSingleShot(True)
        self._old.timeout.connect(lambda: self._show_remark("", None))
        self._kept: tuple[str, str] | None = None
        """The command that the remark is about, and its text."""
        self._text = ScrollingText("fleet_draft_text", LINES, NOTHING, framed=True)
        self._lay_out(actions)
        desk.drafts.changed.connect(self._show)
        desk.checks.progressed.connect(self._show)
        desk.sending.outgoing.changed.connect(self._show)
        desk.sending.waiting_changed.connect(self._show)
        desk.hint.connect(self._show_hint)
        desk.orders.kept.connect(self._follow)
        desk.state.commands_changed.connect(self._apply_steps)
        desk.state.site_changed.connect(lambda: self._show_hint(""))

    def _lay_out(self, actions: Actions) -> None:
        # The arrows are familiar; with words they made the panel too wide.
        changes = [_button(one, words=False) for one in (actions.undo, actions.redo, actions.reverse)]
        beside = QVBoxLayout()
        beside.setSpacing(GAP)
        beside.addLayout(_row(changes))
        beside.addWidget(_button(actions.override))
        beside.addStretch(1)
        above = QHBoxLayout()
        above.setSpacing(GAP)
        above.addWidget(self._text, 1)
        above.addLayout(beside)
        rows = QVBoxLayout(self)
        rows.setContentsMargins(0, 0, 0, 0)
        rows.setSpacing(GAP)
        rows.addLayout(above)
        rows.addLayout(_row([_button(one) for one in (actions.send, actions.enqueue, actions.cancel)]))

    def _show_hint(self, text: str) -> None:
        """Show a text for a while; QGIS's message log keeps it."""
        if text:
            QgsMessageLog.logMessage(text, TITLE, Qgis.MessageLevel.Info, False)
        self._show_remark(text, None)
        self._old.start(REMARK_MS)

    def _show_remark(self, text: str, kept: tuple[str, str] | None) -> None:
        self._old.stop()
        self._remark, self._kept = text, kept
        self._show()

    def _follow(self, command: str, words: str) -> None:
        """Show the state of a command, and each of its steps, until something else happens."""
        known = self._desk.state.commands.get(command)
        stands = COMMAND_STATES[CommandState.QUEUED] if known is None else command_state_in_words(known)
        # At the beginning: the following text may be longer than the visible lines.
        self._show_remark(f"{stands[0].upper()}{stands[1:]}. {words}.", (command, words))

    def _apply_steps(self, reports: Sequence[CommandReport]) -> None:
        if self._kept is not None and any(report.command == self._kept[0] for report in reports):
            self._follow(*self._kept)

    def _show(self) -> None:
        draft = self._desk.drafts.draft
        text = self._description(draft) if draft is not None else self._remark or NOTHING
        self._text.setText("\n".join([*self._going_out(), text]))
        is_wrong = draft is not None and draft.findings.faults
        self._text.set_text_style(WRONG_STYLE if is_wrong else "")

    def _going_out(self) -> list[str]:
        """Return a line about drafts sent before the one on the map was begun."""
        outgoing = self._desk.sending.outgoing
        if outgoing.first is None:
            return []
        return [
            tr(
                "{in_words} is being checked: {share:.0%}. It goes out when nothing speaks against it.",
                in_words=outgoing.first.in_words(),
                share=outgoing.share,
            )
        ]

    def _description(self, draft: PendingCommand) -> str:
        checks = self._desk.checks
        if self._desk.sending.awaits_way:
            return tr(
                "{in_words}. It goes out when that is found and nothing speaks against it; Esc keeps it "
                "back.",
                in_words=draft.in_words(),
            )
        if not checks.is_under_way:
            return _in_words(draft)
        if not checks.has_order:
            return tr(
                "{in_words}. Being checked: {share:.0%}.", in_words=draft.in_words(), share=checks.share
            )
        return tr(
            "{in_words}. Being checked: {share:.0%}. It goes out when nothing speaks against it; Esc keeps "
            "it back.",
            in_words=draft.in_words(),
            share=checks.share,
        )


def _button(action: QAction, *, words: bool = True) -> QToolButton:
    button = QToolButton()
    button.setObjectName(f"{action.objectName()}_button")
    button.setDefaultAction(action)
    style, policy = Qt.ToolButtonStyle, QSizePolicy.Policy
    button.setToolButtonStyle(style.ToolButtonTextBesideIcon if words else style.ToolButtonIconOnly)
    button.setSizePolicy(policy.Expanding, policy.Fixed)
    return button


def _row(buttons: Sequence[QToolButton]) -> QHBoxLayout:
    row = QHBoxLayout()
    row.setContentsMargins(0, 0, 0, 0)
    row.setSpacing(GAP)
    for button in buttons:
        row.addWidget(button)
    return row


def _in_words(draft: PendingCommand) -> str:
    if draft.override:
        return tr(
            "{in_words}. OVERRIDDEN: {override}. Enter or Send sends it.",
            in_words=draft.in_words(),
            override=draft.override,
        )
    if draft.findings.faults:
        found = in_brief(draft.findings.faults)
        hint = tr(" Override… sends it all the same, where your role may.") if draft.can_be_overridden else ""
        return tr(
            "{in_words}. Not to be sent: {found}{hint}",
            in_words=draft.in_words(),
            found=found,
            hint=hint,
        )
    if draft.fault:
        return f"{draft.in_words()}: {draft.fault}."
    warnings = f" {in_brief(draft.findings.warnings)}" if draft.findings.warnings else ""
    if draft.kind == TARGETS:
        return tr(
            "{in_words}.{warnings} Add to queue lets them be placed one after the other.",
            in_words=draft.in_words(),
            warnings=warnings,
        )
    return tr("{in_words}.{warnings} Enter or Send sends it.", in_words=draft.in_words(), warnings=warnings)


LONGEST_WHY = 300
"""characters."""
LONGEST = 1000
"""characters of the text sent to the gateway."""
MOST_SHOWN = 6


class OverrideDialog(QuestionDialog):
    """Shows the findings on ``what``, and the action ``then``; disabled until a reason is given.

    ``is_safe`` as in the base class: where robots set off by it, Enter does not override.
    """

    confirmed = pyqtSignal(str)
    """The findings overridden and the reason."""

    def __init__(self, what: str, found: Sequence[str], then: str, parent: QWidget, *, is_safe: bool):
        super().__init__(
            "fleet_override",
            tr("Override the checks"),
            ("fleet_override_confirm", tr("Override")),
            is_safe=is_safe,
            parent=parent,
        )
        self._found = in_brief(found, MOST_SHOWN)
        self.add_text(f"{what}. {self._found}")
        self._why = self.add_reason(tr("Why it is right all the same"), LONGEST_WHY, "fleet_override_why")
        log = tr("Your name, what was found and why go into the gateway's log.")
        self.add_text(f"{log} {then}")
        self.lay_out()
        self.confirm.setEnabled(False)
        self._why.textChanged.connect(lambda text: self.confirm.setEnabled(bool(text.strip())))
        self.accepted.connect(self._confirm)

    def _confirm(self) -> None:
        why = tr("because: {reason}", reason=self._why.text().strip())
        found = self._found[: LONGEST - len(why) - 1]
        text = "".join(c if c.isprintable() else " " for c in f"{found} {why}")
        self.confirmed.emit(text)


class PendingCommandActions(QObject):
    """Connects the actions of drafts. None of them sends a draft but ``enqueue``, to its robot's queue."""

    def __init__(self, desk: FleetController, edits: QueueEdits, actions: Actions, window: QWidget):
        super().__init__(window)
        self._desk = desk
        self._edits = edits
        self._actions = actions
        self._window = window
        self._coordinates: CoordinatesDialog | None = None
        self._reading = CooperativeTask(self)
        actions.undo.triggered.connect(lambda: desk.drafts.undo())
        actions.redo.triggered.connect(lambda: desk.drafts.redo())
        actions.reverse.triggered.connect(lambda: self._try(self._reverse))
        actions.enqueue.triggered.connect(lambda: self._try(self._enqueue))
        actions.override.triggered.connect(lambda: self._try(self._override))
        actions.from_layer.triggered.connect(lambda: self._try(self._draft_from_layer))
        actions.coordinates.triggered.connect(self._ask_for_coordinates)
        actions.send_map.triggered.connect(lambda: self._try(self._send_maps))
        desk.drafts.changed.connect(self._enable)
        self._enable()

    def remove(self) -> None:
        """Close the coordinates dialog, and delete this object."""
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
        self._desk.target_ways.set_command(turned_round(self._draft()))

    def _enqueue(self) -> None:
        """Append the draft to its robot's queue.

        :raises FleetError: when that is not allowed or possible; it stays on the map then.
        """
        if self._desk.sending.is_second_press():
            return
        self._draft()
        self._desk.sending.order(self._add)

    def _add(self, draft: PendingCommand) -> None:
        draft = draft.as_task()
        if draft.fault:
            raise NotSentError(
                tr(
                    "{in_words} was not put into the queue: {fault}",
                    in_words=draft.in_words(),
                    fault=draft.fault,
                )
            )
        words = tr("{in_words}, into the queue", in_words=draft.in_words())
        self._edits.add(draft.robot, queue_tasks(draft), words, draft.override, draft)
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

    def _overridden(self, draft: PendingCommand, text: str) -> None:
        now, seen = self._desk.drafts.draft, draft.findings.overridable
        if now is None or (now.place, now.findings.overridable) != (draft.place, seen):
            self._desk.warning.emit(
                tr(
                    "The draft has changed since it was looked at, so nothing was overridden. Press "
                    "Override again."
                )
            )
            return
        self._desk.drafts.renew(replace(now, override=text))

    def _draft_from_layer(self) -> None:
        self._check_free()
        work = command_from_layer(self._desk.canvas.currentLayer(), self._desk)
        draft = self._reading.begin(work, done=self._read, failed=self._failed)
        if draft is not None:
            self._set_draft(draft)

    def _read(self, draft: PendingCommand) -> None:
        self._try(lambda: self._set_draft(draft))

    def _set_draft(self, draft: PendingCommand) -> None:
        self._check_free()
        self._desk.target_ways.set_command(draft)
        self._show(draft.points)

    def _failed(self, error: FleetError) -> None:
        self._desk.failed.emit(str(error))

    def _ask_for_coordinates(self) -> None:
        if self._coordinates is None:
            self._coordinates = CoordinatesDialog(self._desk, self._window)
            self._coordinates.chosen.connect(self._chosen)
        self._coordinates.ask()

    def _chosen(self, x: float, y: float) -> None:
        if not isinstance(self._desk.canvas.mapTool(), DrawingTool):
            self._actions.cone.trigger()
        tool: DrawingTool = self._desk.canvas.mapTool()
        tool.add_point((x, y))
        self._try(lambda: self._show(((x, y),)))

    def _send_maps(self) -> None:
        if not self._desk.selection.robots:
            raise NotSentError(tr("No robot is selected, so none was sent the map. Select it first."))
        self._desk.orders.ask_each(
            self._desk.selection.robots,
            lambda robot: self._desk.orders.ask(SendMap(robot), tr("Map for {robot}", robot=robot)),
            tr("Map for {robot}"),
        )

    def _draft(self) -> PendingCommand:
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
        """Pan the map where none of ``points`` is on it."""
        canvas = self._desk.canvas
        places = self._desk.site_to_canvas.transform().to_map(np.array(points))
        # For a rotated map the extent also has corners that are off the screen.
        seen, rule = canvas.mapSettings().visiblePolygon(), Qt.FillRule.OddEvenFill
        if not any(seen.containsPoint(QPointF(x, y), rule) for x, y in places.tolist()):
            canvas.setCenter(QgsPointXY(*places[0]))
            canvas.refresh()

    def _try(self, action: Callable[[], object]) -> None:
        try:
            action()
        except FleetError as error:
            self._desk.failed.emit(str(error))

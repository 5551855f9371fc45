"""What is drawn on the map and would be sent, with the buttons that change it, send it or take it away."""

from __future__ import annotations

from collections.abc import Sequence

from qgis.core import Qgis, QgsMessageLog
from qgis.PyQt.QtCore import Qt, QTimer
from qgis.PyQt.QtWidgets import (
    QAction,
    QHBoxLayout,
    QSizePolicy,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from ...robot_bridge.messages import CommandReport, CommandState
from ..language import tr
from .actions import Actions
from .colours import WRONG_STYLE
from .command_book import how_it_stands
from .desk import Desk
from .drafts import TARGETS, Draft, in_brief
from .fixed_size import ScrollingText
from .notices import TITLE
from .state_words import COMMAND_STATES

NOTHING = tr("Select a robot, choose Cone target or Draw route, and click on the map.")

LINES = 3
"""Lines of the draft in words that are seen at once."""
REMARK_MS = 60_000
"""How long a remark stands there: of a command, its newest state stands there longer."""
GAP = 4
"""Pixels between two parts."""


class DraftPanel(QWidget):
    """The draft in words; the last thing that happened when there is no draft. Its buttons never move."""

    def __init__(self, desk: Desk, actions: Actions, parent: QWidget | None = None):
        super().__init__(parent)
        self._desk = desk
        self._remark = ""
        self._old = QTimer(self)
        self._old.setSingleShot(True)
        self._old.timeout.connect(lambda: self._show_remark("", None))
        self._kept: tuple[str, str] | None = None
        """The command that the remark is about, and what it is in words."""
        self._text = ScrollingText("fleet_draft_text", LINES, NOTHING, framed=True)
        self._lay_out(actions)
        desk.drafts.changed.connect(self._show)
        desk.checks.progressed.connect(self._show)
        desk.sending.outgoing.changed.connect(self._show)
        desk.sending.waiting_changed.connect(self._show)
        desk.remarked.connect(self._remarked)
        desk.orders.kept.connect(self._follow)
        desk.commands_changed.connect(self._take_steps)
        desk.site_changed.connect(lambda: self._remarked(""))

    def _lay_out(self, actions: Actions) -> None:
        # The arrows are known from every program; with words they made the panel too broad.
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

    def _remarked(self, text: str) -> None:
        """Show a text for a while; QGIS's log of messages keeps it."""
        if text:
            QgsMessageLog.logMessage(text, TITLE, Qgis.MessageLevel.Info, False)
        self._show_remark(text, None)
        self._old.start(REMARK_MS)

    def _show_remark(self, text: str, kept: tuple[str, str] | None) -> None:
        self._old.stop()
        self._remark, self._kept = text, kept
        self._show()

    def _follow(self, command: str, words: str) -> None:
        """Say how a command stands, from now on at each of its steps until something else happens."""
        known = self._desk.book.get(command)
        stands = COMMAND_STATES[CommandState.QUEUED] if known is None else how_it_stands(known)
        # First of all: what follows may be longer than the lines that are seen.
        self._show_remark(f"{stands[0].upper()}{stands[1:]}. {words}.", (command, words))

    def _take_steps(self, reports: Sequence[CommandReport]) -> None:
        if self._kept is not None and any(report.command == self._kept[0] for report in reports):
            self._follow(*self._kept)

    def _show(self) -> None:
        draft = self._desk.drafts.draft
        told = self._told(draft) if draft is not None else self._remark or NOTHING
        self._text.setText("\n".join([*self._going_out(), told]))
        is_wrong = draft is not None and draft.findings.faults
        self._text.set_text_style(WRONG_STYLE if is_wrong else "")

    def _going_out(self) -> list[str]:
        """Return a line about what was sent before the draft on the map was begun."""
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

    def _told(self, draft: Draft) -> str:
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


def _in_words(draft: Draft) -> str:
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

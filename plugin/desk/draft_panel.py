"""What is drawn on the map and would be sent, with the buttons that send it or take it away."""

from __future__ import annotations

from collections.abc import Sequence

from qgis.PyQt.QtCore import Qt
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
from .state_words import COMMAND_STATES
from .whole_text import WholeText

NOTHING = tr("Select a robot, choose Cone target or Draw route, and click on the map.")


class DraftPanel(QWidget):
    """The draft in words; the last thing that happened when there is no draft."""

    def __init__(self, desk: Desk, actions: Actions, parent: QWidget | None = None):
        super().__init__(parent)
        self._desk = desk
        self._remark = ""
        self._kept: tuple[str, str] | None = None
        """The command that the remark is about, and what it is in words."""
        self._text = WholeText(NOTHING, lines=2)
        self._text.setObjectName("fleet_draft_text")
        self._text.setAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignTop)
        rows = QVBoxLayout(self)
        rows.setContentsMargins(0, 0, 0, 0)
        rows.setSpacing(4)
        rows.addWidget(self._text)
        self._changes = QWidget()
        # The arrows of the first two are known from every program; with words they made the panel too broad.
        changes = [_button(actions.undo, words=False), _button(actions.redo, words=False)]
        changes += [_button(actions.reverse), _button(actions.override)]
        self._changes.setLayout(_row(changes))
        rows.addWidget(self._changes)
        rows.addLayout(_row([_button(one) for one in (actions.send, actions.enqueue, actions.cancel)]))
        self._actions = actions
        self._changes.hide()
        for action in (actions.undo, actions.redo, actions.override):
            # They are told of a draft after this panel is.
            action.changed.connect(self._show_changes)
        desk.drafts.changed.connect(self._show)
        desk.checks.progressed.connect(self._show)
        desk.remarked.connect(self._remarked)
        desk.orders.kept.connect(self._follow)
        desk.commands_changed.connect(self._take_steps)
        desk.site_changed.connect(lambda: self._remarked(""))

    def _remarked(self, text: str) -> None:
        self._remark, self._kept = text, None
        self._show()

    def _follow(self, command: str, words: str) -> None:
        """Say how a command stands, from now on at each of its steps until something else happens."""
        known = self._desk.book.get(command)
        stands = COMMAND_STATES[CommandState.QUEUED] if known is None else how_it_stands(known)
        self._remarked(f"{words}. {stands[0].upper()}{stands[1:]}.")
        self._kept = command, words

    def _take_steps(self, reports: Sequence[CommandReport]) -> None:
        if self._kept is not None and any(report.command == self._kept[0] for report in reports):
            self._follow(*self._kept)

    def _show(self) -> None:
        draft = self._desk.drafts.draft
        self._text.setText(self._told(draft) if draft is not None else self._remark or NOTHING)
        self._show_changes()
        is_wrong = draft is not None and draft.findings.faults
        self._text.setStyleSheet(WRONG_STYLE if is_wrong else "")

    def _show_changes(self) -> None:
        changes = (self._actions.undo, self._actions.redo, self._actions.override)
        self._changes.setVisible(any(action.isEnabled() for action in changes))

    def _told(self, draft: Draft) -> str:
        checks = self._desk.checks
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
    button.setSizePolicy(policy.Expanding if words else policy.Fixed, policy.Fixed)
    return button


def _row(buttons: Sequence[QToolButton]) -> QHBoxLayout:
    row = QHBoxLayout()
    row.setContentsMargins(0, 0, 0, 0)
    row.setSpacing(4)
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

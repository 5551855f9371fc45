"""What is drawn on the map and would be sent, with the buttons that send it or take it away."""

from __future__ import annotations

from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtWidgets import QHBoxLayout, QLabel, QSizePolicy, QToolButton, QVBoxLayout, QWidget

from .actions import Actions
from .desk import Desk
from .drafts import Draft

NOTHING = "Select a robot, choose Cone target or Draw route, and click on the map."


class DraftPanel(QWidget):
    """The draft in words; the last thing that happened when there is no draft."""

    def __init__(self, desk: Desk, actions: Actions, parent: QWidget | None = None):
        super().__init__(parent)
        self._desk = desk
        self._remark = ""
        self._text = QLabel(NOTHING)
        self._text.setObjectName("fleet_draft_text")
        self._text.setWordWrap(True)
        self._text.setTextFormat(Qt.TextFormat.PlainText)
        self._text.setMinimumHeight(2 * self._text.fontMetrics().lineSpacing() + 2)
        self._text.setAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignTop)
        buttons = QHBoxLayout()
        buttons.setSpacing(4)
        for action in (actions.send, actions.cancel):
            button = QToolButton()
            button.setObjectName(f"{action.objectName()}_button")
            button.setDefaultAction(action)
            button.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonTextBesideIcon)
            button.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
            buttons.addWidget(button, 2 if action is actions.send else 1)
        rows = QVBoxLayout(self)
        rows.setContentsMargins(0, 0, 0, 0)
        rows.setSpacing(4)
        rows.addWidget(self._text)
        rows.addLayout(buttons)
        desk.drafts.changed.connect(self._show)
        desk.remarked.connect(self._remarked)

    def _remarked(self, text: str) -> None:
        self._remark = text
        self._show()

    def _show(self) -> None:
        draft = self._desk.drafts.draft
        self._text.setText(_in_words(draft) if draft is not None else self._remark or NOTHING)
        self._text.setStyleSheet("color: #C62828;" if draft is not None and draft.findings.refused else "")


def _in_words(draft: Draft) -> str:
    if draft.findings.refused:
        return f"{draft.in_words()}. Not to be sent: {draft.fault}"
    if draft.fault:
        return f"{draft.in_words()}: {draft.fault}."
    warnings = f" {' '.join(draft.findings.warnings)}" if draft.findings.warnings else ""
    return f"{draft.in_words()}.{warnings} Enter or Send sends it."

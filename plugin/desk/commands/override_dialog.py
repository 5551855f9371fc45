"""Asks why a draft is to be sent in spite of what the checks found."""

from __future__ import annotations

from qgis.PyQt.QtCore import Qt, pyqtSignal
from qgis.PyQt.QtWidgets import QDialog, QDialogButtonBox, QLineEdit, QVBoxLayout, QWidget

from ...language import tr
from ..drafts import Draft, in_brief
from ..whole_text import WholeText

LONGEST_WHY = 300
"""characters."""
LONGEST = 1000
"""characters of what goes to the gateway."""
WIDTH = 480
MOST_SHOWN = 6


class OverrideDialog(QDialog):
    """Shows what was found; the button sends nothing before a reason is given."""

    confirmed = pyqtSignal(object, str)
    """The draft, and what is overridden and why."""

    def __init__(self, draft: Draft, parent: QWidget | None = None):
        super().__init__(parent)
        self.setObjectName("fleet_override")
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setWindowTitle(tr("Override the checks"))
        self.setMinimumWidth(WIDTH)
        self._draft = draft
        self._why = QLineEdit()
        self._why.setObjectName("fleet_override_why")
        self._why.setMaxLength(LONGEST_WHY)
        self._why.setPlaceholderText(tr("Why it is right all the same"))
        buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Cancel)
        self._override = buttons.addButton(tr("Override"), QDialogButtonBox.ButtonRole.AcceptRole)
        self._override.setObjectName("fleet_override_confirm")
        self._override.setEnabled(False)
        rows = QVBoxLayout(self)
        found = f"{draft.in_words()}. {in_brief(draft.findings.overridable, MOST_SHOWN)}"
        rows.addWidget(WholeText(found))
        rows.addWidget(self._why)
        note = tr("Your name, what was found and why go into the gateway's log. Nothing is sent yet.")
        rows.addWidget(WholeText(note))
        rows.addWidget(buttons)
        self._why.textChanged.connect(lambda text: self._override.setEnabled(bool(text.strip())))
        buttons.accepted.connect(self._confirm)
        buttons.rejected.connect(self.reject)

    def _confirm(self) -> None:
        why = tr("because: {strip}", strip=self._why.text().strip())
        found = in_brief(self._draft.findings.overridable, MOST_SHOWN)[: LONGEST - len(why) - 1]
        text = "".join(c if c.isprintable() else " " for c in f"{found} {why}")
        self.confirmed.emit(self._draft, text)
        self.accept()

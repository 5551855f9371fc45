"""Asks why a draft is to be sent in spite of what the checks found."""

from __future__ import annotations

from qgis.PyQt.QtCore import pyqtSignal
from qgis.PyQt.QtWidgets import QWidget

from ...language import tr
from ..drafts import Draft, in_brief
from ..question_dialog import QuestionDialog

LONGEST_WHY = 300
"""characters."""
LONGEST = 1000
"""characters of what goes to the gateway."""
MOST_SHOWN = 6


class OverrideDialog(QuestionDialog):
    """Shows what was found; the button sends nothing before a reason is given."""

    confirmed = pyqtSignal(object, str)
    """The draft, and what is overridden and why."""

    def __init__(self, draft: Draft, parent: QWidget):
        super().__init__(
            "fleet_override",
            tr("Override the checks"),
            ("fleet_override_confirm", tr("Override")),
            is_safe=False,
            parent=parent,
        )
        self._draft = draft
        self.add_text(f"{draft.in_words()}. {in_brief(draft.findings.overridable, MOST_SHOWN)}")
        self._why = self.add_reason(tr("Why it is right all the same"), LONGEST_WHY, "fleet_override_why")
        self.add_text(tr("Your name, what was found and why go into the gateway's log. Nothing is sent yet."))
        self.lay_out()
        self.confirm.setEnabled(False)
        self._why.textChanged.connect(lambda text: self.confirm.setEnabled(bool(text.strip())))
        self.accepted.connect(self._confirm)

    def _confirm(self) -> None:
        why = tr("because: {reason}", reason=self._why.text().strip())
        found = in_brief(self._draft.findings.overridable, MOST_SHOWN)[: LONGEST - len(why) - 1]
        text = "".join(c if c.isprintable() else " " for c in f"{found} {why}")
        self.confirmed.emit(self._draft, text)

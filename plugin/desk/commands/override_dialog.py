"""Asks why something is to be sent in spite of what the checks found."""

from __future__ import annotations

from collections.abc import Sequence

from qgis.PyQt.QtCore import pyqtSignal
from qgis.PyQt.QtWidgets import QWidget

from ...language import tr
from ..drafts import in_brief
from ..question_dialog import QuestionDialog

LONGEST_WHY = 300
"""characters."""
LONGEST = 1000
"""characters of what goes to the gateway."""
MOST_SHOWN = 6


class OverrideDialog(QuestionDialog):
    """Shows what was found of ``what``, and what is done ``then``; nothing is before a reason is given.

    ``is_safe`` as with the dialog itself: where robots set off by it, Enter does not override.
    """

    confirmed = pyqtSignal(str)
    """What is overridden and why."""

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

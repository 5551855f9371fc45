"""Sends the draft on the map once it has been looked at afresh, and says so where it is not sent."""

from __future__ import annotations

from collections.abc import Callable

from qgis.PyQt.QtCore import QObject, pyqtSignal

from ...errors import FleetError
from ...language import tr
from ..drafts import Draft, DraftBoard, in_brief
from ..orders import Orders
from .draft_checker import DraftChecker


class DraftSending(QObject):
    """Sends no draft that has changed meanwhile, nor one with warnings that the operator has not seen."""

    failed = pyqtSignal(str)
    """A draft was not sent: the text must not go unseen."""
    complained = pyqtSignal(str)
    """There is none to be sent."""

    def __init__(
        self, drafts: DraftBoard, checks: DraftChecker, orders: Orders, parent: QObject | None = None
    ):
        super().__init__(parent)
        self._drafts, self._checks, self._orders = drafts, checks, orders
        checks.overtaken.connect(self._overtaken)
        orders.refused.connect(self._refused)

    def send(self) -> None:
        """Send the draft once it was looked at afresh; without one, or when it cannot be sent, say so."""
        draft = self._drafts.draft
        if draft is None:
            self.complained.emit(
                tr(
                    "There is nothing to send. Select a robot, then set a cone target or draw a route on "
                    "the map."
                )
            )
            return
        try:
            self.order(self._send)
        except FleetError as error:
            self.failed.emit(tr("{in_words} was not sent: {error}", in_words=draft.in_words(), error=error))

    def order(self, order: Callable[[Draft], None]) -> None:
        """Look at the draft on the map afresh, then do something with it.

        Not if it is another by then, nor if the operator has not seen the warnings that there are now.

        :raises FleetError: when it cannot be looked at.
        """
        draft = self._drafts.draft
        assert draft is not None
        self._checks.again(lambda looked_at: self._order(looked_at, draft.findings.warnings, order))

    def withdraw(self) -> None:
        """Send no draft any more that is still looked at: the operator wants robots to stand."""
        draft = self._drafts.draft
        if self._checks.withdraw() and draft is not None:
            self.failed.emit(
                tr(
                    "{in_words} was not sent: robots were told to stop before it had been checked.",
                    in_words=draft.in_words(),
                )
            )

    def _order(self, draft: Draft, known: tuple[str, ...], order: Callable[[Draft], None]) -> None:
        unseen = [text for text in draft.findings.warnings if text not in known]
        if not unseen or draft.fault:
            order(draft)
            return
        self.failed.emit(
            tr(
                "{in_words} was not sent, since only now this is known: {warnings} Ask for it again to send "
                "it all the same.",
                in_words=draft.in_words(),
                warnings=in_brief(unseen),
            )
        )

    def _send(self, draft: Draft) -> None:
        try:
            self._orders.send(draft)
        except FleetError as error:
            self.failed.emit(str(error))
        else:
            self._drafts.done()

    def _overtaken(self, draft: Draft) -> None:
        self.failed.emit(
            tr(
                "{in_words} was not sent: the draft was changed before it had been checked. Send it anew.",
                in_words=draft.in_words(),
            )
        )

    def _refused(self, text: str, draft: Draft | None) -> None:
        self.failed.emit(text)
        if draft is not None and self._drafts.draft is None:
            # Nothing the operator drew is lost because a gateway refused it.
            self._drafts.put(draft)

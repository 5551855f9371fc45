"""What a window asks the gateway, and who gets the answer when it comes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from qgis.PyQt.QtCore import QObject, pyqtSignal

from ..errors import FleetError
from ..language import tr
from ..wire.outbox import Answer
from .desk import Desk

Take = Callable[[dict[str, Any]], None]


class Inquiries(QObject):
    """Hands each answer to whoever asked, however late it comes; never waits for one.

    An answer may be all there ever is of a token, so one is taken even after the link was lost.
    """

    refused = pyqtSignal(str)
    """Something was not done, or its answer cannot be read: why, for the operator."""

    def __init__(self, desk: Desk, parent: QObject | None = None):
        super().__init__(parent)
        self._desk = desk
        self._takers: dict[str, tuple[str, Take]] = {}
        desk.answered.connect(self._answered)

    def ask(self, request: Any, words: str, take: Take) -> None:
        """Ask for ``request``, which is ``words`` to the operator; ``take`` gets the result."""
        try:
            self._takers[self._desk.inquire(request)] = words, take
        except FleetError as error:
            self.refused.emit(f"{words}: {error}")

    def _answered(self, answer: Answer) -> None:
        words, take = self._takers.pop(answer.order.key, ("", None))
        if take is None:
            return
        if answer.error is not None:
            self.refused.emit(f"{words}: {answer.error}")
        else:
            self._hand_over(words, take, answer.result or {})

    def _hand_over(self, words: str, take: Take, result: dict[str, Any]) -> None:
        try:
            take(result)
        except (KeyError, TypeError, ValueError) as error:
            # The result itself is not shown: a token may be in it.
            kind = type(error).__name__
            self.refused.emit(
                tr(
                    "{words}: the gateway's answer cannot be read ({kind}). Update the gateway or the "
                    "plugin, whichever is older.",
                    words=words,
                    kind=kind,
                )
            )

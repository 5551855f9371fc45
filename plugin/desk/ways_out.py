"""What two robots in each other's way can do about it, as the gateway reckons it again and again."""

from __future__ import annotations

from qgis.PyQt.QtCore import QObject, pyqtSignal

from ...robot_bridge.messages import GetWaysOut, WayOut, ways_out_report
from ..errors import NotSentError
from ..language import tr
from ..wire.outbox import Answer
from .desk import Desk

Pair = tuple[str, str]

ASK_EVERY = 3.0
"""Seconds: robots drive on, and what was possible is so no longer."""
ANSWERED_WITHIN = 10.0
"""Seconds after which another question is asked, though the last one was not answered."""


class WaysOutQuery(QObject):
    """Asks for one pair at a time. What is known of a pair is forgotten when another one is watched."""

    changed = pyqtSignal()

    def __init__(self, desk: Desk, parent: QObject | None = None):
        super().__init__(parent)
        self._desk = desk
        self._pair: Pair | None = None
        self._kind = ""
        self._ways: dict[tuple[str, str], WayOut] = {}
        self._key: str | None = None
        self._asked_at = 0.0
        self.why_not = ""
        """Why it is not known what the robots can do; empty where it is known or was just asked."""
        desk.pulled.connect(self._ask_again)
        desk.answered.connect(self._answered)

    def watch(self, pair: Pair | None, kind: str = "") -> None:
        """Ask about ``pair`` from now on, None for no pair; at once where they meet in another way."""
        if pair == self._pair:
            if kind != self._kind:
                self._kind = kind
                self._ask()
            return
        self._pair, self._kind, self._key, self.why_not = pair, kind, None, ""
        self._ways.clear()
        self._ask()
        self.changed.emit()

    def way(self, robot: str, how: str) -> WayOut | None:
        """Return what a robot can do: ``how`` is ``give way`` or ``aside``; None where that is not known."""
        return self._ways.get((robot, how))

    def _ask_again(self) -> None:
        waits = ASK_EVERY if self._key is None else ANSWERED_WITHIN
        if self._pair is not None and self._desk.clock() - self._asked_at >= waits:
            self._ask()

    def _ask(self) -> None:
        if self._pair is None:
            return
        self._asked_at = self._desk.clock()
        try:
            self._key = self._desk.inquire(GetWaysOut(*self._pair))
        except NotSentError as error:
            self._key = None
            self._know({}, str(error))

    def _answered(self, answer: Answer) -> None:
        if self._key is None or answer.order.key != self._key:
            return
        self._key = None
        if answer.error is not None:
            self._know({}, answer.error)
            return
        try:
            found = ways_out_report(answer.result or {}).ways
        except (KeyError, TypeError, ValueError):
            self._know({}, tr("the gateway's answer cannot be read; it may be older than this plugin"))
            return
        self._know({(way.robot, way.how): way for way in found}, "")

    def _know(self, ways: dict[tuple[str, str], WayOut], why_not: str) -> None:
        if (ways, why_not) != (self._ways, self.why_not):
            self._ways, self.why_not = ways, why_not
            self.changed.emit()

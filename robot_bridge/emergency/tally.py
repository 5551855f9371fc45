"""What the robots said to an emergency stop; no I/O."""

from __future__ import annotations

from collections.abc import Iterable
from enum import IntEnum
from typing import Any

from ..messages import Abort, CommandReport, CommandState

MOST_NAMES = 50


class Answer(IntEnum):
    """How far a robot has come; a later one says more."""

    NONE = 0
    REFUSED = 1
    ACKNOWLEDGED = 2
    STANDING = 3


_BY_STATE = {
    CommandState.FAILED: Answer.REFUSED,
    CommandState.ACKNOWLEDGED: Answer.ACKNOWLEDGED,
    CommandState.REACHED: Answer.STANDING,
}


class Tally:
    """The answer of each robot. Every method that takes one in tells whether it changed anything."""

    def __init__(self) -> None:
        self._answers: dict[str, Answer] = {}

    def begin(self, robots: Iterable[str]) -> None:
        """Count from nought: these robots are told."""
        self._answers = dict.fromkeys(robots, Answer.NONE)

    def told(self, robot: str) -> None:
        """Count one robot from nought: it is new, or started anew."""
        self._answers[robot] = Answer.NONE

    def forget(self, robot: str) -> bool:
        """Count a robot no more; tell whether it was counted."""
        return self._answers.pop(robot, None) is not None

    def answer(self, robot: str, *, refused: bool) -> bool:
        """Take in what a robot said."""
        return self._raise(robot, Answer.REFUSED if refused else Answer.ACKNOWLEDGED)

    def note_step(self, report: CommandReport) -> bool:
        """Take in what became of a command, if it is the Abort of an emergency stop."""
        if report.op != Abort.__name__ or not report.params.get("emergency"):
            return False
        return self._raise(report.robot, _BY_STATE.get(report.state, Answer.NONE))

    def counts(self) -> dict[str, Any]:
        """Return robots, acknowledged, standing, waiting and refused as an EmergencyReport has them."""
        answers = self._answers
        return {
            "robots": len(answers),
            "acknowledged": sum(answer >= Answer.ACKNOWLEDGED for answer in answers.values()),
            "standing": sum(answer is Answer.STANDING for answer in answers.values()),
            "waiting": self._names(Answer.NONE),
            "refused": self._names(Answer.REFUSED),
        }

    def _names(self, wanted: Answer) -> list[str]:
        return sorted(robot for robot, answer in self._answers.items() if answer is wanted)[:MOST_NAMES]

    def _raise(self, robot: str, answer: Answer) -> bool:
        if answer <= self._answers.get(robot, Answer.NONE):
            return False
        self._answers[robot] = answer
        return True

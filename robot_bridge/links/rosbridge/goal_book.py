"""Which of an action server's goals is for which of the gateway's messages; no I/O.

rosbridge lets the server side choose a goal's id, and says it to nobody. So the goals that were known are
kept before one is sent: the one that is new afterwards is ours. That is written down before it is sent, and
outlives this process.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from ..ros.effects import Action
from ..ros.goals import GoalStatus

MOST_ENTRIES = 10
"""goals of one robot that are remembered."""
MOST_BEFORE = 1000
"""goals of others that are remembered from before."""


@dataclass
class Entry:
    """A goal that was sent: ``goal`` is its id here, ``real`` the one that it has on the robot.

    ``doomed``: it is to be canceled as soon as that is known. ``was_shown``: an action server has named it
    over this connection.
    """

    action: Action
    goal: bytes
    before: frozenset[bytes]
    real: bytes | None = None
    doomed: bool = False
    is_over: bool = False
    was_shown: bool = field(default=False, compare=False)


class GoalBook:
    """The goals of one robot, the newest last."""

    def __init__(self) -> None:
        self.entries: list[Entry] = []

    def find(self, goal: bytes) -> Entry | None:
        """Return the newest entry of a goal."""
        return next((one for one in reversed(self.entries) if one.goal == goal), None)

    def add(self, action: Action, goal: bytes, known: frozenset[bytes]) -> Entry:
        """Note that a goal is about to be sent to a server whose goals are ``known``."""
        for earlier in self.entries:
            # The server has not shown it until now, or has been told by its own id to cancel it.
            earlier.is_over |= earlier.action is action and earlier.real is None
        entry = Entry(action, goal, frozenset(sorted(known)[:MOST_BEFORE]))
        self.entries = [*self.entries, entry][-MOST_ENTRIES:]
        return entry

    def forget(self) -> None:
        """Take it that no server knows any goal."""
        self.entries = []

    def translate(
        self, action: Action, statuses: Mapping[bytes, GoalStatus]
    ) -> tuple[dict[bytes, GoalStatus], bool]:
        """Return the statuses under the ids that are used here, and whether a goal was found by that."""
        found = self._claim(action, statuses)
        ours = {one.real: one for one in self.entries if one.action is action and one.real is not None}
        translated = {}
        for real, status in statuses.items():
            entry = ours.get(real)
            if entry is not None:
                entry.was_shown = True
                entry.is_over |= status in (GoalStatus.SUCCEEDED, GoalStatus.CANCELED, GoalStatus.ABORTED)
            translated[real if entry is None else entry.goal] = status
        return translated, found

    def _claim(self, action: Action, statuses: Mapping[bytes, GoalStatus]) -> bool:
        """Find the goals that were sent, and whose ids are not known yet, among those that are new."""
        claimed = {one.real for one in self.entries}
        found = False
        for entry in self.entries:
            if entry.action is not action or entry.real is not None or entry.is_over:
                continue
            new = [real for real in statuses if real not in entry.before and real not in claimed]
            if new:
                entry.real = new[0]
                claimed.add(new[0])
                found = True
        return found

    def to_json(self) -> list[dict[str, Any]]:
        """Return it as it is written down."""
        return [
            {
                "action": one.action.value,
                "goal": one.goal.hex(),
                "real": one.real.hex() if one.real else None,
                "before": [real.hex() for real in sorted(one.before)],
            }
            for one in self.entries
            if not one.is_over
        ]

    @classmethod
    def from_json(cls, rows: Any) -> GoalBook:
        """Return what was written down; raises ValueError, TypeError or KeyError where it was not by us."""
        book = cls()
        for row in rows[-MOST_ENTRIES:]:
            real = bytes.fromhex(row["real"]) if row["real"] is not None else None
            before = frozenset(bytes.fromhex(one) for one in row["before"])
            book.entries.append(Entry(Action(row["action"]), bytes.fromhex(row["goal"]), before, real))
        return book

"""The desk's beat, and the turns in which the parts of the window look at the robots."""

from __future__ import annotations

PULL_EVERY_MS = 50
PULLS_IN_HALF_A_SECOND = 500 // PULL_EVERY_MS
_STRIDE = 3
"""Pulls between the turns of two who asked one after the other: ten of them have a pull each."""


class Beat:
    """Counts the desk's pulls.

    What is read by people need not change more than twice a second; but if all of it changed in the same
    pull, the window would stand still for as long as all of it takes.
    """

    def __init__(self) -> None:
        self.pulls = 0
        self._turns = 0

    def turn(self) -> Turn:
        """Return a turn in which nobody else comes, as far as there are enough pulls."""
        self._turns += 1
        return Turn(self, self._turns * _STRIDE)


class Turn:
    """Comes in one pull of each half second, from ``first`` on."""

    def __init__(self, beat: Beat, first: int) -> None:
        self._beat = beat
        self._first = first

    def has_come(self, half_seconds: int = 1) -> bool:
        """Tell whether it comes in this pull, if it is to come once in so many half seconds."""
        return (self._beat.pulls - self._first) % (half_seconds * PULLS_IN_HALF_A_SECOND) == 0

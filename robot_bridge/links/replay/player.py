"""What of a recording is to be told when its clock is at a place; no I/O."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from enum import Enum

from ...recordings.tracks import Recording, Track


class Presence(Enum):
    """Whether the recording knows of a robot at a place: not yet, now, silent for too long, or no more."""

    BEFORE, HERE, SILENT, OVER = range(4)


@dataclass
class _Cursor:
    track: Track
    at: int = -1
    """the number of the position that was told last, -1 for none."""

    def move(self, place: float) -> bool:
        """Go to the last position up to ``place``; return whether that is another one."""
        last, self.at = self.at, int(self.track.t.searchsorted(place, side="right")) - 1
        return self.at != last

    def presence(self, place: float, largest_gap: float) -> Presence:
        """Return whether the recording knows of the robot."""
        if self.at < 0:
            return Presence.BEFORE
        if place - self.track.t[self.at] <= largest_gap:
            return Presence.HERE
        return Presence.OVER if self.at == len(self.track.t) - 1 else Presence.SILENT


@dataclass(frozen=True)
class Told:
    """Position number ``at`` of a track is told; ``is_new`` unless it was told before."""

    track: Track
    at: int
    presence: Presence
    is_new: bool


class Player:
    """Goes through the tracks of a recording.

    A robot of which the recording says nothing for more than ``largest_gap`` of its seconds is silent.
    """

    def __init__(self, recording: Recording, largest_gap: float) -> None:
        self._cursors = [_Cursor(track) for track in recording.tracks]
        self._largest_gap = largest_gap
        self.begin, self.end = recording.begin, recording.end

    def advance(self, place: float) -> Iterator[Told]:
        """Yield for each robot where it is at ``place``, seconds of the recording."""
        for cursor in self._cursors:
            is_new = cursor.move(place)
            yield Told(cursor.track, cursor.at, cursor.presence(place, self._largest_gap), is_new)

    def next_place(self) -> float:
        """Return when the recording says something new, infinite at its end."""
        following = (float(c.track.t[c.at + 1]) for c in self._cursors if c.at + 1 < len(c.track.t))
        return min(following, default=math.inf)

"""Table ``[replay]`` of a link's settings: which file is played, and how."""

from __future__ import annotations

import re
from pathlib import Path

import msgspec

from ...messages import MessageError, check_robot_name
from ...recordings.columns import TableForm
from ...recordings.errors import RecordingError
from ...recordings.opening import ReadingOptions
from ..base.errors import LinkError

PREFIX = "replay-"
"""What the names of all replayed robots begin with, also where only names are stored."""
_SLOWEST, _FASTEST = 0.1, 1000.0
_UNUSABLE = re.compile(r"[^A-Za-z0-9_.-]+")


class ReplaySettings(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """``file`` is beside the settings; ``robots`` gives recorded robots other names.

    ``speed``, ``start_s`` (seconds after its begin), ``loop`` and ``paused`` may be changed while it is
    played. A robot of which the file says nothing for ``largest_gap_s`` of its seconds is silent.
    ``columns``, ``delimiter``, ``time_unit`` and ``theta_unit`` are those of CSV; ``topics`` are patterns of
    the topics of a bag.
    """

    file: str
    speed: float = 1.0
    start_s: float = 0.0
    loop: bool = False
    paused: bool = False
    robots: dict[str, str] = {}
    largest_gap_s: float = 10.0
    columns: dict[str, str] = {}
    delimiter: str = ","
    time_unit: str = "s"
    theta_unit: str = "rad"
    topics: list[str] = []

    def check(self, file: Path) -> None:
        """Raise LinkError, naming file and key, for what cannot be."""
        bounds = {"speed": (_SLOWEST, _FASTEST), "start_s": (0.0, 1e9), "largest_gap_s": (0.1, 1e6)}
        for key, (least, most) in bounds.items():
            if not least <= getattr(self, key) <= most:
                raise LinkError(
                    f"{file}: replay.{key} = {getattr(self, key)}: give a number from {least:g} to {most:g}"
                )
        try:
            self.reading.table.check()
        except RecordingError as error:
            raise LinkError(f"{file}: replay.{error}") from None

    @property
    def reading(self) -> ReadingOptions:
        """How the file is to be read."""
        return ReadingOptions(
            TableForm(self.columns, self.delimiter, self.time_unit, self.theta_unit), tuple(self.topics)
        )

    def is_same_recording(self, other: ReplaySettings) -> bool:
        """Tell whether ``other`` differs only in what may be changed while it is played."""
        changed = msgspec.structs.replace(
            other, speed=self.speed, start_s=self.start_s, loop=self.loop, paused=self.paused
        )
        return changed == self

    def names(self, recorded: list[str], file: Path) -> dict[str, str]:
        """Return the names that recorded robots have on the map; raises LinkError."""
        for name in self.robots:
            if name not in recorded:
                there = ", ".join(recorded[:20])
                raise LinkError(f"{file}: replay.robots.{name}: no robot is recorded so; there are {there}")
        names: dict[str, str] = {}
        for name in recorded:
            given = self.robots.get(name, _UNUSABLE.sub("-", name).strip("-"))
            names[name] = given if given.startswith(PREFIX) else PREFIX + given
            try:
                check_robot_name(names[name])
            except MessageError as error:
                raise LinkError(f"{file}: replay.robots.{name}: {error}") from None
        if len(set(names.values())) < len(names):
            raise LinkError(f"{file}: replay.robots: two robots would have one name; give each its own")
        return names

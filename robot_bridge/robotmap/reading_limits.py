"""How much a binary map may unpack to, by the size of its file: what a stranger's file may cost its reader.

On a common computer a file of up to 1 MB costs less than 1 s and 200 MB; a larger one in proportion. A map of
all buildings and walls of Malta, 1.3 MB, has half of the text and two thirds of the parts that it may have.
"""

from __future__ import annotations

from typing import NamedTuple

from .errors import BinaryError

LARGEST_TEXT = 256 << 20
"""bytes of text that a reader accepts at most, whatever its file has."""

_ONE_FILE = 1_000_000
"""bytes; smaller files may unpack to as much as one of this size."""
_TEXT_PER_BYTE = 8
_PARTS_PER_BYTE = 0.9
_OBSTACLE_PARTS, _SEGMENT_PARTS = 16, 4
"""An obstacle costs as much as four segments, a segment as much as four lines, extras or comments."""


class ReadingLimits(NamedTuple):
    """The most bytes of text, and the most parts: obstacles, segments, lines, extras, by what each costs."""

    text: int
    parts: float

    @classmethod
    def of_file(cls, size: int) -> ReadingLimits:
        """Return the limits for a file of ``size`` bytes that comes from anybody."""
        size = max(size, _ONE_FILE)
        return cls(min(LARGEST_TEXT, _TEXT_PER_BYTE * size), _PARTS_PER_BYTE * size)

    @classmethod
    def of_text(cls, length: int) -> ReadingLimits:
        """Return the limits for a text of at most ``length`` bytes that comes from who may be believed."""
        return cls(length, float("inf"))

    def check_text(self, text: str) -> None:
        """Raise BinaryError when ``text`` has too many parts; nothing is taken apart for that."""
        obstacles = text.count("obstacle;")
        lines = text.count("\n") - 4 * obstacles
        self._check(_OBSTACLE_PARTS * obstacles + lines + text.count("=") + text.count(","))

    def check_counts(self, obstacles: int, segments: int, extras: int) -> None:
        """Raise BinaryError when a map of so many parts is too large."""
        self._check(_OBSTACLE_PARTS * obstacles + _SEGMENT_PARTS * segments + extras)

    def _check(self, parts: int) -> None:
        if parts > self.parts:
            raise BinaryError(
                "size check: the map has more obstacles, segments and labels than a file of its size may "
                "have; export it as text, or in tiles"
            )

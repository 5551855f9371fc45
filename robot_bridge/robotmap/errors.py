"""The exception family of the robot map."""

from __future__ import annotations


class RobotMapError(Exception):
    """Something is wrong with a robot map; the text names what, where, and what to do."""


class WindowError(RobotMapError):
    """A window that encloses nothing, or of which nothing is known."""


class TextError(RobotMapError):
    """A text that is no robot map; names the line, what was expected there and what was found."""


class BinaryError(RobotMapError):
    """Bytes that are no robot map, or are damaged; names the check that failed."""


class MissingCodecError(RobotMapError):
    """The binary format needs a package that this Python does not have."""


class ShapingError(RobotMapError):
    """Something that cannot be asked of outlines; names it and what to give instead."""


class CancelledError(RobotMapError):
    """Work was ended midway by whoever asked for it."""


class MissingGeometryError(RobotMapError):
    """Reducing outlines needs a package that this Python does not have."""


class NavigationMapError(RobotMapError):
    """A map of Nav2 that cannot be read; the text names the key, its value and what is right."""

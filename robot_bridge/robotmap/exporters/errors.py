"""What can be wrong with an export; part of the robot map's exception family."""

from __future__ import annotations

from ..errors import RobotMapError


class ExportError(RobotMapError):
    """A robot map cannot be written in another format; the text names what, where, and what to do."""


class GridError(ExportError):
    """A grid that has no cells or too many."""


class AreaError(ExportError):
    """An area of a mask that is no polygon, or a speed that is none."""


class PlaceError(ExportError):
    """Positions of the map have no place on the earth that the format can express."""


class MissingPackageError(ExportError):
    """The format needs a package that this Python does not have."""

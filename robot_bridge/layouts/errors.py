"""The exception family of cone layouts."""

from __future__ import annotations


class LayoutsError(Exception):
    """Something is wrong with a cone layout; names what, where, and what to do."""


class DimensionError(LayoutsError):
    """A dimension that a layout does not have, or a value that it cannot have."""


class LineError(LayoutsError):
    """A line that a layout cannot lie along."""


class TableError(LayoutsError):
    """A table of cones that cannot be read; names row and column."""

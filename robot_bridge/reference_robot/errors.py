"""The exception family of the reference robot."""

from __future__ import annotations


class ReferenceRobotError(Exception):
    """Something the robot cannot do; the text names what was wrong, where, and what to do."""

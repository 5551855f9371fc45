"""The exception of the stage."""

from __future__ import annotations


class StageError(Exception):
    """Something the demonstration needs did not come up; the text says what, and what to do."""

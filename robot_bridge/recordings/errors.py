"""The exception family of recordings."""

from __future__ import annotations

from ..errors import BridgeError


class RecordingError(BridgeError):
    """A file of which nothing can be played; the text names file, row and column, and what to do."""

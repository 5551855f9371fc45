"""What clients are told about the gateway itself."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Stopping:
    """The gateway ends in good order, and closes its connections with code 1012. ``reason`` is for people."""

    reason: str

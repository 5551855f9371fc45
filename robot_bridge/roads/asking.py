"""Asking in the midst of long work whether it is still wanted."""

from __future__ import annotations

from collections.abc import Callable

Ask = Callable[[], None]
"""Called between the steps of long work; what it raises ends that, with nothing changed."""


def go_on() -> None:
    """Let the work go on to its end."""

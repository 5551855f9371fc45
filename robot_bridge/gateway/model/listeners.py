"""The operators' sessions that are connected, and hear what happens."""

from __future__ import annotations

import logging
from typing import Any, Protocol

from ...core.logs import log_and_continue

log = logging.getLogger(__name__)


class Listener(Protocol):
    """An operator's session, which hears what happens."""

    def notify(self, method: str, key: str, params: dict[str, Any]) -> None:
        """Take note of news; of those with the same method and key only the last counts. Must not block."""


class Listeners:
    """The sessions that hear what happens, such as every step of every command."""

    def __init__(self) -> None:
        self._all: set[Listener] = set()

    def __len__(self) -> int:
        return len(self._all)

    def add(self, listener: Listener) -> None:
        """Have ``listener`` hear from now on what happens."""
        self._all.add(listener)

    def discard(self, listener: Listener) -> None:
        """Have ``listener`` hear nothing more."""
        self._all.discard(listener)

    def announce(self, method: str, key: str, params: dict[str, Any]) -> None:
        """Notify every session of what happened; one that fails keeps no other from hearing it.

        See :meth:`Listener.notify`.
        """
        for listener in list(self._all):
            with log_and_continue(log, f"telling an operator's session of {method}"):
                listener.notify(method, key, params)

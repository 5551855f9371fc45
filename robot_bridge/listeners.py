"""Who is told what happens: the sessions of operators that are connected."""

from __future__ import annotations

import logging
from typing import Any, Protocol

from .monitoring.unforeseen import going_on

log = logging.getLogger(__name__)


class Listener(Protocol):
    """An operator's session, told what happens."""

    def notify(self, method: str, key: str, params: dict[str, Any]) -> None:
        """Take note of news; of those with the same method and key only the last counts. Must not block."""


class Listeners:
    """The sessions that are told what happens: every step of every command."""

    def __init__(self) -> None:
        self._all: set[Listener] = set()

    def __len__(self) -> int:
        return len(self._all)

    def add(self, listener: Listener) -> None:
        """Tell ``listener`` from now on what happens."""
        self._all.add(listener)

    def discard(self, listener: Listener) -> None:
        """Tell ``listener`` nothing more."""
        self._all.discard(listener)

    def announce(self, method: str, key: str, params: dict[str, Any]) -> None:
        """Tell every session what happened; see :meth:`Listener.notify`."""
        for listener in list(self._all):
            with going_on(log, f"telling an operator's session of {method}"):
                listener.notify(method, key, params)

"""The exception family of the gateway and the reference robot."""

from __future__ import annotations

from typing import Any


class BridgeError(Exception):
    """Something the bridge cannot do; the text names what was wrong, where, and what to do."""


class StoreError(BridgeError):
    """The database cannot be opened, read or written."""


class DataRefusedError(StoreError):
    """The database is in order and refuses a value: too long, or of a kind that it cannot hold."""


class UncertainError(StoreError):
    """The connection was lost during a commit: what it was to store may be stored or not."""


class RefusedError(BridgeError):
    """A request that was understood and is not done: unknown robot, target outside the site, ..."""


class ForbiddenError(RefusedError):
    """A request that the operator's role does not allow."""


class OutdatedError(RefusedError):
    """A change to something that has changed since it was looked at; ``newer`` is how it is now, as JSON."""

    def __init__(self, text: str, newer: dict[str, Any]) -> None:
        super().__init__(text)
        self.newer = newer


class BusyError(RefusedError):
    """A request that is not dealt with because too many others wait."""


class HopelessError(BridgeError):
    """The gateway cannot go on: its process ends with this text, to be started anew."""


class NotReadyError(BridgeError):
    """A robot speaks that has not said Ready to this database."""

"""The exception family of the gateway and the reference robot."""

from __future__ import annotations

from collections.abc import Iterable
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


class OtherRunError(RefusedError):
    """What another robot says under the account of the one that was let in."""


class ForbiddenError(RefusedError):
    """A request that the operator's role does not allow."""


class OutdatedError(RefusedError):
    """A change to something that has changed since it was looked at; ``newer`` is how it is now, as JSON."""

    def __init__(self, text: str, newer: dict[str, Any]) -> None:
        super().__init__(text)
        self.newer = newer


class OverridableError(RefusedError):
    """A request that is done all the same with an override; ``found`` is all that speaks against it."""

    NAMED = 3
    """So much of what was found stands in the text."""

    def __init__(self, found: Iterable[str], otherwise: str) -> None:
        self.found = list(dict.fromkeys(found))
        more = len(self.found) - self.NAMED
        named = "; ".join(self.found[: self.NAMED]) + (f"; and {more} more" if more > 0 else "")
        super().__init__(f"{named}: {otherwise}")


class BusyError(RefusedError):
    """A request that is not dealt with because too many others wait."""


class HopelessError(BridgeError):
    """The gateway cannot go on: its process ends with this text, to be started anew."""


class NotReadyError(BridgeError):
    """A robot speaks that has not said Ready to this database."""

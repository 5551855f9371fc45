"""How far long work is, told to whoever waits for it, who may end it midway."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import TypeVar

from .errors import CancelledError

Item = TypeVar("Item")

_EVERY = 100
"""After how many items it is asked whether the work is still wanted."""


class Watch:
    """Tells ``progress`` how much of the work is done, 0 to 1, and asks ``cancelled`` whether to end it.

    Either may be nothing.
    """

    def __init__(
        self,
        progress: Callable[[float], None] | None = None,
        cancelled: Callable[[], bool] | None = None,
    ):
        self._progress, self._cancelled = progress, cancelled

    def at(self, share: float) -> None:
        """Tell that ``share`` of the work is done; raises CancelledError when it is no longer wanted."""
        if self._cancelled is not None and self._cancelled():
            raise CancelledError("the work was cancelled; nothing of it is kept")
        if self._progress is not None:
            self._progress(share)

    def over(self, items: Sequence[Item]) -> Iterator[Item]:
        """Yield ``items``, telling how far it is on the way; raises CancelledError as :meth:`at`."""
        for k, item in enumerate(items):
            if k % _EVERY == 0:
                self.at(k / len(items))
            yield item

    def part(self, start: float, end: float) -> Watch:
        """Return the watch over that part of the work, ``start`` and ``end`` from 0 to 1."""
        tell = self._progress
        if tell is None:
            return Watch(None, self._cancelled)
        return Watch(lambda share: tell(start + share * (end - start)), self._cancelled)


UNWATCHED = Watch()

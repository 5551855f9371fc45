"""What is on and what is off, for each robot and each pair, and what has just changed."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from .rules import Bools, Floats, Ints

PAIR_SHIFT = np.int64(32)
MOST_AT_ONCE = 200
"""Changes of one look; others come with the next: a whole fleet that is lost does not hold up the window."""


class RowLatch:
    """One rule for all robots: goes on where it holds for a while, off where it is over for a while."""

    def __init__(self) -> None:
        self.on = np.zeros(0, dtype=bool)
        self._holds_since = np.full(0, np.inf)
        self._over_since = np.full(0, np.inf)

    def update(
        self, holds: Bools, over: Bools, now: float, on_after: float, off_after: float
    ) -> tuple[npt.NDArray[np.intp], npt.NDArray[np.intp]]:
        """Take in at time ``now`` where the rule (n,) holds and is over; return the rows gone on, and off."""
        self._grow(len(holds))
        self._holds_since = np.where(holds, np.minimum(self._holds_since, now), np.inf)
        self._over_since = np.where(over, np.minimum(self._over_since, now), np.inf)
        rises = np.flatnonzero(~self.on & (now - self._holds_since >= on_after))[:MOST_AT_ONCE]
        falls = np.flatnonzero(self.on & ~holds & (now - self._over_since >= off_after))[:MOST_AT_ONCE]
        self.on[rises], self.on[falls] = True, False
        return rises, falls

    def drop(self, rows: Ints) -> None:
        """Forget robots that are there no more; those below them move up."""
        rows = rows[rows < len(self.on)]
        self.on = np.delete(self.on, rows)
        self._holds_since = np.delete(self._holds_since, rows)
        self._over_since = np.delete(self._over_since, rows)

    def _grow(self, count: int) -> None:
        more = count - len(self.on)
        if more > 0:
            self.on = np.concatenate([self.on, np.zeros(more, dtype=bool)])
            self._holds_since = np.concatenate([self._holds_since, np.full(more, np.inf)])
            self._over_since = np.concatenate([self._over_since, np.full(more, np.inf)])


class PairLatch:
    """Pairs of robots: on when nearer than one distance, off when further apart than another."""

    def __init__(self) -> None:
        self._on = np.empty(0, np.int64)

    def update(
        self, one: Ints, other: Ints, apart: Floats, distance: float
    ) -> tuple[list[tuple[int, int]], list[tuple[int, int]]]:
        """Take in all pairs that are not yet far enough apart; return the pairs gone on, and off."""
        key = (one << PAIR_SHIFT) + other
        begins = key[apart < distance]
        on = np.union1d(np.intersect1d(self._on, key), begins)
        rises = np.setdiff1d(on, self._on)[:MOST_AT_ONCE]
        falls = np.setdiff1d(self._on, on)[:MOST_AT_ONCE]
        self._on = np.setdiff1d(np.union1d(self._on, rises), falls)
        return _pairs(rises), _pairs(falls)

    def drop(self, rows: Ints) -> None:
        """Forget the pairs of robots that are there no more; those below them move up."""
        pairs = np.array(_pairs(self._on), dtype=np.int64).reshape(-1, 2)
        pairs = pairs[~np.isin(pairs, rows).any(axis=1)]
        pairs -= np.searchsorted(np.sort(rows), pairs)
        self._on = np.sort((pairs[:, 0] << PAIR_SHIFT) + pairs[:, 1])


def _pairs(keys: Ints) -> list[tuple[int, int]]:
    low = (np.int64(1) << PAIR_SHIFT) - 1
    return list(zip((keys >> PAIR_SHIFT).tolist(), (keys & low).tolist(), strict=True))

"""A sparse route: stretches of edges, one after another."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from .centrelines import Floats, Ints
from .network import Network


@dataclass(frozen=True)
class Route:
    """Stretch ``k`` runs along edge ``edges[k]`` from station ``begin[k]`` to ``end[k]``, all (n,).

    It runs against the edge where ``end`` is less than ``begin``. ``off_start`` and ``off_goal`` are the
    metres from the places that were asked for to the network; ``engine`` says what found the way.
    """

    network: Network
    edges: Ints
    begin: Floats
    end: Floats
    off_start: float
    off_goal: float
    engine: str

    @cached_property
    def lengths(self) -> Floats:
        """Metres of each stretch."""
        lengths: Floats = np.abs(self.end - self.begin)
        return lengths

    @property
    def metres(self) -> float:
        """Metres of the whole route."""
        return float(self.lengths.sum())

    @property
    def seconds(self) -> float:
        """Seconds at the speeds of the roads."""
        return self.seconds_at(np.inf)

    def seconds_at(self, speed: float) -> float:
        """Return the seconds of one that drives at most ``speed`` m/s, and nowhere faster than the road."""
        return float((self.lengths / np.minimum(self.network.edges.speed[self.edges], speed)).sum())

    @property
    def surfaces(self) -> tuple[str, ...]:
        """The surface of each stretch."""
        return tuple(str(surface) for surface in self.network.edges.surface[self.edges])

    @property
    def nodes(self) -> tuple[int, ...]:
        """The n - 1 nodes between the stretches."""
        back = self.end < self.begin
        passed = np.where(back, self.network.tail[self.edges], self.network.head[self.edges])
        return tuple(passed[:-1].tolist())

    @cached_property
    def points(self) -> Floats:
        """The line of the route, (m, 2)."""
        lines = self.lines
        return np.concatenate([lines[0], *(line[1:] for line in lines[1:])])

    @cached_property
    def widths(self) -> Floats:
        """Metres of road along each of the m - 1 pieces of :attr:`points`."""
        widths = self.network.edges.width[self.edges]
        return np.repeat(widths, [len(line) - 1 for line in self.lines])

    @cached_property
    def lines(self) -> list[Floats]:
        """The line of each stretch."""
        line = self.network.edges.line
        spans = zip(self.edges.tolist(), self.begin.tolist(), self.end.tolist(), strict=True)
        return [stretch(line(edge), begin, end) for edge, begin, end in spans]


def stretch(line: Floats, begin: float, end: float) -> Floats:
    """Return ``line``, (n, 2), from station ``begin`` to station ``end``, turned where ``end`` is less."""
    low, high = min(begin, end), max(begin, end)
    stations = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))])
    inner = line[(stations > low + 1e-9) & (stations < high - 1e-9)]
    ends = np.column_stack([np.interp([low, high], stations, line[:, k]) for k in (0, 1)])
    cut: Floats = np.concatenate([ends[:1], inner, ends[1:]])
    return cut[::-1] if end < begin else cut

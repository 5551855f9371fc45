"""What is odd in a road network, each with its place and what can be done."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum

import numpy as np

from ..counting import counted
from .ends import Breaks, Gap, breaks_of, loose_ends
from .network import Network
from .strong_parts import strong_parts


class Kind(Enum):
    """What a finding is about."""

    GAP = "gap"
    OVERSHOOT = "overshoot"
    DUPLICATE = "duplicate"
    DEAD_END = "dead end"
    PART = "disconnected part"
    ONE_WAY = "one-way"


REPAIRED = (Kind.GAP, Kind.OVERSHOOT, Kind.DUPLICATE)
"""What :func:`.repairs.repaired` mends; the others are for people to decide."""


@dataclass(frozen=True)
class Finding:
    """One finding: the place (x, y) in metres and the road it is about, an index of the input.

    ``other`` is the other road where there is one; ``pattern`` says what is odd, with ``{other}`` for it.
    """

    kind: Kind
    x: float
    y: float
    road: int
    pattern: str
    other: int = -1

    @property
    def text(self) -> str:
        """What is odd, with the other road as a number."""
        return self.pattern.format(other=self.other)

    def told(self, names: Sequence[object]) -> str:
        """Return what is odd, with ``names`` for the roads."""
        return self.pattern.format(other=names[self.other] if self.other >= 0 else "")


def find(network: Network, tolerance: float) -> list[Finding]:
    """Return what is odd in ``network``; ends within ``tolerance`` metres of a road were meant to meet it."""
    breaks = breaks_of(network, tolerance)
    return [
        *broken(network, breaks),
        *_dead_ends(network, breaks),
        *_parts(network),
        *_one_way(network),
    ]


def broken(network: Network, breaks: Breaks) -> list[Finding]:
    """Return a finding for each of ``breaks``."""
    return [
        *(_at_edge(network, k, Kind.DUPLICATE, "The road is drawn twice here.") for k in breaks.duplicates),
        *(_overshoot(network, k) for k in breaks.overshoots),
        *(_gap(network, gap) for gap in breaks.gaps),
    ]


def _at_edge(network: Network, edge: int, kind: Kind, text: str) -> Finding:
    line = network.edges.line(edge)
    x, y = (line[(len(line) - 1) // 2] + line[len(line) // 2]) / 2
    return Finding(kind, float(x), float(y), int(network.edges.source[edge]), text)


def _overshoot(network: Network, edge: int) -> Finding:
    over = network.lengths[edge]
    return _at_edge(network, edge, Kind.OVERSHOOT, f"The road ends {over:.3f} m beyond the one it meets.")


def _gap(network: Network, gap: Gap) -> Finding:
    x, y = network.nodes[gap.node]
    text = f"The road ends {gap.metres:.3f} m short of road {{other}}."
    return Finding(Kind.GAP, float(x), float(y), gap.road, text, gap.other)


def _dead_ends(network: Network, breaks: Breaks) -> list[Finding]:
    excused = {gap.node for gap in breaks.gaps}
    over = set(breaks.overshoots.tolist())
    return [
        Finding(
            Kind.DEAD_END,
            float(network.nodes[node, 0]),
            float(network.nodes[node, 1]),
            int(network.edges.source[edge]),
            "The road ends here and meets no other.",
        )
        for node, edge in zip(*(ends.tolist() for ends in loose_ends(network)), strict=True)
        if node not in excused and edge not in over
    ]


def _parts(network: Network) -> list[Finding]:
    """Return a finding for each part but the longest."""
    if not len(network):
        return []
    part, of_edge = np.unique(network.parts[network.tail], return_inverse=True)
    metres = np.bincount(of_edge, network.lengths)
    count = np.bincount(of_edge)
    first = np.unique(of_edge, return_index=True)[1]
    main = int(np.argmax(metres))
    return [
        _at_edge(
            network,
            int(first[k]),
            Kind.PART,
            f"Connected with no other road: {counted(int(count[k]), 'edge')} of {metres[k]:.1f} m.",
        )
        for k in range(len(part))
        if k != main
    ]


def _one_way(network: Network) -> list[Finding]:
    """Return a finding for each edge of which one cannot come back to where one was, or cannot come to."""
    edge, tail, head = network.arcs()
    strong = strong_parts(len(network.nodes), tail, head)
    inside = np.zeros(len(network), bool)
    inside[edge[strong[tail] == strong[head]]] = True
    return [_at_edge(network, int(k), Kind.ONE_WAY, _ONE_WAY) for k in np.flatnonzero(~inside)]


_ONE_WAY = "Who drives along here cannot come back: the directions of the roads allow no way."


def count_by_kind(findings: list[Finding]) -> dict[str, int]:
    """Return how many findings there are of each kind, in the order of the kinds."""
    return {kind.value: sum(one.kind is kind for one in findings) for kind in Kind}

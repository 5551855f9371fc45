"""Ends of roads that miss what they were drawn to meet, and roads drawn twice."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from .box_pairs import boxes_of, touching
from .centrelines import Floats, Ints, ranges
from .network import Network
from .points import foot_on


@dataclass(frozen=True)
class Gap:
    """The end ``node`` of edge ``edge`` is ``metres`` from the point ``to`` of edge ``target``.

    ``road`` and ``other`` are the roads of the two; ``vertex`` is the index of the point of the edges'
    ``xy`` after which ``to`` lies, at ``share`` of the way to the next; None where ``to`` is ``target_node``.
    """

    node: int
    edge: int
    metres: float
    to: tuple[float, float]
    road: int
    other: int
    vertex: int | None
    share: float
    target_node: int | None


@dataclass(frozen=True)
class Breaks:
    """What can be mended: edges drawn twice, edges that reach beyond a junction, and gaps."""

    duplicates: Ints = field(default_factory=lambda: np.empty(0, np.int64))
    overshoots: Ints = field(default_factory=lambda: np.empty(0, np.int64))
    gaps: list[Gap] = field(default_factory=list)

    def any(self) -> bool:
        """Tell whether there is anything to mend."""
        return bool(self.edges() or self.gaps)

    def edges(self) -> list[int]:
        """Return the edges that are to go."""
        return sorted({*self.duplicates.tolist(), *self.overshoots.tolist()})


def breaks_of(network: Network, tolerance: float) -> Breaks:
    """Return what can be mended of ``network``; ends within ``tolerance`` metres of a road meet it."""
    return Breaks(duplicates(network), overshoots(network, tolerance), gaps(network, tolerance))


def loose_ends(network: Network) -> tuple[Ints, Ints]:
    """Return the nodes where only one edge ends, and that edge of each."""
    nodes = np.concatenate([network.tail, network.head])
    edges = np.concatenate([np.arange(len(network))] * 2)
    loose = network.degrees[nodes] == 1
    return nodes[loose], edges[loose]


def overshoots(network: Network, tolerance: float) -> Ints:
    """Return the edges that reach at most ``tolerance`` metres beyond a junction and end there."""
    nodes, edges = loose_ends(network)
    other = network.tail[edges] + network.head[edges] - nodes
    over = (network.lengths[edges] <= tolerance) & (network.degrees[other] >= 3)
    found: Ints = np.unique(edges[over])
    return found


def duplicates(network: Network) -> Ints:
    """Return the edges that run along another of the same level; the first of each is not among them."""
    turned = network.tail > network.head
    key = np.column_stack(
        [
            np.where(turned, network.head, network.tail),
            np.where(turned, network.tail, network.head),
            network.edges.level,
            network.edges.counts(),
        ]
    )
    _, group, size = np.unique(key, axis=0, return_inverse=True, return_counts=True)
    group = group.reshape(-1)
    seen: dict[tuple[int, bytes], int] = {}
    again = []
    for k in np.flatnonzero(size[group] > 1).tolist():
        line = np.round(network.edges.line(k), 3)
        if tuple(line[0]) > tuple(line[-1]):
            line = line[::-1]
        again += [k] if seen.setdefault((int(group[k]), line.tobytes()), k) != k else []
    return np.array(again, dtype=np.int64)


def gaps(network: Network, tolerance: float) -> list[Gap]:
    """Return, for each loose end that is no overshoot, the nearest other road within ``tolerance`` metres."""
    nodes, edges = loose_ends(network)
    meant = ~np.isin(edges, overshoots(network, tolerance))
    nodes, edges = nodes[meant], edges[meant]
    at = ranges(network.edges.first[:-1], network.edges.counts() - 1)
    owner = np.repeat(np.arange(len(network)), network.edges.counts() - 1)
    a, b = network.edges.xy[at], network.edges.xy[at + 1]
    ends = network.nodes[nodes]
    i, j = touching(boxes_of(ends, ends, tolerance), boxes_of(a, b, 0.0))
    level = network.edges.level
    fits = (owner[j] != edges[i]) & (level[owner[j]] == level[edges[i]])
    i, j = i[fits], j[fits]
    share, away = foot_on(a[j], b[j], ends[i])
    near = away <= tolerance
    i, j, share, away = i[near], j[near], share[near], away[near]
    order = np.lexsort([away, i])
    nearest = order[np.unique(i[order], return_index=True)[1]]
    found = []
    for k in nearest.tolist():
        segment = int(j[k])
        foot = a[segment] + share[k] * (b[segment] - a[segment])
        near_end = _nearest_end(network, int(nodes[i[k]]), int(owner[segment]), tolerance)
        place = (int(at[segment]), float(share[k])) if near_end is None else None
        to = foot if near_end is None else network.nodes[near_end]
        end, edge, target = int(nodes[i[k]]), int(edges[i[k]]), int(owner[segment])
        found.append(_gap(network, end, edge, target, to, place, near_end))
    return [gap for gap in found if gap.target_node not in _ends(network, gap.edge)]


def _ends(network: Network, edge: int) -> tuple[int, int]:
    return int(network.tail[edge]), int(network.head[edge])


def _nearest_end(network: Network, node: int, edge: int, tolerance: float) -> int | None:
    """Return the end of ``edge`` within ``tolerance`` of ``node``: two ends were meant to meet there."""
    away = {
        end: float(np.hypot(*(network.nodes[end] - network.nodes[node])))
        for end in _ends(network, edge)
        if end != node
    }
    near = min(away, key=away.__getitem__, default=None)
    return near if near is not None and away[near] <= tolerance else None


def _gap(
    network: Network,
    node: int,
    edge: int,
    target: int,
    to: Floats,
    place: tuple[int, float] | None,
    end: int | None,
) -> Gap:
    vertex, share = place or (None, 0.0)
    return Gap(
        node=node,
        edge=edge,
        metres=float(np.hypot(*(to - network.nodes[node]))),
        to=(float(to[0]), float(to[1])),
        road=int(network.edges.source[edge]),
        other=int(network.edges.source[target]),
        vertex=vertex,
        share=share,
        target_node=end,
    )

"""Defects of a road network, each with its place and remedy, and their repair."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from enum import Enum

import numpy as np

from ..errors import counted
from .network import (
    CancelCheck,
    Centrelines,
    Floats,
    Ints,
    Network,
    boxes_of,
    build_network,
    foot_on,
    network_of,
    never_cancel,
    noded,
    ranges,
    touching,
)

# --- Road ends that miss their intended junction, and roads drawn twice ---


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
    """Repairable defects: edges drawn twice, edges that reach beyond a junction, and gaps."""

    duplicates: Ints = field(default_factory=lambda: np.empty(0, np.int64))
    overshoots: Ints = field(default_factory=lambda: np.empty(0, np.int64))
    gaps: list[Gap] = field(default_factory=list)

    def any(self) -> bool:
        """Return whether there is anything to repair."""
        return bool(self.edges() or self.gaps)

    def edges(self) -> list[int]:
        """Return the edges to remove."""
        return sorted({*self.duplicates.tolist(), *self.overshoots.tolist()})


def breaks_of(network: Network, tolerance: float) -> Breaks:
    """Return the repairable defects of ``network``; ends within ``tolerance`` metres of a road should meet
    it."""
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
        found.append(_gap_of_end(network, end, edge, target, to, place, near_end))
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


def _gap_of_end(
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


# --- Parts of a directed network in which one can drive from every node to every other ---


def strongly_connected_components(count: int, tail: Ints, head: Ints) -> Ints:
    """Return a label for each of ``count`` nodes: two share it when each can be reached from the other.

    Tarjan's algorithm (SIAM Journal on Computing 1, 1972) with a stack of its own.
    """
    order = np.argsort(tail, kind="stable")
    first = np.searchsorted(tail[order], np.arange(count + 1)).tolist()
    return np.array(_Search(count, first, head[order].tolist()).run(), dtype=np.int64)


class _Search:
    def __init__(self, count: int, first: list[int], head: list[int]) -> None:
        self._first, self._head = first, head
        self._number = [0] * count
        self._low = [0] * count
        self._label = [-1] * count
        self._open: list[int] = []
        self._seen = 0

    def run(self) -> list[int]:
        for root in range(len(self._number)):
            if not self._number[root]:
                self._from(root)
        return self._label

    def _from(self, root: int) -> None:
        path = [(root, self._first[root])]
        self._enter(root)
        while path:
            node, arc = path.pop()
            if arc == self._first[node + 1]:
                self._leave(node)
                if path:
                    above = path[-1][0]
                    self._low[above] = min(self._low[above], self._low[node])
                continue
            path.append((node, arc + 1))
            to = self._head[arc]
            if not self._number[to]:
                self._enter(to)
                path.append((to, self._first[to]))
            elif self._label[to] < 0:
                self._low[node] = min(self._low[node], self._number[to])

    def _enter(self, node: int) -> None:
        self._seen += 1
        self._number[node] = self._low[node] = self._seen
        self._open.append(node)

    def _leave(self, node: int) -> None:
        if self._low[node] != self._number[node]:
            return
        while self._label[node] < 0:
            self._label[self._open.pop()] = node


# --- Findings on a road network, each with its place and remedy ---


class RoadFindingKind(Enum):
    """The subject of a finding."""

    GAP = "gap"
    OVERSHOOT = "overshoot"
    DUPLICATE = "duplicate"
    DEAD_END = "dead end"
    PART = "disconnected part"
    ONE_WAY = "one-way"


REPAIRED = (RoadFindingKind.GAP, RoadFindingKind.OVERSHOOT, RoadFindingKind.DUPLICATE)
"""What :func:`.network_checks.repaired` repairs; the others need a human decision."""


@dataclass(frozen=True)
class RoadFinding:
    """One finding: the place (x, y) in metres and the road it is about, an index of the input.

    ``other`` is the other road, if any; ``pattern`` describes the defect, with ``{other}`` for that road.
    """

    kind: RoadFindingKind
    x: float
    y: float
    road: int
    pattern: str
    other: int = -1

    @property
    def text(self) -> str:
        """The description, with the other road as a number."""
        return self.pattern.format(other=self.other)

    def in_words(self, names: Sequence[object]) -> str:
        """Return the description, with ``names`` for the roads."""
        return self.pattern.format(other=names[self.other] if self.other >= 0 else "")


def find_road_defects(network: Network, tolerance: float) -> list[RoadFinding]:
    """Return the defects of ``network``; ends within ``tolerance`` metres of a road were meant to meet it."""
    breaks = breaks_of(network, tolerance)
    return [
        *findings_of_breaks(network, breaks),
        *_dead_ends(network, breaks),
        *_parts(network),
        *_one_way(network),
    ]


def findings_of_breaks(network: Network, breaks: Breaks) -> list[RoadFinding]:
    """Return a finding for each of ``breaks``."""
    return [
        *(
            _at_edge(network, k, RoadFindingKind.DUPLICATE, "The road is drawn twice here.")
            for k in breaks.duplicates
        ),
        *(_overshoot_finding(network, k) for k in breaks.overshoots),
        *(_gap_finding(network, gap) for gap in breaks.gaps),
    ]


def _at_edge(network: Network, edge: int, kind: RoadFindingKind, text: str) -> RoadFinding:
    line = network.edges.line(edge)
    x, y = (line[(len(line) - 1) // 2] + line[len(line) // 2]) / 2
    return RoadFinding(kind, float(x), float(y), int(network.edges.source[edge]), text)


def _overshoot_finding(network: Network, edge: int) -> RoadFinding:
    over = network.lengths[edge]
    return _at_edge(
        network, edge, RoadFindingKind.OVERSHOOT, f"The road ends {over:.3f} m beyond the one it meets."
    )


def _gap_finding(network: Network, gap: Gap) -> RoadFinding:
    x, y = network.nodes[gap.node]
    text = f"The road ends {gap.metres:.3f} m short of road {{other}}."
    return RoadFinding(RoadFindingKind.GAP, float(x), float(y), gap.road, text, gap.other)


def _dead_ends(network: Network, breaks: Breaks) -> list[RoadFinding]:
    excused = {gap.node for gap in breaks.gaps}
    over = set(breaks.overshoots.tolist())
    return [
        RoadFinding(
            RoadFindingKind.DEAD_END,
            float(network.nodes[node, 0]),
            float(network.nodes[node, 1]),
            int(network.edges.source[edge]),
            "The road ends here and meets no other.",
        )
        for node, edge in zip(*(ends.tolist() for ends in loose_ends(network)), strict=True)
        if node not in excused and edge not in over
    ]


def _parts(network: Network) -> list[RoadFinding]:
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
            RoadFindingKind.PART,
            f"Connected with no other road: {counted(int(count[k]), 'edge')} of {metres[k]:.1f} m.",
        )
        for k in range(len(part))
        if k != main
    ]


def _one_way(network: Network) -> list[RoadFinding]:
    """Return a finding for each edge from which there is no way back, or to which there is no way."""
    edge, tail, head = network.arcs()
    strong = strongly_connected_components(len(network.nodes), tail, head)
    inside = np.zeros(len(network), bool)
    inside[edge[strong[tail] == strong[head]]] = True
    return [_at_edge(network, int(k), RoadFindingKind.ONE_WAY, _ONE_WAY) for k in np.flatnonzero(~inside)]


_ONE_WAY = "Who drives along here cannot come back: the directions of the roads allow no way."


def count_by_kind(findings: list[RoadFinding]) -> dict[str, int]:
    """Return how many findings there are of each kind, in the order of the kinds."""
    return {kind.value: sum(one.kind is kind for one in findings) for kind in RoadFindingKind}


# --- Repair of a network whose ends miss their road by little ---

_PASSES = 10
"""Each pass may bring ends within reach of others; real data needs two or three."""


def repaired_network(
    roads: Centrelines, tolerance: float, ask: CancelCheck = never_cancel
) -> tuple[Network, list[RoadFinding]]:
    """Return the network of ``roads`` with defects repaired where possible, and a finding for each repair.

    Ends within ``tolerance`` metres of a road are moved onto it, ends that reach beyond one by less are cut
    off, and of roads drawn twice the first is kept. An exception of ``ask`` between two steps ends the work.
    """
    network = build_network(roads, ask)
    done: list[RoadFinding] = []
    for _ in range(_PASSES):
        ask()
        breaks = breaks_of(network, tolerance)
        if not breaks.any():
            break
        mended, repairs = _mended(network, breaks, ask)
        done += findings_of_breaks(network, repairs)
        network = mended
    return network, done


def _mended(network: Network, breaks: Breaks, ask: CancelCheck) -> tuple[Network, Breaks]:
    """Return the network after one pass, and which of ``breaks`` were repaired in it."""
    if breaks.edges():
        keep = np.setdiff1d(np.arange(len(network)), breaks.edges())
        return network_of(network.edges.taken(keep)), Breaks(breaks.duplicates, breaks.overshoots, [])
    joined = _without_swaps(breaks.gaps)
    return network_of(noded(_joined(network, joined), ask)), Breaks(gaps=joined)


def _without_swaps(gaps: list[Gap]) -> list[Gap]:
    """Return the gaps to close now: of two ends meant to meet only one moves."""
    moved: set[int] = set()
    held: set[int] = set()
    now = []
    for gap in gaps:
        if gap.node in held or gap.target_node in moved:
            continue
        moved.add(gap.node)
        if gap.target_node is not None:
            held.add(gap.target_node)
        now.append(gap)
    return now


def _joined(network: Network, gaps: list[Gap]) -> Centrelines:
    """Return the edges with the loose ends of ``gaps`` moved, and with points at their new places."""
    edges = network.edges
    xy, counts = edges.xy.copy(), edges.counts().copy()
    after, points = [], []
    for gap in gaps:
        at_tail = network.tail[gap.edge] == gap.node
        xy[edges.first[gap.edge] if at_tail else edges.first[gap.edge + 1] - 1] = gap.to
        if gap.vertex is not None:
            after.append((gap.vertex, gap.share))
            points.append(gap.to)
    order = sorted(range(len(after)), key=after.__getitem__)
    vertices = np.array([after[k][0] for k in order], dtype=np.int64)
    if len(vertices):
        xy = np.insert(xy, vertices + 1, np.array([points[k] for k in order]), axis=0)
        owner = np.searchsorted(edges.first, vertices, side="right") - 1
        counts += np.bincount(owner, minlength=len(edges))
    first = np.concatenate([[0], np.cumsum(counts)])
    return edges.with_lines(xy, first, np.arange(len(edges)))

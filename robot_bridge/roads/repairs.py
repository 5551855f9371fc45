"""A network mended where ends miss their road by little."""

from __future__ import annotations

import numpy as np

from .asking import Ask, go_on
from .centrelines import Centrelines
from .ends import Breaks, Gap, breaks_of
from .findings import Finding, broken
from .network import Network, build_network, network_of
from .noding import noded

_PASSES = 10
"""Each pass may bring ends within reach of others; real data needs two or three."""


def repaired_network(roads: Centrelines, tolerance: float, ask: Ask = go_on) -> tuple[Network, list[Finding]]:
    """Return the network of ``roads`` with what could be mended mended, and a finding for each repair.

    Ends within ``tolerance`` metres of a road are moved onto it, ends that reach beyond one by less are cut
    off, and of roads drawn twice the first is kept. What ``ask`` raises between two steps ends the work.
    """
    network = build_network(roads, ask)
    done: list[Finding] = []
    for _ in range(_PASSES):
        ask()
        breaks = breaks_of(network, tolerance)
        if not breaks.any():
            break
        mended, told = _mended(network, breaks, ask)
        done += broken(network, told)
        network = mended
    return network, done


def _mended(network: Network, breaks: Breaks, ask: Ask) -> tuple[Network, Breaks]:
    """Return the network after one pass, and which of ``breaks`` were mended in it."""
    if breaks.edges():
        keep = np.setdiff1d(np.arange(len(network)), breaks.edges())
        return network_of(network.edges.taken(keep)), Breaks(breaks.duplicates, breaks.overshoots, [])
    joined = _without_swaps(breaks.gaps)
    return network_of(noded(_joined(network, joined), ask)), Breaks(gaps=joined)


def _without_swaps(gaps: list[Gap]) -> list[Gap]:
    """Return the gaps to close now: of two ends that were drawn to meet only one moves."""
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
    """Return the edges with the loose ends of ``gaps`` moved, and points where they come to lie."""
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

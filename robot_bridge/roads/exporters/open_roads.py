"""The part of a network that is written: open roads, none of which ends where it begins."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace

import numpy as np

from ..centrelines import Floats, Ints
from ..errors import RoadExportError
from ..network import Network


def open_roads(network: Network, closed: Collection[int] = ()) -> Network:
    """Return the open edges of ``network`` but ``closed``, and the nodes that they have.

    Rings become two edges: formats that know an edge by its nodes cannot say which way round it is driven.

    :raises RoadExportError: when no edge is open.
    """
    keep = ~network.edges.closed
    keep[list(closed)] = False
    kept = np.flatnonzero(keep)
    if not len(kept):
        raise RoadExportError(
            f"None of the {len(network)} edges of the road network is open: open a road, or leave out areas "
            "that must not be driven through."
        )
    used, ends = np.unique(np.concatenate([network.tail[kept], network.head[kept]]), return_inverse=True)
    ends = ends.reshape(-1).astype(np.int64)
    edges = network.edges.taken(kept)
    return _without_rings(Network(network.nodes[used], edges, ends[: len(kept)], ends[len(kept) :]))


def moved(network: Network, nodes: Floats, xy: Floats) -> Network:
    """Return ``network`` with its ``nodes`` and the points ``xy`` of its lines in another frame."""
    return replace(network, nodes=nodes, edges=replace(network.edges, xy=xy))


def _without_rings(network: Network) -> Network:
    rings = np.flatnonzero(network.tail == network.head)
    if not len(rings):
        return network
    edges = network.edges
    middles = edges.first[rings] + edges.counts()[rings] // 2
    # The middle point stands twice: at the end of the first half and at the beginning of the second.
    points = np.sort(np.concatenate([np.arange(len(edges.xy)), middles]))
    repeats = np.ones(len(edges), dtype=np.int64)
    repeats[rings] = 2
    of = np.repeat(np.arange(len(edges)), repeats)
    first = _firsts(edges.first, middles)
    new = len(network.nodes) + np.arange(len(rings))
    tail, head = network.tail[of], network.head[of]
    second_halves = np.flatnonzero(np.diff(of, prepend=-1) == 0)
    tail[second_halves], head[second_halves - 1] = new, new
    nodes = np.concatenate([network.nodes, edges.xy[middles]])
    return Network(nodes, edges.with_lines(edges.xy[points], first, of), tail, head)


def _firsts(first: Ints, middles: Ints) -> Ints:
    """Return where lines begin once each of the points ``middles`` ends one line and begins another."""
    shifted = first + np.searchsorted(middles, first)
    starts = middles + 1 + np.arange(len(middles))
    merged: Ints = np.sort(np.concatenate([shifted, starts]))
    return merged

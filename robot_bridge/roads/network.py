"""The road network: edges between nodes."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from .asking import Ask, go_on
from .centrelines import BACKWARD, FORWARD, Centrelines, Floats, Ints
from .noding import noded
from .points import connected


@dataclass(frozen=True)
class Network:
    """``n`` nodes, (n, 2) metres in the site frame, and the edges between them.

    Edge ``k`` is line ``k`` of ``edges``, from node ``tail[k]`` to node ``head[k]``; its ``source`` is the
    index of the road that it is a piece of.
    """

    nodes: Floats
    edges: Centrelines
    tail: Ints
    head: Ints

    def __len__(self) -> int:
        return len(self.tail)

    @cached_property
    def lengths(self) -> Floats:
        """Metres of each edge."""
        return self.edges.lengths()

    @cached_property
    def degrees(self) -> Ints:
        """How many ends of edges each node has."""
        return np.bincount(np.concatenate([self.tail, self.head]), minlength=len(self.nodes))

    @cached_property
    def parts(self) -> Ints:
        """The part that each node belongs to, as the least index of its nodes, whatever the directions."""
        return connected(len(self.nodes), self.tail, self.head)

    def arcs(self) -> tuple[Ints, Ints, Ints]:
        """Return what may be driven: edge, from node, to node; first along the edges, then against them."""
        there = np.flatnonzero(self.edges.direction != BACKWARD)
        back = np.flatnonzero(self.edges.direction != FORWARD)
        return (
            np.concatenate([there, back]),
            np.concatenate([self.tail[there], self.head[back]]),
            np.concatenate([self.head[there], self.tail[back]]),
        )


def network_of(pieces: Centrelines) -> Network:
    """Return the network of ``pieces`` that meet at their ends, as :func:`noded` returns them."""
    ends = np.concatenate([pieces.xy[pieces.first[:-1]], pieces.xy[pieces.first[1:] - 1]])
    nodes, index = np.unique(ends, axis=0, return_inverse=True)
    index = index.reshape(-1).astype(np.int64)
    return Network(nodes.reshape(-1, 2), pieces, index[: len(pieces)], index[len(pieces) :])


def build_network(roads: Centrelines, ask: Ask = go_on) -> Network:
    """Return the network of ``roads`` as they are: split where they meet, nothing repaired.

    What ``ask`` raises between two steps ends the work.
    """
    return network_of(noded(roads, ask))

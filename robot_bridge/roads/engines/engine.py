"""What a search for routes needs of an engine."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from ..centrelines import Floats, Ints

Ends = Sequence[tuple[int, float]]
"""Nodes with what it costs to come from the start to each, or from each to the goal."""


@dataclass(frozen=True)
class Graph:
    """A directed graph: arc ``k`` leads from node ``tail[k]`` to node ``head[k]``; ``nodes`` is (n, 2)."""

    nodes: Floats
    tail: Ints
    head: Ints


class Engine(Protocol):
    """Finds cheapest ways on one graph under one set of costs, which may change arc by arc."""

    name: str
    """What people are told was used."""

    def set_costs(self, arcs: Ints, costs: Floats) -> None:
        """Give ``arcs`` other costs, above 0; infinity closes one."""

    def way(self, starts: Ends, goals: Ends) -> list[int] | None:
        """Return the arcs of the cheapest way from any of ``starts`` to any of ``goals``; None for none.

        A way may be empty: from a node that is both.
        """


def cheapest_of_parallel(graph: Graph, costs: Floats) -> Ints:
    """Return, of the arcs that lead from one node to the same other, the cheapest one each."""
    order = np.lexsort([costs, graph.head, graph.tail])
    tail, head = graph.tail[order], graph.head[order]
    new = np.ones(len(order), bool)
    new[1:] = (tail[1:] != tail[:-1]) | (head[1:] != head[:-1])
    best: Ints = order[new]
    return best

"""Parts of a directed network in which one can drive from every node to every other."""

from __future__ import annotations

import numpy as np

from .centrelines import Ints


def strong_parts(count: int, tail: Ints, head: Ints) -> Ints:
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

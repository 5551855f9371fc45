"""Spatial index of a layer of a GeoPackage, made at once.

SQLite puts every box into its place by itself, which takes longer than to write the features. Its tables hold
plain numbers (https://www.sqlite.org/rtree.html, 6), and GDAL 3.8 and newer write them like this, too.
"""

from __future__ import annotations

import math
import sqlite3
from itertools import pairwise

import numpy as np

_BOXES = 100_000
"""Features whose boxes are in memory together."""
_ENTRY = np.dtype([("id", ">i8"), ("box", ">f4", 4)])
_NODE_HEAD = 4
"""Bytes of the depth, which the root has, and of the number of entries."""
_STEP = 1 / (1 << 23)
"""What a number is changed by to be rounded another way, times itself."""


class BoxTree:
    """Fills the R-tree ``table``, which is empty, with boxes of rows 1, 2 and so on.

    ``packed`` is to write its nodes; else SQLite does, which alone may where it is so strict.
    """

    def __init__(self, database: sqlite3.Connection, table: str, packed: bool | None = None) -> None:
        self._database, self._table = database, table
        (root,) = database.execute(f'SELECT data FROM "{table}_node" WHERE nodeno = 1').fetchone()  # nosec B608 # names
        self._node_bytes = len(root)
        self._fits = (len(root) - _NODE_HEAD) // _ENTRY.itemsize
        self._packed = self._may_pack() if packed is None else packed
        self._waiting: list[np.ndarray] = []
        self._count = 0
        self._last_node = 1
        self._leaves: list[np.ndarray] = []
        self._low, self._high = np.full(2, np.inf), np.full(2, -np.inf)

    @property
    def extent(self) -> list[float] | None:
        """x_min, y_min, x_max and y_max of all boxes, None where there are none."""
        return [*self._low.tolist(), *self._high.tolist()] if self._count else None

    def add(self, boxes: np.ndarray) -> None:
        """Add the boxes of the next rows: (n, 4), x_min, y_min, x_max and y_max; raises sqlite3.Error."""
        self._low = np.minimum(self._low, boxes[:, :2].min(axis=0))
        self._high = np.maximum(self._high, boxes[:, 2:].max(axis=0))
        self._waiting.append(boxes)
        self._count += len(boxes)
        if sum(map(len, self._waiting)) >= _BOXES:
            self._add_waiting()

    def end(self) -> None:
        """Put the rest in its place; raises sqlite3.Error."""
        if not self._packed:
            self._add_waiting()
            return
        depth, kind, nodes = 0, "rowid", self._entries() if self._count <= self._fits else None
        if nodes is None:
            self._add_waiting()
            depth, kind, nodes = 1, "parent", np.concatenate(self._leaves)
        while len(nodes) > self._fits:
            depth, nodes = depth + 1, self._nodes_of(nodes, kind)
        self._write(1, nodes, np.array([len(nodes)]), depth)
        self._insert(kind, nodes["id"], np.full(len(nodes), 1))

    def _may_pack(self) -> bool:
        try:
            self._database.execute(f'UPDATE "{self._table}_node" SET data = data WHERE nodeno = 0')  # nosec B608 # names
        except sqlite3.DatabaseError:
            return False
        return True

    def _add_waiting(self) -> None:
        entries = self._entries()
        if not len(entries):
            return
        if self._packed:
            self._leaves.append(self._nodes_of(entries, "rowid"))
        else:
            rows = zip(entries["id"].tolist(), *entries["box"].T.tolist(), strict=True)
            self._database.executemany(f'INSERT INTO "{self._table}" VALUES (?, ?, ?, ?, ?)', rows)  # nosec B608 # names

    def _entries(self) -> np.ndarray:
        """Return the boxes that wait with their rows, and forget them."""
        boxes = np.concatenate([np.empty((0, 4)), *self._waiting])
        self._waiting = []
        entries = np.empty(len(boxes), _ENTRY)
        entries["id"] = np.arange(self._count - len(boxes), self._count) + 1
        entries["box"] = _outwards(boxes)
        return entries

    def _nodes_of(self, entries: np.ndarray, kind: str) -> np.ndarray:
        """Write ``entries`` into nodes, neighbours together, and return those as entries of the next ones.

        In which node each is goes into the table of ``kind``. No node has much less in it than others.
        """
        entries = entries[_neighbours(entries["box"], self._fits)]
        count = math.ceil(len(entries) / self._fits)
        edges = np.arange(count + 1) * len(entries) // count
        numbers = self._last_node + 1 + np.arange(count)
        self._last_node += count
        self._write(int(numbers[0]), entries, np.diff(edges), 0)
        self._insert(kind, entries["id"], np.repeat(numbers, np.diff(edges)))
        made = np.empty(count, _ENTRY)
        made["id"] = numbers
        for side, joined in enumerate((np.minimum, np.maximum, np.minimum, np.maximum)):
            made["box"][:, side] = joined.reduceat(entries["box"][:, side].astype(np.float32), edges[:-1])
        return made

    def _write(self, first: int, entries: np.ndarray, counts: np.ndarray, depth: int) -> None:
        """Write ``entries`` into nodes from ``first`` on, of which each gets some: ``counts``, (n,)."""
        heads = np.column_stack([np.full(len(counts), depth), counts]).astype(">u2").tobytes()
        data, width = np.ascontiguousarray(entries, _ENTRY).tobytes(), _ENTRY.itemsize
        edges = np.concatenate([[0], np.cumsum(counts)]).tolist()
        nodes = (
            (
                first + k,
                (heads[k * _NODE_HEAD : (k + 1) * _NODE_HEAD] + data[low * width : high * width]).ljust(
                    self._node_bytes, b"\0"
                ),
            )
            for k, (low, high) in enumerate(pairwise(edges))
        )
        self._database.executemany(f'INSERT OR REPLACE INTO "{self._table}_node" VALUES (?, ?)', nodes)  # nosec B608 # names

    def _insert(self, kind: str, ids: np.ndarray, nodes: np.ndarray) -> None:
        order = np.argsort(ids)
        rows = zip(ids[order].tolist(), nodes[order].tolist(), strict=True)
        self._database.executemany(f'INSERT INTO "{self._table}_{kind}" VALUES (?, ?)', rows)  # nosec B608 # names


def _outwards(boxes: np.ndarray) -> np.ndarray:
    """Return x_min, x_max, y_min and y_max as float32, (n, 4), rounded as SQLite does: no box is smaller."""
    rounded = np.empty((len(boxes), 4), np.float32)
    for side, (column, away) in enumerate(((0, -1), (2, 1), (1, -1), (3, 1))):
        exact = boxes[:, column]
        near = exact.astype(np.float32)
        further = (exact * (1 + away * np.sign(exact) * _STEP)).astype(np.float32)
        rounded[:, side] = np.where(away * (near - exact) < 0, further, near)
    return rounded


def _neighbours(boxes: np.ndarray, fits: int) -> np.ndarray:
    """Return the order in which each ``fits`` of ``boxes``, as :func:`_outwards` has them, lie together.

    Sort-tile-recursive: strips by x, which are cut by y (Leutenegger and others, ICDE 1997).
    """
    x, y = (boxes[:, side].astype(np.float64) + boxes[:, side + 1] for side in (0, 2))
    strips = math.ceil(math.sqrt(math.ceil(len(boxes) / fits)))
    order = np.argsort(x, kind="stable")
    strip = np.arange(len(boxes)) // (fits * math.ceil(len(boxes) / fits / strips))
    return order[np.lexsort((y[order], strip))]

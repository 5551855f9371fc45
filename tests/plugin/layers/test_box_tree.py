"""The spatial index of a published layer: written at once, and to SQLite and GDAL one of their own."""

from __future__ import annotations

import sqlite3
from contextlib import closing

import numpy as np
import pytest
from fleet_supervisor.plugin.layers.publishing.site_file import BoxTree

FITS = 51
"""Boxes in a node of SQLite's, at the usual size of a page."""


def boxes_of(count, seed=1):
    chance = np.random.default_rng(seed)
    low = np.column_stack([chance.uniform(-5e5, 5e5, count), chance.uniform(-1, 6e6, count)])
    return np.hstack([low, low + chance.uniform(0, 30, (count, 2))])


@pytest.fixture
def tree():
    """Make a tree of boxes in a database of its own, which is returned."""
    with closing(sqlite3.connect(":memory:", isolation_level=None)) as database:

        def make(boxes, name="tree", at_once=1000, **given):
            database.execute(f"CREATE VIRTUAL TABLE {name} USING rtree(id, minx, maxx, miny, maxy)")
            made = BoxTree(database, name, **given)
            for first in range(0, len(boxes), at_once):
                made.add(boxes[first : first + at_once])
            made.end()
            return database

        yield make


def rows_of(database, name="tree"):
    return database.execute(f"SELECT * FROM {name} ORDER BY id").fetchall()


def ids_in(database, x, y, side):
    window = "SELECT id FROM tree WHERE maxx >= ? AND minx <= ? AND maxy >= ? AND miny <= ? ORDER BY id"
    return [id for (id,) in database.execute(window, [x, x + side, y, y + side])]


@pytest.mark.parametrize("count", [0, 1, FITS, FITS + 1, FITS**2, FITS**2 + 1])
def test_a_tree_holds_what_sqlite_would_have_put_there(tree, count):
    boxes = boxes_of(count)
    tree(boxes, "theirs", packed=False)
    database = tree(boxes)
    assert rows_of(database) == rows_of(database, "theirs")
    assert len(rows_of(database)) == count
    assert database.execute("SELECT rtreecheck('tree')").fetchone() == ("ok",)


def test_a_city_is_found_by_place_and_few_nodes_are_read_for_that(tree):
    boxes = boxes_of(100_002)
    database = tree(boxes, at_once=50_000)
    assert database.execute("SELECT rtreecheck('tree')").fetchone() == ("ok",)
    x, y, side = 1e5, 3e6, 2e4
    there = (boxes[:, 2:] >= (x, y)).all(axis=1) & (boxes[:, :2] <= (x + side, y + side)).all(axis=1)
    assert ids_in(database, x, y, side) == (np.flatnonzero(there) + 1).tolist() != []
    (nodes,) = database.execute("SELECT count(*) FROM tree_node").fetchone()
    assert nodes < len(boxes) / FITS * 1.05
    # Those that came behind the first many have a node of their own, with next to nothing in it.
    database.execute("DELETE FROM tree WHERE id >= 100001")
    assert database.execute("SELECT rtreecheck('tree')").fetchone() == ("ok",)


def test_a_tree_can_be_changed(tree):
    database = tree(boxes_of(5000))
    database.execute("DELETE FROM tree WHERE id % 3 = 0")
    database.executemany(
        "INSERT INTO tree VALUES (?, ?, ?, ?, ?)", [(k, k, k, k, k) for k in range(9000, 9500)]
    )
    assert database.execute("SELECT rtreecheck('tree')").fetchone() == ("ok",)
    assert ids_in(database, 9100, 9100, 0.5) == [9100]


def test_the_extent_is_exact(tree):
    boxes = boxes_of(300)
    with closing(sqlite3.connect(":memory:")) as database:
        database.execute("CREATE VIRTUAL TABLE tree USING rtree(id, minx, maxx, miny, maxy)")
        made = BoxTree(database, "tree")
        assert made.extent is None
        made.add(boxes)
        assert made.extent == [*boxes[:, :2].min(axis=0), *boxes[:, 2:].max(axis=0)]

"""Edges that lead through areas that nobody may drive into."""

from __future__ import annotations

from collections.abc import Sequence

from .centrelines import Floats, Ints
from .network import Network


def edges_through(network: Network, areas: Sequence[Sequence[Floats]]) -> Ints:
    """Return the edges that come into one of ``areas``, each an outer ring and its holes, (n, 2) each.

    :raises ImportError: where shapely is not installed.
    """
    import numpy as np
    import shapely

    if not len(network) or not areas:
        return np.empty(0, np.int64)
    index = np.repeat(np.arange(len(network)), network.edges.counts())
    lines = shapely.linestrings(network.edges.xy, indices=index)
    polygons = [shapely.make_valid(shapely.Polygon(outer, holes)) for outer, *holes in areas]
    tree = shapely.STRtree(polygons)
    # What runs along the rim neither crosses an area nor is within it.
    found = [tree.query(lines, predicate=predicate)[0] for predicate in ("crosses", "within")]
    through: Ints = np.unique(np.concatenate(found)).astype(np.int64)
    return through

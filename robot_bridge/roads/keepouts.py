"""Areas that nobody may drive into: which edges, places and paths come into them."""

from __future__ import annotations

from collections.abc import Sequence

from ..polyline import Track
from .centrelines import Floats, Ints
from .network import Network


class KeepoutIndex:
    """Finds what comes into one of ``areas``, each an outer ring and its holes, (n, 2) each.

    What runs along the rim of an area, or stands on it, does not come into it.

    :raises ImportError: where shapely is not installed.
    """

    def __init__(self, areas: Sequence[Sequence[Floats]]) -> None:
        import shapely

        self._tree = shapely.STRtree(
            [shapely.make_valid(shapely.Polygon(outer, holes)) for outer, *holes in areas]
        )

    def entered(self, tracks: Sequence[Track]) -> dict[int, int]:
        """Return the numbers of those of ``tracks`` that come into an area, each with the area's lowest."""
        import shapely

        found = self._entries([shapely.LineString(t) if len(t) > 1 else shapely.Point(t[0]) for t in tracks])
        return dict(sorted(found.T.tolist(), reverse=True))

    def between_ends(self, path: Track) -> int | None:
        """Return the number of an area that ``path`` comes into and that holds neither end of it, or None.

        Whoever is in an area has to come out of it, and whoever was sent into one has to come there.
        """
        import numpy as np
        import shapely

        through = self._entries([shapely.LineString(path)])[1]
        of_ends = self._entries([shapely.Point(path[0]), shapely.Point(path[-1])])[1]
        crossed = np.setdiff1d(through, of_ends)
        return int(crossed[0]) if len(crossed) else None

    def edges_through(self, network: Network) -> Ints:
        """Return the edges of ``network`` that come into an area, each once."""
        import numpy as np
        import shapely

        index = np.repeat(np.arange(len(network)), network.edges.counts())
        through: Ints = np.unique(self._entries(shapely.linestrings(network.edges.xy, indices=index))[0])
        return through.astype(np.int64)

    def _entries(self, geometries: Sequence[object]) -> Ints:
        """Return the numbers of what comes into areas, and those of the areas, (2, n)."""
        import numpy as np

        found = [self._tree.query(geometries, predicate=predicate) for predicate in ("crosses", "within")]
        entries: Ints = np.concatenate(found, axis=1)
        return entries

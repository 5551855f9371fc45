"""A real city whose roads are exported, and ways on it to hold the exported graphs against."""

from __future__ import annotations

import networkx
import numpy as np
import pyogrio.raw
import pytest
import shapely

from robot_bridge.core.roads.network import Network, build_network, centrelines
from robot_bridge.core.roads.routes import Restrictions, Router


@pytest.fixture(scope="session")
def helsinki(data) -> Network:
    """The centre of Helsinki with its one-way roads and levels."""
    file = data / "osm" / "helsinki_centre_utm35n.gpkg"
    meta, _, shapes, columns = pyogrio.raw.read(file, layer="roads", columns=["oneway", "layer"])
    fields = dict(zip(meta["fields"], columns, strict=True))
    rows = zip(shapely.from_wkb(shapes), fields["oneway"], fields["layer"], strict=True)
    parts = [(line, way, level) for shape, way, level in rows for line in shapely.get_parts(shape)]
    lines, ways, levels = zip(*parts, strict=True)
    random = np.random.default_rng(2)
    roads = centrelines(
        [shapely.get_coordinates(line) for line in lines],
        direction=[{"yes": 1, "-1": -1}.get(way, 0) for way in ways],
        level=[int(level or 0) for level in levels],
        speed=random.uniform(1.0, 9.0, len(lines)),
        closed=random.random(len(lines)) < 0.05,
    )
    return build_network(roads)


@pytest.fixture(scope="session")
def compared(helsinki):
    """Hold ways in a graph, whose nodes have ``xy``, against the project's own; return how many."""
    router = Router(helsinki)
    open_ends = helsinki.tail[~helsinki.edges.closed]
    starts, goals = np.split(np.random.default_rng(16).choice(open_ends, 44), [4])

    def compare(graph: networkx.MultiDiGraph, by: str) -> int:
        places = {tuple(np.round(xy, 6)): node for node, xy in graph.nodes(data="xy")}
        count = 0
        for start in helsinki.nodes[starts].tolist():
            node = places[tuple(np.round(start, 6))]
            found = networkx.single_source_dijkstra_path_length(graph, node, None, by)
            for goal in helsinki.nodes[goals].tolist():
                node = places[tuple(np.round(goal, 6))]
                if node in found:
                    count += 1
                    route = router.route(tuple(start), tuple(goal), Restrictions(fastest=by == "seconds"))
                    assert getattr(route, by) == pytest.approx(found[node], abs=1e-3)
        return count

    return compare

"""Real roads: Malta's network and the lanes of ZalaZONE's university track."""

from __future__ import annotations

import networkx
import numpy as np
import pytest
import shapely

from benchmarks.road_data import malta, track, track_surface
from robot_bridge.core.errors import NoRouteError
from robot_bridge.core.roads.network import build_network
from robot_bridge.core.roads.network_checks import count_by_kind, find_road_defects, repaired_network
from robot_bridge.core.roads.path_smoothing import Driving, dense_path
from robot_bridge.core.roads.routes import Router


def test_malta_has_the_lengths_that_networkx_finds(data):
    roads = malta(data)
    network = build_network(roads)
    assert network.lengths.sum() == pytest.approx(roads.lengths().sum(), rel=1e-9)
    graph = networkx.MultiDiGraph()
    for edge, tail, head in zip(*(column.tolist() for column in network.arcs()), strict=True):
        graph.add_edge(tail, head, weight=float(network.lengths[edge]))
    router = Router(network)
    random = np.random.default_rng(11)
    compared = 0
    for start in random.choice(network.tail, 2).tolist():
        lengths = networkx.single_source_dijkstra_path_length(graph, start)
        for goal in random.choice(network.head, 25).tolist():
            there = tuple(network.nodes[start]), tuple(network.nodes[goal])
            if goal not in lengths:
                with pytest.raises(NoRouteError):
                    router.route(*there)
                continue
            compared += 1
            assert router.route(*there).metres == pytest.approx(lengths[goal], abs=1e-6)
    assert compared > 25


def test_what_is_broken_on_the_track_is_repaired(data):
    roads = track(data)
    found = count_by_kind(find_road_defects(build_network(roads), 0.5))
    assert found == {
        "gap": 4,
        "overshoot": 2,
        "duplicate": 1,
        "dead end": 2,
        "disconnected part": 1,
        "one-way": 13,
    }
    network, done = repaired_network(roads, 0.5)
    repaired = {kind: count for kind, count in count_by_kind(done).items() if count}
    assert repaired == {"gap": 4, "overshoot": 2, "duplicate": 3}
    left = {kind: count for kind, count in count_by_kind(find_road_defects(network, 0.5)).items() if count}
    assert left == {"dead end": 2, "one-way": 10}


def test_routes_on_the_track_stay_on_its_digitised_surface(data):
    surface = track_surface(data)
    network, _ = repaired_network(track(data), 0.5)
    router = Router(network)
    random = np.random.default_rng(6)
    driven = 0
    lowest, highest = surface.bounds[:2], surface.bounds[2:]
    shapely.prepare(surface)
    while driven < 300:
        pair = random.uniform(lowest, highest, (2, 2))
        if not shapely.contains_xy(surface, pair).all():
            continue
        try:
            route = router.route(*map(tuple, pair.tolist()))
        except NoRouteError:
            continue
        driven += 1
        path = dense_path(route.points, route.widths, Driving())
        assert shapely.difference(shapely.LineString(path.points), surface).length < 0.1

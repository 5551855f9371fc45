"""Which edges a path runs along, and which closed roads are found again on another network."""

from __future__ import annotations

import numpy as np
import pytest

from robot_bridge.core.roads.map_matching import NearestEdge, edges_along, edges_of_closure
from robot_bridge.core.roads.network import build_network, centrelines
from robot_bridge.core.roads.routes import Router


def network(*lines, **attributes):
    return build_network(centrelines([np.array(line, float) for line in lines], **attributes))


def ends(net, edges):
    """Return the edges by their ends, the lesser first."""
    found = (net.edges.line(edge)[[0, -1]].tolist() for edge in edges)
    return sorted(tuple(sorted(map(tuple, pair))) for pair in found)


CROSS = [(0, 0), (20, 0)], [(10, -10), (10, 10)]


def along(net, *points, **how):
    return ends(net, edges_along(NearestEdge(net), np.array(points, float), **how))


def test_a_path_runs_along_what_it_shares_its_direction_with_and_not_along_what_it_crosses():
    net = network(*CROSS, width=4.0)
    assert along(net, (1, 0.5), (19, -0.5)) == [((0.0, 0.0), (10.0, 0.0)), ((10.0, 0.0), (20.0, 0.0))]
    assert along(net, (2, 0), (10, 0), (10, 8)) == [((0.0, 0.0), (10.0, 0.0)), ((10.0, 0.0), (10.0, 10.0))]
    assert along(net, (2, -8), (2, 8)) == []
    assert along(net, (5, 8), (15, 8)) == []


def test_a_path_beside_the_road_is_not_on_it():
    net = network([(0, 0), (20, 0)], width=4.0)
    assert along(net, (0, 1.9), (20, 1.9)) != []
    assert along(net, (0, 2.1), (20, 2.1)) == []


def test_of_two_roads_that_part_slowly_the_nearer_counts():
    net = network([(0, 0), (40, 0)], [(0, 0), (40, 10)], width=6.0)
    assert along(net, (0, 0), (40, 10)) == [((0.0, 0.0), (40.0, 10.0))]
    assert along(net, (0, 0), (40, 0)) == [((0.0, 0.0), (40.0, 0.0))]


def test_only_those_asked_for_are_returned_and_a_touch_is_none():
    net = network(*CROSS, width=4.0)
    first = np.zeros(len(net), bool)
    first[0] = True
    assert len(along(net, (1, 0), (19, 0), among=first)) == 1
    assert along(net, (0, 0), (10.4, 0)) == [((0.0, 0.0), (10.0, 0.0))]


def test_a_path_without_length_runs_along_nothing():
    net = network(*CROSS)
    assert along(net, (1, 0), (1, 0)) == []


@pytest.mark.parametrize("seed", range(8))
def test_the_edges_of_random_routes_are_found_again_from_their_points(seed):
    random = np.random.default_rng(seed)
    grid = [[(0, 20 * k), (100, 20 * k)] for k in range(6)] + [[(20 * k, 0), (20 * k, 100)] for k in range(6)]
    net = network(*grid, width=4.0)
    router = Router(net, "plain")
    for _ in range(10):
        route = router.route(*map(tuple, random.uniform(0, 100, (2, 2))))
        driven = set(route.edges[route.lengths > 1.5].tolist())
        found = set(edges_along(NearestEdge(net), route.points).tolist())
        assert driven <= found
        assert found <= set(route.edges.tolist())


def test_a_closure_is_found_where_its_road_was_split_joined_or_moved_a_little():
    line = np.array([(10.0, 0.0), (20.0, 0.0)])
    across = ([(x, -5), (x, 5)] for x in (10, 15, 20))
    split = network([(0, 0), (30, 0)], *across, width=4.0)
    assert ends(split, edges_of_closure(NearestEdge(split), line, 0)) == [
        ((10.0, 0.0), (15.0, 0.0)),
        ((15.0, 0.0), (20.0, 0.0)),
    ]
    whole = network([(0, 0.3), (30, 0.3)], width=4.0)
    assert len(edges_of_closure(NearestEdge(whole), line, 0)) == 1


def test_a_closure_is_not_found_on_another_level_or_where_the_road_is_gone():
    line = np.array([(10.0, 0.0), (20.0, 0.0)])
    bridge = network([(0, 0), (30, 0)], width=4.0, level=1)
    assert len(edges_of_closure(NearestEdge(bridge), line, 0)) == 0
    assert len(edges_of_closure(NearestEdge(bridge), line, 1)) == 1
    assert len(edges_of_closure(NearestEdge(network([(0, 5), (30, 5)], width=4.0)), line, 0)) == 0


def test_edges_to_be_avoided_are_avoided_for_one_route_but_for_those_of_start_and_goal():
    square = [(0, 0), (50, 0), (50, 50), (0, 50), (0, 0)]
    net = network(*(square[k : k + 2] for k in range(4)), width=4.0)
    for engine in ("plain", "scipy", "contraction"):
        router = Router(net, engine)
        south = edges_along(NearestEdge(net), np.array([(0.0, 0.0), (50.0, 0.0)])).tolist()
        there = (0.0, 10.0), (50.0, 10.0)
        assert router.route(*there).metres == pytest.approx(70.0)
        assert router.route(*there, avoid=south).metres == pytest.approx(130.0)
        assert router.route(*there).metres == pytest.approx(70.0)
        assert router.route((10.0, 0.0), (40.0, 0.0), avoid=south).metres == pytest.approx(30.0)

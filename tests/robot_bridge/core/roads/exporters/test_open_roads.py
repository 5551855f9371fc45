"""What of a network is written for others."""

from __future__ import annotations

import numpy as np
import pytest

from robot_bridge.core.errors import RoadExportError
from robot_bridge.core.roads.graph_export import open_roads
from robot_bridge.core.roads.network import build_network, centrelines

CROSS = [[(0, 0), (10, 0)], [(10, 0), (10, 10)], [(10, 0), (20, 5)]]


def test_closed_roads_and_their_nodes_are_left_out():
    network = build_network(centrelines(CROSS, width=[3, 4, 5], closed=[False, True, False]))
    written = open_roads(network)
    assert written.edges.width.tolist() == [3, 5]
    assert sorted(map(tuple, written.nodes.tolist())) == [(0, 0), (10, 0), (20, 5)]
    ends = np.stack([written.nodes[written.tail], written.nodes[written.head]], axis=1)
    assert ends.tolist() == [[[0, 0], [10, 0]], [[10, 0], [20, 5]]]


def test_edges_that_the_caller_closes_are_left_out_too():
    network = build_network(centrelines(CROSS, width=[3, 4, 5]))
    assert open_roads(network, [0]).edges.width.tolist() == [4, 5]


def test_nothing_open_is_refused():
    network = build_network(centrelines(CROSS, closed=True))
    with pytest.raises(RoadExportError, match="None of the 3 edges"):
        open_roads(network)


def test_rings_become_two_edges_as_long_as_they_were():
    rings = [[(10, 0), (14, 0), (14, 4), (10, 0)], [(0, 0), (-4, 0), (-4, -4), (0, -4), (0, 0)]]
    roads = centrelines([rings[0], [(0, 0), (10, 0)], rings[1]], width=[1, 2, 3])
    network = build_network(roads)
    assert (network.tail == network.head).sum() == 2
    written = open_roads(network)
    assert not (written.tail == written.head).any()
    assert written.edges.width.tolist() == [1, 1, 2, 3, 3]
    assert written.lengths.sum() == pytest.approx(network.lengths.sum(), abs=1e-9)
    for k in range(len(written)):
        line = written.edges.line(k)
        assert line[0].tolist() == written.nodes[written.tail[k]].tolist()
        assert line[-1].tolist() == written.nodes[written.head[k]].tolist()
    joined = np.concatenate([written.edges.line(0), written.edges.line(1)[1:]])
    assert joined.tolist() == [list(map(float, point)) for point in rings[0]]

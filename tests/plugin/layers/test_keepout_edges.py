"""Roads through keepouts as QGIS finds them, held against shapely."""

from __future__ import annotations

import numpy as np
import pytest
from fleet_supervisor.plugin.layers.road_layers import edges_through
from fleet_supervisor.robot_bridge.core.roads.network import build_network, centrelines
from fleet_supervisor.robot_bridge.core.sites.fences import KeepoutIndex

pytestmark = pytest.mark.usefixtures("qgis_app")


def network_of(lines):
    many = len(lines)
    return build_network(
        centrelines(
            [np.array(line, dtype=float) for line in lines],
            width=[4.0] * many, surface=["asphalt"] * many, direction=[0] * many, speed=[5.0] * many,
            closed=[False] * many, level=[0] * many,
        )
    )  # fmt: skip


def box(x, y, width, height):
    return np.array([(x, y), (x + width, y), (x + width, y + height), (x, y + height), (x, y)], dtype=float)


def test_a_road_into_an_area_is_found_and_one_along_its_rim_or_in_its_hole_is_not():
    network = network_of(
        [[(0, 5), (20, 5)], [(0, 10), (20, 10)], [(4.5, 5.5), (5.5, 5.5)], [(30, 0), (40, 0)]]
    )
    area = [box(2, 2, 8, 8)]
    with_hole = [box(2, 2, 8, 8), box(4, 5.2, 2, 2)]
    crossing = edges_through(network, [area])
    assert {tuple(network.edges.line(edge)[0]) for edge in crossing} == {(0, 5), (4.5, 5.5)}
    crossing = edges_through(network, [with_hole])
    assert {tuple(network.edges.line(edge)[0]) for edge in crossing} == {(0, 5)}
    assert edges_through(network, []) == []


def test_the_same_roads_are_found_as_by_shapely():
    dice = np.random.default_rng(3)
    lines = [np.cumsum(dice.normal(0, 6, (5, 2)), axis=0) + dice.uniform(0, 100, 2) for _ in range(150)]
    network = network_of(lines)
    areas = [[box(*dice.uniform(0, 90, 2), *dice.uniform(3, 20, 2))] for _ in range(12)]
    found = edges_through(network, areas)
    assert found == KeepoutIndex(areas).edges_through(network).tolist()
    assert len(found) > 10

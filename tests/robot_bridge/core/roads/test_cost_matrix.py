"""The matrix costs what the router's routes cost, between all places at once."""

from __future__ import annotations

import math
import sys

import numpy as np
import pytest

from robot_bridge.core.errors import NoRouteError
from robot_bridge.core.roads.cost_matrix import road_matrix
from robot_bridge.core.roads.network import BOTH, Network, build_network, centrelines
from robot_bridge.core.roads.routes import Restrictions, Router


def town(seed: int) -> Network:
    """Return a grid of streets of which some are one-way, closed, narrow, of gravel, or missing."""
    rng = np.random.default_rng(seed)
    spots = [(i, j) for i in range(6) for j in range(6)]
    lines = [[(10.0 * i, 10.0 * j), (10.0 * i + 10, 10.0 * j)] for i, j in spots if i < 5]
    lines += [[(10.0 * i, 10.0 * j), (10.0 * i, 10.0 * j + 10)] for i, j in spots if j < 5]
    lines = [line for line in lines if rng.uniform() > 0.15]
    count = len(lines)
    return build_network(
        centrelines(
            lines,
            width=rng.choice([2.0, 4.0], count, p=[0.1, 0.9]),
            surface=rng.choice(["asphalt", "gravel"], count, p=[0.9, 0.1]),
            direction=rng.choice([BOTH, BOTH, 1, -1], count),
            speed=rng.uniform(1, 5, count),
            closed=rng.uniform(size=count) < 0.05,
        )
    )


@pytest.mark.parametrize("by_heap", [False, True])
@pytest.mark.parametrize(
    "wanted", [Restrictions(), Restrictions(True), Restrictions(False, frozenset({"asphalt"}), 3.0)]
)
def test_it_costs_what_routes_cost(
    wanted: Restrictions, by_heap: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    if by_heap:
        monkeypatch.setitem(sys.modules, "scipy.sparse", None)
    for seed in range(4):
        network = town(seed)
        places = [tuple(place) for place in np.random.default_rng(seed).uniform(-3, 53, (14, 2)).tolist()]
        # On a node, twice on one edge, and twice the same.
        places += [(10.0, 10.0), (3.0, 0.2), (7.0, 0.4), (7.0, 0.4)]
        router = Router(network, "plain")
        found = road_matrix(network, places, wanted)
        assert found.engine == ("Dijkstra in Python" if by_heap else "SciPy")
        for i, a in enumerate(places):
            for j, b in enumerate(places):
                try:
                    route = router.route(a, b, wanted)
                except NoRouteError:
                    assert math.isinf(found.costs[i, j])
                    continue
                cost = route.seconds if wanted.fastest else route.metres
                assert found.costs[i, j] == pytest.approx(cost, abs=1e-6)
                assert found.away[i] == pytest.approx(route.off_start)


def test_what_is_closed_now_counts() -> None:
    network = town(1)
    router = Router(network, "plain")
    router.close(range(0, len(network), 7))
    places = [(5.0, 5.0), (45.0, 45.0), (25.0, 5.0)]
    costs = road_matrix(network, places, closed=router.closed).costs
    assert not np.array_equal(costs, road_matrix(network, places).costs)
    for i, a in enumerate(places):
        for j, b in enumerate(places):
            if np.isfinite(costs[i, j]):
                assert costs[i, j] == pytest.approx(router.route(a, b).metres, abs=1e-6)


def test_a_place_off_the_network_is_marked() -> None:
    found = road_matrix(town(1), [(5.0, 0.0), (500.0, 0.0)], reach=30.0)
    assert np.isinf(found.away).tolist() == [False, True]
    assert np.isinf(found.costs).tolist() == [[False, True], [True, True]]


def test_whoever_waits_may_end_it() -> None:
    class EndedError(Exception):
        pass

    def progress(share: float) -> None:
        raise EndedError

    with pytest.raises(EndedError):
        road_matrix(town(1), [(5.0, 5.0), (45.0, 45.0)], progress=progress)

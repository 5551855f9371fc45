"""The nearest point of the edges is the one that looking at every segment finds."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robot_bridge.core.roads.map_matching import NearestEdge
from robot_bridge.core.roads.network import build_network, centrelines, foot_on


@given(st.integers(0, 2**32 - 1), st.sampled_from([3.0, 20.0, 400.0]))
@settings(max_examples=60, deadline=None)
def test_of_random_roads_no_other_point_is_nearer(seed: int, reach: float) -> None:
    random = np.random.default_rng(seed)
    lines = [100 * random.uniform(0, 1, 2) + random.uniform(-9, 9, (4, 2)) for _ in range(12)]
    network = build_network(centrelines([line.tolist() for line in lines]))
    allowed = random.uniform(size=len(network)) < 0.7
    x, y = random.uniform(-60, 160, 2).tolist()
    found = NearestEdge(network).nearest(x, y, reach, allowed)

    drawn = {k: network.edges.line(k) for k in np.flatnonzero(allowed).tolist()}
    away = {k: foot_on(line[:-1], line[1:], np.array([x, y]))[1].min() for k, line in drawn.items()}
    if not away or min(away.values()) > reach:
        assert found is None
        return
    assert found is not None
    assert found.away == pytest.approx(min(away.values()))
    assert found.away == pytest.approx(away[found.edge])
    assert np.hypot(found.x - x, found.y - y) == pytest.approx(found.away)
    stations = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(drawn[found.edge], axis=0).T))])
    at = [np.interp(found.station, stations, drawn[found.edge][:, k]) for k in (0, 1)]
    assert at == pytest.approx([found.x, found.y])

"""Routes are the shortest there are, on every engine, and honour what is closed or too narrow."""

from __future__ import annotations

import math
import sys

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from robot_bridge.core.errors import MissingEngineError, NoRouteError, OffNetworkError
from robot_bridge.core.roads.engines import ENGINES, RouteGraph, engines_for
from robot_bridge.core.roads.network import BOTH, FORWARD, Network, build_network, centrelines
from robot_bridge.core.roads.routes import Restrictions, Router
from robot_bridge.core.sites.fences import KeepoutIndex

NAMES = [name for name in ENGINES if name != "automatic"]
SQUARE = [
    [(0.0, 0.0), (10.0, 0.0)],
    [(10.0, 0.0), (10.0, 10.0)],
    [(10.0, 10.0), (0.0, 10.0)],
    [(0.0, 10.0), (0.0, 0.0)],
]


def square(**attributes: object) -> Network:
    """Return a square of 10 m; its edges are numbered from the south on, counter-clockwise."""
    return build_network(centrelines(SQUARE, **attributes))


@pytest.fixture(params=NAMES)
def engine(request: pytest.FixtureRequest) -> str:
    needed = {"contraction": "routingkit_cch", "scipy": "scipy", "plain": "heapq"}
    pytest.importorskip(needed[request.param])
    return request.param


def test_a_route_starts_and_ends_in_the_middle_of_edges(engine: str) -> None:
    route = Router(square(), engine).route((4.0, -1.0), (11.0, 7.0))
    assert route.metres == pytest.approx(13.0)
    assert route.points.tolist() == [[4.0, 0.0], [10.0, 0.0], [10.0, 7.0]]
    assert (route.edges.tolist(), route.lengths.tolist()) == ([0, 1], [6.0, 7.0])
    assert (route.off_start, route.off_goal) == (1.0, 1.0)
    assert square().nodes[list(route.nodes)].tolist() == [[10.0, 0.0]]


def test_the_other_way_round_is_taken_when_it_is_shorter(engine: str) -> None:
    route = Router(square(), engine).route((2.0, 0.0), (4.0, 10.0))
    assert route.points.tolist() == [[2.0, 0.0], [0.0, 0.0], [0.0, 10.0], [4.0, 10.0]]


def test_along_one_edge_no_node_is_passed(engine: str) -> None:
    route = Router(square(), engine).route((7.0, 0.0), (3.0, 0.0))
    assert route.points.tolist() == [[7.0, 0.0], [3.0, 0.0]]
    assert route.nodes == ()


def test_against_a_one_way_road_one_drives_all_the_way_round(engine: str) -> None:
    router = Router(square(direction=FORWARD), engine)
    assert router.route((3.0, 0.0), (7.0, 0.0)).metres == pytest.approx(4.0)
    assert router.route((7.0, 0.0), (3.0, 0.0)).metres == pytest.approx(36.0)


def test_a_one_way_loop_of_one_edge_is_driven_round(engine: str) -> None:
    loop = [(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0), (0.0, 0.0)]
    router = Router(build_network(centrelines([loop], direction=FORWARD)), engine)
    assert router.route((1.0, 0.0), (0.0, 1.0)).metres == pytest.approx(38.0)
    assert router.route((0.0, 1.0), (1.0, 0.0)).metres == pytest.approx(2.0)


def test_from_a_place_to_itself_is_nothing(engine: str) -> None:
    route = Router(square(direction=FORWARD), engine).route((3.0, 1.0), (3.0, 1.0))
    assert route.metres == 0.0


def test_a_node_is_left_by_any_of_its_roads(engine: str) -> None:
    router = Router(square(direction=FORWARD), engine)
    assert router.route((10.0, 0.0), (10.0, 5.0)).metres == pytest.approx(5.0)
    assert router.route((5.0, 0.0), (10.0, 0.0)).metres == pytest.approx(5.0)


def test_fastest_and_shortest_differ(engine: str) -> None:
    router = Router(square(speed=[1.0, 1.0, 9.0, 9.0]), engine)
    there = (0.0, 0.0), (10.0, 9.0)
    shortest = router.route(*there)
    fastest = router.route(*there, Restrictions(fastest=True))
    assert (shortest.metres, shortest.seconds) == pytest.approx((19.0, 19.0))
    assert (fastest.metres, fastest.seconds) == pytest.approx((21.0, 20 / 9 + 1))


def test_a_closed_edge_is_driven_round_at_once_and_opened_again(engine: str) -> None:
    router = Router(square(), engine)
    there = (0.0, 0.0), (10.0, 10.0)
    before = router.route(*there).edges.tolist()
    router.close([before[0]])
    assert before[0] not in router.route(*there).edges
    router.close([k for k in range(4) if k != before[0]])
    with pytest.raises(OffNetworkError):
        router.route(*there)
    router.open(range(4))
    assert router.route(*there).metres == pytest.approx(20.0)


def test_a_road_that_is_too_narrow_stays_so_when_it_is_opened_again(engine: str) -> None:
    router = Router(square(width=[2, 9, 9, 9]), engine)
    there, wide = ((5.0, 0.0), (5.0, 10.0)), Restrictions(least_width=3.0)
    assert router.route(*there, wide, reach=6.0).off_start == pytest.approx(5.0)
    router.close([0, 1])
    router.open([0, 1])
    assert router.route(*there, wide, reach=6.0).off_start == pytest.approx(5.0)
    assert router.route(*there).off_start == 0.0


def test_roads_closed_from_the_beginning_are_not_used(engine: str) -> None:
    router = Router(square(closed=[True, False, False, False]), engine)
    assert router.route((0.0, 0.0), (10.0, 0.0)).metres == pytest.approx(30.0)


def test_surfaces_and_widths_restrict(engine: str) -> None:
    router = Router(square(surface=["slippery", "asphalt", "asphalt", "asphalt"], width=[9, 9, 2, 9]), engine)
    there = (0.0, 2.0), (10.0, 2.0)
    asphalt = router.route(*there, Restrictions(surfaces=frozenset({"asphalt"})))
    assert asphalt.metres == pytest.approx(26.0)
    assert set(asphalt.surfaces) == {"asphalt"}
    assert router.route(*there, Restrictions(least_width=3.0)).surfaces == ("asphalt", "slippery", "asphalt")
    with pytest.raises(NoRouteError, match="closed roads, one-way roads, surfaces and widths"):
        router.route(*there, Restrictions(surfaces=frozenset({"asphalt"}), least_width=3.0))


def test_places_far_from_roads_are_refused_by_name_and_distance(engine: str) -> None:
    router = Router(square(), engine)
    with pytest.raises(OffNetworkError, match=r"The goal \(31.00, 5.00\) is more than 20 m from every road"):
        router.route((0.0, 0.0), (31.0, 5.0))
    assert router.route((0.0, 0.0), (31.0, 5.0), reach=21.0).off_goal == pytest.approx(21.0)
    with pytest.raises(OffNetworkError, match="start"):
        router.route((math.nan, 0.0), (31.0, 5.0))


def test_parts_without_a_way_between_them_have_no_route(engine: str) -> None:
    network = build_network(centrelines([*SQUARE, [(0.0, 50.0), (10.0, 50.0)]]))
    with pytest.raises(NoRouteError, match=r"from \(0.00, 0.00\) to \(0.00, 50.00\)"):
        Router(network, engine).route((0.0, 0.0), (0.0, 50.0))


def test_the_route_says_which_engine_found_it(engine: str) -> None:
    names = {"contraction": "contraction hierarchies (RoutingKit)", "scipy": "SciPy"}
    wanted = names.get(engine, "Dijkstra in Python")
    assert Router(square(), engine).route((0.0, 0.0), (5.0, 0.0)).engine == wanted


def test_where_no_engines_package_is_installed_python_searches(monkeypatch: pytest.MonkeyPatch) -> None:
    for module in ("routingkit_cch", "scipy.sparse.csgraph"):
        monkeypatch.setitem(sys.modules, module, None)
    assert Router(square()).route((0.0, 0.0), (5.0, 0.0)).engine == "Dijkstra in Python"
    with pytest.raises(MissingEngineError, match=r"'scipy' .* install it with 'pip install scipy'"):
        Router(square(), "scipy")


def test_an_engine_that_is_none_is_refused() -> None:
    with pytest.raises(MissingEngineError, match="choose of automatic, contraction, scipy, plain"):
        engines_for(RouteGraph(np.zeros((1, 2)), np.empty(0, int), np.empty(0, int)), "magic")


@pytest.mark.parametrize(
    ("roads", "wanted", "why"),
    [
        ({"closed": True}, {}, "is closed"),
        ({"width": 2.0}, {"least_width": 2.5}, "is 2 m wide, narrower than 2.5 m"),
        ({"surface": "sand"}, {"surfaces": frozenset({"asphalt"})}, "has another surface, sand"),
        ({"surface": ""}, {"surfaces": frozenset({"asphalt"})}, "has another surface, none"),
    ],
)
def test_it_is_said_why_the_road_that_is_near_may_not_be_used(roads, wanted, why) -> None:
    line = [np.array([(0.0, 0.0), (10.0, 0.0)])]
    router = Router(build_network(centrelines(line, **roads)))
    with pytest.raises(OffNetworkError, match=rf"may be used \(the road 1\.0 m away {why}\): choose"):
        router.route((5.0, 1.0), (9.0, 0.0), Restrictions(**wanted))
    with pytest.raises(OffNetworkError, match="from every road that may be used: choose"):
        router.route((5.0, 100.0), (9.0, 0.0), Restrictions(**wanted))


def test_edges_through_an_area_are_found_and_those_along_it_are_not() -> None:
    area = np.array([(4.0, -1.0), (6.0, -1.0), (6.0, 1.0), (4.0, 1.0), (4.0, -1.0)])
    beside = np.array([(10.0, 2.0), (12.0, 2.0), (12.0, 4.0), (10.0, 4.0), (10.0, 2.0)])
    assert KeepoutIndex([[area], [beside]]).edges_through(square()).tolist() == [0]


@pytest.mark.parametrize(
    ("track", "enters"),
    [
        ([(5.0, 5.0)], True),
        ([(0.0, 5.0)], False),
        ([(20.0, 5.0)], False),
        ([(5.0, 2.5)], False),
        ([(-5.0, 5.0), (15.0, 5.0)], True),
        ([(-5.0, 5.0), (1.0, 5.0)], True),
        ([(4.0, 1.0), (6.0, 1.0)], True),
        ([(-5.0, 0.0), (15.0, 0.0)], False),
        ([(4.0, 2.5), (6.0, 2.5)], False),
        ([(1.0, 1.0), (1.0, 1.0)], True),
    ],
)
def test_what_comes_into_a_keepout_is_told_from_what_is_on_its_rim_or_in_its_hole(track, enters) -> None:
    outer = np.array([(0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0), (0.0, 0.0)])
    hole = np.array([(3.0, 2.0), (7.0, 2.0), (7.0, 3.0), (3.0, 3.0), (3.0, 2.0)])
    elsewhere = outer + 100.0
    index = KeepoutIndex([[elsewhere], [outer, hole]])
    assert index.entered([[(50.0, 50.0)], track]) == ({1: 1} if enters else {})


def test_without_keepouts_nothing_comes_into_one() -> None:
    assert KeepoutIndex([]).entered([[(0.0, 0.0)]]) == {}
    assert KeepoutIndex([]).edges_through(square()).tolist() == []


@settings(max_examples=40, deadline=None)
@given(seed=st.integers(0, 10**6), ways=st.sampled_from([BOTH, None]))
def test_random_networks_have_the_lengths_that_networkx_finds(seed: int, ways: int | None) -> None:
    networkx = pytest.importorskip("networkx")
    random = np.random.default_rng(seed)
    lines = [random.uniform(0, 100, (int(random.integers(2, 4)), 2)) for _ in range(12)]
    direction = BOTH if ways == BOTH else random.integers(-1, 2, 12)
    network = build_network(centrelines(lines, direction=direction))
    graph = networkx.MultiDiGraph()
    for edge, tail, head in zip(*network.arcs(), strict=True):
        graph.add_edge(tail, head, weight=float(network.lengths[edge]))
    routers = [Router(network, name) for name in NAMES]
    for _ in range(5):
        a, b = random.integers(0, len(network.nodes), 2)
        there = tuple(network.nodes[a]), tuple(network.nodes[b])
        try:
            wanted = networkx.dijkstra_path_length(graph, a, b)
        except (networkx.NetworkXNoPath, networkx.NodeNotFound):
            wanted = None
        for router in routers:
            if wanted is None:
                with pytest.raises(NoRouteError):
                    router.route(*there)
                continue
            route = router.route(*there)
            assert route.metres == pytest.approx(wanted, abs=1e-6 + 2e-4 * len(route.edges))
            assert np.hypot(*np.diff(route.points, axis=0).T).sum() == pytest.approx(route.metres)
            assert len(route.widths) == len(route.points) - 1


def test_a_way_too_long_to_be_counted_in_tenths_of_a_millimetre_is_found(engine: str) -> None:
    far = [[(0.0, 0.0), (200_000.0, 0.0)], [(200_000.0, 0.0), (400_000.0, 0.0)], [(0.0, 9.0), (9.0, 9.0)]]
    router = Router(build_network(centrelines(far, direction=FORWARD)), engine)
    assert router.route((0.0, 0.0), (400_000.0, 0.0)).metres == pytest.approx(400_000.0)
    with pytest.raises(NoRouteError):
        router.route((400_000.0, 0.0), (0.0, 0.0))
    router.close([1])
    with pytest.raises(OffNetworkError):
        router.route((0.0, 0.0), (400_000.0, 0.0))

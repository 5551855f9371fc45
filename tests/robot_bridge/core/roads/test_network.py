"""Roads become a network that is topologically right: every case is drawn by hand."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from robot_bridge.core.errors import RoadInputError
from robot_bridge.core.roads.network import (
    BOTH,
    FORWARD,
    SAME,
    CancelCheck,
    Centrelines,
    Network,
    build_network,
    centrelines,
)
from robot_bridge.core.roads.network_checks import (
    RoadFinding,
    RoadFindingKind,
    count_by_kind,
    find_road_defects,
    repaired_network,
)

EAST = [(0.0, 0.0), (10.0, 0.0)]
NORTH = [(5.0, -5.0), (5.0, 5.0)]


def edges(network: Network) -> set[frozenset[tuple[float, float]]]:
    """Return the ends of each edge, to the millimetre."""
    nodes = [tuple(np.round(node, 3).tolist()) for node in network.nodes]
    return {frozenset((nodes[a], nodes[b])) for a, b in zip(network.tail, network.head, strict=True)}


def kinds(findings: list[RoadFinding]) -> list[str]:
    return sorted({finding.kind.value for finding in findings})


def only(findings: list[RoadFinding], kind: RoadFindingKind) -> RoadFinding:
    (found,) = [finding for finding in findings if finding.kind is kind]
    return found


def ring(centre: tuple[float, float], radius: float) -> list[tuple[float, float]]:
    around = np.linspace(0, 2 * np.pi, 33)
    return [(centre[0] + radius * np.cos(a), centre[1] + radius * np.sin(a)) for a in around]


def test_crossing_roads_are_split_where_they_cross() -> None:
    network = build_network(centrelines([EAST, NORTH]))
    middle = (5.0, 0.0)
    assert edges(network) == {
        frozenset((middle, end)) for end in [(0.0, 0.0), (10.0, 0.0), (5.0, -5.0), (5.0, 5.0)]
    }
    assert network.edges.source.tolist() == [0, 0, 1, 1]
    assert network.lengths.tolist() == pytest.approx([5.0] * 4)


def test_a_road_that_ends_on_another_splits_it() -> None:
    network = build_network(centrelines([EAST, [(5.0, 0.0), (5.0, 5.0)]]))
    assert edges(network) == {frozenset(((5.0, 0.0), end)) for end in [(0.0, 0.0), (10.0, 0.0), (5.0, 5.0)]}


def test_roads_meet_in_a_vertex_that_both_have() -> None:
    bent = [(0.0, 3.0), (5.0, 0.0), (10.0, 3.0)]
    network = build_network(centrelines([[(0.0, 0.0), (5.0, 0.0), (10.0, 0.0)], bent]))
    assert len(network) == 4
    assert sorted(network.degrees.tolist()) == [1, 1, 1, 1, 4]


def test_a_bridge_passes_over_a_road() -> None:
    network = build_network(centrelines([EAST, NORTH], level=[0, 1]))
    assert len(network) == 2
    assert len(set(network.parts.tolist())) == 2


def test_a_bridge_is_reached_at_its_ends() -> None:
    roads = [[(5.0, -9.0), (5.0, -5.0)], NORTH, [(5.0, 5.0), (5.0, 9.0)], EAST]
    network = build_network(centrelines(roads, level=[0, 1, 0, 0]))
    assert len(network) == 4
    assert sorted(network.degrees.tolist()) == [1, 1, 1, 1, 2, 2]


def test_a_bridge_may_begin_in_the_middle_of_a_road() -> None:
    through = [(0.0, 0.0), (5.0, 0.0), (10.0, 0.0)]
    network = build_network(centrelines([through, [(5.0, 0.0), (5.0, 9.0)]], level=[0, 1]))
    assert len(network) == 3
    over = build_network(centrelines([through, [(5.0, -9.0), (5.0, 0.0), (5.0, 9.0)]], level=[0, 1]))
    assert len(over) == 2


def test_a_roundabout_is_split_at_its_arms() -> None:
    roads = [ring((0.0, 0.0), 5.0), [(5.0, 0.0), (20.0, 0.0)], [(-5.0, 0.0), (-20.0, 0.0)]]
    network = build_network(centrelines(roads, direction=[FORWARD, BOTH, BOTH]))
    assert len(network) == 4
    assert sorted(network.degrees.tolist()) == [1, 1, 3, 3]
    halves = network.lengths[network.edges.source == 0]
    assert halves.tolist() == pytest.approx([halves.sum() / 2] * 2)
    assert kinds(find_road_defects(network, 0.5)) == ["dead end"]


def test_a_road_that_crosses_itself_is_split() -> None:
    eight = [(0.0, 0.0), (10.0, 10.0), (10.0, 0.0), (0.0, 10.0)]
    network = build_network(centrelines([eight]))
    assert sorted(network.degrees.tolist()) == [1, 1, 4]


def test_roads_that_run_along_one_another_share_their_nodes() -> None:
    network = build_network(centrelines([EAST, [(4.0, 0.0), (20.0, 0.0)]]))
    assert edges(network) == {
        frozenset(pair)
        for pair in [((0.0, 0.0), (4.0, 0.0)), ((4.0, 0.0), (10.0, 0.0)), ((10.0, 0.0), (20.0, 0.0))]
    }
    assert only(find_road_defects(network, 0.5), RoadFindingKind.DUPLICATE).road == 1


def test_ends_a_hair_apart_are_one_node() -> None:
    network = build_network(centrelines([EAST, [(10.0005, 0.0), (20.0, 0.0)]]))
    assert sorted(network.degrees.tolist()) == [1, 1, 2]


def test_repeated_points_and_roads_without_length_vanish() -> None:
    dot = [(3.0, 3.0), (3.0, 3.0)]
    network = build_network(centrelines([dot, [(0.0, 0.0), (0.0, 0.0), (10.0, 0.0), (10.0, 0.0)]]))
    assert network.edges.source.tolist() == [1]
    assert network.edges.line(0).tolist() == [[0.0, 0.0], [10.0, 0.0]]


def test_nothing_makes_an_empty_network() -> None:
    assert len(build_network(centrelines([]))) == 0
    assert find_road_defects(build_network(centrelines([])), 0.5) == []


def test_an_end_short_of_a_road_is_a_gap_and_closed_on_request() -> None:
    roads = centrelines([EAST, [(5.0, 0.3), (5.0, 5.0)]])
    network = build_network(roads)
    gap = only(find_road_defects(network, 0.5), RoadFindingKind.GAP)
    assert (gap.x, gap.y, gap.road) == (5.0, 0.3, 1)
    assert "0.300 m short of road 0" in gap.text
    assert len(network) == 2
    mended, done = repaired_network(roads, 0.5)
    assert kinds(done) == ["gap"]
    assert len(mended) == 3
    assert kinds(find_road_defects(mended, 0.5)) == ["dead end"]


def test_an_end_farther_than_the_tolerance_is_left_alone() -> None:
    mended, done = repaired_network(centrelines([EAST, [(5.0, 0.6), (5.0, 5.0)]]), 0.5)
    assert done == []
    assert kinds(find_road_defects(mended, 0.5)) == ["dead end", "disconnected part"]


def test_two_ends_that_were_meant_to_meet_meet_once() -> None:
    mended, done = repaired_network(centrelines([EAST, [(10.3, 0.0), (20.0, 0.0)]]), 0.5)
    assert count_by_kind(done)["gap"] == 1
    assert sorted(mended.degrees.tolist()) == [1, 1, 2]


def test_an_end_under_a_bridge_is_no_gap() -> None:
    roads = centrelines([EAST, [(5.0, 0.3), (5.0, 5.0)]], level=[1, 0])
    assert RoadFindingKind.GAP not in {
        finding.kind for finding in find_road_defects(build_network(roads), 0.5)
    }


def test_an_end_beyond_a_road_is_an_overshoot_and_cut_off_on_request() -> None:
    roads = centrelines([EAST, [(5.0, -0.2), (5.0, 5.0)]])
    assert "0.200 m" in only(find_road_defects(build_network(roads), 0.5), RoadFindingKind.OVERSHOOT).text
    mended, done = repaired_network(roads, 0.5)
    assert kinds(done) == ["overshoot"]
    assert len(mended) == 3
    assert mended.lengths.sum() == pytest.approx(15.0)


def test_of_roads_drawn_twice_the_first_is_kept() -> None:
    roads = centrelines([EAST, EAST[::-1]], width=[3.0, 4.0])
    mended, done = repaired_network(roads, 0.5)
    assert kinds(done) == ["duplicate"]
    assert mended.edges.width.tolist() == [3.0]


def test_a_part_of_its_own_is_found_with_its_length() -> None:
    found = find_road_defects(build_network(centrelines([EAST, [(0.0, 50.0), (4.0, 50.0)]])), 0.5)
    part = only(found, RoadFindingKind.PART)
    assert (part.x, part.y) == (2.0, 50.0)
    assert "1 edge of 4.0 m" in part.text


def test_a_one_way_loop_can_be_driven_round_and_a_one_way_spur_not() -> None:
    loop = ring((0.0, 0.0), 5.0)
    assert kinds(find_road_defects(build_network(centrelines([loop], direction=FORWARD)), 0.5)) == []
    spur = [(5.0, 0.0), (20.0, 0.0)]
    network = build_network(centrelines([loop, spur], direction=FORWARD))
    found = find_road_defects(network, 0.5)
    assert only(found, RoadFindingKind.ONE_WAY).road == 1
    assert kinds(found) == ["dead end", "one-way"]


def test_a_one_way_road_has_one_arc_in_its_direction() -> None:
    network = build_network(centrelines([EAST, EAST, EAST], direction=[1, -1, 0], level=[0, 1, 2]))
    edge, tail, head = network.arcs()
    west = int(np.argmin(network.nodes[:, 0]))
    driven = sorted(zip(edge.tolist(), (tail == west).tolist(), (head == west).tolist(), strict=True))
    assert driven == [(0, True, False), (1, False, True), (2, False, True), (2, True, False)]


@pytest.mark.parametrize(
    ("lines", "given", "told"),
    [
        ([EAST, [(1.0, 1.0)]], {}, "Road 1 has the shape (1, 2)"),
        ([EAST, [(1.0, 1.0), (np.nan, 2.0)]], {}, "Road 1 has a coordinate that is no number"),
        ([EAST, NORTH], {"width": [3.0, 0.0]}, "The width of road 1 is 0"),
        ([EAST], {"speed": np.inf}, "The speed of road 0 is inf"),
        ([EAST], {"direction": 2}, "The direction of road 0 is 2"),
    ],
)
def test_what_is_no_road_is_refused_by_its_number(lines: list, given: dict, told: str) -> None:
    with pytest.raises(RoadInputError, match=told.replace("(", r"\(").replace(")", r"\)")):
        centrelines(lines, **given)


def test_no_metre_of_random_roads_is_lost_and_no_two_edges_cross() -> None:
    shapely = pytest.importorskip("shapely")
    random = np.random.default_rng(5)
    lines = [random.uniform(0, 100, (int(random.integers(2, 6)), 2)) for _ in range(40)]
    roads: Centrelines = centrelines(lines)
    network = build_network(roads)
    assert network.lengths.sum() == pytest.approx(roads.lengths().sum(), rel=1e-9)
    drawn = [shapely.LineString(network.edges.line(k)) for k in range(len(network))]
    tree = shapely.STRtree(drawn)
    i, j = tree.query(drawn, predicate="intersects")
    for a, b in zip(i[i < j], j[i < j], strict=True):
        shared = {*drawn[a].boundary.geoms} & {*drawn[b].boundary.geoms}
        meet = shapely.intersection(drawn[a], drawn[b])
        assert shapely.difference(meet, shapely.buffer(shapely.MultiPoint(list(shared)), 1e-6)).is_empty
    union = shapely.union_all([shapely.LineString(line) for line in lines])
    assert len(network) == int((shapely.length(shapely.get_parts(union)) > SAME).sum())


class GivenUpError(Exception):
    """What whoever waits raises."""


def test_making_and_mending_end_at_whichever_question_says_so() -> None:
    roads = centrelines([EAST, [(10.3, 0.0), (20.0, 0.0)], [(5.0, -0.2), (5.0, 5.0)]])

    def asked_of(making: Callable[[CancelCheck], object], last: float = np.inf) -> int:
        asked = 0

        def ask() -> None:
            nonlocal asked
            asked += 1
            if asked >= last:
                raise GivenUpError

        if last == np.inf:
            making(ask)
        else:
            with pytest.raises(GivenUpError):
                making(ask)
        return asked

    built = asked_of(lambda ask: build_network(roads, ask))
    mended = asked_of(lambda ask: repaired_network(roads, 0.5, ask))
    # Two passes mend something, by noding once more, and one finds nothing.
    assert (built, mended) == (6, 6 + 1 + 1 + 6 + 1)
    for last in range(1, mended + 1):
        assert asked_of(lambda ask: repaired_network(roads, 0.5, ask), last) == last

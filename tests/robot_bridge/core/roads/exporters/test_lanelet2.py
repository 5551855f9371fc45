"""Lanelet2 maps, read by Lanelet2 itself, whose routing graph is held against the network."""

from __future__ import annotations

import numpy as np
import pyproj
import pytest
import shapely

from robot_bridge.core.errors import RoadExportError
from robot_bridge.core.roads.graph_export import open_roads
from robot_bridge.core.roads.lanelet2_export import Lane, Lanes, lanes_of, misread_places
from robot_bridge.core.roads.lanelet2_export import lanelet2_document as written
from robot_bridge.core.roads.network import BACKWARD, FORWARD, build_network, centrelines

lanelet2 = pytest.importorskip("lanelet2", reason="make setup installs lanelet2 where there is one")

ORIGIN = np.array([500_100.0, 5_427_000.0])
"""In UTM 32 N."""


def to_lonlat(crs, origin=(0.0, 0.0)):
    transformer = pyproj.Transformer.from_crs(crs, "EPSG:4326", always_xy=True)
    return lambda xy: np.stack(transformer.transform(*(xy + origin).T), axis=1)


@pytest.fixture
def read(tmp_path):
    """Return map, traffic rules and routing graph of a network as Lanelet2 has them."""

    def load(network, crs="EPSG:32632", origin=ORIGIN, keep_left=False):
        import lanelet2.io
        import lanelet2.projection
        import lanelet2.routing
        import lanelet2.traffic_rules as rules

        lonlat = to_lonlat(crs, origin)
        file = tmp_path / "map.osm"
        file.write_bytes(written(lanes_of(network, keep_left), lonlat))
        lon, lat = lonlat(np.zeros((1, 2)) if origin is ORIGIN else network.nodes[:1])[0]
        projector = lanelet2.projection.UtmProjector(lanelet2.io.Origin(lat, lon))
        made, errors = lanelet2.io.loadRobust(str(file), projector)
        assert list(errors) == []
        traffic = rules.create(rules.Locations.Germany, rules.Participants.Vehicle)
        graph = lanelet2.routing.RoutingGraph(made, traffic)
        assert list(graph.checkValidity(False)) == []
        return made, traffic, graph

    return load


def roads_of(made):
    return {one.attributes["road"]: one for one in made.laneletLayer if "road" in one.attributes}


def name_of(lane):
    # Lanelet2's attributes have no get().
    return lane.attributes["road"] if "road" in lane.attributes else "turn"  # noqa: SIM401


def followers(made, graph):
    """Return which lane of a road follows which, by way of a turn."""
    return {
        (name, name_of(after))
        for name, lane in roads_of(made).items()
        for turn in graph.following(lane)
        for after in graph.following(turn)
    }


def wanted_followers(network):
    """Return which arcs of a network follow which, without turning back on the same road."""
    edge, start, end = (column.tolist() for column in network.arcs())
    forward = int((network.edges.direction != BACKWARD).sum())
    going = {}
    for arc in range(len(edge)):
        going.setdefault(start[arc], []).append(arc)
    names = [f"e{edge[arc]}" + ("" if arc < forward else "r") for arc in range(len(edge))]
    return {
        (names[arc], names[after])
        for arc in range(len(edge))
        for after in going.get(end[arc], [])
        if edge[after] != edge[arc]
    }


CROSS = [[(0, 0), (50, 0)], [(50, 0), (100, 0)], [(50, 0), (50, 60)], [(50, 0), (50, -60)]]


@pytest.mark.parametrize("keep_left", [False, True])
def test_lanes_follow_one_another_as_roads_do(read, keep_left):
    network = build_network(centrelines(CROSS, direction=[0, 0, FORWARD, BACKWARD], width=[4, 6, 3, 5]))
    made, _, graph = read(network, keep_left=keep_left)
    assert sorted(roads_of(made)) == ["e0", "e0r", "e1", "e1r", "e2", "e3r"]
    assert followers(made, graph) == wanted_followers(network)
    assert len(followers(made, graph)) == 7


def test_lanes_have_the_width_of_their_half_and_the_side_of_the_traffic(read):
    network = build_network(centrelines([[(0, 0), (50, 0)]], width=6))
    for keep_left, middle in ((False, -1.5), (True, 1.5)):
        made, _, _ = read(network, keep_left=keep_left)
        lane = roads_of(made)["e0"]
        y = [(left.y + right.y) / 2 for left, right in zip(lane.leftBound, lane.rightBound, strict=True)]
        assert y == pytest.approx([middle] * 2, abs=0.01)
        assert [left.y - right.y for left, right in zip(lane.leftBound, lane.rightBound, strict=True)] == (
            pytest.approx([3.0] * 2, abs=0.01)
        )
        assert lane.leftBound[0].x < lane.leftBound[1].x
        assert roads_of(made)["e0r"].leftBound[0].x > roads_of(made)["e0r"].leftBound[1].x


def test_speeds_are_limits_that_traffic_rules_know(read):
    roads = centrelines([[(0, 0), (50, 0)], [(50, 0), (90, 0)]], speed=[2.0, 5.0], direction=FORWARD)
    made, traffic, _ = read(build_network(roads))
    limits = {name_of(one): traffic.speedLimit(one).speedLimit for one in made.laneletLayer}
    assert limits == pytest.approx({"e0": 7.2, "e1": 18.0, "turn": 7.2})


def test_places_are_kept_to_the_millimetre(read):
    network = build_network(centrelines([[(0, 0), (300, 40), (700, -90)]], direction=FORWARD, width=2))
    made, _, _ = read(network)
    (lane,) = made.laneletLayer
    left, right = (np.array([(p.x, p.y) for p in side]) for side in (lane.leftBound, lane.rightBound))
    assert (left + right) / 2 == pytest.approx(network.edges.xy, abs=1e-3)
    local = [(float(p.attributes["local_x"]), float(p.attributes["local_y"])) for p in lane.leftBound]
    assert left == pytest.approx(np.array(local), abs=1e-3)


def test_a_place_that_is_none_on_the_earth_is_refused():
    network = build_network(centrelines([[(0, 0), (50, 0)]]))
    with pytest.raises(RoadExportError, match="none on the earth"):
        written(lanes_of(network), lambda xy: np.full_like(xy, np.inf))


def test_lanes_whose_borders_cross_are_named():
    lanes = Lanes()
    left = lanes.add_border(lanes.add_points(np.array([(0.0, 1.0), (5.0, 1.0), (9.0, 1.0)])), "virtual")
    for line, misread in (([(0, 0), (5, 0), (9, 0)], 0), ([(9, 0), (5, 0), (0, 0)], 1)):
        right = lanes.add_border(lanes.add_points(np.array(line, dtype=float)), "virtual")
        lanes.lanes[:] = [Lane(left, right, 1.0, "")]
        assert misread_places(lanes) == [(0.0, 1.0)] * misread


ON_THE_LEFT = pytest.param(
    True, marks=pytest.mark.again("[False], and test_lanes_follow_one_another_as_roads_do")
)


@pytest.mark.parametrize("keep_left", [False, ON_THE_LEFT])
def test_a_real_city_has_the_same_connections(helsinki, read, keep_left):
    """But for turns back onto roads that lie on the one they come from."""
    network = open_roads(helsinki, range(1000, len(helsinki)))
    made, _, graph = read(network, "EPSG:32635", (0.0, 0.0), keep_left)
    assert len(roads_of(made)) == len(network.arcs()[0])
    found, wanted = followers(made, graph), wanted_followers(network)
    assert found <= wanted
    assert len(misread_places(lanes_of(network, keep_left))) <= len(wanted - found)
    assert len(wanted) > 1500
    left_out = {tuple(name.rstrip("r") for name in pair) for pair in wanted - found}
    assert all(_lie_on_one_another(network, *pair) for pair in left_out)


def _lie_on_one_another(network, *names):
    lines = [shapely.LineString(network.edges.line(int(name[1:]))) for name in names]
    return max(one.distance(shapely.Point(p)) for one, o in (lines, lines[::-1]) for p in _near(one, o)) < 0.5


def _near(one, other):
    """Return places of ``other`` half a metre from where both meet."""
    ends = [at for at in (0.0, other.length) if one.distance(other.interpolate(at)) < 1e-6]
    return [other.interpolate(abs(at - min(0.5, other.length))).coords[0] for at in ends]

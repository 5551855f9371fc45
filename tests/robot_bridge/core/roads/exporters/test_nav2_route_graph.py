"""Nav2 route graphs, read by a reader that follows nav2_route's GeoJsonGraphFileLoader and its scorers."""

from __future__ import annotations

import json
import math

import networkx
import numpy as np
import pytest

from robot_bridge.core.roads.graph_export import largest_error, nav2_route_graph, open_roads
from robot_bridge.core.roads.network import BACKWARD, FORWARD, build_network, centrelines

LARGEST_ID = 2**32 - 1


def read(content: bytes) -> networkx.MultiDiGraph:
    """Return the graph as the route server has it: nodes with places, edges straight from node to node."""
    graph = networkx.MultiDiGraph()
    features = json.loads(content)["features"]
    for feature in features:
        if feature["geometry"]["type"] == "Point":
            number = _identifier(feature["properties"]["id"])
            assert number not in graph
            graph.add_node(number, xy=tuple(map(float, feature["geometry"]["coordinates"][:2])))
            graph.nodes[number]["frame"] = feature["properties"].get("frame", "map")
    known = set(graph)
    for feature in features:
        if feature["geometry"]["type"] not in ("MultiLineString", "LineString"):
            continue
        properties = feature["properties"]
        start, end = (_identifier(properties[name]) for name in ("startid", "endid"))
        assert {start, end} <= known
        metadata = properties.get("metadata", {})
        assert float(properties.get("cost", 0.0)) >= 0.0
        # any_cast<float> of a number that JSON has as an integer ends the server.
        assert all(isinstance(metadata[key], float) for key in ("abs_speed_limit",) if key in metadata)
        metres = math.dist(graph.nodes[start]["xy"], graph.nodes[end]["xy"])
        speed = metadata.get("abs_speed_limit", 0.5)
        number = _identifier(properties["id"])
        graph.add_edge(start, end, number, metres=metres, seconds=metres / speed, **properties)
    assert graph.number_of_edges()
    return graph


def _identifier(value: object) -> int:
    assert type(value) is int
    assert 0 <= value <= LARGEST_ID
    return value


def straight(roads):
    return read(nav2_route_graph(open_roads(build_network(roads))))


def length(graph, start, goal, by="metres"):
    places = {data["xy"]: node for node, data in graph.nodes(data=True)}
    return networkx.dijkstra_path_length(graph, places[start], places[goal], by)


@pytest.mark.parametrize("name", ["aws_graph", "depot_graph", "error_codes", "sample_graph"])
def test_the_reader_reads_nav2s_own_graphs(data, name):
    assert len(read((data / "nav2" / "graphs" / f"{name}.geojson").read_bytes())) > 5


def test_members_and_properties_are_those_of_nav2s_own_graphs(data):
    ours = json.loads(nav2_route_graph(build_network(centrelines([[(0, 0), (9, 0)]]))))
    theirs = json.loads((data / "nav2" / "graphs" / "aws_graph.geojson").read_bytes())
    assert ours.keys() <= theirs.keys()
    assert ours["crs"] == theirs["crs"]
    for kind in ("Point", "MultiLineString"):
        one, other = (next(f for f in c["features"] if f["geometry"]["type"] == kind) for c in (ours, theirs))
        assert other["properties"].keys() <= one["properties"].keys()
        assert one.keys() == other.keys()
        depth = np.array(one["geometry"]["coordinates"]).ndim
        assert depth == np.array(other["geometry"]["coordinates"]).ndim


def test_curves_are_driven_through_nodes_of_their_own():
    graph = straight(centrelines([[(0, 0), (3, 4), (3, 10)]]))
    assert length(graph, (0, 0), (3, 10)) == pytest.approx(11.0)
    assert length(graph, (3, 10), (0, 0)) == pytest.approx(11.0)
    assert (len(graph), graph.number_of_edges()) == (3, 4)


@pytest.mark.parametrize(("direction", "there", "back"), [(FORWARD, True, False), (BACKWARD, False, True)])
def test_one_way_roads_lead_one_way(direction, there, back):
    graph = straight(centrelines([[(0, 0), (5, 1), (10, 0)]], direction=direction))
    places = {data["xy"]: node for node, data in graph.nodes(data=True)}
    start, goal = places[0, 0], places[10, 0]
    assert (networkx.has_path(graph, start, goal), networkx.has_path(graph, goal, start)) == (there, back)


def test_speeds_are_limits_in_metres_a_second_and_floats():
    graph = straight(centrelines([[(0, 0), (10, 0)]], speed=2, width=3, surface="asphalt"))
    traits = [data["metadata"] for *_, data in graph.edges(data=True)]
    assert traits == [{"abs_speed_limit": 2.0, "width": 3.0, "surface": "asphalt"}] * 2
    assert length(graph, (0, 0), (10, 0), "seconds") == pytest.approx(5.0)
    assert length(graph, (0, 0), (10, 0), "cost") == pytest.approx(10.0)


def test_closed_roads_are_left_out():
    graph = straight(centrelines([[(0, 0), (10, 0)], [(10, 0), (20, 0)]], closed=[False, True]))
    assert sorted(data["xy"] for _, data in graph.nodes(data=True)) == [(0, 0), (10, 0)]


def test_frame_and_place_are_said():
    network = build_network(centrelines([[(0, 0), (10, 0)]]))
    place = {"crs": "EPSG:32633", "origin": [500000.0, 1.0], "rotation": 0.5}
    content = nav2_route_graph(network, "site", site_frame=place)
    assert json.loads(content)["site_frame"] == place
    assert {data["frame"] for _, data in read(content).nodes(data=True)} == {"site"}
    stated = json.loads(nav2_route_graph(network, crs="EPSG:32633"))["crs"]["properties"]["name"]
    assert stated == "urn:ogc:def:crs:EPSG::32633"


def test_the_error_of_32_bits_is_told():
    near, far = (build_network(centrelines([[(x, 0), (x + 10, 0)]])) for x in (0.0, 5193530.0))
    assert largest_error(near) < 1e-6
    assert largest_error(far) == 0.25


def test_ways_in_a_real_city_are_as_long_and_take_as_long_as_the_projects_own(helsinki, compared):
    graph = read(nav2_route_graph(open_roads(helsinki)))
    assert compared(graph, "metres") > 100
    assert compared(graph, "seconds") > 100

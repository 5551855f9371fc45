"""Layouts in VDMA's format, read by ``vdma_lif``, whose classes are made of the published structure."""

from __future__ import annotations

import json
from datetime import datetime, timezone

import networkx
import numpy as np
import pytest

from robot_bridge.core.roads.graph_export import LayoutNames, lif_document, open_roads
from robot_bridge.core.roads.network import BACKWARD, FORWARD, build_network, centrelines

parser = pytest.importorskip("vdma_lif.parser", reason="make setup installs vdma-lif, which reads layouts")
interpolate = pytest.importorskip("scipy.interpolate", reason="make setup installs scipy")

AT = datetime(2026, 11, 23, 18, 30, 5, 120000, tzinfo=timezone.utc)
NAMES = LayoutNames("Campus", "ground", "acme.carrier")


def layout_of(roads):
    content = lif_document(open_roads(build_network(roads)), NAMES, AT)
    (layout,) = parser.LIFParser.from_json(content.decode()).layouts
    return layout


def graph_of(layout):
    """Return nodes with places and edges with metres; those of curved edges by what SciPy makes of them."""
    graph = networkx.MultiDiGraph()
    for node in layout.nodes:
        assert node.node_id not in graph
        graph.add_node(node.node_id, xy=(node.node_position.x, node.node_position.y))
    for edge in layout.edges:
        start, end = edge.start_node_id, edge.end_node_id
        assert start in graph and end in graph and start != end
        (traits,) = edge.vehicle_type_edge_properties
        points = np.array([graph.nodes[start]["xy"], graph.nodes[end]["xy"]])
        if traits.trajectory is not None:
            curve = _points(traits.trajectory)
            assert curve[[0, -1]] == pytest.approx(points, abs=1e-9)
            points = curve
        metres = float(np.hypot(*np.diff(points, axis=0).T).sum())
        assert not graph.has_edge(start, end, edge.edge_id)
        graph.add_edge(start, end, edge.edge_id, metres=metres)
    return graph


def _points(trajectory):
    controls = np.array([(point.x, point.y) for point in trajectory.control_points])
    knots, degree = np.array(trajectory.knot_vector), trajectory.degree
    assert (len(knots), degree) == (len(controls) + degree + 1, 1)
    assert (np.diff(knots) >= 0).all() and (knots[0], knots[-1]) == (0.0, 1.0)
    assert {point.weight for point in trajectory.control_points} == {1.0}
    return interpolate.BSpline(knots, controls, degree)(np.unique(knots))


def test_the_head_says_what_it_is_and_of_when():
    content = lif_document(build_network(centrelines([[(0, 0), (10, 0)]])), NAMES, AT)
    collection = parser.LIFParser.from_json(content.decode())
    meta = collection.meta_information
    assert (meta.project_identification, meta.lif_version) == ("Campus", "1.0.0")
    assert meta.export_timestamp == AT
    assert json.loads(content)["metaInformation"]["exportTimestamp"] == "2026-11-23T18:30:05.12Z"
    (layout,) = collection.layouts
    assert (layout.layout_version, layout.stations) == ("1", [])
    assert {node.map_id for node in layout.nodes} == {"ground"}
    types = {one.vehicle_type_id for node in layout.nodes for one in node.vehicle_type_node_properties}
    assert types == {"acme.carrier"}


def test_what_the_published_structure_requires_is_there():
    layout = json.loads(lif_document(build_network(centrelines([[(0, 0), (5, 5), (10, 0)]])), NAMES, AT))[
        "layouts"
    ][0]
    assert {"layoutId", "layoutVersion", "nodes", "edges", "stations"} <= layout.keys()
    for edge in layout["edges"]:
        (traits,) = edge["vehicleTypeEdgeProperties"]
        assert {"vehicleTypeId", "rotationAllowed"} <= traits.keys()
        assert {"knotVector", "controlPoints"} <= traits["trajectory"].keys()


def test_roads_of_both_directions_are_two_edges_and_one_way_roads_one():
    roads = [[(0, 0), (10, 0)], [(10, 0), (20, 0)], [(20, 0), (30, 0)]]
    layout = layout_of(centrelines(roads, direction=[0, FORWARD, BACKWARD], speed=[1, 2, 3]))
    places = {node.node_id: node.node_position.x for node in layout.nodes}
    ways = {
        (places[edge.start_node_id], places[edge.end_node_id]): edge.vehicle_type_edge_properties[0].max_speed
        for edge in layout.edges
    }
    assert ways == {(0, 10): 1.0, (10, 0): 1.0, (10, 20): 2.0, (30, 20): 3.0}


def test_curves_have_trajectories_in_their_direction_and_may_be_turned_on():
    layout = layout_of(centrelines([[(0, 0), (3, 4), (3, 10)], [(3, 10), (9, 10)]]))
    assert sorted(graph_of(layout).get_edge_data(*ends)["metres"] for ends in graph_of(layout).edges) == (
        pytest.approx([6.0, 6.0, 11.0, 11.0])
    )
    turning = [edge.vehicle_type_edge_properties[0].rotation_allowed for edge in layout.edges]
    assert sorted(turning) == [False, False, True, True]


def test_ways_in_a_real_city_are_as_long_as_the_projects_own(helsinki, compared):
    (layout,) = parser.LIFParser.from_json(lif_document(open_roads(helsinki), NAMES, AT).decode()).layouts
    assert compared(graph_of(layout), "metres") > 100

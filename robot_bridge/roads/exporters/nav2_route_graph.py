"""A graph for Nav2's route server, as its GeoJsonGraphFileLoader reads it.

The loader passes over the geometry of edges: robots drive straight from node to node. So every point of a
line becomes a node, and the edges between them are straight.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from itertools import pairwise
from typing import Any

import numpy as np

from ..centrelines import BACKWARD, FORWARD, Ints
from ..network import Network

STAND_IN_CRS = "urn:ogc:def:crs:EPSG::3857"
"""What Nav2's own graphs say of metres in a frame that no CRS describes; programs then show metres."""

_DIGITS = 6
"""A micrometre, so that many short pieces have the length of their road."""


def nav2_route_graph(
    network: Network, frame: str = "map", crs: str = "", site_frame: Mapping[str, Any] | None = None
) -> bytes:
    """Return the graph of ``network``, whose coordinates are metres in the robots' frame ``frame``.

    ``crs`` is the code of the CRS that they are metres of, if of any. ``site_frame``, which says where the
    frame lies on the earth, becomes a member of its own, which the route server passes over.
    """
    content: dict[str, Any] = {
        "type": "FeatureCollection",
        "name": "route_graph",
        "crs": {"type": "name", "properties": {"name": _crs_urn(crs)}},
    }
    if site_frame:
        content["site_frame"] = dict(site_frame)
    ids = _node_ids(network)
    xy = np.round(_node_points(network, ids), _DIGITS).tolist()
    nodes = [
        {
            "type": "Feature",
            "properties": {"id": number, "frame": frame},
            "geometry": {"type": "Point", "coordinates": point},
        }
        for number, point in enumerate(xy)
    ]
    content["features"] = [*nodes, *_pieces(network, ids, xy)]
    text = json.dumps(content, ensure_ascii=False, allow_nan=False, separators=(",", ":"))
    # A feature a line: people and their diffs read it.
    return (text.replace('{"type":"Feature",', '\n{"type":"Feature",') + "\n").encode()


def largest_error(network: Network) -> float:
    """Return by how many metres the route server moves a node at most: it keeps coordinates in 32 bits."""
    return float(np.spacing(np.float32(np.abs(network.edges.xy).max()))) / 2.0


def _node_ids(network: Network) -> Ints:
    """Return the node of each point of the lines: those of the network first, then the points between."""
    edges = network.edges
    ids = np.full(len(edges.xy), -1, dtype=np.int64)
    ids[edges.first[:-1]] = network.tail
    ids[edges.first[1:] - 1] = network.head
    between = np.flatnonzero(ids < 0)
    ids[between] = len(network.nodes) + np.arange(len(between))
    return ids


def _node_points(network: Network, ids: Ints) -> np.ndarray[Any, Any]:
    between = ids >= len(network.nodes)
    return np.concatenate([network.nodes, network.edges.xy[between]])


def _pieces(network: Network, ids: Ints, xy: list[list[float]]) -> Iterator[dict[str, Any]]:
    """Yield the straight edges, each direction of its own; their ids follow those of the nodes."""
    edges = network.edges
    number = len(xy)
    for k in range(len(network)):
        along = ids[edges.first[k] : edges.first[k + 1]].tolist()
        traits = _metadata(network, k)
        for direction, order in ((FORWARD, along), (BACKWARD, along[::-1])):
            if edges.direction[k] == -direction:
                continue
            for start, end in pairwise(order):
                yield _edge(number, (start, end), (xy[start], xy[end]), traits)
                number += 1


def _edge(
    number: int, ends: tuple[int, int], line: tuple[list[float], list[float]], traits: dict[str, Any]
) -> dict[str, Any]:
    (x, y), (to_x, to_y) = line
    metres = round(float(np.hypot(to_x - x, to_y - y)), _DIGITS)
    return {
        "type": "Feature",
        "properties": {
            "id": number,
            "startid": ends[0],
            "endid": ends[1],
            "cost": metres,
            "metadata": traits,
        },
        "geometry": {"type": "MultiLineString", "coordinates": [list(line)]},
    }


def _metadata(network: Network, k: int) -> dict[str, Any]:
    """Return what scorers and operations are told; numbers as floats, or the server ends by an exception."""
    edges = network.edges
    traits: dict[str, Any] = {
        "abs_speed_limit": float(edges.speed[k]),
        "width": float(edges.width[k]),
    }
    if edges.surface[k]:
        traits["surface"] = str(edges.surface[k])
    return traits


def _crs_urn(crs: str) -> str:
    authority, _, code = crs.partition(":")
    return f"urn:ogc:def:crs:{authority}::{code}" if code.isalnum() else STAND_IN_CRS

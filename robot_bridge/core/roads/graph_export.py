"""Graph export: VDMA's Layout Interchange Format (VDA 5050) and Nav2's route server."""

from __future__ import annotations

import json
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, replace
from datetime import datetime, timezone
from itertools import pairwise
from typing import Any

import numpy as np

from ..errors import RoadExportError
from .network import BACKWARD, FORWARD, Floats, Ints, Network

# --- The exported part of a network: open roads, none of which ends where it begins ---


def open_roads(network: Network, closed: Collection[int] = ()) -> Network:
    """Return the open edges of ``network`` except ``closed``, and their nodes.

    Rings become two edges: formats that identify an edge by its nodes cannot express its direction.

    :raises RoadExportError: when no edge is open.
    """
    keep = ~network.edges.closed
    keep[list(closed)] = False
    kept = np.flatnonzero(keep)
    if not len(kept):
        raise RoadExportError(
            f"None of the {len(network)} edges of the road network is open: open a road, or leave out areas "
            "that must not be driven through."
        )
    used, ends = np.unique(np.concatenate([network.tail[kept], network.head[kept]]), return_inverse=True)
    ends = ends.reshape(-1).astype(np.int64)
    edges = network.edges.taken(kept)
    return _without_rings(Network(network.nodes[used], edges, ends[: len(kept)], ends[len(kept) :]))


def transformed_network(network: Network, nodes: Floats, xy: Floats) -> Network:
    """Return ``network`` with its ``nodes`` and the points ``xy`` of its lines in another frame."""
    return replace(network, nodes=nodes, edges=replace(network.edges, xy=xy))


def _without_rings(network: Network) -> Network:
    rings = np.flatnonzero(network.tail == network.head)
    if not len(rings):
        return network
    edges = network.edges
    middles = edges.first[rings] + edges.counts()[rings] // 2
    # The middle point stands twice: at the end of the first half and at the beginning of the second.
    points = np.sort(np.concatenate([np.arange(len(edges.xy)), middles]))
    repeats = np.ones(len(edges), dtype=np.int64)
    repeats[rings] = 2
    of = np.repeat(np.arange(len(edges)), repeats)
    first = _firsts(edges.first, middles)
    new = len(network.nodes) + np.arange(len(rings))
    tail, head = network.tail[of], network.head[of]
    second_halves = np.flatnonzero(np.diff(of, prepend=-1) == 0)
    tail[second_halves], head[second_halves - 1] = new, new
    nodes = np.concatenate([network.nodes, edges.xy[middles]])
    return Network(nodes, edges.with_lines(edges.xy[points], first, of), tail, head)


def _firsts(first: Ints, middles: Ints) -> Ints:
    """Return the first points of lines after splitting at each of the points ``middles``."""
    shifted = first + np.searchsorted(middles, first)
    starts = middles + 1 + np.arange(len(middles))
    merged: Ints = np.sort(np.concatenate([shifted, starts]))
    return merged


# --- A layout for masters of VDA 5050 vehicles: VDMA's Layout Interchange Format, version 1.0.0 ---

LIF_VERSION = "1.0.0"

_DIGITS = 6


@dataclass(frozen=True)
class LayoutNames:
    """Names of the layout, its map and the vehicles that may drive on it."""

    project: str
    map_id: str = "map"
    vehicle_type: str = "robot"


def lif_document(network: Network, names: LayoutNames, exported_at: datetime) -> bytes:
    """Return the layout of ``network``, whose coordinates are metres in the frame of the vehicles' map.

    Two-way roads become two edges. A road that is not straight has a trajectory of degree
    1, a line through its points.
    """
    at = exported_at.astimezone(timezone.utc)
    content = {
        "metaInformation": {
            "projectIdentification": names.project,
            "creator": "Fleet Supervisor",
            "exportTimestamp": at.strftime("%Y-%m-%dT%H:%M:%S.") + f"{at.microsecond // 10000:02d}Z",
            "lifVersion": LIF_VERSION,
        },
        "layouts": [
            {
                "layoutId": names.map_id,
                "layoutName": names.project,
                "layoutVersion": "1",
                "layoutLevelId": "0",
                "nodes": list(_nodes(network, names)),
                "edges": list(_edges(network, names)),
                "stations": [],
            }
        ],
    }
    text = json.dumps(content, ensure_ascii=False, allow_nan=False, separators=(",", ":"))
    # One node or edge per line, for readable diffs.
    for key in ("nodeId", "edgeId"):
        text = text.replace(f'{{"{key}":', f'\n{{"{key}":')
    return (text + "\n").encode()


def _nodes(network: Network, names: LayoutNames) -> Iterator[dict[str, Any]]:
    for number, (x, y) in enumerate(np.round(network.nodes, _DIGITS).tolist()):
        yield {
            "nodeId": _node_id(number),
            "mapId": names.map_id,
            "nodePosition": {"x": x, "y": y},
            "vehicleTypeNodeProperties": [{"vehicleTypeId": names.vehicle_type}],
        }


def _edges(network: Network, names: LayoutNames) -> Iterator[dict[str, Any]]:
    edges = network.edges
    for k in range(len(network)):
        ends = _node_id(int(network.tail[k])), _node_id(int(network.head[k]))
        for direction, suffix in ((FORWARD, ""), (BACKWARD, "r")):
            if edges.direction[k] == -direction:
                continue
            start, end = ends[::direction]
            traits: dict[str, Any] = {
                "vehicleTypeId": names.vehicle_type,
                "vehicleOrientation": 0.0,
                "orientationType": "TANGENTIAL",
                "maxSpeed": float(edges.speed[k]),
            }
            points = edges.line(k)[::direction]
            # A vehicle on a line with corners turns in them.
            traits["rotationAllowed"] = len(points) > 2
            if len(points) > 2:
                traits["trajectory"] = _trajectory(points)
            yield {
                "edgeId": f"e{k}{suffix}",
                "startNodeId": start,
                "endNodeId": end,
                "vehicleTypeEdgeProperties": [traits],
            }


def _trajectory(points: Floats) -> dict[str, Any]:
    """Return a NURBS of degree 1 through ``points``: as many knots as points and two, by metres along it."""
    along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])
    knots = np.concatenate([[0.0], along / along[-1], [1.0]])
    return {
        "degree": 1,
        "knotVector": np.round(knots, 12).tolist(),
        "controlPoints": [{"x": x, "y": y, "weight": 1.0} for x, y in np.round(points, _DIGITS).tolist()],
    }


def _node_id(number: int) -> str:
    return f"n{number}"


# --- A graph for Nav2's route server, as its GeoJsonGraphFileLoader reads it ---
# The loader ignores the geometry of edges: robots drive straight from node to node. So every point of a
# line becomes a node, and the edges between them are straight.

STAND_IN_CRS = "urn:ogc:def:crs:EPSG::3857"
"""The CRS in Nav2's own graphs for metres in a frame without a CRS; programs then show metres."""


def nav2_route_graph(
    network: Network, frame: str = "map", crs: str = "", site_frame: Mapping[str, Any] | None = None
) -> bytes:
    """Return the graph of ``network``, whose coordinates are metres in the robots' frame ``frame``.

    ``crs`` is the code of their CRS, if any. ``site_frame``, the georeference of the frame, becomes a member
    of its own, which the route server ignores.
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
    # One feature per line, for readable diffs.
    return (text.replace('{"type":"Feature",', '\n{"type":"Feature",') + "\n").encode()


def largest_error(network: Network) -> float:
    """Return the largest shift of a node by the route server in metres: it stores coordinates in 32 bits."""
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
    """Yield the straight edges, one per direction; their ids follow those of the nodes."""
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
    """Return the metadata for scorers and operations; numbers as floats, or the server ends with an
    exception."""
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

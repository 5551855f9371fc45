"""A layout for masters of VDA 5050 vehicles: VDMA's Layout Interchange Format, version 1.0.0."""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass
from datetime import datetime, timezone
from typing import Any

import numpy as np

from ..centrelines import BACKWARD, FORWARD, Floats
from ..network import Network

VERSION = "1.0.0"

_DIGITS = 6


@dataclass(frozen=True)
class LayoutNames:
    """What the layout, its map and the vehicles that may drive on it are called."""

    project: str
    map_id: str = "map"
    vehicle_type: str = "robot"


def lif(network: Network, names: LayoutNames, exported_at: datetime) -> bytes:
    """Return the layout of ``network``, whose coordinates are metres in the frame of the vehicles' map.

    Roads that are driven both ways become two edges. A road that is not straight has a trajectory of degree
    1, a line through its points.
    """
    at = exported_at.astimezone(timezone.utc)
    content = {
        "metaInformation": {
            "projectIdentification": names.project,
            "creator": "Fleet Supervisor",
            "exportTimestamp": at.strftime("%Y-%m-%dT%H:%M:%S.") + f"{at.microsecond // 10000:02d}Z",
            "lifVersion": VERSION,
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
    # A node or an edge a line: people and their diffs read it.
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
            # A vehicle that drives along a line with corners turns in them.
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

"""A Lanelet2 map, in OSM format: a lanelet for each direction of a road and for each turn."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..centrelines import Floats
from ..errors import RoadExportError
from .lanes import Lane, Lanes

ToLonLat = Callable[[Floats], NDArray[Any]]
"""From (n, 2) metres in the site frame to (n, 2) longitudes and latitudes, WGS 84 degrees."""

_BORDERS = {
    "road_border": '<tag k="type" v="road_border"/>',
    "line_thin": '<tag k="type" v="line_thin"/><tag k="subtype" v="solid"/>',
    "virtual": '<tag k="type" v="virtual"/>',
}
_LANE = (
    '<tag k="type" v="lanelet"/><tag k="subtype" v="road"/><tag k="location" v="urban"/>'
    '<tag k="one_way" v="yes"/><tag k="participant:vehicle" v="yes"/>'
)


def lanelet2(lanes: Lanes, to_lonlat: ToLonLat) -> bytes:
    """Return the map of ``lanes``, whose coordinates are metres in the site frame.

    Nodes have these, too, as ``local_x`` and ``local_y``. Lanelets of roads name their edge as ``road``.

    :raises RoadExportError: when a position is none on the earth.
    """
    lines = [
        '<?xml version="1.0" encoding="UTF-8"?>',
        '<osm version="0.6" generator="Fleet Supervisor">',
        *_nodes(lanes, to_lonlat),
        *_ways(lanes),
        *_relations(lanes),
        "</osm>\n",
    ]
    return "\n".join(lines).encode()


def _nodes(lanes: Lanes, to_lonlat: ToLonLat) -> Iterator[str]:
    xy = np.array(lanes.points, dtype=np.float64)
    lonlat = np.asarray(to_lonlat(xy), dtype=np.float64)
    if not np.isfinite(lonlat).all() or (np.abs(lonlat) > (180.0, 90.0)).any():
        raise RoadExportError(
            "Lanelet2: a position of the roads is none on the earth: check the CRS, the origin and the "
            "rotation of the site frame."
        )
    for number, ((x, y), (lon, lat)) in enumerate(zip(xy.tolist(), lonlat.tolist(), strict=True), 1):
        yield (
            f'<node id="{number}" lat="{lat:.11f}" lon="{lon:.11f}">'
            f'<tag k="local_x" v="{x:.4f}"/><tag k="local_y" v="{y:.4f}"/></node>'
        )


def _ways(lanes: Lanes) -> Iterator[str]:
    for number, border in enumerate(lanes.borders, _first_way(lanes)):
        points = "".join(f'<nd ref="{point + 1}"/>' for point in border.points)
        yield f'<way id="{number}">{points}{_BORDERS[border.kind]}</way>'


def _relations(lanes: Lanes) -> Iterator[str]:
    """Yield a speed limit for each speed, and the lanelets that refer to them."""
    first = _first_way(lanes) + len(lanes.borders)
    speeds = sorted({lane.speed for lane in lanes.lanes})
    limits = dict(zip(speeds, range(first, first + len(speeds)), strict=True))
    for speed, number in limits.items():
        yield (
            f'<relation id="{number}"><tag k="type" v="regulatory_element"/>'
            f'<tag k="subtype" v="speed_limit"/><tag k="sign_type" v="{speed * 3.6:.6g} km/h"/></relation>'
        )
    for number, lane in enumerate(lanes.lanes, first + len(speeds)):
        yield _lanelet(number, lane, _first_way(lanes), limits[lane.speed])


def _lanelet(number: int, lane: Lane, first_way: int, limit: int) -> str:
    name = f'<tag k="road" v="{lane.name}"/>' if lane.name else ""
    return (
        f'<relation id="{number}"><member type="way" role="left" ref="{first_way + lane.left}"/>'
        f'<member type="way" role="right" ref="{first_way + lane.right}"/>'
        f'<member type="relation" role="regulatory_element" ref="{limit}"/>{_LANE}{name}</relation>'
    )


def _first_way(lanes: Lanes) -> int:
    return len(lanes.points) + 1

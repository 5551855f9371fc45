"""Real roads as the network takes them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pyogrio
import shapely

from robot_bridge.core.roads.network import FORWARD, Centrelines, Network, centrelines, network_of


def malta(data: Path, most: int | None = None) -> Centrelines:
    """Return the 25 034 roads of Malta with their directions and levels, or the first of them."""
    where = f"fid <= {most}" if most else None
    lines, fields = _read(data / "osm" / "malta_2018_utm33n.gpkg", "roads", where)
    structure = zip(fields["layer"], fields["bridge"], fields["tunnel"], strict=True)
    return centrelines(
        lines,
        direction=[{"yes": 1, "-1": -1}.get(way, 0) for way in fields["oneway"]],
        level=[_level(*row) for row in structure],
    )


def track(data: Path) -> Centrelines:
    """Return the 110 lanes of ZalaZONE's university track, each driven along its line."""
    lines, fields = _read(
        data / "zalazone" / "zalazone_lanelets_utm33.gpkg", "centrelines", "module = 'university_track'"
    )
    return centrelines(lines, width=fields["width_m"], direction=FORWARD)


def track_surface(data: Path) -> shapely.Geometry:
    """Return the digitised surfaces of that track as one geometry."""
    file = data / "zalazone" / "university_track_surfaces_derived_utm33.gpkg"
    _, _, shapes, _ = pyogrio.raw.read(file)
    return shapely.union_all(shapely.from_wkb(shapes))


def four_islands(roads: Centrelines) -> Centrelines:
    """Return ``roads`` four times side by side, with 40 bridges from each to the next."""
    size = np.ptp(roads.xy, axis=0) + 1000.0
    ends = np.random.default_rng(3).choice(roads.xy[roads.first[:-1]], (4, 40))
    copies = [roads.xy + size * (k % 2, k // 2) for k in range(4)]
    steps = ((0, 1), (1, 3), (3, 2), (2, 0))
    bridges = [
        np.stack([end + size * (a % 2, a // 2), end + size * (b % 2, b // 2)])
        for chosen, (a, b) in zip(ends, steps, strict=True)
        for end in chosen
    ]
    lines = [one for xy in copies for one in np.split(xy, roads.first[1:-1])]
    # Each bridge is high above all others and everything else.
    levels = np.concatenate([np.tile(roads.level, 4), 100 + np.arange(len(bridges))])
    direction = np.concatenate([np.tile(roads.direction, 4), np.zeros(len(bridges))])
    return centrelines([*lines, *bridges], direction=direction, level=levels)


def grid(side: int) -> Network:
    """Return a made-up town of about 2 · ``side``² streets whose crossings are not quite in line."""
    random = np.random.default_rng(7)
    x, y = np.meshgrid(np.arange(side) * 100.0, np.arange(side) * 100.0)
    nodes = np.stack([x, y], axis=-1) + random.uniform(-30, 30, (side, side, 2))
    across = np.stack([nodes[:, :-1], nodes[:, 1:]], axis=2).reshape(-1, 2, 2)
    along = np.stack([nodes[:-1], nodes[1:]], axis=2).reshape(-1, 2, 2)
    return network_of(centrelines(np.concatenate([across, along])))


def _level(layer: str | None, bridge: str | None, tunnel: str | None) -> int:
    if layer and layer.lstrip("-").isdigit():
        return int(layer)
    return 1 if bridge not in (None, "no") else -1 if tunnel not in (None, "no") else 0


def _read(file: Path, layer: str, where: str | None = None) -> tuple[list[np.ndarray], dict[str, np.ndarray]]:
    meta, _, shapes, columns = pyogrio.raw.read(file, layer=layer, where=where)
    lines = [shapely.get_coordinates(line) for line in shapely.from_wkb(shapes)]
    return lines, dict(zip(meta["fields"], columns, strict=True))

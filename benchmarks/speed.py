"""Windows cut from a published site of Malta's obstacles, and the same by others in the same run."""

from __future__ import annotations

import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pyogrio
import shapely
from osgeo import ogr

from benchmarks.clock import again, each, in_a_process, table, with_children
from benchmarks.layers import features, moved, rows
from benchmarks.trial import size
from robot_bridge.core.robotmap.binary import encode
from robot_bridge.core.robotmap.builder import build_map
from robot_bridge.core.robotmap.model import Window
from robot_bridge.core.robotmap.outlines import Outlines
from robot_bridge.core.robotmap.text_format import write_text
from robot_bridge.core.robotmap.window_index import OutlineIndex
from robot_bridge.core.sites.frame import SiteBounds
from robot_bridge.core.sites.settings import SiteSettings
from robot_bridge.core.sites.site import Site, read_site, write_site
from robot_bridge.gateway.site.site_maps import SiteMaps

ORIGIN = (430000.0, 3960000.0)
SIDE = 100.0
OBSTACLES = "obstacles"
RUNS, CHOSEN, MOST = size((5, 3000, 200), (2, 3000, 10))
"""How often the site is read, and windows looked at and measured."""
CROWDED = (20, 30)
"""obstacles in a window of a town."""


def publish(file: Path, folder: Path) -> None:
    """Publish Malta's sound buildings and barriers in ``folder``."""
    read = [item for layer in ("buildings", "barriers") for item in features(file, layer)]
    made = [
        row for source, shape, _ in read if shape.is_valid for row in rows(shape, source, place=moved(ORIGIN))
    ]
    outlines = Outlines.from_rows(made)
    low, high = outlines.coordinates.min(axis=0).tolist(), outlines.coordinates.max(axis=0).tolist()
    settings = SiteSettings("malta", "Malta", 1, "EPSG:32633", ORIGIN, SiteBounds(*low, *high))
    write_site(folder, settings, outlines)


def windows(outlines: Outlines, count: int) -> list[Window]:
    """Return windows of 100 m × 100 m around corners of obstacles."""
    chance = np.random.default_rng(4)
    corners = outlines.coordinates[chance.integers(0, len(outlines.coordinates), count)]
    return [Window(float(x), float(y), SIDE, SIDE) for x, y in corners]


def speed_tables(folder: Path) -> str:
    """Return the tables of times for the site in ``folder``."""
    site, loading = again(lambda: read_site(folder), RUNS)
    index, indexing = again(lambda: OutlineIndex.of(site.outlines), RUNS)
    anywhere = windows(site.outlines, CHOSEN)
    counts = [len(np.unique(index.segments_in(w.border).outline)) for w in anywhere]
    town = [w for w, n in zip(anywhere, counts, strict=True) if CROWDED[0] <= n <= CROWDED[1]][:MOST]
    country = [w for w, n in zip(anywhere, counts, strict=True) if n < CROWDED[0]][:MOST]
    times = [_compared(site, index, folder, some) for some in (town, country)]
    lines = [(name, *(column[name] for column in times)) for name in times[0]]
    heads = (
        "ms, median",
        f"{len(town)} windows with {CROWDED[0]} to {CROWDED[1]} obstacles",
        f"{len(country)} with fewer",
    )
    megabytes_more = in_a_process(_MEMORY.format(folder=str(folder)))
    return (
        f"{len(site.outlines)} outlines with {len(site.outlines.coordinates)} points, read from the "
        f"published site in {loading:.2f} s and indexed in {indexing:.2f} s; "
        f"{megabytes_more:.0f} MB of memory.\n\n" + table(heads, lines)
    )


_MEMORY = """
import json, pyogrio, pyproj, shapely
from benchmarks.clock import megabytes
from robot_bridge.core.sites.site import read_site
before = megabytes()
site = read_site({folder!r})
site.map_around(site.bounds.x_min, site.bounds.y_min, 100)
print(json.dumps(megabytes() - before))
"""


def _compared(site: Site, index: OutlineIndex, folder: Path, some: list[Window]) -> dict[str, str]:
    """Return the medians of each way to cut ``some`` windows, and how often the first one's they are."""
    maps, area = SiteMaps(site), SIDE**2
    times = {
        "**extraction: oriented segments in the window**": each(lambda w: index.segments_in(w.border), some),
        "the same without the index": each(lambda w: build_map(site.outlines, w), some[:12]),
        "shapely: STRtree and `clip_by_rect`, geometries in memory": each(_shapely(folder), some),
        "GDAL in this process, open file: spatial filter, geometries only, one `clip_by_rect` of all": each(
            _gdal(folder), some
        ),
        "the same feature by feature, with height, label and flag": each(_gdal_by_feature(folder), some),
        "pyogrio: `raw.read(bbox=…)`, which opens the file, then one `clip_by_rect`": each(
            _pyogrio(folder), some
        ),
        "`ogr2ogr -spat … -clipsrc …`, a process": each(_ogr2ogr(folder), some[:21], with_children),
    }
    first = next(iter(times.values())).median
    lines = {name: f"{time} ({time.median / first:.1f})" for name, time in times.items()}
    stages = {
        "map: obstacles with ids and labels": each(index.map_of, some),
        "map and text": each(lambda w: write_text(index.map_of(w)), some),
        "**complete GetMap, codec 1**": each(lambda w: maps.map_around(w.x, w.y, area), some),
        "complete GetMap, codec 2": each(lambda w: encode(site.map_around(w.x, w.y, area), codec=2), some),
    }
    return lines | {name: str(time) for name, time in stages.items()}


def _crs_box(window: Window) -> tuple[float, float, float, float]:
    x_min, y_min, x_max, y_max = window.border
    return x_min + ORIGIN[0], y_min + ORIGIN[1], x_max + ORIGIN[0], y_max + ORIGIN[1]


def _shapely(folder: Path) -> Any:
    shapes = np.array([shape for _, shape, _ in features(folder / "site.gpkg", OBSTACLES)])
    tree = shapely.STRtree(shapes)

    def cut(window: Window) -> Any:
        box = _crs_box(window)
        return shapely.clip_by_rect(shapely.boundary(shapes[tree.query(shapely.box(*box))]), *box)

    return cut


def _gdal(folder: Path) -> Any:
    features_in = _by_gdal(folder)

    def cut(window: Window) -> Any:
        box = _crs_box(window)
        wkb = [bytes(feature.GetGeometryRef().ExportToWkb()) for feature in features_in(box)]
        return shapely.clip_by_rect(shapely.boundary(shapely.from_wkb(wkb)), *box)

    return cut


def _gdal_by_feature(folder: Path) -> Any:
    features_in = _by_gdal(folder)

    def cut(window: Window) -> Any:
        box = _crs_box(window)
        return [
            (
                shapely.clip_by_rect(
                    shapely.from_wkb(bytes(feature.GetGeometryRef().ExportToWkb())).boundary, *box
                ),
                *(feature[name] for name in ("height_m", "semantics", "outdoor")),
            )
            for feature in features_in(box)
        ]

    return cut


def _by_gdal(folder: Path) -> Any:
    """Return what reads the obstacles near a box, of a file that is open."""
    source = ogr.Open(str(folder / "site.gpkg"))
    layer = source.GetLayerByName(OBSTACLES)

    def features_in(box: Any) -> Any:
        layer.SetSpatialFilterRect(*box)
        layer.ResetReading()
        return source and layer  # a layer does not keep its source

    return features_in


def _pyogrio(folder: Path) -> Any:
    def cut(window: Window) -> Any:
        box = _crs_box(window)
        _, _, wkb, _ = pyogrio.raw.read(folder / "site.gpkg", layer=OBSTACLES, bbox=box)
        return shapely.clip_by_rect(shapely.boundary(shapely.from_wkb(wkb)), *box)

    return cut


def _ogr2ogr(folder: Path) -> Any:
    def cut(window: Window) -> Any:
        box = [str(value) for value in _crs_box(window)]
        command = ["ogr2ogr", "-f", "GeoJSON", "-spat", *box, "-clipsrc", *box, "/vsistdout/"]
        done = subprocess.run(
            [*command, str(folder / "site.gpkg"), OBSTACLES], capture_output=True, check=True
        )
        return done.stdout

    return cut

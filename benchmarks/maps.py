"""The part on robot maps: windows, growth, sizes, and correctness on two cities."""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

import numpy as np
import shapely
from osgeo import gdal

from benchmarks.correctness import NEAR, SIDES, City, faults
from benchmarks.growth import PITCH, growth_table
from benchmarks.page import Part, goal
from benchmarks.sizes import PAPER, PLANE, campus_table, quarter_table
from benchmarks.speed import SIDE, publish, speed_tables
from benchmarks.trial import size

WINDOWS = size(200, 5)
CITIES = (
    ("Helsinki", "helsinki_centre_utm35n.gpkg", (385944.0, 6672300.0)),
    ("Malta", "malta_2018_utm33n.gpkg", (450000.0, 3970000.0)),
)

TEXT = """\
numpy {numpy}, shapely {shapely}, GDAL {gdal}.

### A window from a published site

Malta's buildings and barriers (OpenStreetMap), published as the gateway serves them. Everything is warm: the
site is loaded, the file is in the system's cache; times are processor time. In round brackets, times the
extraction, whose result is segments
with direction, height and obstacle in centimetres; the others return clipped geometries.

{speed}

### Growth

Cities that are made up, {dense:.0f} buildings in a window of {side:g} m × {side:g} m.

{growth}

### Sizes

Bytes/m². The paper gives {paper} as text for this site, with buildings, columns and walls. Strict is the
paper's format and nothing else: what each obstacle comes from (`src`) is left out.

{campus}

The robot's plane leaves out what begins higher than {above:g} m above the ground beside it, or ends within
{below:g} m of the ground.

{quarter}

### Correctness

{correctness}

Held against shapely, which shares no code with the builder: the segments are the drawn obstacles inside the
window within {near:g} cm, both ways; buildings are on the left of their segments; no segment lies on the
window's border where no wall is. Wrong windows: {wrong} ({goal}).
"""


def _correctness(data: Path) -> tuple[str, int]:
    """Return what was checked, and how many windows were wrong."""
    said, wrong = [], 0
    for name, file, origin in CITIES:
        city = City.read(data / "osm" / file, name, origin)
        segments = 0
        for window in city.windows(WINDOWS, seed=1):
            found = faults(city, window)
            segments += city.index.map_of(window).segment_count
            wrong += bool(found)
            for fault in found:
                print(f"{name}, {window}: {fault}", file=sys.stderr)
        sides = f"{SIDES[0]:g} m to {SIDES[1]:g} m"
        said.append(f"- {name}: {WINDOWS} windows of {sides}, {segments} segments")
    return "\n".join(said), wrong


def measure(data: Path) -> Part:
    """Return what is said of robot maps; it fails when a window was wrong."""
    with tempfile.TemporaryDirectory() as folder:
        publish(data / "osm" / "malta_2018_utm33n.gpkg", Path(folder))
        speed = speed_tables(Path(folder))
    checked, wrong = _correctness(data)
    text = TEXT.format(
        numpy=np.__version__,
        shapely=shapely.__version__,
        gdal=gdal.__version__,
        speed=speed,
        dense=(SIDE / PITCH) ** 2,
        side=SIDE,
        paper=PAPER,
        below=PLANE[0],
        above=PLANE[1],
        near=100 * NEAR,
        goal=goal("none", wrong == 0),
        growth=growth_table(),
        campus=campus_table(data / "upc_campus_nord" / "upc_campus_nord_local.gpkg"),
        quarter=quarter_table(data / "osm" / "momepy_bubenec.gpkg"),
        correctness=checked,
        wrong=wrong,
    )
    return Part("Robot maps", text, failed=bool(wrong))

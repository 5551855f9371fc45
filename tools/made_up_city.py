"""Make up a city as GIS data, with what publishing needs of it.

    .venv/bin/python -m tools.made_up_city OUT_DIR [--buildings 1000000] [--seed 1]

Writes to ``OUT_DIR``: ``city.gpkg`` with the layers buildings, walls, furniture, streets, surfaces and
keepouts in EPSG:32633, and the map profile ``city.toml``. The command that publishes it is printed. The same
numbers give the same bytes. As in real data some heights, widths and directions are missing, and a few
footprints are broken.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt
import pyogrio
import shapely

Floats = npt.NDArray[np.float64]
Rows = tuple[npt.NDArray[Any], dict[str, npt.NDArray[Any]]]
"""K shapely geometries, and K values of each field."""

CRS = "EPSG:32633"
ORIGIN = (400_000.0, 5_200_000.0)
"""The south-west corner of the city in :data:`CRS`."""
LOT_M, STREET_M = 22.0, 12.0
LOTS = 4
"""Lots along a block; a block has as many rows of them."""
BLOCK_M = LOTS * LOT_M + STREET_M
CHUNK = 100_000
"""Features made and written at a time, which bounds the memory."""
CROSSING_EVERY, EMPTY_EVERY, FLAT_EVERY, ODD_HEIGHT_EVERY = 1000, 20_000, 10_000, 5000
"""One building in so many crosses itself, has no geometry, encloses nothing, or has a height below 0."""

_SQUARE = [(-1, -1), (1, -1), (1, 1), (-1, 1), (-1, -1)]
_INNER = [(-0.4, -0.4), (-0.4, 0.4), (0.4, 0.4), (0.4, -0.4), (-0.4, -0.4)]
_ROUND = [(math.cos(turn * math.pi / 8), math.sin(turn * math.pi / 8)) for turn in (*range(16), 0)]
FOOTPRINTS: tuple[tuple[list[tuple[float, float]], list[tuple[float, float]] | None], ...] = (
    (_SQUARE, None),
    ([(-1, -1), (1, -1), (1, 0), (0, 0), (0, 1), (-1, 1), (-1, -1)], None),
    ([(-1, -1), (1, -1), (1, 1), (0.4, 1), (0.4, -0.3), (-0.4, -0.3), (-0.4, 1), (-1, 1), (-1, -1)], None),
    ([(-1, 0.3), (-0.3, 0.3), (-0.3, -1), (0.3, -1), (0.3, 0.3), (1, 0.3), (1, 1), (-1, 1), (-1, 0.3)], None),
    (_SQUARE, _INNER),
    (_ROUND, None),
)
"""Outer ring and courtyard of each kind, within 1 of the middle."""
_CROSSED = [(-1, -1), (1, 1), (1, -1), (-1, 1), (-1, -1)]
_FLAT = [(-1, 0), (1, 0), (0, 0), (-1, 0)]

PROFILE = """\
name = "Made-up city"
about = "The layers that tools/made_up_city.py writes."

[[layers]]
names = ["buildings"]
role = "obstacle"
height = '"height"'
estimate = '3 * "levels"'
semantics = "'building,' || \\"use\\""

[[layers]]
names = ["walls"]
role = "obstacle"
height = '"height"'
semantics = '"kind"'

[[layers]]
names = ["furniture"]
role = "furniture"
height = '"height"'
semantics = '"kind"'
template = '"template"'
width = '"width"'
rotation = '"heading"'

[[layers]]
names = ["streets"]
role = "road_centreline"
width = '"width"'
semantics = '"surface"'

[[layers]]
names = ["surfaces"]
role = "road_surface"
semantics = '"surface"'

[[layers]]
names = ["keepouts"]
role = "keepout"
semantics = '"name"'
"""


class City(NamedTuple):
    """What is made up: ``buildings`` is how many, ``seed`` which of all such cities."""

    buildings: int = 1_000_000
    seed: int = 1

    @property
    def blocks(self) -> int:
        """Blocks along one side of the city."""
        return math.ceil(math.sqrt(self.buildings / LOTS**2))

    @property
    def side(self) -> float:
        """Metres along one side of the city."""
        return self.blocks * BLOCK_M

    @property
    def centre(self) -> tuple[float, float]:
        """The middle of a block with others all around it, in :data:`CRS`."""
        x = (self.blocks // 2 + 0.5) * BLOCK_M
        y = (self.blocks // 4 + 0.5) * BLOCK_M
        return ORIGIN[0] + x, ORIGIN[1] + y

    def write(self, folder: Path) -> Path:
        """Write ``city.gpkg`` and ``city.toml`` to ``folder``, over older ones; return the first."""
        folder.mkdir(parents=True, exist_ok=True)
        file = folder / "city.gpkg"
        file.unlink(missing_ok=True)
        (folder / "city.toml").write_text(PROFILE, encoding="utf-8")
        # GDAL notes the time of writing, which would be the only difference between two files.
        pyogrio.set_gdal_config_options({"OGR_CURRENT_DATE": "2026-01-01T00:00:00.000Z"})
        try:
            for name, kind, parts in self._layers():
                for number, (shapes, values) in enumerate(parts):
                    _append(file, name, kind, shapes, values, first=number == 0)
        finally:
            pyogrio.set_gdal_config_options({"OGR_CURRENT_DATE": None})
        return file

    def publish_arguments(self, folder: Path, site: Path) -> list[str]:
        """Return what ``qgis_process run`` needs to publish the city in ``folder`` as the folder ``site``."""
        file = folder / "city.gpkg"
        layers = {
            "OBSTACLES": ("buildings", "walls", "furniture"),
            "ROAD_CENTRELINES": ("streets",),
            "ROAD_SURFACES": ("surfaces",),
            "KEEPOUTS": ("keepouts",),
        }
        given = [f"--{name}={file}|layername={one}" for name, some in layers.items() for one in some]
        return [
            "fleet:publishsite",
            *given,
            f"--PROFILE={folder / 'city.toml'}",
            "--SITE_ID=made-up-city",
            f"--ORIGIN={ORIGIN[0]:.0f},{ORIGIN[1]:.0f} [{CRS}]",
            f"--FOLDER={site}",
        ]

    def _layers(self) -> Iterator[tuple[str, str, Iterator[Rows]]]:
        yield "buildings", "Polygon", self._parts(_buildings, self.buildings)
        yield "walls", "LineString", self._parts(_walls, self.buildings // 20)
        yield "furniture", "Point", self._parts(_furniture, self.buildings // 10)
        yield "streets", "LineString", self._parts(_streets, 2 * self.blocks**2)
        yield "surfaces", "Polygon", self._parts(_surfaces, self.blocks**2 // 5)
        yield "keepouts", "Polygon", self._parts(_keepouts, max(self.buildings // 500, 1))

    def _parts(self, make: Any, count: int) -> Iterator[Rows]:
        for first in range(0, max(count, 1), CHUNK):
            chance = np.random.default_rng([self.seed, *make.__name__.encode(), first])
            yield make(self, np.arange(first, min(first + CHUNK, count)), chance)


def _append(
    file: Path,
    name: str,
    kind: str,
    shapes: npt.NDArray[Any],
    values: dict[str, npt.NDArray[Any]],
    first: bool,
) -> None:
    pyogrio.raw.write(
        str(file),
        geometry=shapely.to_wkb(shapes),
        field_data=list(values.values()),
        fields=list(values),
        layer=name,
        driver="GPKG",
        geometry_type=kind,
        crs=CRS,
        append=file.exists(),
        # Version 1.3 is what GDAL 3.6 and older read.
        **({"dataset_options": {"VERSION": "1.3"}} if first and not file.exists() else {}),
    )


def _corner(city: City, block: npt.NDArray[np.int64]) -> Floats:
    """Return the south-west corner of each of ``block``, (K, 2) in the CRS."""
    return np.array(ORIGIN) + BLOCK_M * np.column_stack([block % city.blocks, block // city.blocks])


def _placed(ring: list[tuple[float, float]], centre: Floats, reach: Floats, turn: Floats) -> Floats:
    """Return ``ring`` at K places, (K, n, 2): ``reach`` is (K, 2) half sides, ``turn`` (K,) radians."""
    x, y = np.moveaxis(np.array(ring, dtype=float) * reach[:, None], 2, 0)
    cos, sin = np.cos(turn)[:, None], np.sin(turn)[:, None]
    return centre[:, None] + np.stack([x * cos - y * sin, x * sin + y * cos], axis=2)


def _buildings(city: City, number: npt.NDArray[np.int64], chance: np.random.Generator) -> Rows:
    count = len(number)
    lot = number % LOTS**2
    lots = np.column_stack([lot % LOTS, lot // LOTS])
    centre = _corner(city, number // LOTS**2) + STREET_M + (lots + 0.5) * LOT_M
    reach, turn = chance.uniform(3.5, 7.2, (count, 2)), chance.uniform(-0.15, 0.15, count)
    kind = chance.choice(len(FOOTPRINTS), count, p=(0.4, 0.2, 0.1, 0.1, 0.15, 0.05))
    shapes = np.empty(count, dtype=object)
    for one, (outer, inner) in enumerate(FOOTPRINTS):
        some = kind == one
        rings = shapely.linearrings(_placed(outer, centre[some], reach[some], turn[some]))
        holes = None
        if inner is not None:
            holes = shapely.linearrings(_placed(inner, centre[some], reach[some], turn[some]))[:, None]
        shapes[some] = shapely.polygons(rings, holes)
    for every, ring in ((CROSSING_EVERY, _CROSSED), (FLAT_EVERY, _FLAT)):
        broken = number % every == every // 2
        shapes[broken] = shapely.polygons(_placed(ring, centre[broken], reach[broken], turn[broken]))
    shapes[number % EMPTY_EVERY == EMPTY_EVERY // 3] = None
    height = chance.uniform(3, 30, count).round(1)
    levels = np.ceil(height / 3)
    unknown = chance.random(count)
    height[unknown < 0.3] = np.nan
    levels[unknown < 0.1] = np.nan
    height[number % ODD_HEIGHT_EVERY == ODD_HEIGHT_EVERY // 4] = -1.0
    use = np.array(["residential", "commercial", "school", "garage"], dtype=object)
    return shapes, {"height": height, "levels": levels, "use": use[chance.integers(0, 4, count)]}


def _walls(city: City, number: npt.NDArray[np.int64], chance: np.random.Generator) -> Rows:
    """Make walls between the rows of lots of every other block."""
    corner = _corner(city, number * LOTS**2 * 20 // LOTS**2 // LOTS**2)
    start = (
        corner + STREET_M + np.column_stack([chance.uniform(0, 20, len(number)), np.full(len(number), 44.0)])
    )
    steps = np.stack(
        [chance.uniform(5, 15, (len(number), 3)), chance.uniform(-0.3, 0.3, (len(number), 3))], axis=2
    )
    points = np.concatenate([start[:, None], start[:, None] + steps.cumsum(axis=1)], axis=1)
    height = chance.uniform(0.4, 2.5, len(number)).round(1)
    height[chance.random(len(number)) < 0.2] = np.nan
    kind = np.array(["wall", "fence", "hedge"], dtype=object)[chance.integers(0, 3, len(number))]
    return shapely.linestrings(points), {"height": height, "kind": kind}


def _furniture(city: City, number: npt.NDArray[np.int64], chance: np.random.Generator) -> Rows:
    """Make points along the kerbs: lamps, benches, bins and trees by template, bollards by width."""
    along = STREET_M + chance.uniform(0, LOTS * LOT_M, len(number))
    place = _corner(city, number * 10 // LOTS**2) + np.column_stack(
        [along, np.full(len(number), STREET_M - 1.0)]
    )
    kinds = np.array(["street_lamp", "bench", "litter_bin", "tree", "bollard"], dtype=object)
    kind = chance.integers(0, len(kinds), len(number))
    template = np.where(kind < 4, kinds[kind], None)
    width = np.where(kind == 4, chance.uniform(0.1, 0.4, len(number)).round(2), np.nan)
    heading = np.where(kind == 1, chance.integers(0, 360, len(number)), np.nan)
    height = np.array([5.0, 0.9, 0.9, 8.0, 0.9])[kind]
    values = {"kind": kinds[kind], "template": template, "width": width, "heading": heading, "height": height}
    return shapely.points(place), values


def _street_ends(city: City, number: npt.NDArray[np.int64]) -> tuple[Floats, Floats]:
    """Return both ends of each street, (K, 2): odd ones lead north, even ones east of a block's corner."""
    start = _corner(city, number // 2) + STREET_M / 2
    step = np.where((number % 2 == 1)[:, None], (0.0, BLOCK_M), (BLOCK_M, 0.0))
    return start, start + step


def _streets(city: City, number: npt.NDArray[np.int64], chance: np.random.Generator) -> Rows:
    start, end = _street_ends(city, number)
    bend = (start + end) / 2 + chance.uniform(-1.5, 1.5, (len(number), 2))
    width = chance.choice([4.0, 6.0, 7.5], len(number))
    width[chance.random(len(number)) < 0.2] = np.nan
    ways = np.array(["no", "yes", "-1", None], dtype=object)
    surface = np.array(["asphalt", "concrete", "paving stones", "gravel"], dtype=object)
    speed = np.array(["30", "50", None], dtype=object)
    return shapely.linestrings(np.stack([start, bend, end], axis=1)), {
        "surface": surface[chance.integers(0, 4, len(number))],
        "width": width,
        "oneway": ways[chance.choice(4, len(number), p=(0.2, 0.2, 0.1, 0.5))],
        "maxspeed": speed[chance.integers(0, 3, len(number))],
    }


def _surfaces(city: City, number: npt.NDArray[np.int64], chance: np.random.Generator) -> Rows:
    """Make the surface of every tenth street, and of the crossing that it begins at."""
    start, end = _street_ends(city, number * 10)
    low, high = np.minimum(start, end) - STREET_M / 2, np.maximum(start, end) + STREET_M / 2
    surface = np.array(["asphalt", "paving stones", "gravel"], dtype=object)[
        chance.integers(0, 3, len(number))
    ]
    name = np.array([f"street {k}" for k in (number * 10).tolist()], dtype=object)
    return shapely.box(*low.T, *high.T), {"surface": surface, "name": name}


def _keepouts(city: City, number: npt.NDArray[np.int64], chance: np.random.Generator) -> Rows:
    """Make a turned area in the middle of some blocks."""
    block = (number * 500 // LOTS**2) % city.blocks**2
    centre = _corner(city, block) + STREET_M + LOTS * LOT_M / 2
    reach = chance.uniform(3, 30, (len(number), 2))
    rings = _placed(_SQUARE, centre, reach, chance.uniform(0, 1.5, len(number)))
    name = np.array([f"works {k}" for k in number.tolist()], dtype=object)
    return shapely.polygons(rings), {"name": name}


def main() -> None:
    """Make the city that the command line asks for."""
    parser = argparse.ArgumentParser(description="Make up a city as GIS data.")
    parser.add_argument("folder", type=Path)
    parser.add_argument("--buildings", type=int, default=City().buildings)
    parser.add_argument("--seed", type=int, default=City().seed)
    given = parser.parse_args()
    if given.buildings < 1:
        parser.error(f"--buildings is {given.buildings}: give 1 or more.")
    city, folder = City(given.buildings, given.seed), given.folder.resolve()
    city.write(folder)
    arguments = " ".join(f"'{one}'" for one in city.publish_arguments(folder, folder / "site"))
    print(
        f"{folder}: city.gpkg of {city.buildings} buildings, {city.side / 1000:.1f} km a side, and city.toml"
    )
    print(f"Publish it: qgis_process run {arguments}")


if __name__ == "__main__":
    main()

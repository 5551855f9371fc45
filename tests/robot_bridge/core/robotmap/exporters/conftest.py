"""Small maps to export, and a reader that follows nav2_map_server's rules."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
import yaml
from PIL import Image

from robot_bridge.core.robotmap.builder import build_map
from robot_bridge.core.robotmap.model import RobotMap, ShapeType, Window
from robot_bridge.core.robotmap.outlines import OutlineRow, Outlines
from robot_bridge.core.sites.site import Site, read_site


@dataclass(frozen=True)
class ReadMap:
    """What a robot has after loading a map: the OccupancyGrid's data, row 0 the lowest."""

    cells: np.ndarray
    resolution: float
    origin: tuple[float, float, float]
    mode: str

    def at(self, x: float, y: float) -> int:
        """Return the cell at a place, as costmaps look it up."""
        column = int((x - self.origin[0]) / self.resolution)
        row = int((y - self.origin[1]) / self.resolution)
        return int(self.cells[row, column])


def read_nav2(file: Path) -> ReadMap:
    """Read a YAML and its image as loadMapFromYaml of nav2_map_server does (map_io.cpp)."""
    content = yaml.safe_load(file.read_text(encoding="utf-8"))
    shade = np.asarray(Image.open(file.parent / content["image"]).convert("L"), dtype=float) / 255.0
    occupied = shade if int(content["negate"]) else 1.0 - shade
    high, low = float(content["occupied_thresh"]), float(content["free_thresh"])
    mode = content.get("mode", "trinary")
    if mode == "raw":
        value = np.round(shade * 255)
        cells = np.where(value <= 100, value, -1)
    else:
        between = np.rint((occupied - low) / (high - low) * 100.0) if mode == "scale" else -1
        cells = np.where(high < occupied, 100, np.where(occupied < low, 0, between))
    origin = tuple(float(number) for number in content["origin"])
    assert len(origin) == 3
    return ReadMap(cells[::-1].astype(np.int8), float(content["resolution"]), origin, mode)


@pytest.fixture
def read_written(tmp_path):
    """Write files as an export returns them, and read the map among them back."""

    def read(files: dict[str, bytes]) -> ReadMap:
        for name, content in files.items():
            (tmp_path / name).write_bytes(content)
        (name,) = [name for name in files if name.endswith(".yaml")]
        return read_nav2(tmp_path / name)

    return read


@pytest.fixture
def read_nav2_file():
    """The reader itself, for files that others wrote."""
    return read_nav2


@pytest.fixture
def make_map():
    """Return a map of outlines, each (points, keyword arguments of OutlineRow)."""

    def make(outlines: Sequence[tuple[Sequence, dict]], window: Sequence[float], meta=None) -> RobotMap:
        standard = {
            "shape_type": ShapeType.CLOSED_POLYGON,
            "height": 3.0,
            "semantics": "building",
            "source": "",
        }
        rows = [
            OutlineRow(points=np.array(points, dtype=float), **{**standard, **given})
            for points, given in outlines
        ]
        return build_map(Outlines.from_rows(rows), Window.from_bounds(*window), meta)

    return make


@pytest.fixture
def house() -> list:
    """An outline that has no symmetry, with its lower left corner in (12, 21)."""
    return [(12, 21), (18, 21), (18, 22), (14, 22), (14, 26), (12, 26), (12, 21)]


@pytest.fixture(scope="session")
def site_on_disk(root) -> Site:
    """The site that comes with the product."""
    return read_site(root / "resources" / "sample_site")


@pytest.fixture(scope="session")
def count_regions():
    """Return how many regions true cells form that are connected by their edges."""

    def count(cells: np.ndarray) -> int:
        left = set(zip(*np.nonzero(cells), strict=True))
        regions = 0
        while left:
            regions += 1
            found = [left.pop()]
            while found:
                row, column = found.pop()
                near = {(row + 1, column), (row - 1, column), (row, column + 1), (row, column - 1)} & left
                left -= near
                found += near
        return regions

    return count

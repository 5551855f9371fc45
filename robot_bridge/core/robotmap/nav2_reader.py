"""Reader of Nav2's maps: the YAML beside an image, and the meaning of its pixels.

The rules are those of nav2_map_server (map_io.cpp): the darker a pixel, the more occupied, unless ``negate``
is set; the first row of the image is the highest; ``origin`` is x, y and yaw of the lower left corner of the
lower left pixel.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import NavigationMapError, in_one_line, installation

LARGEST_MAP = 64_000_000
"""cells that a map may have, the same limit as for writing."""
LARGEST_YAML = 65_536
"""characters of the YAML: it holds eight short lines."""
MODES = "trinary", "scale", "raw"
UNKNOWN, FREE, OCCUPIED = -1, 0, 100
_FINEST, _COARSEST = 1e-4, 1e3
_FARTHEST = 1e8
_PLACE = re.compile(r"# (crs|origin|rotation) (\S+)")


@dataclass(frozen=True)
class Nav2Map:
    """The YAML of a map: ``image`` is its file, ``resolution`` metres, ``origin`` x, y in metres and yaw.

    ``meta`` are crs, origin and rotation of the site, if its leading comments state them.
    """

    image: str
    resolution: float
    origin: tuple[float, float, float]
    mode: str = "trinary"
    negate: bool = False
    occupied_thresh: float = 0.65
    free_thresh: float = 0.25
    meta: Mapping[str, str] = field(default_factory=dict)

    def corners(self, columns: int, rows: int) -> NDArray[np.float64]:
        """Return the image's upper left, upper right and lower left corner, (3, 2) metres, map frame."""
        x, y, yaw = self.origin
        width, height = columns * self.resolution, rows * self.resolution
        flat = np.array([[0.0, height], [width, height], [0.0, 0.0]])
        turn = np.array([[math.cos(yaw), math.sin(yaw)], [-math.sin(yaw), math.cos(yaw)]])
        corners: NDArray[np.float64] = flat @ turn + (x, y)
        return corners


def read_yaml(text: str) -> Nav2Map:
    """Return the parsed YAML of a map; raises NavigationMapError, naming the key."""
    values = _values(text)
    mode = values.get("mode", "trinary")
    if mode not in MODES:
        raise NavigationMapError(f"mode: {mode!r:.40} is none of {', '.join(MODES)}")
    image = values.get("image")
    if not isinstance(image, str) or not image.strip():
        raise NavigationMapError("image: there is none; give the name of the image's file")
    negate = values.get("negate", 0)
    if negate not in (0, 1):
        raise NavigationMapError(f"negate: {negate!r:.40}; give 0 or 1")
    occupied = _number(values, "occupied_thresh", 0.65, 0.0, 1.0)
    free = _number(values, "free_thresh", 0.25, 0.0, 1.0)
    if free >= occupied:
        raise NavigationMapError(
            f"free_thresh: {free:g} is not below occupied_thresh, {occupied:g}; a pixel could be both"
        )
    resolution = _number(values, "resolution", None, _FINEST, _COARSEST)
    return Nav2Map(image, resolution, _origin(values), mode, bool(negate), occupied, free, _place(text))


def check_size(columns: int, rows: int) -> None:
    """Raise NavigationMapError for an image of more cells than a map may have."""
    if columns * rows > LARGEST_MAP:
        raise NavigationMapError(
            f"the image has {columns} x {rows} pixels; a map has at most {LARGEST_MAP / 1e6:g} million: "
            "cut it or make it coarser"
        )


def cells_of(bands: NDArray[np.uint8], described: Nav2Map, *, alpha: bool = False) -> NDArray[np.int16]:
    """Return -1 (unknown) or 0 to 100 (occupied) for each pixel, (rows, columns), first row highest.

    ``bands`` are (bands, rows, columns) of 0 to 255; with ``alpha`` the last is opacity. A transparent pixel
    is unknown in mode scale, and accordingly lighter in mode trinary, as in Nav2.
    """
    colours = bands[:-1] if alpha else bands
    opacity = bands[-1] if alpha else None
    shades = bands if alpha and described.mode == "trinary" else colours
    # By the sum of the bands, which has few values, not by pixel: a city has tens of millions.
    total = shades.sum(axis=0, dtype=np.uint16)
    most = 255 * len(shades)
    table = _of_shade(np.arange(most + 1) / most, described)
    cells: NDArray[np.int16] = table[total]
    if opacity is not None and described.mode == "scale":
        cells[opacity < 255] = UNKNOWN
    return cells


def _of_shade(light: NDArray[np.float64], described: Nav2Map) -> NDArray[np.int16]:
    """Return the cell that a pixel makes of each lightness from 0 to 1."""
    if described.mode == "raw":
        value = np.rint(light * 255)
        return np.where(value <= OCCUPIED, value, UNKNOWN).astype(np.int16)
    occupied = light if described.negate else 1.0 - light
    between = float(UNKNOWN) * np.ones_like(light)
    if described.mode == "scale":
        span = described.occupied_thresh - described.free_thresh
        between = np.rint((occupied - described.free_thresh) / span * 100)
    low = np.where(occupied < described.free_thresh, FREE, between)
    return np.where(occupied > described.occupied_thresh, OCCUPIED, low).astype(np.int16)


def _values(text: str) -> dict[str, Any]:
    if len(text) > LARGEST_YAML:
        raise NavigationMapError(f"the YAML has {len(text)} characters; that of a map has few lines")
    try:
        import yaml
    except ImportError:
        raise NavigationMapError(
            f"the Python package PyYAML is missing: install it {installation('PyYAML')}"
        ) from None
    try:
        # Not libyaml's loader: deeply nested brackets crash its process.
        values = yaml.load(text, yaml.SafeLoader)
    except (yaml.YAMLError, RecursionError, ValueError) as error:
        raise NavigationMapError(f"it is no YAML: {in_one_line(error)[:200]}") from None
    if not isinstance(values, dict):
        raise NavigationMapError("it holds no keys such as image, resolution and origin")
    return values


def _number(
    values: Mapping[str, Any], key: str, default: float | None, least: float, most: float, value: Any = None
) -> float:
    value = values.get(key, default) if value is None else value
    try:
        # YAML 1.1 reads 1e-2 as a text.
        number = float(value) if isinstance(value, (int, float, str)) else math.nan
    except ValueError:
        number = math.nan
    if isinstance(value, bool) or not least <= number <= most:
        raise NavigationMapError(f"{key}: {value!r:.40}; give a number from {least:g} to {most:g}")
    return number


def _origin(values: Mapping[str, Any]) -> tuple[float, float, float]:
    origin = values.get("origin")
    if not isinstance(origin, list) or len(origin) != 3:
        raise NavigationMapError(f"origin: {origin!r:.60}; give [x, y, yaw]")
    x, y = (_number(values, "origin", None, -_FARTHEST, _FARTHEST, one) for one in origin[:2])
    return x, y, _number(values, "origin", None, -1e3, 1e3, origin[2])


def _place(text: str) -> dict[str, str]:
    """Return crs, origin and rotation of the site from the leading comments, if they name a CRS."""
    found = {}
    for line in text.splitlines():
        if not line.startswith("#"):
            break
        if match := _PLACE.fullmatch(line.strip()):
            found[match[1]] = match[2]
    return found if "crs" in found else {}

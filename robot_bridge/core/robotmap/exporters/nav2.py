"""Nav2 export: raster, occupancy grid, PGM and YAML, keepout and speed masks."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from ...errors import ExportGridError, MaskAreaError
from ..model import Border, Obstacle, RobotMap, ShapeType
from .geometries import Points, edges_of, flanks_of, signed_area, solids_of

# --- The cells of a grid: their places, and their largest number ---

LARGEST_GRID = 64_000_000
"""cells that a grid may have by default: 400 m x 400 m at 5 cm, about 64 MB for a robot."""

_WHOLE = 1e-6
"""cells; a border this much wider than a whole number of cells has no further cell."""


@dataclass(frozen=True)
class RasterGrid:
    """Square cells of ``resolution`` metres; (x_min, y_min) is the lower left corner of cell (0, 0).

    Row 0 is the lowest, as in a ROS OccupancyGrid; images, whose first row is the highest, are flipped when
    written.
    """

    x_min: float
    y_min: float
    resolution: float
    columns: int
    rows: int

    @classmethod
    def covering(cls, border: Border, resolution: float, limit: int = LARGEST_GRID) -> RasterGrid:
        """Return the grid that covers ``border``, its origin in the border's lower left corner.

        Raises ExportGridError when the resolution is no length or there would be more than ``limit`` cells.
        """
        if not math.isfinite(resolution) or resolution <= 0:
            raise ExportGridError(
                f"resolution: {resolution} m is no side of a cell; give one above 0, such as 0.05"
            )
        width, height = border.x_max - border.x_min, border.y_max - border.y_min
        columns = max(1, math.ceil(width / resolution - _WHOLE))
        rows = max(1, math.ceil(height / resolution - _WHOLE))
        if columns * rows > limit:
            coarse = _rounded_up(math.sqrt(width * height / limit))
            raise ExportGridError(
                f"resolution: {width:g} m x {height:g} m at {resolution:g} m are {columns} x {rows} = "
                f"{columns * rows / 1e6:.1f} million cells, the limit is {limit / 1e6:g} million; choose "
                f"{coarse:g} m or coarser, or a smaller window"
            )
        return cls(border.x_min, border.y_min, resolution, columns, rows)


def _rounded_up(length: float) -> float:
    """Return ``length`` in metres, rounded up to two digits."""
    step = 10.0 ** (math.floor(math.log10(length)) - 1)
    return round(math.ceil(length / step + 1e-9) * step, 12)


# --- Lines and areas on a grid, vectorised: cells touched by lines, cell centres enclosed by rings

CellArray = NDArray[Any]

_NOISE_DIGITS = 6
"""Significant digits of a cell; further digits are floating-point noise."""

_FAR = 1e9
"""cells; a file may hold numbers beyond the range of integers."""

_BAND_CELLS = 1 << 21
"""cells that are summed at once, so that memory stays far below that of whole grids of integers."""


def touched_cells(grid: RasterGrid, a: NDArray[Any], b: NDArray[Any]) -> CellArray:
    """Return (rows, columns) bool, true for each cell that one of the segments a→b, (n, 2) metres, touches.

    Consecutive cells of a line share edges, never only corners, so thin walls have no gaps. A line along the
    edge of two cells belongs to the upper or right one, on the far border of the grid to the last one.
    """
    lower, upper = _in_cells(grid, a, b)
    first = np.maximum(_floor(lower[:, 1], grid.rows), 0)
    last = np.minimum(_floor(upper[:, 1], grid.rows), grid.rows - 1)
    inside = (upper[:, 1] >= 0) & (lower[:, 1] <= grid.rows)
    segment, row = _rows_of(first, last, inside)
    low, high = lower[segment], upper[segment]
    ends = (_x_at(low, high, np.maximum(low[:, 1], row)), _x_at(low, high, np.minimum(high[:, 1], row + 1)))
    flat = low[:, 1] == high[:, 1]
    left = np.where(flat, np.minimum(low[:, 0], high[:, 0]), np.minimum(*ends))
    right = np.where(flat, np.maximum(low[:, 0], high[:, 0]), np.maximum(*ends))
    left, right = np.round(left, _NOISE_DIGITS), np.round(right, _NOISE_DIGITS)
    kept = (right >= 0) & (left <= grid.columns)
    begin = np.maximum(_floor(left[kept], grid.columns), 0)
    end = np.minimum(_floor(right[kept], grid.columns), grid.columns - 1) + 1
    row = row[kept]
    ones = np.ones(len(row))
    return _summed(
        grid, np.concatenate([row, row]), np.concatenate([begin, end]), np.concatenate([ones, -ones])
    )


def enclosed_cells(grid: RasterGrid, a: NDArray[Any], b: NDArray[Any]) -> CellArray:
    """Return (rows, columns) bool, true where rings of segments a→b, (n, 2) metres, enclose a cell's centre.

    Counter-clockwise rings count up and clockwise ones down, so a courtyard opens its building and a building
    in a courtyard closes it again.
    """
    lower, upper = _in_cells(grid, a, b)
    first = np.maximum(np.ceil(lower[:, 1] - 0.5).astype(np.int64), 0)
    last = np.minimum(np.ceil(upper[:, 1] - 0.5).astype(np.int64) - 1, grid.rows - 1)
    segment, row = _rows_of(first, last, np.ones(len(first), dtype=bool))
    x = np.round(_x_at(lower[segment], upper[segment], row + 0.5), _NOISE_DIGITS)
    column = np.clip(np.ceil(x - 0.5).astype(np.int64), 0, grid.columns)
    # A downward segment has the inside on its right side of the sheet, where the row continues.
    return _summed(grid, row, column, np.sign(a[segment, 1] - b[segment, 1]))


def _in_cells(grid: RasterGrid, a: NDArray[Any], b: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
    """Return the lower and the upper end of each segment, (n, 2) each, in cells from the grid's corner."""
    origin = (grid.x_min, grid.y_min)
    ends = [(end.reshape(-1, 2) - origin) / grid.resolution for end in (a, b)]
    ends = [np.clip(end, -_FAR, _FAR).round(_NOISE_DIGITS) for end in ends]
    upward = (ends[0][:, 1] <= ends[1][:, 1])[:, None]
    return np.where(upward, ends[0], ends[1]), np.where(upward, ends[1], ends[0])


def _floor(values: NDArray[Any], count: int) -> NDArray[Any]:
    """Return the cell of each coordinate; the far border belongs to the last cell."""
    cells: NDArray[Any] = np.where(values == count, count - 1, np.floor(values)).astype(np.int64)
    return cells


def _rows_of(
    first: NDArray[Any], last: NDArray[Any], inside: NDArray[Any]
) -> tuple[NDArray[Any], NDArray[Any]]:
    """Return the segment and the row of each such pair."""
    count = np.where(inside, np.maximum(last - first + 1, 0), 0)
    segment = np.repeat(np.arange(len(count)), count)
    begin = np.cumsum(count) - count
    return segment, first[segment] + np.arange(len(segment)) - begin[segment]


def _x_at(low: NDArray[Any], high: NDArray[Any], y: NDArray[Any]) -> NDArray[Any]:
    rise = high[:, 1] - low[:, 1]
    part = np.divide(y - low[:, 1], rise, out=np.zeros(len(rise)), where=rise > 0)
    x: NDArray[Any] = low[:, 0] + np.clip(part, 0.0, 1.0) * (high[:, 0] - low[:, 0])
    return x


def _summed(grid: RasterGrid, row: NDArray[Any], column: NDArray[Any], weight: NDArray[Any]) -> CellArray:
    """Return where the weights at or to the left of a cell in its row sum up to more than 0."""
    cells = np.zeros((grid.rows, grid.columns), dtype=bool)
    order = np.argsort(row, kind="stable")
    row, column, weight = row[order], column[order], weight[order]
    width = grid.columns + 1
    for low, high in _bands(grid):
        start, end = np.searchsorted(row, (low, high))
        if start == end:
            continue
        place = (row[start:end] - low) * width + column[start:end]
        steps = np.bincount(place, weights=weight[start:end], minlength=(high - low) * width)
        cells[low:high] = np.cumsum(steps.reshape(-1, width), axis=1)[:, :-1] > 0.5
    return cells


def _bands(grid: RasterGrid) -> Iterator[tuple[int, int]]:
    height = max(1, _BAND_CELLS // grid.columns)
    for low in range(0, grid.rows, height):
        yield low, min(low + height, grid.rows)


# --- A robot map as an occupancy grid, as read by Nav2 and AMCL ---

FREE, OCCUPIED, UNKNOWN = 0, 100, -1
"""Values of nav_msgs/OccupancyGrid."""

Inside = Literal["unknown", "occupied"]


@dataclass(frozen=True, eq=False)
class Occupancy:
    """``cells`` is (rows, columns) int8 of FREE, OCCUPIED and UNKNOWN; row 0 is the lowest."""

    grid: RasterGrid
    cells: NDArray[Any]
    warnings: tuple[str, ...] = ()


def occupancy_of(
    robot_map: RobotMap,
    resolution: float = 0.05,
    *,
    inside: Inside = "unknown",
    drives_over: float = 0.0,
    limit: int = LARGEST_GRID,
) -> Occupancy:
    """Return the grid of a map, with the site frame as its frame.

    Every cell that a segment touches is occupied. Cells whose centre lies in an obstacle are unknown: the map
    has its wall and nothing behind it, and a laser scan matched against a solid block would fit equally well
    a metre too deep. The wall has no gap, so a planner enters neither way; ``inside="occupied"`` fills it on
    request. Courtyards and everything else within the border are free, cells whose centre lies beyond the
    border unknown. Segments lower than ``drives_over`` metres and ramps are no obstacles; stairs are, with
    their flanks.

    :raises ExportGridError: when the resolution is no length or the grid would have more than ``limit``
    cells.
    """
    grid = RasterGrid.covering(robot_map.border, resolution, limit)
    solids, warnings = solids_of(robot_map)
    kept = [solid.ring for solid in solids if not _driven_over(solid.obstacle, drives_over).all()]
    cells = np.full((grid.rows, grid.columns), FREE, dtype=np.int8)
    cells[enclosed_cells(grid, *edges_of(kept))] = OCCUPIED if inside == "occupied" else UNKNOWN
    _forget_beyond(robot_map, grid, cells)
    cells[touched_cells(grid, *_walls(robot_map, drives_over))] = OCCUPIED
    return Occupancy(grid, cells, tuple(warnings))


def _walls(robot_map: RobotMap, drives_over: float) -> tuple[NDArray[Any], NDArray[Any]]:
    """Return the blocking segments, a→b, (n, 2) each."""
    starts, ends = [np.empty((0, 2))], [np.empty((0, 2))]
    for obstacle in robot_map.obstacles:
        stands = ~_driven_over(obstacle, drives_over)
        starts.append(obstacle.a[stands])
        ends.append(obstacle.b[stands])
        if obstacle.shape_type is ShapeType.STAIRS and stands.any():
            sides = flanks_of(obstacle)
            starts.append(sides[0])
            ends.append(sides[1])
    return np.concatenate(starts), np.concatenate(ends)


def _driven_over(obstacle: Obstacle, drives_over: float) -> NDArray[Any]:
    """Return which segments a robot drives over; a flight of stairs is judged by its highest riser."""
    if obstacle.shape_type is ShapeType.RAMP:
        return np.ones(len(obstacle.a), dtype=bool)
    if obstacle.shape_type is ShapeType.STAIRS:
        return np.full(len(obstacle.a), bool((obstacle.height < drives_over).all()))
    lower: NDArray[Any] = obstacle.height < drives_over
    return lower


def _forget_beyond(robot_map: RobotMap, grid: RasterGrid, cells: NDArray[Any]) -> None:
    """Mark the cells whose centre lies beyond the right or upper border."""
    x = grid.x_min + (np.arange(grid.columns) + 0.5) * grid.resolution
    y = grid.y_min + (np.arange(grid.rows) + 0.5) * grid.resolution
    cells[:, x > robot_map.border.x_max] = UNKNOWN
    cells[y > robot_map.border.y_max] = UNKNOWN


# --- The two files of a Nav2 map: a PGM image and its YAML description ---
# The rules are those of nav2_map_server (map_io.cpp): the darker a pixel, the more occupied; the first row
# of
# the image is the highest; ``origin`` is the lower left corner of the lower left pixel.

FREE_PIXEL, UNKNOWN_PIXEL, OCCUPIED_PIXEL = 254, 205, 0
"""The pixel values of map_saver."""

OCCUPIED_THRESHOLD, FREE_THRESHOLD = 0.65, 0.196
"""205 is occupied by 50/255 = 0.19608: above 0.196, so unknown, and below the 0.25 that map_saver writes into
its files, which would make it free."""


def trinary_files(
    name: str, grid: RasterGrid, cells: NDArray[Any], comments: Mapping[str, str] | None = None
) -> dict[str, bytes]:
    """Return ``name``.pgm and ``name``.yaml of occupied, free and unknown ``cells``, (rows, columns) int8.

    ``comments`` are written at the head of the YAML as ``# key value``.
    """
    pixels = np.full(cells.shape, FREE_PIXEL, dtype=np.uint8)
    pixels[cells == UNKNOWN] = UNKNOWN_PIXEL
    pixels[cells == OCCUPIED] = OCCUPIED_PIXEL
    yaml = _yaml(name, grid, "trinary", (OCCUPIED_THRESHOLD, FREE_THRESHOLD), comments or {})
    return {f"{name}.pgm": _pgm(pixels), f"{name}.yaml": yaml}


def scale_files(
    name: str, grid: RasterGrid, cells: NDArray[Any], comments: Mapping[str, str] | None = None
) -> dict[str, bytes]:
    """Return ``name``.pgm and ``name``.yaml of ``cells``, (rows, columns) int8, each from 0 to 100."""
    pixels = np.round(255.0 * (100 - np.arange(101)) / 100.0).astype(np.uint8)[cells]
    yaml = _yaml(name, grid, "scale", (1.0, 0.0), comments or {})
    return {f"{name}.pgm": _pgm(pixels), f"{name}.yaml": yaml}


def _pgm(pixels: NDArray[Any]) -> bytes:
    rows, columns = pixels.shape
    return b"P5\n%d %d\n255\n" % (columns, rows) + pixels[::-1].tobytes()


def _yaml(
    name: str, grid: RasterGrid, mode: str, thresholds: tuple[float, float], comments: Mapping[str, str]
) -> bytes:
    occupied, free = thresholds
    lines = [
        *(_comment(f"{key} {value}") for key, value in comments.items()),
        f"image: {_word(name + '.pgm')}",
        f"mode: {mode}",
        f"resolution: {_number(grid.resolution)}",
        f"origin: [{_number(grid.x_min)}, {_number(grid.y_min)}, 0.0]",
        "negate: 0",
        f"occupied_thresh: {occupied}",
        f"free_thresh: {free}",
    ]
    return ("\n".join(lines) + "\n").encode()


def _comment(text: str) -> str:
    """Return one line of comment; YAML forbids control characters even there."""
    return "# " + "".join(letter if letter.isprintable() else " " for letter in text).strip()


def _word(text: str) -> str:
    """Return a text as a YAML scalar; in quotes, YAML reads what JSON reads."""
    plain = re.fullmatch(r"[A-Za-z_][A-Za-z0-9_./-]*", text)
    return text if plain else json.dumps(text, ensure_ascii=False).replace("\x7f", "\\x7f")


def _number(value: float) -> str:
    return np.format_float_positional(value, trim="0")


# --- Masks for Nav2's costmap filters: keepouts and speed limits ---

NO_LIMIT = 0
"""The value that SpeedFilter treats as no limit; it refuses unknown cells."""

_STEPS = (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0)


@dataclass(frozen=True)
class MaskArea:
    """One polygon: the outer ring, then its holes, each (n, 2) metres in the site frame, in any direction.

    ``speed`` in m/s is for speed masks. ``name`` is for messages.
    """

    rings: Sequence[Points]
    name: str
    speed: float = math.nan


@dataclass(frozen=True, eq=False)
class SpeedMask:
    """``cells`` is (rows, columns) int8 from 0, no limit, to 100; the limit is cell x ``multiplier`` m/s."""

    grid: RasterGrid
    cells: NDArray[Any]
    multiplier: float


def keepout_mask(grid: RasterGrid, areas: Sequence[MaskArea]) -> NDArray[Any]:
    """Return (rows, columns) int8, OCCUPIED in each cell that an area touches and FREE elsewhere.

    KeepoutFilter leaves free cells unchanged in the costmap. Raises MaskAreaError.
    """
    cells = np.full((grid.rows, grid.columns), FREE, dtype=np.int8)
    cells[_covered(grid, areas)] = OCCUPIED
    return cells


def speed_mask(grid: RasterGrid, areas: Sequence[MaskArea]) -> SpeedMask:
    """Return the mask of speed limits, rounded down to steps.

    Where areas overlap the lower speed holds; a cell on an edge belongs to both sides. Raises MaskAreaError
    for a speed that is not above 0, and for one too low relative to the highest to differ from 0.
    """
    for area in areas:
        if not math.isfinite(area.speed) or area.speed <= 0:
            raise MaskAreaError(
                f"{area.name}: its speed is {area.speed:g} m/s; give one above 0, or make it a keepout area"
            )
    fastest = max((area.speed for area in areas), default=1.0)
    multiplier = _step_for(fastest)
    cells = np.full((grid.rows, grid.columns), NO_LIMIT, dtype=np.int8)
    for speed in sorted({area.speed for area in areas}, reverse=True):
        alike = [area for area in areas if area.speed == speed]
        value = math.floor(speed / multiplier + 1e-9)
        if value < 1:
            raise MaskAreaError(
                f"{alike[0].name}: {speed:g} m/s cannot be told from 0 in a mask that also holds {fastest:g} "
                f"m/s; give at least {multiplier:g} m/s, or make it a keepout area"
            )
        cells[_covered(grid, alike)] = value
    return SpeedMask(grid, cells, multiplier)


def filter_parameters(kind: int, mask: str, multiplier: float = 1.0) -> bytes:
    """Return the parameters of Nav2's costmap_filter_info_server that belong to a mask, as YAML.

    ``kind`` is 0 for keepout and 2 for speeds in m/s; ``mask`` names the topics.
    """
    return (
        f"{mask}_filter_info_server:\n"
        "  ros__parameters:\n"
        f"    type: {kind}\n"
        f"    filter_info_topic: {mask}_filter_info\n"
        f"    mask_topic: {mask}_filter_mask\n"
        "    base: 0.0\n"
        f"    multiplier: {multiplier}\n"
    ).encode()


def _covered(grid: RasterGrid, areas: Sequence[MaskArea]) -> NDArray[Any]:
    """Return which cells an area touches, even without their centre."""
    rings = [ring for area in areas for ring in _oriented(area)]
    edges = edges_of(rings)
    covered: NDArray[Any] = enclosed_cells(grid, *edges) | touched_cells(grid, *edges)
    return covered


def _oriented(area: MaskArea) -> list[Points]:
    """Return the rings closed, the outer one counter-clockwise and holes clockwise."""
    oriented = []
    for number, points in enumerate(area.rings):
        ring = np.asarray(points, dtype=np.float64).reshape(-1, 2)
        if len(ring) < 3 or not np.isfinite(ring).all():
            raise MaskAreaError(
                f"{area.name}: ring {number + 1} is no polygon of finite points; correct or remove it"
            )
        if (ring[0] != ring[-1]).any():
            ring = np.concatenate([ring, ring[:1]])
        solid = signed_area(ring) >= 0
        oriented.append(ring if solid == (number == 0) else ring[::-1])
    return oriented


def _step_for(fastest: float) -> float:
    """Return the smallest step, m/s, of which a hundred reach the highest speed."""
    for step in _STEPS:
        if fastest <= 100 * step * (1 + 1e-9):
            return step
    raise MaskAreaError(
        f"a speed limit of {fastest:g} m/s is above {100 * _STEPS[-1]:g} m/s: give metres a second"
    )

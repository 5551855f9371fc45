"""Where the tiles of a map lie: in a grid, or along a route."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...robot_bridge.robotmap.model import Border
from ...robot_bridge.robotmap.window import Window
from ..language import tr
from .errors import ParameterError

MOST_TILES = 10_000


@dataclass(frozen=True)
class Tile:
    """One window: its ``name``; its row and column in a grid, or how many metres along which route."""

    name: str
    window: Window
    row: int | None = None
    column: int | None = None
    route: int | None = None
    along: float | None = None


@dataclass(frozen=True)
class TileSize:
    """Width along x, height along y, and what neighbours share; metres in the site frame."""

    width: float
    height: float
    overlap: float = 0.0

    def __post_init__(self) -> None:
        for name in ("width", "height"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value >= 1.0):
                raise ParameterError(
                    tr(
                        "The {name} of a tile is {value} m: give at least 1 m, such as 100.",
                        name=name,
                        value=value,
                    )
                )
        if not 0.0 <= self.overlap <= 0.9 * min(self.width, self.height):
            raise ParameterError(
                tr(
                    "OVERLAP is {overlap} m: give 0 or more, and at most nine tenths of a tile's side.",
                    overlap=self.overlap,
                )
            )


def grid_tiles(area: Border, size: TileSize) -> list[Tile]:
    """Return tiles of one size that cover ``area``, from its left-lower corner, row by row.

    The last ones of a row or column reach beyond the area.

    :raises ParameterError: when there would be too many.
    """
    step_x, step_y = size.width - size.overlap, size.height - size.overlap
    columns = _steps(area.x_max - area.x_min - size.overlap, step_x)
    rows = _steps(area.y_max - area.y_min - size.overlap, step_y)
    _check_count(rows * columns)
    return [
        Tile(
            f"tile_r{row + 1:03}_c{column + 1:03}",
            _window(area.x_min + column * step_x, area.y_min + row * step_y, size),
            row=row + 1,
            column=column + 1,
        )
        for row in range(rows)
        for column in range(columns)
    ]


def route_tiles(routes: Sequence[np.ndarray], size: TileSize) -> list[Tile]:
    """Return tiles centred on points of each of ``routes``, (n, 2) metres in the site frame.

    Two that follow each other share at least the overlap, and every point of a route is at least half of it
    inside a tile. Where routes meet, a tile that is there already is left out.

    :raises ParameterError: when there would be too many, or no route has a length.
    """
    step = min(size.width, size.height) - size.overlap
    along = [np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(route, axis=0).T))]) for route in routes]
    counts = [_steps(float(distance[-1]), step) for distance in along]
    _check_count(sum(counts) + len(counts))
    tiles: list[Tile] = []
    seen: set[Border] = set()
    for number, (route, distance, count) in enumerate(zip(routes, along, counts, strict=True), 1):
        for at in np.linspace(0.0, distance[-1], count + 1):
            x, y = (float(np.interp(at, distance, route[:, axis])) for axis in (0, 1))
            window = _window(x - size.width / 2, y - size.height / 2, size)
            if window.border not in seen:
                seen.add(window.border)
                name = f"route_{len(tiles) + 1:04}"
                tiles.append(Tile(name, window, route=number, along=round(float(at), 2)))
    if not tiles:
        raise ParameterError(tr("ROUTE holds no line: choose a layer with the route to export along."))
    return tiles


def area_of(tiles: Sequence[Tile]) -> Border:
    """Return the rectangle that holds all ``tiles``."""
    corners = np.array([tile.window.border for tile in tiles])
    low, high = corners[:, :2].min(axis=0), corners[:, 2:].max(axis=0)
    return Border(float(low[0]), float(low[1]), float(high[0]), float(high[1]))


def _window(x: float, y: float, size: TileSize) -> Window:
    # In whole centimetres, so that neighbours without overlap share their side to the digit.
    x, y = round(x, 2), round(y, 2)
    return Window.from_bounds(x, y, x + size.width, y + size.height)


def _steps(length: float, step: float) -> int:
    # A millimetre more than whole steps is rounding, not a step.
    return max(math.ceil((length - 1e-3) / step), 1)


def _check_count(count: int) -> None:
    if count > MOST_TILES:
        raise ParameterError(
            tr(
                "That would be {count} tiles, and {most_tiles} are the most: choose larger tiles, less "
                "overlap or a smaller area.",
                count=count,
                most_tiles=MOST_TILES,
            )
        )

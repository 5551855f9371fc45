"""The files of each format that ``fleet:exportnavigationmap`` writes."""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from ...robot_bridge.robotmap.exporters.geojson import geojson_of
from ...robot_bridge.robotmap.exporters.grid import Grid
from ...robot_bridge.robotmap.exporters.masks import MaskArea, filter_parameters, keepout_mask, speed_mask
from ...robot_bridge.robotmap.exporters.nav2 import scale_files, trinary_files
from ...robot_bridge.robotmap.exporters.occupancy import Inside, occupancy_of
from ...robot_bridge.robotmap.exporters.shapes import obstacle_shapes, segment_shapes
from ...robot_bridge.robotmap.exporters.svg import svg_of
from ...robot_bridge.robotmap.model import RobotMap
from .geopackage_by_qgis import write_geopackage
from .map_place import PlacedMap
from .svg_picture import png_of

Files = dict[str, bytes]

_KEEPOUT, _SPEED_IN_M_S = 0, 2
"""Types of Nav2's costmap filters."""


@dataclass
class NavigationExport:
    """A map, where it lies, and what to make of it; ``warnings`` grow while files are made."""

    robot_map: RobotMap
    place: PlacedMap
    name: str
    resolution: float
    inside: Inside
    drives_over: float
    keepouts: list[MaskArea] = field(default_factory=list)
    speed_areas: list[MaskArea] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)

    def files(self, format: str) -> Files:
        """Return names and contents of the files of a format; the first is the one to open.

        :raises FleetError: :raises RobotMapError: when the format cannot hold this map.
        """
        return FORMATS[format](self)

    @property
    def grid(self) -> Grid:
        """The grid of the masks, which is that of the occupancy grid."""
        return Grid.covering(self.robot_map.border, self.resolution)


def _occupancy(export: NavigationExport) -> Files:
    made = occupancy_of(
        export.robot_map, export.resolution, inside=export.inside, drives_over=export.drives_over
    )
    export.warnings += made.warnings
    return trinary_files(export.name, made.grid, made.cells, export.robot_map.meta)


def _keepout(export: NavigationExport) -> Files:
    name = f"{export.name}_keepout"
    cells = keepout_mask(export.grid, export.keepouts)
    files = trinary_files(name, export.grid, cells, export.robot_map.meta)
    return {**files, f"{name}_filter.yaml": filter_parameters(_KEEPOUT, "keepout")}


def _speed(export: NavigationExport) -> Files:
    name = f"{export.name}_speed"
    mask = speed_mask(export.grid, export.speed_areas)
    files = scale_files(name, mask.grid, mask.cells, export.robot_map.meta)
    return {**files, f"{name}_filter.yaml": filter_parameters(_SPEED_IN_M_S, "speed", mask.multiplier)}


def _geojson(export: NavigationExport) -> Files:
    robot_map, to_lonlat = export.robot_map, export.place.to_lonlat
    return {
        f"{export.name}_{kind}.geojson": geojson_of(shapes, to_lonlat, robot_map.meta)
        for kind, shapes in (
            ("obstacles", obstacle_shapes(robot_map)),
            ("segments", segment_shapes(robot_map)),
        )
    }


def _geopackage(export: NavigationExport) -> Files:
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / f"{export.name}.gpkg"
        write_geopackage(export.robot_map, file, export.place)
        return {file.name: file.read_bytes()}


def _svg(export: NavigationExport) -> Files:
    return {f"{export.name}.svg": svg_of(export.robot_map)}


def _png(export: NavigationExport) -> Files:
    return {f"{export.name}.png": png_of(svg_of(export.robot_map))}


FORMATS: dict[str, Callable[[NavigationExport], Files]] = {
    "occupancy": _occupancy,
    "keepout": _keepout,
    "speed": _speed,
    "geojson": _geojson,
    "geopackage": _geopackage,
    "svg": _svg,
    "png": _png,
}

"""A robot map as a picture for people, in SVG that browsers and Qt draw alike."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping

import numpy as np

from ...counting import counted
from ..model import RobotMap, ShapeType
from .lines import Points, lines_of
from .palette import FACE, INK, Colours, colours_of, colours_of_labels, deepened
from .roomy import roomy_place
from .shapes import Shape, obstacle_shapes
from .sheet import Sheet, text
from .solids import Solid, solids_of

_LEGEND_ROWS = 12
_TEXT_ROOM = 12.0
"""pixels that a line of text needs above and below its middle."""

_SHADOW = np.array([0.16, -0.12])
"""metres to the right and up for each metre of height."""

_LOWEST_SHADOW, _HIGHEST_SHADOW = 0.5, 30.0
"""metres: what is lower has no shadow, what is higher none that is longer."""


def svg_of(robot_map: RobotMap, title: str = "", size: float = 1000.0) -> bytes:
    """Return the picture of a map: its longer side is ``size`` pixels, plus margins.

    Areas are coloured by the first label and darker where they are higher, with a shadow as long as they are
    high; heights and names stand where there is room. Grid north comes from the leading line ``rotation``.
    """
    sheet = Sheet.of(robot_map.border, size)
    by_label = colours_of_labels(robot_map.obstacles)
    solids, _ = solids_of(robot_map)
    shapes = obstacle_shapes(robot_map)
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{sheet.width}" height="{sheet.height}" '
        f'viewBox="0 0 {sheet.width} {sheet.height}">',
        *sheet.face(),
        *_shadows(sheet, solids, shapes),
        *_cut_areas(sheet, solids, by_label),
        *_areas(sheet, shapes, by_label),
        *_lines(sheet, robot_map, by_label),
        *_labels(sheet, shapes),
        *sheet.surround(title or _title(robot_map), _subtitle(robot_map)),
        *sheet.margin(_north(robot_map), _legend(robot_map, by_label)),
        "</svg>\n",
    ]
    return "\n".join(parts).encode()


def _shadows(sheet: Sheet, solids: list[Solid], shapes: list[Shape]) -> Iterator[str]:
    bodies = [([solid.ring], float(solid.obstacle.height.max())) for solid in solids if solid.cut]
    bodies += [
        (list(shape.parts), shape.attributes["height_m"])
        for shape in shapes
        if shape.kind == "Polygon" and not shape.attributes["courtyard"]
    ]
    for rings, height in bodies:
        if height >= _LOWEST_SHADOW:
            moved = [ring + _SHADOW * min(height, _HIGHEST_SHADOW) for ring in rings]
            yield f'<path d="{_path(sheet, moved)}" fill="{INK}" fill-opacity="0.07" fill-rule="evenodd"/>'


def _cut_areas(sheet: Sheet, solids: list[Solid], by_label: Mapping[str, Colours]) -> Iterator[str]:
    for solid in solids:
        if solid.cut:
            colours = colours_of(solid.obstacle.shape_type, solid.obstacle.semantics, by_label)
            fill = deepened(colours.fill, float(solid.obstacle.height.max()))
            yield f'<path d="{_path(sheet, [solid.ring])}" fill="{fill}"/>'
        elif solid.obstacle.shape_type is ShapeType.STAIRS:
            fill = colours_of(solid.obstacle.shape_type, solid.obstacle.semantics, by_label).fill
            yield f'<path d="{_path(sheet, [solid.ring])}" fill="{fill}"/>'


def _areas(sheet: Sheet, shapes: list[Shape], by_label: Mapping[str, Colours]) -> Iterator[str]:
    areas = [shape for shape in shapes if shape.kind == "Polygon"]
    # Grounds come first, so that they do not cover what stands on them.
    for shape in sorted(areas, key=lambda area: not _is_ground(area)):
        shape_type = shape.attributes["shape_type"]
        colours = colours_of(shape_type, shape.attributes["semantics"], by_label)
        fill = FACE if shape.attributes["courtyard"] else deepened(colours.fill, shape.attributes["height_m"])
        stroke = min(1.6, max(0.8, float(np.ptp(shape.parts[0], axis=0).max()) * sheet.scale / 6))
        dashes = ' stroke-dasharray="6 4"' if shape_type == ShapeType.RAMP else ""
        yield (
            f'<path d="{_path(sheet, shape.parts)}" fill="{fill}" fill-rule="evenodd" '
            f'stroke="{colours.stroke}" stroke-width="{stroke:.1f}" stroke-linejoin="round"{dashes}/>'
        )


def _is_ground(area: Shape) -> bool:
    return bool(area.attributes["courtyard"] or area.attributes["shape_type"] == ShapeType.RAMP)


def _lines(sheet: Sheet, robot_map: RobotMap, by_label: Mapping[str, Colours]) -> Iterator[str]:
    for obstacle in robot_map.obstacles:
        if obstacle.shape_type in (ShapeType.OPEN_POLYGON, ShapeType.OPEN_CURVE):
            width = 2.2
        elif obstacle.shape_type is ShapeType.STAIRS:
            width = 1.2
        else:
            continue
        stroke = colours_of(obstacle.shape_type, obstacle.semantics, by_label).stroke
        path = "".join(_open_path(sheet, line) for line in lines_of(obstacle))
        yield (
            f'<path d="{path}" fill="none" stroke="{stroke}" stroke-width="{width}" '
            'stroke-linecap="round" stroke-linejoin="round"/>'
        )


def _labels(sheet: Sheet, shapes: list[Shape]) -> Iterator[str]:
    """Yield name and height of each area that has room for them."""
    for shape in shapes:
        if shape.kind != "Polygon" or shape.attributes["courtyard"] or not shape.attributes["height_m"]:
            continue
        rings = [sheet.pixels(ring) for ring in shape.parts]
        if np.ptp(rings[0], axis=0).min() < 2 * _TEXT_ROOM:
            continue
        place = roomy_place(rings)
        height = f"{shape.attributes['height_m']:.10g} m"
        name = shape.attributes["semantics"].partition(",")[2].partition(",")[0]
        if place.away < _TEXT_ROOM or len(height) * 3.4 > place.beside:
            continue
        if name and place.away > 1.6 * _TEXT_ROOM and len(name) * 4.2 < place.beside:
            yield text(place.x, place.y - 3, name, 12, INK, "middle", bold=True)
            yield text(place.x, place.y + 12, height, 11, INK, "middle")
        else:
            yield text(place.x, place.y + 4, height, 11, INK, "middle")


def _path(sheet: Sheet, rings: tuple[Points, ...] | list[Points]) -> str:
    return "".join(_open_path(sheet, ring[:-1]) + "Z" for ring in rings)


def _open_path(sheet: Sheet, line: Points) -> str:
    return "M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in sheet.pixels(line).tolist())


def _title(robot_map: RobotMap) -> str:
    meta = robot_map.meta
    version = f", version {meta['version']}" if "version" in meta else ""
    return f"{meta['id']}{version}" if meta.get("id") else "Robot map"


def _subtitle(robot_map: RobotMap) -> str:
    border = robot_map.border
    size = f"{border.x_max - border.x_min:.10g} m × {border.y_max - border.y_min:.10g} m"
    counts = f"{counted(len(robot_map.obstacles), 'obstacle')}, {counted(robot_map.segment_count, 'segment')}"
    return " · ".join(part for part in (size, counts, robot_map.meta.get("crs", "")) if part)


def _north(robot_map: RobotMap) -> float | None:
    """Return the angle of grid north clockwise from the site's y axis, radians; None when it is not known."""
    # A CRS of a site's own has a name instead of a code, and its y axis may point anywhere.
    if not re.fullmatch(r"\w+:\w+", robot_map.meta.get("crs", "")):
        return None
    try:
        angle = float(robot_map.meta.get("rotation", "0"))
    except ValueError:
        return None
    return angle if math.isfinite(angle) else None


def _legend(robot_map: RobotMap, by_label: Mapping[str, Colours]) -> list[tuple[str, Colours]]:
    rows: dict[str, Colours] = {}
    for label in by_label:
        example = next(o for o in robot_map.obstacles if o.semantics.partition(",")[0] == label)
        rows[label or "(no label)"] = colours_of(example.shape_type, example.semantics, by_label)
    shown = list(rows.items())
    if len(shown) <= _LEGEND_ROWS:
        return shown
    more = len(shown) - _LEGEND_ROWS + 1
    return [*shown[: _LEGEND_ROWS - 1], (f"and {more} more", Colours("#ffffff", "#847c74"))]

"""SVG picture of a robot map: palette, sheet, labels."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple
from xml.sax.saxutils import escape  # nosec B406 # writes XML, reads none

import numpy as np
from numpy.typing import NDArray

from ...errors import counted
from ..model import Border, Obstacle, RobotMap, ShapeType
from .geometries import MapShape, Points, Solid, first_label, lines_of, obstacle_shapes, solids_of

# --- Colours of obstacles in a picture, by label ---

FACE, GRID_LINE, INK, QUIET = "#f5f2ec", "#ffffff", "#2f2a26", "#847c74"


class Colours(NamedTuple):
    """The fill of an area and the stroke of its walls, ``#rrggbb``."""

    fill: str
    stroke: str


STAIRS = Colours("#ecbfa3", "#96512c")
RAMP = Colours("#d3e3ec", "#4f7b96")
_KNOWN = (
    (("building", "house", "hall", "roof", "garage"), Colours("#dcc7aa", "#6b563f")),
    (("wall", "fence", "barrier", "railing", "kerb"), Colours("#a49c91", "#47423d")),
    (("column", "pillar", "pier"), Colours("#c0b0d4", "#5b4a78")),
    (("bin", "waste"), Colours("#9fcdbb", "#2a6a56")),
    (("bench", "planter", "furniture", "rack", "table"), Colours("#cbd8a6", "#5a6d31")),
    (("lamp", "post", "bollard", "pole", "mast"), Colours("#f1d283", "#846510")),
    (("tree", "hedge", "plant", "wood"), Colours("#aed299", "#3b6a29")),
    (("stair", "step"), STAIRS),
)
_OTHERS = (
    Colours("#b5cbe3", "#33557c"),
    Colours("#e6b8c2", "#8a3a4d"),
    Colours("#c9d9d2", "#43665a"),
    Colours("#e3d4ee", "#6d4a86"),
    Colours("#efd9b4", "#8b6424"),
    Colours("#cfcfd8", "#52525f"),
)


def colours_of_labels(obstacles: Iterable[Obstacle]) -> dict[str, Colours]:
    """Return the colours of every first label, commonest first; the same labels always get the same ones."""
    counts: dict[str, int] = {}
    for obstacle in obstacles:
        counts[first_label(obstacle)] = counts.get(first_label(obstacle), 0) + 1
    others = [label for label in sorted(counts) if _known(label) is None]
    colours = {label: _OTHERS[k % len(_OTHERS)] for k, label in enumerate(others)}
    order = sorted(counts, key=lambda label: (-counts[label], label))
    return {label: _known(label) or colours[label] for label in order}


def colours_of(shape_type: int, semantics: str, by_label: Mapping[str, Colours]) -> Colours:
    """Return the colours of an obstacle: those of stairs and ramps depend on their shape type."""
    if shape_type == ShapeType.STAIRS:
        return STAIRS
    if shape_type == ShapeType.RAMP:
        return RAMP
    return by_label[semantics.partition(",")[0]]


def deepened(colour: str, height: float) -> str:
    """Return a fill that is darker for what is higher, up to 30 m."""
    keep = 1.0 - 0.30 * min(max(height, 0.0), 30.0) / 30.0
    return "#" + "".join(f"{round(int(colour[k : k + 2], 16) * keep):02x}" for k in (1, 3, 5))


def _known(label: str) -> Colours | None:
    text = label.lower()
    return next((colours for words, colours in _KNOWN if any(word in text for word in words)), None)


# --- Place for a label in a polygon ---

_STEPS = 24
_AS_GOOD = 0.85
"""Share of the best distance that is enough for a place nearer to the middle."""


class LabelPosition(NamedTuple):
    """A point, how far it is from the nearest side, and from the nearest one on its left and right."""

    x: float
    y: float
    away: float
    beside: float


def label_position(rings: Sequence[NDArray[Any]]) -> LabelPosition:
    """Return a place far from the sides of a polygon, whose rings are (n, 2) and closed.

    Only a grid of points is searched, so a polygon that is narrow everywhere may give a distance of 0.
    """
    low, high = rings[0].min(axis=0), rings[0].max(axis=0)
    steps = (np.arange(_STEPS + 1) + 0.5) / (_STEPS + 1)
    x, y = (grid.reshape(-1, 1) for grid in np.meshgrid(*(low + steps[:, None] * (high - low)).T))
    a = np.concatenate([ring[:-1] for ring in rings])
    b = np.concatenate([ring[1:] for ring in rings])
    along = b - a
    across = (a[:, 1] > y) != (b[:, 1] > y)
    with np.errstate(divide="ignore", invalid="ignore"):
        level = a[:, 0] + (y - a[:, 1]) * along[:, 0] / along[:, 1]
    inside = (across & (level > x)).sum(axis=1) % 2 == 1
    squared = np.maximum((along**2).sum(axis=1), 1e-12)
    part = np.clip(((x - a[:, 0]) * along[:, 0] + (y - a[:, 1]) * along[:, 1]) / squared, 0.0, 1.0)
    distance = np.hypot(x - a[:, 0] - part * along[:, 0], y - a[:, 1] - part * along[:, 1])
    away = np.where(inside, distance.min(axis=1), 0.0)
    from_middle = np.hypot(*(np.hstack([x, y]) - (low + high) / 2).T)
    best = int(np.argmin(np.where(away >= _AS_GOOD * away.max(), from_middle, np.inf)))
    beside = np.where(across[best], np.abs(level[best] - x[best]), np.inf).min()
    return LabelPosition(float(x[best, 0]), float(y[best, 0]), float(away[best]), float(beside))


# --- The sheet of a picture of a map: transform from metres, and the margins around the map

_LEFT, _TOP, _RIGHT, _BOTTOM = 62.0, 66.0, 210.0, 40.0
_SMALLEST_SIDE = 300.0
FONT = 'font-family="DejaVu Sans, Verdana, sans-serif"'


@dataclass(frozen=True)
class Sheet:
    """A map's border on a sheet, ``scale`` pixels a metre, y upwards as in the site frame."""

    border: Border
    scale: float

    @classmethod
    def of(cls, border: Border, size: float) -> Sheet:
        """Return the sheet whose map is ``size`` pixels on its longer side."""
        return cls(border, size / max(border.x_max - border.x_min, border.y_max - border.y_min))

    @property
    def map_width(self) -> float:
        """Pixels."""
        return (self.border.x_max - self.border.x_min) * self.scale

    @property
    def map_height(self) -> float:
        """Pixels."""
        return (self.border.y_max - self.border.y_min) * self.scale

    @property
    def width(self) -> int:
        """Pixels of the whole sheet."""
        return math.ceil(_LEFT + max(self.map_width, _SMALLEST_SIDE / 2) + _RIGHT)

    @property
    def height(self) -> int:
        """Pixels of the whole sheet."""
        return math.ceil(_TOP + max(self.map_height, _SMALLEST_SIDE) + _BOTTOM)

    def pixels(self, points: NDArray[Any]) -> NDArray[Any]:
        """Return (n, 2) metres in the site frame as (n, 2) pixels of the sheet."""
        x = _LEFT + (points[:, 0] - self.border.x_min) * self.scale
        y = _TOP + (self.border.y_max - points[:, 1]) * self.scale
        return np.column_stack([x, y])

    def face(self) -> Iterator[str]:
        """Yield the ground with its grid of metres."""
        yield _rectangle(_LEFT, _TOP, self.map_width, self.map_height, f'fill="{FACE}"')
        for x in self._ticks(self.border.x_min, self.border.x_max):
            yield self._line([(x, self.border.y_min), (x, self.border.y_max)])
        for y in self._ticks(self.border.y_min, self.border.y_max):
            yield self._line([(self.border.x_min, y), (self.border.x_max, y)])

    def surround(self, title: str, subtitle: str) -> Iterator[str]:
        """Yield the content of the margins: paper, frame, the grid's metres and the title."""
        right, bottom = _LEFT + self.map_width, _TOP + self.map_height
        yield (
            f'<path d="M0 0H{self.width}V{self.height}H0ZM{_LEFT} {_TOP}V{bottom:.1f}H{right:.1f}V{_TOP}Z" '
            'fill="#ffffff" fill-rule="evenodd"/>'
        )
        yield _rectangle(
            _LEFT, _TOP, self.map_width, self.map_height, f'fill="none" stroke="{INK}" stroke-width="1.6"'
        )
        for x in self._ticks(self.border.x_min, self.border.x_max):
            place = _LEFT + (x - self.border.x_min) * self.scale
            yield svg_text(place, bottom + 17, _metres(x), 10.5, QUIET, "middle")
        for y in self._ticks(self.border.y_min, self.border.y_max):
            place = _TOP + (self.border.y_max - y) * self.scale
            yield svg_text(_LEFT - 7, place + 4, _metres(y), 10.5, QUIET, "end")
        yield svg_text(_LEFT, 32, title, 20, INK, "start", bold=True)
        yield svg_text(_LEFT, 52, subtitle, 12, QUIET, "start")

    def margin(self, north: float | None, legend: Sequence[tuple[str, Colours]]) -> Iterator[str]:
        """Yield the right margin: north arrow, legend, scale bar.

        ``north`` is the angle of grid north, radians clockwise from the sheet's upward direction; None shows
        the site's y axis instead.
        """
        left = _LEFT + max(self.map_width, _SMALLEST_SIDE / 2) + 26
        angle, letter = (0.0, "y") if north is None else (math.degrees(north), "N")
        yield (
            f'<g transform="translate({left + 22:.1f} {_TOP + 34}) rotate({angle:.3f})">'
            f'<path d="M0 -30L11 14L0 6Z" fill="{INK}"/>'
            f'<path d="M0 -30L-11 14L0 6Z" fill="#ffffff" stroke="{INK}" stroke-width="1.2"/></g>'
        )
        yield svg_text(left + 22, _TOP + 74, letter, 13, INK, "middle", bold=True)
        top = _TOP + 108
        for number, (label, colours) in enumerate(legend):
            y = top + 24 * number
            marks = f'rx="2.5" fill="{colours.fill}" stroke="{colours.stroke}" stroke-width="1.6"'
            yield _rectangle(left, y - 11, 20, 14, marks)
            yield svg_text(left + 30, y, label, 12, INK, "start")
        yield from self._scale_bar(left, max(_TOP + self.map_height, top + 24 * len(legend) + 30))

    def _scale_bar(self, left: float, bottom: float) -> Iterator[str]:
        length = _nice(120 / self.scale)
        half = length * self.scale / 2
        yield _rectangle(left, bottom - 8, half, 7, f'fill="{INK}" stroke="{INK}" stroke-width="1"')
        yield _rectangle(left + half, bottom - 8, half, 7, f'fill="#ffffff" stroke="{INK}" stroke-width="1"')
        yield svg_text(left, bottom - 14, "0", 10.5, INK, "middle")
        yield svg_text(left + 2 * half, bottom - 14, f"{length:g} m", 10.5, INK, "middle")

    def _ticks(self, low: float, high: float) -> list[float]:
        step = _nice(130 / self.scale)
        first = math.ceil(low / step - 1e-9)
        return [k * step for k in range(first, math.floor(high / step + 1e-9) + 1)]

    def _line(self, ends: list[tuple[float, float]]) -> str:
        (x1, y1), (x2, y2) = self.pixels(np.array(ends)).tolist()
        return f'<path d="M{x1:.1f} {y1:.1f}L{x2:.1f} {y2:.1f}" stroke="{GRID_LINE}" stroke-width="1.2"/>'


def svg_text(
    x: float, y: float, words: str, size: float, colour: str, anchor: str, bold: bool = False, halo: str = ""
) -> str:
    """Return a line of text without characters that XML cannot hold."""
    shown = escape("".join(letter for letter in words if letter.isprintable()))
    weight = ' font-weight="bold"' if bold else ""
    place = f'x="{x:.1f}" y="{y:.1f}" {FONT} font-size="{size:g}" text-anchor="{anchor}"{weight}'
    line = f'<text {place} fill="{colour}">{shown}</text>'
    if not halo:
        return line
    return f'<text {place} fill="{halo}" stroke="{halo}" stroke-width="3">{shown}</text>{line}'


def _rectangle(x: float, y: float, width: float, height: float, style: str) -> str:
    return f'<rect x="{x:.1f}" y="{y:.1f}" width="{width:.1f}" height="{height:.1f}" {style}/>'


def _nice(length: float) -> float:
    """Return the largest 1, 2 or 5 times a power of ten that is at most ``length``."""
    power = 10.0 ** math.floor(math.log10(length))
    return next(step * power for step in (5.0, 2.0, 1.0) if step * power <= length * (1 + 1e-9))


def _metres(value: float) -> str:
    return f"{value:.10g}".replace("-", "−")


# --- A robot map as a picture for people, in SVG that browsers and Qt draw alike ---

_LEGEND_ROWS = 12
_TEXT_ROOM = 12.0
"""pixels that a line of text needs above and below its middle."""

_SHADOW = np.array([0.16, -0.12])
"""metres to the right and up for each metre of height."""

_LOWEST_SHADOW, _HIGHEST_SHADOW = 0.5, 30.0
"""metres: lower obstacles have no shadow, higher ones no longer shadow."""


def svg_of(robot_map: RobotMap, title: str = "", size: float = 1000.0) -> bytes:
    """Return the picture of a map: its longer side is ``size`` pixels, plus margins.

    Areas are coloured by the first label and darker where they are higher, with a shadow as long as they are
    high; heights and names are drawn where there is room. Grid north comes from the leading line
    ``rotation``.
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


def _shadows(sheet: Sheet, solids: list[Solid], shapes: list[MapShape]) -> Iterator[str]:
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


def _areas(sheet: Sheet, shapes: list[MapShape], by_label: Mapping[str, Colours]) -> Iterator[str]:
    areas = [shape for shape in shapes if shape.kind == "Polygon"]
    # Grounds come first, so that they do not cover the obstacles on them.
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


def _is_ground(area: MapShape) -> bool:
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


def _labels(sheet: Sheet, shapes: list[MapShape]) -> Iterator[str]:
    """Yield name and height of each area that has room for them."""
    for shape in shapes:
        if shape.kind != "Polygon" or shape.attributes["courtyard"] or not shape.attributes["height_m"]:
            continue
        rings = [sheet.pixels(ring) for ring in shape.parts]
        if np.ptp(rings[0], axis=0).min() < 2 * _TEXT_ROOM:
            continue
        place = label_position(rings)
        height = f"{shape.attributes['height_m']:.10g} m"
        name = shape.attributes["semantics"].partition(",")[2].partition(",")[0]
        if place.away < _TEXT_ROOM or len(height) * 3.4 > place.beside:
            continue
        if name and place.away > 1.6 * _TEXT_ROOM and len(name) * 4.2 < place.beside:
            yield svg_text(place.x, place.y - 3, name, 12, INK, "middle", bold=True)
            yield svg_text(place.x, place.y + 12, height, 11, INK, "middle")
        else:
            yield svg_text(place.x, place.y + 4, height, 11, INK, "middle")


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
    """Return the angle of grid north clockwise from the site's y axis, radians; None if unknown."""
    # A local CRS of a site has a name instead of a code, and its y axis may point anywhere.
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

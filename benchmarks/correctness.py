"""Windows of real cities held against shapely, which shares no code with the builder."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import shapely

from benchmarks.layers import features, moved, rows
from robot_bridge.core.robotmap.model import Border, Obstacle, RobotMap, Window
from robot_bridge.core.robotmap.outlines import Outlines
from robot_bridge.core.robotmap.window_index import OutlineIndex

NEAR = 0.01
"""metres; what a map may be off the drawing."""
SIDES = (30.0, 200.0)
"""metres; the shortest and the longest side of a window."""
_STUB = 2 * NEAR
"""metres; a piece this short may be no segment in centimetres."""
_SLACK = 1e-4


@dataclass(frozen=True)
class City:
    """One city: ``drawn`` are its features as they are in the data, in the frame of the maps."""

    name: str
    index: OutlineIndex
    sources: np.ndarray
    drawn: np.ndarray
    tree: Any

    @classmethod
    def read(cls, file: Path, name: str, origin: tuple[float, float]) -> City:
        """Return the buildings and barriers of ``file``."""
        read = [item for layer in ("buildings", "barriers") for item in features(file, layer)]
        made = [row for source, shape, _ in read for row in rows(shape, source, place=moved(origin))]
        drawn = shapely.transform([shape for _, shape, _ in read], moved(origin))
        sources = np.array([source for source, _, _ in read])
        return cls(name, OutlineIndex.of(Outlines.from_rows(made)), sources, drawn, shapely.STRtree(drawn))

    def windows(self, count: int, seed: int) -> Iterator[Window]:
        """Yield windows of 30 m to 200 m around corners of features."""
        chance = np.random.default_rng(seed)
        for feature in chance.integers(0, len(self.drawn), count):
            corners = shapely.get_coordinates(self.drawn[feature])
            x, y = corners[chance.integers(0, len(corners))] + chance.uniform(-SIDES[0], SIDES[0], 2)
            yield Window(float(x), float(y), *chance.uniform(*SIDES, 2).tolist())


def faults(city: City, window: Window) -> list[str]:
    """Return what is wrong with the map of ``window``: nothing, if all is well."""
    robot_map = city.index.map_of(window)
    box = shapely.box(*robot_map.border)
    said = {warning.partition(": ")[0] for warning in robot_map.warnings}
    near = np.sort(city.tree.query(box))
    kept = [k for k in near if city.sources[k] not in said]
    drawn = _union(_lines(city.drawn[k]) for k in kept)
    made = shapely.multilinestrings(shapely.linestrings(np.stack(_ends(robot_map.obstacles), axis=1)))
    # What is drawn within a centimetre of the border may come to lie on its other side.
    inside = shapely.intersection(drawn, shapely.buffer(box, -NEAR, join_style="mitre"))
    return [
        *_missing("of the obstacles is not in the map", inside, made),
        *_missing("in the map is no obstacle", made, drawn),
        *_missing("outside the window", made, box),
        *_invented(robot_map, drawn),
        *_wrongly_oriented(robot_map, {city.sources[k]: city.drawn[k] for k in kept}),
    ]


def _union(lines: Iterator[Any]) -> Any:
    return shapely.union_all(list(lines))


def _lines(geometry: Any) -> Any:
    return shapely.boundary(geometry) if shapely.get_dimensions(geometry) == 2 else geometry


def _ends(obstacles: Sequence[Obstacle]) -> tuple[np.ndarray, np.ndarray]:
    empty = [np.empty((0, 2))]
    return np.concatenate(empty + [o.a for o in obstacles]), np.concatenate(empty + [o.b for o in obstacles])


def _missing(what: str, wanted: Any, found: Any) -> Iterator[str]:
    left = shapely.get_parts(shapely.difference(wanted, shapely.buffer(found, NEAR + _SLACK)))
    for part in left:
        if part.length > (_STUB if part.geom_type == "LineString" else 0):
            yield f"{part.length:.3f} m {what}: {part.wkt[:90]}"


def _invented(robot_map: RobotMap, drawn: Any) -> Iterator[str]:
    """Yield each segment along the border that is no wall."""
    a, b = _ends(robot_map.obstacles)
    border: Border = robot_map.border
    along = np.zeros(len(a), dtype=bool)
    for axis, sides in ((0, (border.x_min, border.x_max)), (1, (border.y_min, border.y_max))):
        for side in sides:
            along |= (a[:, axis] == side) & (b[:, axis] == side)
    middles = shapely.points((a[along] + b[along]) / 2)
    for point, distance in zip(middles, shapely.distance(middles, drawn), strict=True):
        if distance > NEAR:
            yield f"a wall along the border that is none: {point.wkt}"


def _wrongly_oriented(robot_map: RobotMap, drawn: dict[str, Any]) -> Iterator[str]:
    """Yield each closed obstacle, or piece of one, that has its building on its right."""
    for obstacle in robot_map.obstacles:
        shape = drawn[obstacle.ext["src"]]
        step = obstacle.b - obstacle.a
        length = np.hypot(*step.T)
        longest = int(length.argmax())
        if shapely.get_dimensions(shape) < 2 or not shape.is_valid or length[longest] < 0.5:
            continue
        middle = (obstacle.a[longest] + obstacle.b[longest]) / 2
        right = np.array([step[longest, 1], -step[longest, 0]]) / length[longest] * 2 * NEAR
        # Helsinki has buildings a millimetre wide, in which there is no room to look for the inside.
        if not shapely.distance(shapely.buffer(shape, -NEAR), shapely.Point(middle)) <= 3 * NEAR:
            continue
        if shapely.contains_xy(shape, *(middle + right)) or not shapely.contains_xy(shape, *(middle - right)):
            yield f"obstacle {obstacle.id} ({obstacle.ext['src']}) has its inside on the right"

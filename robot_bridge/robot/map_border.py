"""How near a place is to where a robot's map ends and the site goes on."""

from __future__ import annotations

import math

from ..robotmap.model import PART_OF, RobotMap

SAME_EDGE = 0.02
"""metres: what a map's border may differ from the site's by rounding."""


def before_border(robot_map: RobotMap, x: float, y: float) -> float:
    """Return how far (x, y) is inside the border of a map, metres; negative outside.

    Edges at which the site ends as well do not count; infinite for a map of the whole site.
    """
    if PART_OF not in robot_map.meta:
        return math.inf
    border, whole = robot_map.border, _whole(robot_map)
    apart = (x - border.x_min, y - border.y_min, border.x_max - x, border.y_max - y)
    inner = (
        border.x_min - whole[0],
        border.y_min - whole[1],
        whole[2] - border.x_max,
        whole[3] - border.y_max,
    )
    return min((far for far, room in zip(apart, inner, strict=True) if room > SAME_EDGE), default=math.inf)


def _whole(robot_map: RobotMap) -> tuple[float, float, float, float]:
    """Return the bounds of the site; a line that cannot be read says that it goes on everywhere."""
    try:
        x_min, y_min, x_max, y_max = (float(part) for part in robot_map.meta[PART_OF].split(","))
    except ValueError:
        return -math.inf, -math.inf, math.inf, math.inf
    return x_min, y_min, x_max, y_max

"""What is asked of outlines before a map is built of them; each thing by itself and off unless asked for."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from .chaining import chained
from .dissolving import without_hidden_lines, without_shared_walls
from .errors import ShapingError
from .model import ShapeType
from .outlines import OutlineRow, Outlines
from .simplifying import simplified, without_short_segments

_STEP_SLACK = 1e-6
"""of a height step; 0.3 m is three steps of 0.1 m, not four."""
_DRIVEN_ON = (ShapeType.STAIRS, ShapeType.RAMP)


@dataclass(frozen=True)
class Shaping:
    """How outlines are reduced to what a robot needs; all lengths in metres, 0 or nothing is off."""

    plane: tuple[float, float] | None = None
    """The heights above the ground between which the robot is. What ends below or begins above is left out,
    but for stairs and ramps."""
    height_step: float = 0.0
    """Heights are rounded up to a multiple of it."""
    dissolve: bool = False
    """Walls between buildings that touch, and lines inside or along buildings, are left out."""
    chain: bool = False
    """Lines that meet end to end and agree in all but their source become one."""
    tolerance: float = 0.0
    """How far a simplified outline may be from the one it stands for."""
    shortest: float = 0.0
    """Corners nearer than this to the one before are left out."""

    def __post_init__(self) -> None:
        for name in ("height_step", "tolerance", "shortest"):
            if not 0 <= getattr(self, name) < np.inf:
                raise ShapingError(f"{name} is {getattr(self, name)}; give metres, 0 or more")
        if self.plane is not None and not -np.inf < self.plane[0] < self.plane[1] < np.inf:
            raise ShapingError(f"plane is {self.plane}; give the lower and the upper height in metres")


def shaped(outlines: Outlines, shaping: Shaping) -> Outlines:
    """Return ``outlines`` as ``shaping`` asks for.

    Outlines that are broken stay as they are; the builder names them. Raises MissingGeometryError where
    shapely is needed and missing.
    """
    rows: Iterable[OutlineRow] = outlines.rows()
    if shaping.plane is not None:
        rows = [row for row in rows if _in_plane(row, *shaping.plane)]
    if shaping.height_step:
        rows = [replace(row, height=_rounded_up(row.height, shaping.height_step)) for row in rows]
    if shaping.dissolve:
        rows = without_hidden_lines(list(rows))
    if shaping.chain:
        rows = chained(list(rows))
    # After chaining: what is left of a polygon's outline has a free side and may not be turned round.
    if shaping.dissolve:
        rows = without_shared_walls(list(rows))
    if shaping.shortest:
        rows = [without_short_segments(row, shaping.shortest) for row in rows]
    if shaping.tolerance:
        rows = [simplified(row, shaping.tolerance) for row in rows]
    return Outlines.from_rows(list(rows))


def _in_plane(row: OutlineRow, low: float, high: float) -> bool:
    """Tell whether a robot between ``low`` and ``high`` meets it; what has no finite height is met."""
    if row.shape_type in _DRIVEN_ON:
        return True
    return not (row.base >= high or row.base + row.height <= low)


def _rounded_up(height: float, step: float) -> float:
    if not np.isfinite(height):
        return height
    return float(np.round(np.ceil(height / step - _STEP_SLACK) * step, 2))

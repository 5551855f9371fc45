"""What is asked of outlines before a map is built of them; each thing by itself and off unless asked for."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from .chaining import chained
from .dissolving import without_hidden_lines, without_shared_walls
from .errors import ShapingError
from .model import ShapeType
from .outlines import OutlineRow, Outlines
from .simplifying import simplified, without_short_segments
from .watch import Watch

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


def shaped(
    outlines: Outlines,
    shaping: Shaping,
    progress: Callable[[float], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
) -> Outlines:
    """Return ``outlines`` as ``shaping`` asks for.

    ``progress`` is told how much is done, 0 to 1; ``cancelled`` is asked again and again whether to end.
    Outlines that are broken stay as they are; the builder names them. Raises MissingGeometryError where
    shapely is needed and missing, CancelledError when ``cancelled`` said so.
    """
    stages, watch = _stages(shaping), Watch(progress, cancelled)
    rows: Sequence[OutlineRow] = outlines.rows()
    for k, stage in enumerate(stages):
        rows = stage(rows, watch.part(k / len(stages), (k + 1) / len(stages)))
    watch.at(1.0)
    return Outlines.from_rows(rows)


Stage = Callable[[Sequence[OutlineRow], Watch], Sequence[OutlineRow]]


def _stages(shaping: Shaping) -> list[Stage]:
    """Return what is to be done, in its order."""
    plane, step = shaping.plane, shaping.height_step
    shortest, tolerance = shaping.shortest, shaping.tolerance
    stages: list[Stage] = []
    if plane is not None:
        stages.append(lambda rows, watch: [row for row in watch.over(rows) if _in_plane(row, *plane)])
    if step:
        stages.append(
            lambda rows, watch: [
                replace(row, height=_rounded_up(row.height, step)) for row in watch.over(rows)
            ]
        )
    if shaping.dissolve:
        stages.append(without_hidden_lines)
    if shaping.chain:
        stages.append(chained)
    # After chaining: what is left of a polygon's outline has a free side and may not be turned round.
    if shaping.dissolve:
        stages.append(without_shared_walls)
    if shortest:
        stages.append(lambda rows, watch: [without_short_segments(row, shortest) for row in watch.over(rows)])
    if tolerance:
        stages.append(lambda rows, watch: [simplified(row, tolerance) for row in watch.over(rows)])
    return stages


def _in_plane(row: OutlineRow, low: float, high: float) -> bool:
    """Tell whether a robot between ``low`` and ``high`` meets it; what has no finite height is met."""
    if row.shape_type in _DRIVEN_ON:
        return True
    return not (row.base >= high or row.base + row.height <= low)


def _rounded_up(height: float, step: float) -> float:
    if not np.isfinite(height):
        return height
    return float(np.round(np.ceil(height / step - _STEP_SLACK) * step, 2))

"""What the operator wants of a plan, kept with the project."""

from __future__ import annotations

import json
import math
from dataclasses import asdict, dataclass, field, fields, replace
from typing import Any

from qgis.core import QgsProject

from ....robot_bridge.assignment.job import FINISHES, STAY, Robot
from ....robot_bridge.assignment.scheduling import BALANCED, OBJECTIVES
from ....robot_bridge.core.decoding import decode_json

SCOPE, KEY = "fleet_supervisor", "plans/settings"


@dataclass(frozen=True)
class RobotSettings:
    """What one robot can do: cones it carries, cones aboard now, m/s, metres of battery (0: any)."""

    used: bool = True
    capacity: int = 8
    aboard: int = 0
    speed: float = 1.0
    range_m: float = 0.0

    def robot(self, name: str, x: float, y: float) -> Robot:
        """Return the robot ``name`` at (x, y), as an assignment takes it."""
        return Robot(
            name, x, y, self.capacity, self.speed, self.range_m or math.inf, min(self.aboard, self.capacity)
        )


@dataclass(frozen=True)
class PlanSettings:
    """The panel's settings. Layers are named by their ids; an empty one is none.

    ``direct_m`` is up to how far robots drive straight and not along the roads; ``clearance_m`` how far they
    keep from cones; ``apart_m`` how far from one another. With ``by_itself`` a new plan is sent without a
    question when a robot is lost.
    """

    cones: str = ""
    selected_only: bool = False
    stores: str = ""
    objective: str = BALANCED
    finish: str = STAY
    seconds: float = 10.0
    service_s: float = 5.0
    store_s: float = 30.0
    on_roads: bool = True
    direct_m: float = 25.0
    clearance_m: float = 0.8
    apart_m: float = 2.0
    by_itself: bool = False
    robots: dict[str, RobotSettings] = field(default_factory=dict)

    @property
    def off_standing_m(self) -> float:
        """How far to keep from a robot that stands: half of what two keep that drive, for only one errs."""
        return max(self.clearance_m, self.apart_m / 2)

    def of_robot(self, name: str) -> RobotSettings:
        """Return the settings of a robot, the usual ones where it has none."""
        return self.robots.get(name, RobotSettings())

    def with_robot(self, name: str, settings: RobotSettings) -> PlanSettings:
        """Return these settings with those of one robot changed."""
        return replace(self, robots={**self.robots, name: settings})


def settings_in(project: QgsProject) -> PlanSettings:
    """Return the settings kept in ``project``; what is not there or not right is as usual."""
    text, found = project.readEntry(SCOPE, KEY, "")
    if not found or not text:
        return PlanSettings()
    try:
        given = decode_json(text)
        robots = {name: _made(RobotSettings, one) for name, one in given.pop("robots", {}).items()}
        made = _made(PlanSettings, given)
    except (ValueError, TypeError, AttributeError):
        return PlanSettings()
    if made.objective not in OBJECTIVES or made.finish not in FINISHES:
        made = replace(made, objective=BALANCED, finish=STAY)
    # Whoever opens a project has not switched on yet what is sent without a question.
    return replace(made, robots=robots, by_itself=False)


def keep_settings(project: QgsProject, settings: PlanSettings) -> None:
    """Keep the settings with ``project``."""
    project.writeEntry(SCOPE, KEY, json.dumps(asdict(settings)))


def _made(kind: type, given: dict[str, Any]):
    usual = kind()
    known = {one.name: getattr(usual, one.name) for one in fields(kind)}
    values = {}
    for name, value in given.items():
        fitting = (int, float) if isinstance(known.get(name), float) else type(known.get(name))
        if name in known and isinstance(value, fitting):
            values[name] = value
    return kind(**values)

"""Round a keepout: a cone target behind the water basin is driven to by the road, as it is shown."""

from __future__ import annotations

import math

from robot_bridge.core.geometry import Polyline
from tests.support.errors import StageError
from tools.walkthrough.scene import Scene

TARGET = (52.0, 41.0)
"""From r3 the water basin lies straight before it; site frame, metres."""
BASIN, BASIN_M = (65.4, 32.0), 3.0
"""The middle of the water basin, and metres from there to its edge."""
PIXEL_M = 0.02
"""Metres by which a point may be rounded on its way to the gateway."""
CORRIDOR_M = 1.0
"""Metres beside its path that a robot may be."""
UNDER_WAY_M = 6.0


def lead_round_keepout(scene: Scene) -> None:
    """Set a target behind the basin, look at the way, send it, and look at what is left of it."""
    operator, film = scene.operator, scene.film
    scene.select_in_table("r3")
    operator.press("F8")
    operator.point_at_map(TARGET)
    film.shoot("way-to-mouse", "the way to the mouse, thin and pale")
    operator.click_map(TARGET)
    operator.wait_for_text("fleet_draft_text", "along the roads")
    film.shoot("way-shown", "the way round the basin that the robot will drive")
    start, shown = scene.gateway.place_of("r3"), operator.desk()["way"]
    require_round_basin(shown)
    operator.press("Enter")
    operator.wait_for_state("r3", "acknowledged")
    line = require_path(scene, shown)
    operator.wait("r3 under way", lambda: math.dist(start, _place(scene, line)) > UNDER_WAY_M)
    film.shoot("round-keepout", "r3 drives the way that was shown")
    operator.click("fleet_abort_all_button")
    operator.wait("the end of the task", lambda: _is_aborted(scene))
    scene.wait_until_standing("r3")
    film.shoot("all-aborted", "after ABORT ALL nothing of the way is left on the map")


def require_round_basin(shown: list[list[float]]) -> None:
    """Raise StageError unless the straight line leads across the basin, and the way does not."""
    straight, way = (_distance(Polyline(points), BASIN) for points in ([shown[0], shown[-1]], shown))
    if straight > BASIN_M or way < BASIN_M:
        raise StageError(f"the straight line passes the basin at {straight:.1f} m, the way at {way:.1f} m")


def require_path(scene: Scene, shown: list[list[float]]) -> Polyline:
    """Return the path that r3 was sent; raises StageError unless it is the one shown, with a cone."""
    command = scene.gateway.newest_command("r3")
    if command["op"] != "SetPath" or command["params"].get("cone") is not True:
        raise StageError(f"r3 was not sent along the way that was drawn, but told {command['op']}")
    sent = command["params"]["points"]
    apart = max(map(math.dist, sent, shown)) if len(sent) == len(shown) else math.inf
    if apart > PIXEL_M:
        raise StageError(f"r3 was sent along {sent}, but {shown} was shown")
    return Polyline(sent)


def _place(scene: Scene, line: Polyline) -> tuple[float, float]:
    place = scene.gateway.place_of("r3")
    off = _distance(line, place)
    if off > CORRIDOR_M:
        raise StageError(f"r3 is {off:.1f} m off the way that was shown")
    return place


def _is_aborted(scene: Scene) -> bool:
    return bool(scene.gateway.newest_command("r3")["state"] == "aborted")


def _distance(line: Polyline, place: tuple[float, float]) -> float:
    return float(line.feet(*place)[1].min())

"""The third act: a robot is chosen on the map, is sent to a cone target, and gets there."""

from __future__ import annotations

import math

from tests.support.errors import StageError
from tools.walkthrough.scene import Scene

TARGET = (38.0, 8.0)
"""Along the straight; site frame, metres."""
UNDER_WAY = 26.0
"""How far east r1 is when it is photographed; metres."""
REACHED_M = 0.2
"""The sample site's tolerance."""
PIXEL_M = 0.3
"""How far the place that the gateway got may lie from the one that was clicked."""


def send_cone(scene: Scene) -> None:
    """Select r1 on the map, set a target, send it by its key and watch."""
    operator, film = scene.operator, scene.film
    operator.press("Shift+F9")
    operator.point_at_map(scene.gateway.place_of("r1"))
    operator.wait_for_text("fleet_hover_card", "r1")
    film.shoot("card", "the mouse rests on r1, whose card is shown")
    operator.click_map(scene.gateway.place_of("r1"))
    scene.wait_for_selection("r1")
    film.shoot("selected", "r1 is selected by a click on the map")
    operator.press("F8")
    operator.click_map(TARGET)
    operator.wait_for_text("fleet_draft_text", "Cone for r1")
    operator.wait_for_text("fleet_draft_text", "along the roads")
    film.shoot("cone-draft", "a cone target as a draft")
    operator.press("Enter")
    # With the tool in hand the way to the mouse would go on being shown.
    operator.press("Shift+F9")
    operator.wait("r1 being under way", lambda: scene.gateway.place_of("r1")[0] > UNDER_WAY)
    require_place(scene)
    film.shoot("driving", "r1 drives to its target")
    operator.wait_for_state("r1", "reached")
    operator.wait("r1's row saying so", lambda: operator.desk()["robots"]["r1"]["Task"] == "stopped")
    require_reached(scene)
    film.shoot("reached", "r1 reached its target")


def require_place(scene: Scene) -> None:
    """Raise StageError unless the gateway sent r1 where the operator clicked."""
    command = scene.gateway.newest_command("r1")
    if command["op"] != "SetPath" or command["params"].get("cone") is not True:
        raise StageError(f"r1 was not sent along the way that was drawn, but told {command['op']}")
    x, y = command["params"]["points"][-1]
    if math.dist((x, y), TARGET) > PIXEL_M:
        raise StageError(f"r1 was sent to {x:.2f}, {y:.2f}, but {TARGET} was clicked")


def require_reached(scene: Scene) -> None:
    """Raise StageError unless the gateway says reached, and r1 is where it was sent."""
    scene.gateway.require_state("r1", "reached")
    sent = scene.gateway.newest_command("r1")["params"]
    off = math.dist(sent["points"][-1], scene.gateway.place_of("r1"))
    if off > REACHED_M:
        raise StageError(f"r1 stands {off:.2f} m from its target, not within {REACHED_M} m")

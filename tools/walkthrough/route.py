"""The fourth act: a route is drawn, changed in every way, sent, and aborted under way."""

from __future__ import annotations

import math

from tests.support.errors import StageError
from tools.walkthrough.scene import Scene

DRAWN = [(58.0, 84.0), (70.0, 84.0), (80.0, 80.0), (96.0, 84.0)]
"""Ahead of r2 on the campus road; site frame, metres."""
MOVED = (82.0, 84.0)
"""Where the third vertex is dragged to."""
PUT_IN = ((89.0, 84.0), (90.0, 82.0))
"""A place on the last leg, and where it is dragged to."""
PIXEL_M = 0.3


def send_route(scene: Scene) -> None:
    """Draw, change, send and abort a route for r2."""
    scene.select_in_table("r2")
    scene.operator.press("Ctrl+F8")
    draw(scene)
    change(scene)
    send(scene)
    abort(scene)


def draw(scene: Scene) -> None:
    for count, place in enumerate(DRAWN, start=1):
        scene.operator.click_map(place)
        wait_for_vertices(scene, count)
    scene.film.shoot("route-drawn", "a route of four vertices")


def change(scene: Scene) -> None:
    """Drag a vertex, put one in, delete another, take that back and do it again."""
    operator, film = scene.operator, scene.film
    operator.drag_on_map(DRAWN[2], MOVED)
    wait_for_route(scene, [*DRAWN[:2], MOVED, DRAWN[3]])
    operator.drag_on_map(*PUT_IN)
    wait_for_route(scene, [*DRAWN[:2], MOVED, PUT_IN[1], DRAWN[3]])
    film.shoot("route-changed", "a vertex was dragged, another put in")
    operator.point_at_map(DRAWN[1])
    operator.press("Del")
    shorter = [DRAWN[0], MOVED, PUT_IN[1], DRAWN[3]]
    wait_for_route(scene, shorter)
    operator.press("Ctrl+Z")
    wait_for_vertices(scene, 5)
    operator.press("Ctrl+Shift+Z")
    wait_for_route(scene, shorter)
    film.shoot("route-ready", "a vertex was deleted, that was undone, and done again")


def send(scene: Scene) -> None:
    scene.operator.press("Enter")
    scene.operator.wait_for_state("r2", "acknowledged")
    require_points(scene, [DRAWN[0], MOVED, PUT_IN[1], DRAWN[3]])
    scene.wait_until_driving("r2")
    scene.film.shoot("route-driving", "r2 drives its route")


def abort(scene: Scene) -> None:
    scene.operator.press("Ctrl+F10")
    scene.wait_until_standing("r2")
    scene.operator.wait("aborted in the log", lambda: "aborted" in states(scene, "r2"))
    scene.gateway.require_state("r2", "aborted")
    scene.film.shoot("aborted", "r2 was aborted, and stands")


def states(scene: Scene, robot: str) -> list[str]:
    """Return the states of a robot's commands in the log."""
    rows = scene.operator.desk()["commands"]
    return [row["state"] for row in rows if row["what"].startswith(f"{robot} ")]


def wait_for_vertices(scene: Scene, count: int) -> None:
    """Look until the draft has so many points, and the panel says so."""
    scene.operator.wait(f"a route of {count} points", lambda: len(scene.operator.desk()["points"]) == count)
    if count > 1:
        scene.operator.wait_for_text("fleet_draft_text", f"Route for r2: {count} points")


def wait_for_route(scene: Scene, places: list[tuple[float, float]]) -> None:
    """Look until the draft goes through these places, as near as a pixel is."""
    scene.operator.wait(
        f"the route going by {places}", lambda: is_near(scene.operator.desk()["points"], places)
    )


def require_points(scene: Scene, places: list[tuple[float, float]]) -> None:
    """Raise StageError unless the gateway got this route, behind where the robot was."""
    points = scene.gateway.newest_command("r2")["params"]["points"]
    if not is_near(points[-len(places) :], places):
        raise StageError(f"r2 was sent along {points}, but {places} was drawn")


def is_near(points: list[list[float]], places: list[tuple[float, float]]) -> bool:
    """Tell whether the points are those places."""
    return len(points) == len(places) and all(
        math.dist(point, place) <= PIXEL_M for point, place in zip(points, places, strict=True)
    )

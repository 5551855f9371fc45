"""From connecting to stopping without the mouse."""

from __future__ import annotations

from pyproj import Transformer

from tests.support.errors import StageError
from tools.walkthrough.gateway import Place
from tools.walkthrough.options import CONNECTION
from tools.walkthrough.scene import NAME, Scene

CONE = (32.0, 8.0)
"""Along the straight, ahead of r1; site frame, metres."""
FAR = (60.0, 8.0)


def work_by_keyboard(scene: Scene) -> None:
    """Open a connection, have r1 place a cone by its queue, send it on, and stop it."""
    connect(scene)
    find(scene)
    place_cone(scene)
    stop(scene)


def connect(scene: Scene) -> None:
    """Choose the connection in the menu beside Connect, and open it."""
    operator = scene.operator
    operator.press("Alt+G")
    on_the_way = ("url", "access_button", "operator", "connect_button")
    for name, key in (*((name, "Tab") for name in on_the_way), ("connections_button", "Space")):
        operator.wait(
            f"{name} with the keyboard", lambda name=name: operator.widget(f"fleet_{name}")["focus"]
        )
        operator.press(key)
    operator.wait(
        "the connections being listed", lambda: operator.widget("fleet_connections_menu")["visible"]
    )
    operator.press("Down")
    operator.press("Enter")
    operator.wait_for_text("fleet_url", scene.gateway.address)
    operator.press("Ctrl+F9")
    scene.wait_until_live()
    operator.wait_for_text("fleet_link_state", f"{NAME}, supervisor")
    scene.film.happened(f"the connection {CONNECTION} is open")


def find(scene: Scene) -> None:
    """Find r3 and then r1 in the locator, one straight after the other."""
    operator = scene.operator
    look_for(scene, "r3")
    operator.press("Enter")
    scene.wait_for_selection("r3")
    look_for(scene, "r1")
    scene.film.shoot("locator", "the locator has found r1")
    operator.press("Enter")
    scene.wait_for_selection("r1")
    operator.wait("the map going to r1", lambda: operator.is_shown(scene.gateway.place_of("r1")))


def look_for(scene: Scene, robot: str) -> None:
    scene.operator.press("Ctrl+K")
    scene.operator.type(f"rb {robot}")
    scene.operator.wait_for_row("QgsLocatorResultsView", robot)


def place_cone(scene: Scene) -> None:
    """Type where r1 is to place a cone, in degrees, and put that into its queue."""
    operator = scene.operator
    operator.press("F8")
    type_place(scene, CONE)
    scene.film.shoot("coordinates", "a cone target by its coordinates")
    set_place(scene)
    operator.press("Ctrl+Shift+F9")
    operator.wait_for_state("r1", "reached")
    scene.gateway.require_state("r1", "reached")


def stop(scene: Scene) -> None:
    """Send r1 further and stop it by the key."""
    operator = scene.operator
    operator.press("F8")
    type_place(scene, FAR)
    set_place(scene)
    operator.press("Ctrl+Shift+F8")
    scene.wait_until_driving("r1")
    operator.press("F10")
    operator.wait_for_text("fleet_emergency_text", "3 of 3 robots acknowledged, 3 seen to stand")
    if not scene.gateway.emergency()["in_force"]:
        raise StageError(
            "the banner says that the emergency stop is in force, the gateway says that it is not"
        )
    scene.film.shoot("stopped", "the emergency stop, in the dark theme and without the mouse")


def type_place(scene: Scene, place: Place) -> None:
    """Type a place of the site as latitude and longitude."""
    operator = scene.operator
    operator.press("Shift+F11")
    operator.wait_for_dialog("fleet_coordinates_dialog")
    frame = operator.frame
    to_degrees = Transformer.from_crs(frame.crs, "EPSG:4326")
    latitude, longitude = to_degrees.transform(*frame.to_crs([place])[0])
    operator.type(f"{latitude:.7f}, {longitude:.7f}")
    operator.wait_for_text("fleet_coordinates_told", f"^{place[0]:.2f}, {place[1]:.2f} m on the site")


def set_place(scene: Scene) -> None:
    operator = scene.operator
    operator.press("Enter")
    operator.wait_for_text("fleet_draft_text", "Cone for r1")
    operator.close_dialog()

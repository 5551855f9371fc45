"""The second act: the desk is connected, by keyboard."""

from __future__ import annotations

from tools.walkthrough.scene import NAME, Scene

ZOOM_AT = (23.5, 13.0)
"""Where the wheel is turned so that the robots and their roads fill the map; site frame, metres."""


def connect(scene: Scene) -> None:
    """Type gateway and name, and press Connect without the mouse."""
    operator = scene.operator
    operator.write("fleet_url", f"{scene.gateway.address}/desk")
    operator.write("fleet_operator", NAME)
    scene.film.shoot("address", "gateway and name are typed")
    operator.press("Tab")
    operator.wait("the button having the keyboard", lambda: operator.widget("fleet_connect_button")["focus"])
    operator.press("Space")
    scene.wait_until_live()
    operator.wait_for_text("fleet_link_state", f"{NAME}, supervisor")
    operator.zoom_in(ZOOM_AT)
    scene.film.shoot("connected", "connected: three robots, all fresh")

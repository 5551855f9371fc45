"""A published site is dragged from QGIS's browser panel onto the map."""

from __future__ import annotations

from tests.support.fleet import SITE
from tools.walkthrough.scene import NAME, Scene

LAYERS = {"Keepouts", "Obstacles", "Road centrelines", "Road surfaces"}
LAYERS_WIDTH = 230
"""Pixels in which the names of the site's layers can be read."""


def show_site(scene: Scene) -> None:
    """Drag a site onto the map, and take a picture of it."""
    drop_site(scene)
    scene.film.shoot("site", "a published site was dragged from the browser panel onto the map")


def open_site(scene: Scene) -> None:
    """Drag a site onto the map, and connect to its gateway."""
    drop_site(scene)
    operator = scene.operator
    operator.write("fleet_url", f"{scene.gateway.address}/desk")
    operator.write("fleet_operator", NAME)
    operator.press("Ctrl+F9")
    scene.wait_until_live()


def drop_site(scene: Scene) -> None:
    """Open the home folder in the browser panel and drag the site's folder from it onto the map."""
    operator = scene.operator
    operator.press("Ctrl+N")
    operator.wait_for_new_map()
    operator.widen_panel("Browser", LAYERS_WIDTH)
    operator.open_row("Browser", "Home")
    operator.drag_row_to_map("Browser", "Home", SITE.name)
    operator.wait("the site's layers being there", lambda: set(operator.layers()) == LAYERS)
    operator.close_panel("Browser")

"""A published site is dragged from QGIS's browser panel onto the map."""

from __future__ import annotations

from stage.fleet import SITE

from .scene import Scene

LAYERS = {"Keepouts", "Obstacles", "Road centrelines", "Road surfaces"}
LAYERS_WIDTH = 230
"""Pixels in which the names of the site's layers can be read."""


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
    scene.film.shoot("site", "a published site was dragged from the browser panel onto the map")

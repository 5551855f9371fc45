"""The first act: a fresh QGIS offers the tour; it is taken, with the practice fleet."""

from __future__ import annotations

from dataclasses import replace

from tools.walkthrough.gateway import Gateway
from tools.walkthrough.scene import Scene

TARGET = (24.0, 8.0)
"""Ahead of r1 on the straight; site frame, metres."""
LAYERS_WIDTH = 230
"""Pixels in which the names of the sample site's layers can be read."""


def take_tour(scene: Scene) -> None:
    """Go through the tour's pages and try what they say; close it."""
    operator, film = scene.operator, scene.film
    make_room(scene)
    operator.wait("the offer of the tour", lambda: operator.widget("fleet_tour_start")["visible"])
    film.shoot("offer", "a new profile: the tour is offered")
    operator.click("fleet_tour_start")
    operator.wait_for_text("fleet_tour_title", "Five minutes")
    operator.click("fleet_tour_next")
    operator.click("fleet_tour_offer")
    operator.wait_for_text("fleet_tour_said", "is open")
    film.shoot("tour-site", "the sample site is open")
    operator.click("fleet_tour_next")
    practise(scene)
    leave(scene)


def make_room(scene: Scene) -> None:
    """Close QGIS's browser and draw the list of layers wider, as anybody would with a window of this size."""
    scene.operator.close_panel("Browser")
    scene.operator.widen_panel("Layers", LAYERS_WIDTH)


def practise(scene: Scene) -> None:
    """Start the practice fleet and send a robot of it."""
    operator, film = scene.operator, scene.film
    operator.click("fleet_tour_offer")
    scene.wait_until_live()
    # Each tour starts a gateway of its own; the panel shows where.
    address = operator.tip("fleet_link_state").splitlines()[0]
    practice = replace(scene, gateway=Gateway(address.removesuffix("/desk")))
    film.shoot("tour-link", "the practice fleet runs, and the desk is connected to it")
    operator.click("fleet_tour_next")
    scene.select_in_table("r1")
    operator.click("fleet_tour_next")
    operator.click("fleet_tour_next")
    operator.wait_for_text("fleet_tour_text", "Try it")
    operator.click("fleet_cone_target_button")
    operator.click_map(TARGET)
    operator.wait_for_text("fleet_draft_text", "Cone for r1")
    film.shoot("tour-send", "a target for a robot of the practice fleet")
    operator.press("Enter")
    operator.click("fleet_tour_next")
    operator.wait_for_state("r1", "reached")
    practice.gateway.require_state("r1", "reached")
    film.shoot("tour-commands", "the tour's robot reached its target")


def leave(scene: Scene) -> None:
    """Go to the tour's end; the practice fleet ends with it."""
    operator = scene.operator
    operator.click("fleet_tour_next")
    operator.wait_for_text("fleet_tour_text", "EMERGENCY STOP")
    operator.click("fleet_tour_next")
    operator.wait_for_text("fleet_tour_next", "Finish")
    operator.click("fleet_tour_next")
    operator.wait("the tour closing", lambda: not operator.widget("fleet_tour")["visible"])
    operator.wait_for_text("fleet_link_state", "Not connected")
    scene.film.happened("the tour ended, and the practice fleet with it")

"""The last act: what was driven is played again, beside the live map, by QGIS's temporal controller."""

from __future__ import annotations

import time

from tests.support.errors import StageError
from tools.walkthrough.scene import Scene

LAST_S = 300.0
"""How long before now the replay begins, unless another time is chosen: "the last 5 minutes"."""
NEAR_S = 5.0
"""How far beside the wanted moment a click on the time line may be: a pixel or two."""
LINE_EDGE = 9
"""Pixels of the time line's widget left and right of the line."""


def play_again(scene: Scene) -> None:
    """Load the last minutes, seek the middle of r1's drive, play and hold."""
    operator, film = scene.operator, scene.film
    operator.choose_from_menu("Plugins", "Fleet Supervisor", "Replay")
    loaded = time.time()
    operator.click("fleet_replay_load")
    operator.wait_for_text("fleet_replay_banner", r"positions: \d+, robots: 3")
    wanted = middle_of_drive(scene)
    operator.click_along("fleet_replay_line", 1.0 - (loaded - wanted) / LAST_S, edge=LINE_EDGE)
    operator.wait("that moment being shown", lambda: abs(operator.replayed()["at"] - wanted) < NEAR_S)
    before = operator.replayed()["at"]
    operator.click("fleet_replay_play")
    operator.wait("time going on", lambda: operator.replayed()["at"] > before + 1.0)
    film.shoot("replay", "r1's drive is played beside the live map")
    operator.click("fleet_replay_play")
    operator.wait("time being held", lambda: not operator.replayed()["plays"])
    if "Connected" not in operator.text("fleet_link_state"):
        raise StageError("the desk lost its gateway while it replayed")
    film.happened("the replay was held; the desk is connected as before")


def middle_of_drive(scene: Scene) -> float:
    """Return the moment when r1 was half way to the cone that it placed, in seconds since 1970.

    What it was given last was aborted a moment ago: the time that is replayed would end while it is played.
    """
    steps = scene.gateway.newest_command("r1", "reached")["steps"]
    return (steps[0]["at"] + steps[-1]["at"]) / 2

"""The last act: what was driven is played again, beside the live map, by QGIS's temporal controller."""

from __future__ import annotations

from .scene import Scene

MOMENT = r"\d\d:\d\d:\d\d"


def play_again(scene: Scene) -> None:
    """Load the last minutes, go to a moment, play with QGIS's own controller."""
    operator, film = scene.operator, scene.film
    operator.choose_from_menu("Plugins", "Fleet Supervisor", "Replay")
    operator.click("fleet_replay_load")
    operator.wait_for_text("fleet_replay_banner", r"positions: \d+, robots: 3")
    operator.click_part("fleet_replay_line", 0.9)
    film.shoot("replay", "the last minutes beside the live map")
    operator.choose_from_menu("View", "Panels", "Temporal Controller")
    before = moment(scene)
    operator.click("mForwardButton")
    operator.wait("the replayed time going on", lambda: moment(scene) != before)
    film.shoot("replay-playing", "QGIS's temporal controller plays it")


def moment(scene: Scene) -> str:
    """Return the moment that the replay's banner names."""
    return scene.operator.wait_for_text("fleet_replay_banner", MOMENT).group()

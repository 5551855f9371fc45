"""The last act: what was driven is played again, beside the live map, by QGIS's temporal controller."""

from __future__ import annotations

from stage.errors import StageError

from .scene import Scene

EARLIER = 0.9
"""Where on the time line is clicked, as a share of its length: about half a minute before its end."""


def play_again(scene: Scene) -> None:
    """Load the last minutes, go to a moment, play and hold."""
    operator, film = scene.operator, scene.film
    operator.choose_from_menu("Plugins", "Fleet Supervisor", "Replay")
    operator.click("fleet_replay_load")
    operator.wait_for_text("fleet_replay_banner", r"positions: \d+, robots: 3")
    operator.click_part("fleet_replay_line", EARLIER)
    before = operator.replayed()["at"]
    operator.click("fleet_replay_play")
    operator.wait("time going on", lambda: operator.replayed()["at"] > before + 2000)
    film.shoot("replay", "the last minutes are played beside the live map")
    operator.click("fleet_replay_play")
    operator.wait("time being held", lambda: not operator.replayed()["plays"])
    if "Connected" not in operator.text("fleet_link_state"):
        raise StageError("the desk lost its gateway while it replayed")
    film.happened("the replay was held; the desk is connected as before")

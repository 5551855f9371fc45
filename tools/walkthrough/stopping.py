"""The fifth act: the emergency stop, by its key, and how a supervisor clears it."""

from __future__ import annotations

from tests.support.errors import StageError
from tools.walkthrough.scene import Scene

FAR = (40.0, 22.0)
"""Along the handling loop, ahead of r3; site frame, metres."""
WHY = "everybody is off the track"


def stop_and_clear(scene: Scene) -> None:
    """Press the key while r3 drives, see the banner, clear it in its dialog."""
    operator, film = scene.operator, scene.film
    scene.select_in_table("r3")
    operator.press("F8")
    operator.click_map(FAR)
    operator.press("Enter")
    operator.press("Shift+F9")
    scene.wait_until_driving("r3")
    operator.press("F10")
    operator.wait_for_text("fleet_emergency_text", "3 of 3 robots acknowledged, 3 seen to stand")
    require_in_force(scene, True)
    scene.gateway.require_state("r3", "aborted")
    film.shoot("emergency", "the emergency stop is in force, all robots stand")
    clear(scene)


def clear(scene: Scene) -> None:
    operator, film = scene.operator, scene.film
    operator.click("fleet_clear_emergency_button")
    operator.wait_for_dialog("fleet_clear_dialog")
    operator.write("fleet_clear_reason", WHY)
    film.shoot("clear", "what clearing it means, and why it is done")
    operator.click("fleet_clear_confirm")
    operator.wait_for_no_dialog()
    operator.wait("the banner going", lambda: not operator.widget("fleet_emergency_banner")["visible"])
    require_in_force(scene, False)
    said = scene.gateway.emergency()["clear_reason"]
    if said != WHY:
        raise StageError(f"the gateway knows {said!r} as the reason for clearing, not {WHY!r}")
    film.shoot("cleared", "the emergency stop is cleared")


def require_in_force(scene: Scene, wanted: bool) -> None:
    """Raise StageError unless the gateway says so, too."""
    if scene.gateway.emergency()["in_force"] is not wanted:
        raise StageError(f"the banner says {wanted} of the emergency stop, the gateway something else")

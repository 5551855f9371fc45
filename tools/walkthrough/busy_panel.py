"""Buttons that stay: pressed while a check is under way, beside a conflict, and under texts of any length.

What each picture shows is held against the one before: see :mod:`tools.walkthrough.still_buttons`.
"""

from __future__ import annotations

from tools.walkthrough.scene import Scene

EAST, TARGET = (104.0, 8.0), (70.0, 8.0)
"""Where r1 drives along the straight, and r3 against it; site frame, metres."""
BASIN = (65.4, 32.0)
"""In the middle of the keepout."""


def keep_buttons(scene: Scene) -> None:
    """Press Send with nothing to send and before a check has ended; have conflicts and long texts shown."""
    send_nothing(scene)
    send_east(scene)
    press_while_checked(scene)
    show_refusal(scene)
    stop_all(scene)


def send_nothing(scene: Scene) -> None:
    """Press Send while there is no draft."""
    scene.operator.click("fleet_send_button")
    scene.operator.wait_for_text("fleet_notice", "nothing to send")
    scene.film.shoot("nothing-to-send", "Send, with nothing to send, says so over the map")


def send_east(scene: Scene) -> None:
    """Send r1 where r3 will come from."""
    operator = scene.operator
    scene.select_in_table("r1")
    operator.press("F8")
    operator.click_map(EAST)
    operator.press("Enter")
    operator.wait_for_state("r1", "acknowledged")


def press_while_checked(scene: Scene) -> None:
    """Press Send while the gateway, which holds still, has not said yet which way leads to the target.

    The conflict with r1, which comes of it, is seen as soon as it is sent.
    """
    operator, film = scene.operator, scene.film
    operator.click_tab("fleet_tabs", "Conflicts")
    scene.select_in_table("r3")
    operator.press("F8")
    target, send = operator.places_to_click(TARGET, "fleet_send_button")
    with scene.halted_gateway():
        operator.click_at_once(target, send)
        operator.wait_for_text("fleet_draft_text", "It goes out when that is found")
        # Not a moment longer: the desk gives up a question that nobody answers.
        pressed = film.look()
    operator.wait_for_text("fleet_draft_text", "^Acknowledged")
    operator.wait_for_text("fleet_give_way_r3", "r3 gives way")
    # At once: before long the two have met.
    sent = film.look()
    film.keep(pressed, "send-pressed", "Send was pressed while the way was still being found")
    film.keep(sent, "conflict", "the check has ended: r3 was sent, and will meet r1")


def show_refusal(scene: Scene) -> None:
    """Set a target in a keepout, whose reason for not being sent is a long one."""
    operator, film = scene.operator, scene.film
    scene.select_in_table("r1")
    operator.press("F8")
    operator.click_map(BASIN)
    operator.wait_for_text("fleet_draft_text", "Not to be sent")
    film.shoot("refused", "a target in the water basin is not to be sent, and says why")
    operator.press("Esc")
    operator.wait_for_text("fleet_draft_text", "^(?!.*Not to be sent)")


def stop_all(scene: Scene) -> None:
    """Press ABORT ALL where it was, and acknowledge the alarm that the two were too near to one another."""
    operator = scene.operator
    operator.click("fleet_abort_all_button")
    operator.wait_for_text("fleet_draft_text", "ABORT ALL: sent to 3 robots")
    scene.wait_until_standing("r3")
    operator.click_tab("fleet_tabs", "Alarms")
    operator.wait_for_widget("fleet_acknowledge_all")
    if operator.widget("fleet_acknowledge_all")["enabled"]:
        operator.click("fleet_acknowledge_all")
    operator.click_tab("fleet_tabs", "Commands")

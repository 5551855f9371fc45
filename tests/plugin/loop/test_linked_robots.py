"""Robots behind links, led by clicks on the canvas: a real peer, the link's adapter, a gateway, the window.

To the window all links are one; that each kind is driven, aborted, stopped and cleared, its own tests show.
"""

from __future__ import annotations

import math
from urllib.request import urlopen

import numpy as np
import pytest
from fleet_supervisor.plugin.panel.emergency import ClearDialog
from fleet_supervisor.plugin.panel.robot_model import TITLES
from fleet_supervisor.plugin.ui.glyphs import UNSURE_COLOUR
from fleet_supervisor.robot_bridge.core.messages.commands import CommandState
from qgis.PyQt.QtWidgets import QLabel, QLineEdit, QPushButton, QTableView

from tests.plugin.map.on_canvas import expected, spots
from tests.robot_bridge.links.vda5050.peers import Yard, require_peers
from tests.support.processes import Processes, free_port
from tests.support.robots.robot_wires import RobotWire

ROBOT = "linked"


@pytest.fixture
def linked(loop, root, tmp_path):
    """A vehicle at (20, 8), and the adapter that links it."""
    with Processes(tmp_path / "peers") as processes:
        yard = Yard(processes, tmp_path, require_peers(root))
        yard.start_broker()
        yard.start_adapter(loop.address)
        yield yard.start_vehicle(ROBOT, 20.0, 8.0, speed=3.0)


def wait_for_newest(operator, state):
    """Wait until the drive that was sent last has a state; return its report."""

    def newest():
        drives = [one for one in operator.sent_to(ROBOT) if one.op != "Abort"]
        return drives[-1] if drives else None

    operator.wait(f"the drive being {state.value}", lambda: newest() and newest().state is state, 60)
    return newest()


def send_to(operator, x):
    sent = len(operator.sent_to(ROBOT))
    operator.set_cone(ROBOT, x, 8.0)
    operator.wait("its command", lambda: len(operator.sent_to(ROBOT)) > sent, 20)


def send_far(operator):
    before = operator.report(ROBOT).x
    send_to(operator, 110.0)
    operator.wait("it driving", lambda: abs(operator.report(ROBOT).x - before) > 1.0, 30)


def clear_emergency(operator):
    operator.press("fleet_clear_emergency")
    window = operator._window
    operator.wait("the question", lambda: window.findChild(ClearDialog), 5)
    asked = window.findChild(ClearDialog)
    asked.findChild(QLineEdit, "fleet_clear_reason").setText("it was a test")
    asked.findChild(QPushButton, "fleet_clear_confirm").click()
    operator.wait("the end of it", lambda: not operator.desk.state.emergency.in_force, 20)


def banner(operator):
    return operator._window.findChild(QLabel, "fleet_emergency_text").text()


def is_at(operator, x, y):
    seen = operator.report(ROBOT)
    # Known, it may not have said yet where it is.
    return seen.x is not None and math.dist((seen.x, seen.y), (x, y)) <= 0.5


@pytest.mark.usefixtures("linked")
def test_a_linked_robot_is_led_from_the_canvas(loop, operator):
    operator.connect_to(loop, [ROBOT], declare_paths=False)
    operator.wait("where it is", lambda: is_at(operator, 20.0, 8.0), 20)

    send_to(operator, 26.0)
    wait_for_newest(operator, CommandState.REACHED)
    operator.wait("it at the cone", lambda: is_at(operator, 26.0, 8.0), 10)

    operator.choose("fleet_draw_route")
    for place in ((28, 8), (31, 10), (34, 8)):
        operator.click_site(*place)
    operator.press("fleet_send")
    operator.wait("both drives", lambda: len(operator.sent_to(ROBOT)) == 2, 20)
    assert len(wait_for_newest(operator, CommandState.REACHED).params["points"]) == 3
    operator.wait("it at the end", lambda: is_at(operator, 34.0, 8.0), 10)

    send_far(operator)
    operator.press("fleet_abort")
    wait_for_newest(operator, CommandState.ABORTED)
    operator.wait("it standing", lambda: abs(operator.report(ROBOT).v) < 0.05, 10)

    send_far(operator)
    operator.press("fleet_emergency_stop")
    operator.wait("its banner", lambda: "1 of 1 robot acknowledged" in banner(operator), 20)
    wait_for_newest(operator, CommandState.ABORTED)
    operator.wait("it standing", lambda: abs(operator.report(ROBOT).v) < 0.05, 10)
    assert operator.report(ROBOT).x < 105
    clear_emergency(operator)
    send_to(operator, operator.report(ROBOT).x + 5)
    wait_for_newest(operator, CommandState.REACHED)


def test_a_tracker_is_only_seen_and_a_target_for_it_is_refused_with_the_reason(loop, operator, tmp_path):
    port = free_port()
    file = tmp_path / "phones.toml"
    text = f'[tracker]\nhttp = "127.0.0.1:{port}"\n[tracker.names]\n845213 = "{ROBOT}"\n'
    file.write_text(f'[gateway]\nurl = "{loop.address}/link"\n{text}', encoding="utf-8")

    def report():
        place = "id=845213&lat=46.8805&lon=16.8436&speed=0&bearing=90&accuracy=4"
        try:
            return urlopen(f"http://127.0.0.1:{port}/?{place}", timeout=5).status == 200
        except OSError:
            return False

    with Processes(tmp_path / "peers") as processes:
        processes.start_bridge("link-tracker", ["link", "tracker", "--config", file])
        operator.wait("the report of the phone", report, 20)
        operator.connect_to(loop, [ROBOT], declare_paths=False)
        operator.wait("where it is", lambda: operator.report(ROBOT).x is not None, 20)
        operator.set_cone(ROBOT, 26.0, 8.0)
        operator.wait(
            "the reason", lambda: "was not sent: linked is only seen" in str(operator.notices()), 20
        )
        assert operator.sent_to(ROBOT) == []


def test_a_robot_that_leaps_is_unsure_on_the_map_in_the_list_and_among_the_alarms_until_believed(
    loop, operator
):
    robot = RobotWire(f"{loop.address}/robot?robot={ROBOT}")
    robot.plug_in(1)

    def say(x):
        """Have it say where it is: silent, it would be stale."""
        robot.tell("SendPos", {"x": x, "y": 8.0, "theta": 0.5, "v": 0.0})

    def shown():
        """Return its state in the list, and how many points at its place have the colour of such robots."""
        listed = operator._window.findChild(QTableView, "fleet_robot_table").model()
        state = listed.index(0, TITLES.index("State")).data()
        points = spots(operator.canvas, UNSURE_COLOUR)
        at = expected(operator.canvas, operator.desk.state.site, 20.0, 8.0)
        return state, int((np.hypot(*(points - at).T) < 14).sum())

    def alarms():
        model = operator._window.findChild(QTableView, "fleet_alarms").model()
        return [(model.index(row, 1).data(), model.index(row, 2).data()) for row in range(model.rowCount())]

    def is_shown(x, state, has_points):
        say(x)
        word, points = shown()
        return word == state and (points > 15) is has_points

    try:
        say(20.0)
        operator.connect_to(loop, [ROBOT], declare_paths=False)
        operator.wait_for_picture("it fresh", lambda: is_shown(20.0, "fresh", False), 20)
        operator.wait_for_picture("it unsure", lambda: is_shown(5e6, "unsure", True), 20)
        operator.wait("the alarm", lambda: say(5e6) or [state for _, state in alarms()] == ["new"], 20)
        ((text, _),) = alarms()
        assert text.startswith("linked may not be where it is shown: ") and "km outside site" in text
        operator.wait_for_picture("it fresh again", lambda: is_shown(20.1, "fresh", False), 20)
        operator.wait("the end", lambda: say(20.1) or [state for _, state in alarms()] == ["over"], 20)
    finally:
        robot.close()

"""`make demo PARTS=cluster` inside QGIS: a desk at one gateway of four, while servers are killed outside.

What is killed is killed by the process outside, when it reads here that it is time.
"""

from __future__ import annotations

import re
import time
from pathlib import Path

from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtWidgets import QDockWidget, QLabel

from tests.support.inside_qgis.desk_view import NotHappenedError
from tests.support.inside_qgis.session import Session, end, start

STEP = 60
"""Seconds, many times what an idle machine takes."""
WATCHED_S = 3.0
PANEL_WIDTH = 620
"""Pixels: so wide that each line of the emergency stop is seen, and whose a robot is."""


def work(session: Session) -> None:
    """Do what an operator would while the house burns."""
    plan, operator = session.plan, session.operator
    session.size_window(*plan["window"])
    session.open_project()
    operator.close_panel("Browser")
    operator.close_panel("Layers")
    window = session.window()
    panel = [window.findChild(QDockWidget, "fleet_dock")]
    window.resizeDocks(panel, [PANEL_WIDTH], Qt.Orientation.Horizontal)
    operator.show_map(plan["extent"], plan["crs"])
    operator.connect(f"{plan['gateway']}/desk", "operator")
    operator.wait_for_fleet(plan["robots"], STEP)
    session.happened(
        "robots", f"the desk in QGIS, at {plan['name']}, shows all {len(plan['robots'])} robots fresh"
    )
    send(session)
    for robot in plan["robots"]:
        operator.wait_until_driving(robot, STEP)
    picture(session, "driving")
    session.happened("driving", "all of them drive")
    watch_without_nats(session)
    wait_for_another_gateway(session)
    go_on_at_another_gateway(session)
    stop(session)
    end()


def send(session: Session) -> None:
    """Send a robot of the gateway that will be killed by a click."""
    plan, operator = session.plan, session.operator
    robot = plan["sent"]
    operator.send_to(robot, [plan["target"]], plan["crs"])
    seconds = operator.wait_until_taken(robot, 0, STEP)
    session.happened(
        "send",
        f"a click sends {robot}, which is connected to {plan['doomed']}: acknowledged after {seconds:.1f} s",
    )


def watch_without_nats(session: Session) -> None:
    """See that no robot grows old while a server of the bus is gone."""
    until, operator = time.monotonic() + WATCHED_S, session.operator
    while time.monotonic() < until:
        operator.pause(0.2)
    operator.wait_for_fleet(session.plan["robots"], STEP)
    session.happened("bus", f"{WATCHED_S:g} s later all robots are fresh at the desk")


def wait_for_another_gateway(session: Session) -> None:
    """Wait until the robots of the gateway that was killed drive on at others."""
    plan, operator = session.plan, session.operator
    orphans, gone = plan["orphans"], f"@{plan['doomed']}"

    def are_elsewhere() -> bool:
        rows = operator.robots()
        return all(rows[robot]["State"] == "fresh" and gone not in rows[robot]["Link"] for robot in orphans)

    seconds = operator.wait(f"{' and '.join(orphans)} at another gateway", are_elsewhere, STEP)
    rows = operator.robots()
    there = ", ".join(f"{robot} by {rows[robot]['Link']} at {rows[robot]['Speed']}" for robot in orphans)
    picture(session, "gateway-killed")
    session.happened("elsewhere", f"{seconds:.1f} s later the desk has its robots again: {there}")


def go_on_at_another_gateway(session: Session) -> None:
    """Wait until the desk itself is at another gateway than the one that it was given, and has all robots."""
    plan, operator = session.plan, session.operator
    line, given = operator.find(QLabel, "fleet_link_state"), plan["name"]
    seconds = operator.wait("the desk elsewhere", lambda: f"{given} did not answer" in line.text(), STEP)
    operator.wait_for_fleet(plan["robots"], STEP)
    where = re.search(r"at (\w+) \(", line.text()).group(1)
    session.happened("instead", f"{seconds:.1f} s later the desk is at {where}, and shows all robots fresh")


def stop(session: Session) -> None:
    """Press the emergency stop, and read at how many gateways it is in force."""
    plan, operator = session.plan, session.operator
    operator.press("fleet_emergency_stop")
    count = len(plan["robots"])

    def said() -> str:
        return operator.find(QLabel, "fleet_emergency_text").text()

    def is_complete() -> bool:
        everywhere = re.search(r"In force at (\d+) of \1 gateways", said())
        return everywhere is not None and f"{count} of {count} robots acknowledged, {count} seen" in said()

    try:
        seconds = operator.wait("the emergency stop", is_complete, STEP)
    except NotHappenedError:
        raise NotHappenedError(f"the emergency stop is not complete; its banner says: {said()}") from None
    picture(session, "emergency-stop")
    told = re.search(r"\d+ of \d+ gateways", said()).group()
    session.happened(
        "stop",
        f"emergency stop: in force at {told}, {count} of {count} robots acknowledged and seen to stand, "
        f"within {seconds:.1f} s",
    )


def picture(session: Session, name: str) -> None:
    """Save the window."""
    session.operator.pause(0.5)
    session.operator.take_picture(session.window(), Path(session.plan["pictures"]) / f"{name}.png")


start(work)

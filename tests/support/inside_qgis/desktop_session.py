"""`make desktop` inside QGIS: the sample project opens, the desk connects; for a picture the robots drive."""

from __future__ import annotations

from pathlib import Path

from tests.support.inside_qgis.session import Session, end, start

TIMEOUT = 20


def work(session: Session) -> None:
    """Set the window up, and take the picture that the plan asks for, if any."""
    plan, operator = session.plan, session.operator
    if "picture" in plan:
        session.size_window(*plan["window"])
    session.open_project()
    operator.connect(f"{plan['gateway']}/desk", plan["operator"])
    operator.wait("three fresh robots", lambda: all_fresh(session), TIMEOUT)
    session.happened("ready", f"QGIS is open and connected to {plan['gateway']}/desk")
    if "picture" in plan:
        picture(session)
        end()


def all_fresh(session: Session) -> bool:
    states = {name: row["State"] for name, row in session.operator.robots().items()}
    return states == dict.fromkeys(session.plan["robots"], "fresh")


def picture(session: Session) -> None:
    """Let every robot drive, then save the window as it looks."""
    plan, operator = session.plan, session.operator
    operator.close_panel("Browser")
    operator.show_map(plan["extent"], plan["crs"])
    for robot, places in plan["errands"].items():
        operator.select(robot)
        operator.choose("fleet_cone_target" if len(places) == 1 else "fleet_draw_route")
        for place in places:
            operator.click_map(*place, plan["crs"])
        operator.press("fleet_send")
        operator.wait(f"{robot} driving", lambda robot=robot: operator.speed(robot) > 0.5, TIMEOUT)
    operator.pause(plan["drive_seconds"])
    operator.wait_for_map()
    operator.take_picture(session.window(), Path(plan["picture"]))
    session.happened("picture", f"the window was saved as {plan['picture']}")


start(work)

"""The demonstration's part inside QGIS: connect, a cone target, a route, an abort, a picture."""

from __future__ import annotations

from pathlib import Path

from tests.support.inside_qgis.session import Session, end, start

STEP_TIMEOUT = 10
DRIVE_TIMEOUT = 90


def work(session: Session) -> None:
    """Do what an operator would, and write down each thing that really happened."""
    plan, operator = session.plan, session.operator
    session.draw_only_what_is_seen()
    layers = session.open_project()
    session.happened("project", f"QGIS opened the sample project: {layers} layers, all valid", layers=layers)
    session.size_window(1440, 900)
    operator.close_panel("Browser")
    operator.show_map(plan["extent"], plan["crs"])
    connect(session)
    send(session, "r1", "cone target", [plan["cone"]])
    send(session, "r2", f"route of {len(plan['route'])} points", plan["route"])
    send(session, "r3", "cone target", [plan["far"]])
    picture(session)
    abort(session, "r3")
    for robot in ("r1", "r2"):
        seconds = operator.wait(
            f"{robot} reaching its end", lambda robot=robot: ended(session, robot), DRIVE_TIMEOUT
        )
        state = operator.state_of(robot)
        session.happened(f"{robot} ends", f"the log shows {robot}'s command as {state}", waited=seconds)
    end()


def connect(session: Session) -> None:
    plan, operator = session.plan, session.operator
    operator.connect(f"{plan['gateway']}/desk", "demo")
    seconds = operator.wait("connecting", lambda: "Connected" in operator.link_state(), STEP_TIMEOUT)
    session.happened("connect", f"the desk connected to {plan['gateway']}/desk", connected_after=seconds)
    operator.wait_for_fleet(plan["robots"], STEP_TIMEOUT)
    links = ", ".join(f"{name} over {row['Link']}" for name, row in operator.robots().items())
    session.happened("robots", f"the table shows {links}, all fresh")


def send(session: Session, robot: str, what: str, places: list[list[float]]) -> None:
    operator = session.operator
    before = len(operator.commands())
    operator.send_to(robot, places, session.plan["crs"])
    seconds = operator.wait_until_taken(robot, before, STEP_TIMEOUT)
    session.happened(f"{robot} {what}", f"sent {robot} a {what}: acknowledged", acknowledged_after=seconds)


def picture(session: Session) -> None:
    """Save the map while every robot drives."""
    plan, operator = session.plan, session.operator
    operator.pause(2)
    for robot in plan["robots"]:
        operator.wait_until_driving(robot, STEP_TIMEOUT)
    operator.wait_for_map()
    operator.take_picture(operator.canvas, Path(plan["picture"]))
    session.happened("picture", f"all of them drive; the map was saved as {plan['picture']}")


def abort(session: Session, robot: str) -> None:
    """Abort a robot that drives and see it stand."""
    operator = session.operator
    operator.select(robot)
    operator.press("fleet_abort")
    operator.wait(f"the abort of {robot}", lambda: aborted(session, robot), STEP_TIMEOUT)
    seconds = operator.wait(f"{robot} standing", lambda: operator.speed(robot) < 0.05, STEP_TIMEOUT)
    session.happened(f"{robot} abort", f"{robot} was aborted while driving and stands", stood_after=seconds)


def aborted(session: Session, robot: str) -> bool:
    entries = [entry for entry in session.operator.commands() if entry.what.startswith(f"{robot} ")]
    return any(entry.state == "aborted" for entry in entries)


def ended(session: Session, robot: str) -> bool:
    return session.operator.state_of(robot) in ("reached", "aborted", "failed", "expired", "superseded")


start(work)

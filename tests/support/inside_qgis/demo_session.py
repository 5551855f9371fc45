"""The demonstration's part inside QGIS: connect, a cone target, a route, an abort, a picture."""

from __future__ import annotations

from pathlib import Path

from tests.support.inside_qgis.session import Session, end, start

STEP_TIMEOUT = 10
DRIVE_TIMEOUT = 90


def work(session: Session) -> None:
    """Do what an operator would, and write down each thing that really happened."""
    plan, operator = session.plan, session.operator
    layers = session.open_project()
    session.happened("project", f"QGIS opened the sample project: {layers} layers, all valid", layers=layers)
    session.size_window(1440, 900)
    operator.close_panel("Browser")
    operator.show_map(plan["extent"], plan["crs"])
    connect(session)
    send_cone(session, "r1", plan["cone"])
    send_route(session, "r2", plan["route"])
    send_cone(session, "r3", plan["far"])
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

    def all_fresh() -> bool:
        states = {name: row["State"] for name, row in operator.robots().items()}
        return states == dict.fromkeys(plan["robots"], "fresh")

    operator.wait("every robot being fresh", all_fresh, STEP_TIMEOUT)
    links = ", ".join(f"{name} over {row['Link']}" for name, row in operator.robots().items())
    session.happened("robots", f"the table shows {links}, all fresh")


def send_cone(session: Session, robot: str, place: list[float]) -> None:
    operator = session.operator
    operator.select(robot)
    operator.choose("fleet_cone_target")
    operator.click_map(*place, session.plan["crs"])
    send(session, robot, "cone target")


def send_route(session: Session, robot: str, places: list[list[float]]) -> None:
    operator = session.operator
    operator.select(robot)
    operator.choose("fleet_draw_route")
    for place in places:
        operator.click_map(*place, session.plan["crs"])
    send(session, robot, f"route of {len(places)} points")


def send(session: Session, robot: str, what: str) -> None:
    operator = session.operator
    before = len(operator.commands())
    operator.press("fleet_send")
    operator.wait(f"a command for {robot}", lambda: len(operator.commands()) > before, STEP_TIMEOUT)
    seconds = operator.wait(
        f"{robot} acknowledging", lambda: operator.state_of(robot) == "acknowledged", STEP_TIMEOUT
    )
    session.happened(f"{robot} {what}", f"sent {robot} a {what}: acknowledged", acknowledged_after=seconds)


def picture(session: Session) -> None:
    """Save the map while every robot drives."""
    plan, operator = session.plan, session.operator
    operator.pause(2)
    for robot in plan["robots"]:
        operator.wait(f"{robot} driving", lambda robot=robot: operator.speed(robot) >= 0.5, STEP_TIMEOUT)
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

"""`tools/cone_plan_pictures.py` inside QGIS: places a layout, plans, sends, and goes on without a robot."""

from __future__ import annotations

from pathlib import Path

from qgis.core import QgsProject
from qgis.PyQt.QtWidgets import (
    QAbstractButton,
    QAction,
    QApplication,
    QDockWidget,
    QDoubleSpinBox,
    QLabel,
    QMessageBox,
    QTableView,
    QTabWidget,
)
from qgis.utils import iface

from tests.support.inside_qgis.desk_view import NotHappenedError
from tests.support.inside_qgis.session import Session, end, start

TIMEOUT = 30
DRIVING = 120
BETWEEN_GATES = 1.4
"""Seconds until a robot that leaves a gate of cones is far from it, and not yet near the next."""


class Film:
    """The operator at the panel of cone plans, and the camera."""

    def __init__(self, session: Session):
        self.session, self.plan, self.operator = session, session.plan, session.operator
        self.window = session.window()
        self.shots = 0

    def find(self, kind: type, name: str):
        """Return a part of the window."""
        found = self.window.findChild(kind, name)
        if found is None:
            raise NotHappenedError(f"the window has no {kind.__name__} named {name}")
        return found

    def text(self, name: str) -> str:
        """Return what a label says."""
        return self.find(QLabel, name).text()

    def press(self, name: str) -> None:
        """Click a button of the panel once it can be used."""
        button = self.find(QAbstractButton, name)
        self.operator.wait(f"{name} being usable", lambda: button.isEnabled() and button.isVisible(), TIMEOUT)
        button.click()
        QApplication.processEvents()

    def shoot(self, step: str, text: str) -> None:
        """Take the next picture of the window."""
        self.operator.pause(1.2)
        self.operator.wait_for_map()
        self.shots += 1
        path = Path(self.plan["pictures"]) / f"cone-plan-{self.shots}-{step}.png"
        self.operator.take_picture(self.window, path)
        self.session.happened(step, f"{text}: saved as {path}")

    def done(self) -> int:
        """Return how many cones the panel says are placed."""
        words = self.text("fleet_plan_text").split()
        return int(words[words.index("of") - 1]) if "of" in words and words[0] in ("Under", "Done:") else 0

    def placed_by(self, robot: str) -> int:
        """Return how many cones the command log says that a robot has reached."""
        ours = f"{robot} · cone"
        return sum(c.state == "reached" for c in self.operator.commands() if c.what.startswith(ours))


def work(session: Session) -> None:
    """Play the whole sequence."""
    film = Film(session)
    set_up(film)
    place_layout(film)
    make_plan(film)
    send(film)
    go_on_without_r1(film)
    report(film)
    # QGIS 3.22 does not survive its own end with a layer selected.
    QgsProject.instance().clear()
    end()


def set_up(film: Film) -> None:
    plan, operator = film.plan, film.operator
    film.session.size_window(*plan["window"])
    film.session.open_project()
    for panel in ("Browser", "Layers"):
        film.find(QDockWidget, panel).close()
    operator.connect(f"{plan['gateway']}/desk", "anna")
    operator.wait("three robots", lambda: len(operator.robots()) == len(plan["robots"]), TIMEOUT)
    film.find(QAction, "fleet_plan_panel").trigger()
    operator.show_map(plan["extent"], plan["crs"])


def place_layout(film: Film) -> None:
    film.find(QAction, "fleet_cone_layout_iso3888_1").trigger()
    tool = iface.mapCanvas().mapTool()
    # The straight of the sample site is a little shorter than the standard's layout.
    tool.layout = type(tool.layout).of(film.plan["dimensions"])
    film.operator.click_map(*film.plan["origin"], film.plan["crs"])
    iface.actionPan().trigger()
    film.shoot("layout", "The double lane change stands on the straight")


def make_plan(film: Film) -> None:
    robots = film.find(QTableView, "fleet_plan_robots").model()
    film.operator.wait("robots in the panel", lambda: robots.rowCount() == 3, TIMEOUT)
    for row in range(robots.rowCount()):
        for column, value in enumerate((12, 12, film.plan["speed"]), 1):
            robots.setData(robots.index(row, column), f"{value:g}")
    film.find(QDoubleSpinBox, "fleet_plan_seconds").setValue(2.0)
    film.press("fleet_plan_solve")
    film.operator.wait("the plan", lambda: "Not sent yet" in film.text("fleet_plan_text"), TIMEOUT)
    film.shoot("plan", film.text("fleet_plan_text"))


def send(film: Film) -> None:
    film.press("fleet_plan_send")
    question = film.find(QMessageBox, "fleet_plan_question")
    next(button for button in question.buttons() if button.text() == "Send").click()
    film.operator.wait("cones being placed", lambda: film.done() >= 7, DRIVING)
    film.shoot("driving", film.text("fleet_plan_text"))


def go_on_without_r1(film: Film) -> None:
    film.operator.wait("r1 leaving its second gate", lambda: film.placed_by("r1") >= 4, DRIVING)
    film.operator.pause(BETWEEN_GATES)
    film.session.happened("kill r1", "r1 is killed")
    film.operator.wait("r1 being missed", lambda: "r1 is lost" in film.text("fleet_plan_trouble"), TIMEOUT)
    film.shoot("lost", film.text("fleet_plan_trouble"))
    film.press("fleet_plan_rest")
    film.operator.wait("a new plan", lambda: "New plan" in film.text("fleet_plan_text"), TIMEOUT)
    film.shoot("new-plan", film.text("fleet_plan_text"))
    film.press("fleet_plan_confirm")
    film.operator.wait("every cone", lambda: "Done: 18 of 18" in film.text("fleet_plan_text"), DRIVING)
    film.shoot("done", film.text("fleet_plan_text"))


def report(film: Film) -> None:
    film.find(QTabWidget, "fleet_plan_tabs").setCurrentIndex(1)
    film.operator.pause(0.5)
    film.shoot("as-placed", film.text("fleet_placed_figures"))


start(work)

"""`make demo PARTS=zalazone` inside QGIS: cones in three reference systems, a surface, a route, a picture."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from qgis.core import (
    QgsApplication,
    QgsCoordinateReferenceSystem,
    QgsMarkerSymbol,
    QgsPalLayerSettings,
    QgsProject,
    QgsRectangle,
    QgsSettings,
    QgsSingleSymbolRenderer,
    QgsTextBufferSettings,
    QgsTextFormat,
    QgsVectorLayerSimpleLabeling,
)
from qgis.gui import QgsMapCanvas, QgsProjectionSelectionWidget
from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import QAction, QDialog, QDockWidget, QLabel, QLineEdit
from qgis.utils import iface

from tests.support.inside_qgis.desk_view import NotHappenedError
from tests.support.inside_qgis.session import Session, end, start

STEP = 60
DRIVE = 180
"""Seconds, many times what an idle machine takes."""
NEAR_M, NEAR_DEG = 2.0, 2e-5
"""Of the map around a cone that is clicked, on each side: a pixel is 5 mm, so a click can say where."""
LEFT_WIDTH = 400
"""Pixels of the panels on the left, the second map among them."""


def work(session: Session) -> None:
    """Do what an operator of the proving ground would."""
    plan, operator = session.plan, session.operator
    session.size_window(*plan["window"])
    session.draw_only_what_is_seen()
    layers = session.open_project()
    operator.close_panel("Browser")
    operator.show_map(plan["track"], plan["crs"])
    session.happened("project", f"QGIS opened the proving ground: {layers} layers, all valid")
    connect(session)
    second_map(session)
    ask_surface(session)
    for number, cone in enumerate(plan["cones"]):
        if number:
            drive_away(session)
        place_cone(session, cone)
    for cone in plan["cones"]:
        drive_away(session)
        click_cone(session, cone)
    drive_route(session)
    end()


def connect(session: Session) -> None:
    plan, operator = session.plan, session.operator
    operator.connect(f"{plan['gateway']}/desk", "operator")
    operator.wait_for_fleet(plan["robots"], STEP)
    session.happened("robots", "the desk shows six cars marked as replay and two ROS 2 robots, all fresh")


def second_map(session: Session) -> None:
    """Open a second view of the same map, where the cars are."""
    canvas = iface.createNewMapCanvas("Dynamic platform: six recorded cars")
    if canvas is None:
        raise NotHappenedError("QGIS opened no second map")
    session.draw_only_what_is_seen()
    canvas.setExtent(QgsRectangle(*session.plan["platform"]))
    dock = _dock_of(canvas)
    dock.setFloating(False)
    window = session.window()
    window.addDockWidget(Qt.DockWidgetArea.LeftDockWidgetArea, dock)
    layers = window.findChild(QDockWidget, "Layers")
    iface.layerTreeView().collapseAll()
    window.resizeDocks([layers, dock], [LEFT_WIDTH, LEFT_WIDTH], Qt.Orientation.Horizontal)
    window.resizeDocks([layers, dock], [200, 800], Qt.Orientation.Vertical)
    name_cars()
    session.operator.pause(1.0)
    canvas.setExtent(QgsRectangle(*session.plan["platform"]))
    canvas.refresh()
    session.operator.show_map(session.plan["track"], session.plan["crs"])


def name_cars() -> None:
    """Show the recorded cars larger and named in the layer of robots, all that the second map has of them."""
    (layer,) = QgsProject.instance().mapLayersByName("Robots (live)")
    look = QgsPalLayerSettings()
    look.fieldName = "if(\"robot\" like 'replay-%', substr(\"robot\", 8), '')"
    look.isExpression = True
    text = QgsTextFormat()
    text.setSize(8)
    halo = QgsTextBufferSettings()
    halo.setEnabled(True)
    text.setBuffer(halo)
    look.setFormat(text)
    look.dist = 2.0
    layer.setLabeling(QgsVectorLayerSimpleLabeling(look))
    layer.setLabelsEnabled(True)
    dot = {"name": "circle", "size": "3", "color": "#1c71d8", "outline_color": "#ffffff"}
    layer.setRenderer(QgsSingleSymbolRenderer(QgsMarkerSymbol.createSimple(dot)))
    layer.triggerRepaint()


def ask_surface(session: Session) -> None:
    """Click a place with the surface tool and read what it says."""
    plan, operator = session.plan, session.operator
    action = session.window().findChild(QAction, "fleet_surface_at_point")
    action.trigger()
    operator.click_map(*plan["surface_at"], plan["crs"])
    bar = iface.messageBar()

    def said() -> list[str]:
        return [label.text() for label in bar.findChildren(QLabel) if "Asphalt" in label.text()]

    operator.wait("the surface being told", said, STEP)
    told = said()[0]
    bar.clearWidgets()
    session.happened("surface", f"a click with the surface tool says: {told}")


def place_cone(session: Session, cone: dict) -> None:
    """Type a cone's coordinates, send it, and wait until it is reached."""
    operator, robot = session.operator, session.plan["first"]
    operator.select(robot)
    operator.choose("fleet_cone_target")
    told = type_coordinates(session, cone)
    send(session, robot, lambda: operator.press("fleet_send"))
    seconds = reached(session, robot)
    session.happened(
        f"cone in {cone['called']}",
        f"cone at {cone['text']} ({cone['called']}, {cone['crs']}) for {robot}: reached in {seconds:.1f} s. "
        f"{told}",
    )


def click_cone(session: Session, cone: dict) -> None:
    """Click the cone's place on a map in its reference system, send it, and wait until it is reached."""
    operator, plan, robot = session.operator, session.plan, session.plan["first"]
    x, y = cone["x"], cone["y"]
    crs = QgsCoordinateReferenceSystem(cone["crs"])
    near = NEAR_DEG if crs.isGeographic() else NEAR_M
    # Of several operations between two CRSs the first, as the dialog of coordinates has it: nobody is asked.
    QgsSettings().setValue("/projections/promptWhenMultipleTransformsExist", False, QgsSettings.Section.App)
    QgsProject.instance().setCrs(crs)
    operator.show_map((x - near, y - near, x + near, y + near), cone["crs"])
    operator.select(robot)
    operator.choose("fleet_cone_target")
    operator.click_map(x, y, cone["crs"])
    send(session, robot, lambda: session.operator.press("fleet_send"))
    seconds = reached(session, robot)
    session.happened(
        f"click in {cone['called']}",
        f"cone clicked on a map in {cone['called']} ({cone['crs']}) for {robot}: reached in {seconds:.1f} s",
    )
    QgsProject.instance().setCrs(QgsCoordinateReferenceSystem(plan["crs"]))
    operator.show_map(plan["track"], plan["crs"])


def type_coordinates(session: Session, cone: dict) -> str:
    """Set the draft by the dialog of coordinates; return by which operation they came to the site's CRS."""
    session.window().findChild(QAction, "fleet_coordinates").trigger()
    dialog = session.window().findChild(QDialog, "fleet_coordinates_dialog")
    chosen = dialog.findChild(QgsProjectionSelectionWidget, "fleet_coordinates_crs")
    chosen.setCrs(QgsCoordinateReferenceSystem(cone["crs"]))
    field = dialog.findChild(QLineEdit, "fleet_coordinates_text")
    field.selectAll()
    QTest.keyClicks(field, cone["text"])
    told = dialog.findChild(QLabel, "fleet_coordinates_told").text()
    if "m on the site" not in told:
        raise NotHappenedError(f"the coordinates {cone['text']} in {cone['crs']} were not taken: {told}")
    QTest.keyClick(field, Qt.Key.Key_Return)
    dialog.close()
    return told.splitlines()[-1]


def drive_away(session: Session) -> None:
    """Send the first robot off the place of the cones by a click."""
    plan, operator = session.plan, session.operator
    send(session, plan["first"], lambda: operator.send_to(plan["first"], [plan["away"]], plan["crs"]))
    reached(session, plan["first"])


def drive_route(session: Session) -> None:
    """Lead a route along the roads, send it, take the picture on the way, and wait for its end."""
    plan, operator = session.plan, session.operator
    robot = plan["second"]
    operator.select(robot)
    operator.choose("fleet_road_route")
    operator.click_map(*plan["goal"], plan["crs"])
    operator.wait("a way to the click", lambda: operator.draft_text().startswith(f"Route for {robot}"), STEP)
    told = operator.draft_text().partition(". ")[0]
    send(session, robot, lambda: operator.press("fleet_send"))
    session.happened("route", f"a click with the tool for routes on roads: {told}. Sent, and acknowledged")
    operator.wait_until_driving(robot, STEP)
    operator.pause(3)
    picture(session)
    seconds = reached(session, robot)
    session.happened("route ends", f"{robot} reached the end of its route {seconds:.1f} s after the picture")


def picture(session: Session) -> None:
    """Save the window while cars and robot drive."""
    operator, path = session.operator, Path(session.plan["picture"])
    for name, row in operator.robots().items():
        if name.startswith("replay-") and operator.speed(name) < 5:
            raise NotHappenedError(f"{name} does not drive: {row}")
    operator.wait_for_map()
    operator.take_picture(session.window(), path)
    session.happened("picture", f"the window of QGIS with all of it was saved as {path}")


def send(session: Session, robot: str, press: Callable[[], None]) -> None:
    """Send by ``press`` and wait until the robot has acknowledged."""
    operator = session.operator
    before = len(operator.commands())
    said: list[str] = []
    QgsApplication.messageLog().messageReceived.connect(lambda text, *_: said.append(text))
    press()
    try:
        operator.wait_until_taken(robot, before, STEP)
    except NotHappenedError as error:
        raise NotHappenedError(f"{error}; QGIS said: {' '.join(said) or 'nothing'}") from None


def reached(session: Session, robot: str) -> float:
    """Wait until the robot's newest command is reached; return how many seconds that took."""
    operator = session.operator
    return operator.wait(f"{robot} being there", lambda: operator.state_of(robot) == "reached", DRIVE)


def _dock_of(canvas: QgsMapCanvas) -> QDockWidget:
    widget = canvas.parentWidget()
    while widget is not None and not isinstance(widget, QDockWidget):
        widget = widget.parentWidget()
    if widget is None:
        raise NotHappenedError("the second map is in no panel")
    return widget


start(work)

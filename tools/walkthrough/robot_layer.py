"""The robots as a layer like any other: identified, in the attribute table, in expressions, labelled."""

from __future__ import annotations

from tests.support.errors import StageError
from tools.walkthrough.scene import ROBOTS, Scene

LAYER = "Robots (live)"
EXPRESSION_EDITOR = "QgsCodeEditorExpression"
"""By its class: QGIS 3.44 gives it no name."""
NEAR = "robot_state(\"robot\") = 'fresh' and distance_to_robot('r3') < 60"
LABEL = "robot_state(\"robot\") || ', ' || round(distance_to_robot('r3')) || ' m to r3'"


def look_at_layer(scene: Scene) -> None:
    """Make room by hiding the fleet panel, which the keys of the stops do not need."""
    operator = scene.operator
    operator.press("F9")
    operator.wait("the fleet panel closing", lambda: not operator.widget("fleet_dock")["visible"])
    operator.wait_for_map()
    operator.click_row("Layers", "Fleet", LAYER)
    identify(scene)
    open_table(scene)
    select(scene)
    label(scene)


def identify(scene: Scene) -> None:
    """Click r1 with QGIS's Identify."""
    operator = scene.operator
    operator.press("Ctrl+Shift+I")
    operator.click_map(scene.gateway.place_of("r1"))
    operator.wait_for_row("IdentifyResultsDock", LAYER)
    scene.film.shoot("identify", "r1 is identified")
    operator.close_panel("IdentifyResultsDock")


def open_table(scene: Scene) -> None:
    operator = scene.operator
    operator.press("F6")
    operator.wait_for_dialog("mTableView")
    for robot in ROBOTS:
        operator.wait_for_row("mTableView", robot)
    scene.film.shoot("table", "the robots in the attribute table")
    operator.close_dialog()


def select(scene: Scene) -> None:
    """Select the robots near r3 by an expression; they are selected at the desk, too."""
    operator = scene.operator
    operator.press("Ctrl+F3")
    operator.wait_for_dialog(EXPRESSION_EDITOR)
    operator.write("txtSearchEdit", "distance_to")
    operator.click_row("mExpressionTreeView", "Fleet", "distance_to_robot")
    operator.click(EXPRESSION_EDITOR)
    operator.type(NEAR)
    operator.click("mButtonSelect")
    near = [robot for robot in ROBOTS if scene.distance(robot, "r3") < 60]
    operator.wait("those near r3 being selected", lambda: sorted(operator.desk()["selected"]) == near)
    if len(near) in (0, len(ROBOTS)):
        raise StageError(f"{near} are near r3: that tells nothing of the expression")
    scene.film.shoot("expression", "robots are selected by an expression, whose function is explained")
    close_expression(scene)


def close_expression(scene: Scene) -> None:
    """By its button: in QGIS 3.44 the editor keeps Esc to itself."""
    scene.operator.click("mPbnClose")
    scene.operator.wait_for_no_dialog()


def label(scene: Scene) -> None:
    operator = scene.operator
    operator.choose_from_menu("Layer", "Labeling")
    operator.click("mLabelModeComboBox")
    operator.click_row("mLabelModeComboBox", "Single Labels")
    operator.click("mFieldExpressionWidget")
    operator.press("Ctrl+A")
    operator.type(LABEL)
    operator.press("Enter")
    operator.wait("the labels", lambda: any("m to r3" in text for text in operator.labels()))
    scene.film.shoot("labels", "the robots are labelled by an expression")
    operator.close_panel("LayerStyling")

"""The robots' layer is styled by what the plugin's expressions tell, and cones are chosen by theirs."""

from __future__ import annotations

from tools.walkthrough.robot_layer import EXPRESSION_EDITOR, LAYER, close_expression
from tools.walkthrough.scene import Scene
from tools.walkthrough.toolbox import CONE_COUNT

STATE = 'robot_state("robot")'
NEAR = "distance_to_robot('r3') < 40"
ON_ROAD = "road_surface($x, $y) = 'asphalt'"


def style_robots(scene: Scene) -> None:
    """Colour robots by their state, then by rules."""
    operator = scene.operator
    operator.open_row("Layers", "Fleet", LAYER)
    operator.press("F7")
    operator.wait_for_widget("LayerStyling")
    by_state(scene)
    by_rules(scene)
    operator.close_panel("LayerStyling")


def by_state(scene: Scene) -> None:
    """Classify by an expression, in place of the plugin's own classes: one, as every robot is fresh."""
    operator = scene.operator
    operator.click("btnDeleteAllCategories")
    operator.click("mExpressionWidget")
    operator.press("Ctrl+A")
    operator.type(STATE)
    operator.press("Enter")
    operator.click("btnAddCategories")
    operator.wait_for_row("Layers", "Fleet", LAYER, "fresh")
    scene.film.shoot("categories", "the robots are coloured by their state")


def by_rules(scene: Scene) -> None:
    operator = scene.operator
    operator.click("cboRenderers")
    operator.click_row("cboRenderers", "Rule-based")
    operator.click("btnAddRule")
    operator.write("editLabel", "near r3")
    operator.write("editFilter", NEAR)
    scene.film.shoot("rules", "a rule for the robots near r3")


def ask_for_surfaces(scene: Scene) -> None:
    """Select the cones on asphalt, by an expression whose function is explained beside it."""
    operator = scene.operator
    operator.click_row("Layers", "Cones")
    operator.press("Ctrl+F3")
    operator.wait_for_dialog(EXPRESSION_EDITOR)
    operator.write("txtSearchEdit", "road_surf")
    operator.click_row("mExpressionTreeView", "Fleet", "road_surface")
    operator.wait_for_text("txtHelpText", "class of the road surface at a place")
    operator.click(EXPRESSION_EDITOR)
    operator.type(ON_ROAD)
    operator.click("mButtonSelect")
    operator.wait("the cones being selected", lambda: operator.layers()["Cones"] == CONE_COUNT)
    scene.film.shoot("road-surface", "cones are selected by the surface they stand on")
    close_expression(scene)

"""Cones are placed by a plan, and the report of how they stand is made at the panel."""

from __future__ import annotations

import re
from pathlib import Path

from tests.support.errors import StageError
from tools.walkthrough.operator_at_screen import OperatorAtScreen
from tools.walkthrough.scene import Scene
from tools.walkthrough.toolbox import close, lay_out_cones

ABOARD = 2
"""The column of the cones that a robot has aboard."""


def place_cones(scene: Scene) -> None:
    """Lay out a slalom, and send r1 off to place its cones by a plan; other acts go on meanwhile."""
    operator = scene.operator
    lay_out_cones(scene)
    # The toolbox and the layers make room for the plan.
    operator.press("Ctrl+Alt+T")
    operator.press("Ctrl+1")
    operator.press("Alt+F12")
    operator.click("fleet_plan_cones")
    operator.click_row("fleet_plan_cones", "Cones")
    operator.click_cell("fleet_plan_robots", "r1", ABOARD)
    operator.type("8")
    operator.press("Enter")
    operator.click("fleet_plan_preview")
    operator.wait_for_text("fleet_plan_text", "Not sent yet")
    operator.click("fleet_plan_send")
    operator.wait_for_dialog("fleet_plan_question")
    operator.click("fleet_plan_question_send")
    operator.wait_for_no_dialog()
    operator.wait_for_text("fleet_plan_text", "Under way")
    # The keys of the stops do not need the panels, and what comes does need their room.
    operator.press("F9")
    operator.wait("the fleet panel closing", lambda: not operator.widget("fleet_dock")["visible"])
    _show_layers(operator)


def report_cones(scene: Scene) -> None:
    """Look until every cone is placed, and write the report of how they stand."""
    operator = scene.operator
    operator.press("Ctrl+1")
    operator.press("Alt+F12")
    operator.wait_for_text("fleet_plan_text", r"Done: (\d+) of \1 cones")
    operator.click_tab("fleet_plan_tabs", "As placed")
    operator.wait_for_text("fleet_placed_figures", r"^(\d+) of \1 cones placed")
    scene.film.shoot("placed", "the plan is driven: every cone, and how far off it stands")
    write_report(scene)
    _show_layers(operator)


def _show_layers(operator: OperatorAtScreen) -> None:
    """Show the layers where the plan stood, whose room they had made."""
    operator.press("Alt+F12")
    operator.press("Ctrl+1")
    operator.wait_for_widget("Layers")


def write_report(scene: Scene) -> None:
    """Open the report's dialog from the panel, and look at what it writes."""
    operator = scene.operator
    operator.click("fleet_placed_report")
    operator.wait_for_dialog("textShortHelp")
    scene.film.shoot("report-dialog", "the report's dialog, on the layer of placed cones")
    operator.click_button("Run")
    # What runs in QGIS's own thread does not turn to the log.
    said = operator.wait("the report being announced", lambda: written_in(operator.messages()))
    file = Path(said)
    scene.film.keep_page("report", file, "the report's first page")
    if not file.read_bytes().startswith(b"%PDF-"):
        raise StageError(f"{file} is no PDF")
    close(scene)


def written_in(messages: list[str]) -> str:
    """Return the file that a message of QGIS's bar leads to, nothing while there is none."""
    found = (re.search(r'<a href="file://([^"]+)">', message) for message in messages)
    return next((one.group(1) for one in found if one), "")

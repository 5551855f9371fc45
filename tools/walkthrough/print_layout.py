"""A print layout with an atlas: a page of the map for each robot, as PDF."""

from __future__ import annotations

from pathlib import Path

from tests.support.errors import StageError
from tools.walkthrough.robot_layer import LAYER
from tools.walkthrough.scene import ROBOTS, Scene

WHOLE_SCREEN = (0, 0), (1280, 800)
PAPER = (0.22, 0.26), (0.78, 0.74)
"""Where the map lies in the view of the layout, in parts of it: on the page, in its middle."""


def print_atlas(scene: Scene) -> None:
    """Make a layout, led by the robots' layer, with a map that follows it, and write its pages."""
    make_layout(scene)
    lead_by_robots(scene)
    put_map(scene)
    file = export(scene)
    scene.film.keep_page("atlas-page", file, "the atlas's first page")
    pages = file.read_bytes().count(b"/Type /Page\n")
    if pages != len(ROBOTS):
        raise StageError(f"{file} has {pages} pages, not one for each of {', '.join(ROBOTS)}")


def make_layout(scene: Scene) -> None:
    operator = scene.operator
    operator.press("Ctrl+P")
    operator.wait_for_window()
    operator.type("Robots")
    operator.press("Enter")
    operator.wait_for_dialog("QgsLayoutView")
    operator.place_dialog(*WHOLE_SCREEN)


def lead_by_robots(scene: Scene) -> None:
    """Let the atlas have a page for each robot."""
    operator = scene.operator
    operator.choose_from_menu("Atlas", "Atlas Settings")
    operator.click("mUseAtlasCheckBox")
    operator.click("mAtlasCoverageLayerComboBox")
    operator.click_row("mAtlasCoverageLayerComboBox", LAYER)
    operator.choose_from_menu("Atlas", "Preview Atlas")


def put_map(scene: Scene) -> None:
    """Draw a map on the page, and let it go where the atlas's robot is."""
    operator = scene.operator
    operator.choose_from_menu("Add Item", "Add Map")
    operator.drag_in("QgsLayoutView", *PAPER)
    operator.click_panel_tab("Item Properties")
    operator.scroll_to("mAtlasCheckBox", "QgsLayoutMapWidget")
    operator.tick_head("mAtlasCheckBox")
    scene.film.shoot("atlas", "a page of the atlas for each robot")


def export(scene: Scene) -> Path:
    """Write every page into one PDF."""
    operator, file = scene.operator, scene.home / "Documents" / "robots.pdf"
    operator.choose_from_menu("Atlas", "Export Atlas as PDF…")
    operator.wait_for_dialog("fileNameEdit")
    operator.write("fileNameEdit", str(file))
    operator.press("Enter")
    operator.wait_for_dialog("mDisableRasterTilingCheckBox")
    operator.click_button("Save")
    operator.wait("the file's end", lambda: file.exists() and b"%%EOF" in file.read_bytes()[-32:])
    operator.wait_for_dialog("QgsLayoutView")
    operator.press("Ctrl+Q")
    operator.wait_for_no_dialog()
    return file

"""Algorithms of the Processing toolbox, in their dialogs: found, filled in, run to their ends."""

from __future__ import annotations

from pathlib import Path

from robot_bridge.core.robotmap.text_format import read_text
from tests.support.errors import StageError
from tools.walkthrough.gateway import Place
from tools.walkthrough.scene import Scene

CORNER, FAR_CORNER = (20.0, 8.0), (92.0, 22.0)
"""Where the route begins and ends: r1 and r3 stand there. Site frame, metres."""
CONES = (30.0, 6.2)
"""Where the cones begin, eastwards along the straight."""
CONE_COUNT = 5
"""A slalom round one cone has a gate of two before it and one behind it."""

DIALOG_AT, DIALOG_SIZE = (120, 110), (900, 600)
"""Pixels: as large as somebody makes a dialog of many fields."""
FIRST_OUTPUT = r"Results:(?:.*\n)+?.*?'?[A-Z]+'?: '?([^\s',]*[/_][^\s',]*)"
"""QGIS 3.22 tells results as Python does, 3.44 each on a line. A file's name has /, a layer's id _ in it."""


def prepare_site(scene: Scene) -> None:
    """Have a map of the site written, and a route found."""
    open_toolbox(scene)
    export_map(scene)
    find_route(scene)
    close_toolbox(scene)


def open_toolbox(scene: Scene) -> None:
    scene.operator.press("Ctrl+Alt+T")
    scene.operator.wait_for_widget("ProcessingToolbox")


def close_toolbox(scene: Scene) -> None:
    """Close the toolbox."""
    operator = scene.operator
    operator.press("Ctrl+Alt+T")
    operator.wait("the toolbox closing", lambda: not operator.widget("ProcessingToolbox")["visible"])


def export_map(scene: Scene) -> None:
    operator = scene.operator
    open_algorithm(scene, "Robot maps", "Export robot map")
    operator.click_beside("Obstacle layers")
    operator.wait_for_widget("mSelectionList")
    operator.click_row("mSelectionList", "Obstacles [EPSG:32633]")
    operator.press("Space")
    operator.click_button("OK")
    operator.fill_in("Centre of the window", in_crs(scene, (60.0, 60.0)))
    scene.film.shoot("export", "what is to be on the robots' map")
    file = run(scene)
    obstacles = len(read_text(file.read_text(encoding="utf-8")).obstacles)
    if not obstacles:
        raise StageError(f"{file} has no obstacle")
    scene.film.happened(f"the map is written, with {obstacles} obstacles")
    close(scene)


def find_route(scene: Scene) -> None:
    operator = scene.operator
    open_algorithm(scene, "Roads", "Route on roads")
    operator.choose_in("Road centrelines", "Road centrelines")
    operator.fill_in("Start", in_crs(scene, CORNER))
    operator.fill_in("Goal", in_crs(scene, FAR_CORNER))
    run(scene)
    close(scene)
    require_layers(scene, {"Route", "Path"})
    scene.film.shoot("route", "the way from r1 to r3 along the roads, as layers")


def lay_out_cones(scene: Scene) -> None:
    operator = scene.operator
    open_toolbox(scene)
    open_algorithm(scene, "Cones", "Cone layout")
    operator.fill_in("Dimensions", "count=1; gate_distance=5")
    operator.fill_in("Place of the layout's origin", in_crs(scene, CONES))
    operator.fill_in("Heading", "90")
    run(scene)
    scene.film.shoot("cone-layout", "a slalom was laid out; the log says how")
    close(scene)
    scene.operator.wait(f"{CONE_COUNT} cones", lambda: scene.operator.counts().get("Cones") == CONE_COUNT)


def open_algorithm(scene: Scene, group: str, title: str) -> None:
    """Search the toolbox for an algorithm and open its dialog."""
    operator = scene.operator
    operator.write("searchBox", title)
    operator.double_click_row("ProcessingToolbox", "Fleet", group, title)
    operator.wait_for_dialog("textShortHelp")
    operator.place_dialog(DIALOG_AT, DIALOG_SIZE)


def run(scene: Scene) -> Path:
    """Press Run, look until the log says that it is done, and return the first output that it names."""
    operator = scene.operator
    operator.click_button("Run")
    operator.wait_for_text("txtLog", r"Algorithm '.*' finished|Execution failed")
    return Path(operator.wait_for_text("txtLog", FIRST_OUTPUT).group(1))


def close(scene: Scene) -> None:
    """Close the algorithm's dialog."""
    scene.operator.click_button("Close")
    scene.operator.wait_for_no_dialog()


def require_layers(scene: Scene, names: set[str]) -> None:
    """Look until the project has layers of these names."""
    scene.operator.wait(f"the layers {sorted(names)}", lambda: names <= set(scene.operator.layers()))


def in_crs(scene: Scene, place: Place) -> str:
    """Return a place of the site as QGIS's fields for points take it."""
    frame = scene.operator.frame
    x, y = frame.to_crs([place])[0].tolist()
    return f"{x:.2f},{y:.2f} [{frame.crs}]"

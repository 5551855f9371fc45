"""What the gateway stored of the robots' ways becomes lines, by Processing."""

from __future__ import annotations

import subprocess
import sys

from tests.support.errors import StageError
from tests.support.fleet import SITE
from tools.walkthrough.scene import Scene
from tools.walkthrough.toolbox import close, close_toolbox, open_algorithm, open_toolbox, require_layers, run


def show_drives(scene: Scene) -> None:
    """Drag what was exported of the gateway onto the map, and make lines of it."""
    load_positions(scene)
    open_toolbox(scene)
    open_algorithm(scene, "Records", "Trajectories")
    run(scene)
    said = scene.operator.wait_for_text("txtLog", r"(\d+) lines of (\d+) positions, ([\d.]+) m in all")
    if float(said.group(3)) < 10.0:
        raise StageError(f"r1 drove to its cones, and the log says: {said.group(0)}")
    close(scene)
    require_layers(scene, {"Trajectories"})
    # Of the dialog's log there is no picture: it names folders of this computer.
    scene.film.shoot("trajectories", "what the robots drove, as lines")
    close_toolbox(scene)


def load_positions(scene: Scene) -> None:
    """Export positions as whoever runs the site does, and drag their layer from the browser panel."""
    operator, file = scene.operator, scene.home / "Documents" / "drives.gpkg"
    command = [sys.executable, "-m", "robot_bridge", "trajectories", "export", file]
    command += ["--site", SITE, "--database", f"sqlite:///{scene.database}"]
    subprocess.run(command, check=True, capture_output=True)
    # The layers make room for the browser.
    operator.press("Ctrl+1")
    operator.press("Ctrl+2")
    operator.wait_for_widget("Browser")
    for depth in range(1, 4):
        operator.open_row("Browser", *("Home", "Documents", file.name)[:depth])
    operator.drag_row_to_map("Browser", "Home", "Documents", file.name, "positions")
    operator.wait("the layer of positions", lambda: any("positions" in name for name in operator.layers()))
    operator.close_panel("Browser")
    operator.press("Ctrl+1")

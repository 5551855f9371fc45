"""The real proving ground: drone photo, lanes, and robots that drive where a car was recorded driving."""

from __future__ import annotations

import csv
import math
import subprocess
import sys

import numpy as np
import pytest
import shapely
from fleet_supervisor.robot_bridge.core.messages.commands import CommandState
from qgis.core import QgsProject

EVERY = 6
"""Every sixth of the recorded poses is clicked: about 15 m apart."""
POINTS = 5
CRS = "EPSG:32633"
ORIGIN = np.array([639988.0, 5193408.4])


@pytest.fixture(scope="module")
def track(data, root, tmp_path_factory):
    """The published site of the track and its project."""
    folder = tmp_path_factory.mktemp("track")
    subprocess.run([sys.executable, "-m", "tools.proving_ground", folder, data], check=True, cwd=root)
    return folder


@pytest.fixture
def recorded(data):
    """(n, 2) metres in EPSG:32633: where the car of the recorded drive was."""
    with (data / "zalazone" / "uni_track_drive_utm33.csv").open(newline="") as file:
        return np.array([(float(row["x_utm33"]), float(row["y_utm33"])) for row in csv.DictReader(file)])


def road_surface():
    """Return the digitised road surfaces of the open project as one polygon, in EPSG:32633."""
    layers = {layer.name(): layer for layer in QgsProject.instance().mapLayers().values()}
    polygons = [bytes(feature.geometry().asWkb()) for feature in layers["Road surfaces"].getFeatures()]
    return shapely.union_all(shapely.make_valid(shapely.from_wkb(polygons)))


def open_project(track, iface):
    project = QgsProject.instance()
    assert project.read(str(track / "proving_ground.qgz"))
    layers = project.mapLayers().values()
    assert {"Drone photo", "Road surfaces", "Road centrelines"} <= {layer.name() for layer in layers}
    assert all(layer.isValid() for layer in layers)
    iface.canvas.setDestinationCrs(project.crs())
    iface.canvas.setLayers([layer for layer in project.layerTreeRoot().layerOrder() if layer.isSpatial()])


def course(a, b):
    return math.atan2(b[1] - a[1], b[0] - a[0])


def test_robots_drive_on_the_real_track_along_the_recorded_drive(
    track, recorded, start_loop, operator, iface, tmp_path
):
    open_project(track, iface)
    loop = start_loop(track)
    clicked = recorded[: EVERY * POINTS : EVERY]
    for name, at, sql in (("cone-1", 0, False), ("cone-2", EVERY * POINTS + 30, True)):
        x, y = recorded[at] - ORIGIN
        loop.start_robot(name, (x, y, course(*recorded[at : at + 2])), sql=sql, speed=5)
    operator.connect_to(loop, ["cone-1", "cone-2"])
    operator.show_map((*clicked.min(axis=0) - 15, *clicked.max(axis=0) + 15), CRS)

    operator.select("cone-1")
    operator.choose("fleet_draw_route")
    for place in clicked[1:]:
        operator.click_map(*place, CRS)
    operator.press("fleet_send")
    seen = watch_drive(operator, "cone-1", tmp_path)

    places = np.array([(x, y) for x, y, _ in seen])
    distance = shapely.distance(road_surface(), shapely.points(places))
    assert len(seen) > 20
    assert (distance == 0).mean() > 0.95, f"{(distance > 0).sum()} of {len(seen)} places off the road"
    assert distance.max() < 1.0
    moving = [(s, a, b) for s, a, b in zip(seen, places, places[3:], strict=False) if math.dist(a, b) > 1.0]
    errors = [abs(math.remainder(s[2] - course(a, b), math.tau)) for s, a, b in moving]
    assert np.median(errors) < 0.15


def watch_drive(operator, robot, tmp_path):
    """Return (x, y, theta) in EPSG:32633 as the desk saw the robot until it was there."""
    seen = []

    def look():
        report = operator.report(robot)
        if report.v > 0.3:
            seen.append((report.x + ORIGIN[0], report.y + ORIGIN[1], report.theta))
        if len(seen) == 200:
            operator.take_picture(operator.canvas, tmp_path / "track.png")
        commands = [c for c in operator.sent_to(robot) if c.op == "SetPath"]
        return bool(commands) and commands[-1].state is CommandState.REACHED

    operator.wait(f"{robot} reaching the end of its route", look, 90)
    return seen

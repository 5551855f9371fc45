"""One canvas with the real track on it, and the desk's live map or a memory layer over it.

Each is called by :mod:`.desk` in a process of its own.
"""

from __future__ import annotations

import dataclasses
import importlib
import json
import os
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
from qgis.core import (
    QgsApplication,
    QgsCoordinateReferenceSystem,
    QgsFeature,
    QgsGeometry,
    QgsPointXY,
    QgsProject,
    QgsRasterLayer,
    QgsRectangle,
    QgsVectorLayer,
)
from qgis.gui import QgsMapCanvas
from qgis.PyQt.QtCore import QEventLoop, QTimer

from benchmarks.clock import Spread, megabytes, spread
from benchmarks.desk_fleet import SPEED, DrivingFleet
from benchmarks.fleet_views import Fleet
from benchmarks.trial import size
from tests.support.processes import dying_with_this
from tools.plugin_files import ROOT, register_plugin

WINDOW = (1280, 800)
CRS = "EPSG:32633"
SECONDS = size(3.0, 1.0)
ROUNDS = size(5, 2)
"""How often the live map is watched for so many seconds."""
FRAME_S, UPDATE_S = 0.05, 0.1
"""seconds between two updates of the memory layer, and between two positions of a robot."""
UPDATES = size(40, 5)
WARM_UP = size(15, 2)
FEW = 10
HOUR, SETTLED = size((3600, 300), (60, 20))
"""seconds of updates, and those after which memory is looked at first."""


class Stage:
    """A canvas as large as WINDOW with orthophoto and lanes, and robots all over what it shows."""

    def __init__(self, data: str, number: int) -> None:
        self.application = QgsApplication([], True)
        self.application.initQgis()
        folder = Path(data) / "zalazone"
        photo = QgsRasterLayer(str(folder / "zalazone_university_track_utm33_35cm.tif"), "photo")
        lanes = QgsVectorLayer(f"{folder / 'zalazone_lanelets_utm33.gpkg'}|layername=lanes", "lanes", "ogr")
        QgsProject.instance().addMapLayers([photo, lanes])
        self.canvas = QgsMapCanvas()
        self.canvas.resize(*WINDOW)
        self.canvas.setCachingEnabled(True)
        self.canvas.setDestinationCrs(QgsCoordinateReferenceSystem(CRS))
        self.layers = [lanes, photo]
        self.canvas.setLayers(self.layers)
        self.canvas.show()
        shown = photo.extent()
        self.origin = (round(shown.xMinimum()), round(shown.yMinimum()))
        self.canvas.setExtent(QgsRectangle(shown))
        self.run(0.1)
        seen = self.canvas.extent()
        corner = seen.xMinimum() - self.origin[0], seen.yMinimum() - self.origin[1]
        self.area = (*corner, seen.width(), seen.height())
        self.fleet = DrivingFleet(number, self.area)
        self.wait(lambda: not self.canvas.isDrawing())

    def run(self, seconds: float, between: Callable[[], None] = lambda: None) -> None:
        """Let Qt work."""
        end = time.perf_counter() + seconds
        wake = QTimer()
        wake.start(5)
        while time.perf_counter() < end:
            self.application.processEvents(QEventLoop.ProcessEventsFlag.WaitForMoreEvents)
            between()

    def wait(self, true: Callable[[], bool]) -> None:
        """Let Qt work until ``true()``."""
        while not true():
            self.run(0.05)

    def end(self, result: Any) -> None:
        """Print the result and end at once: there is nothing to be kept."""
        print(json.dumps(result), flush=True)
        self.canvas.stopRendering()
        os._exit(0)


def overlay(data: str, number: int) -> None:
    """Print the window's thread's milliseconds of computing for an update, and of its parts, as medians.

    They are of the thread's own clock, and the desk's clock goes on by a tenth of a second an update: neither
    knows of what else the machine does.
    """
    stage = Stage(data, number)
    now = [1000.0]
    desk, view, _ = open_desk(stage, SimpleNamespace(steady=lambda: now[0]))
    wire = importlib.import_module("fleet_supervisor.plugin.gateway_client.robot_states")
    state = importlib.import_module("fleet_supervisor.plugin.gateway_client.fleet_state")
    # As the thread of the connection hands them over.
    buffer = state.UpdateBuffer()
    desk.state.robots.merge(wire.table_from_rows(stage.fleet.reports(), now[0]))
    # To add a robot takes twice as long as to write it again, and is done once: it is not part of an update.
    while len(view.layer) < number:
        view.layer.begin(number)
        view.layer.go_on(desk.state.robots, now[0])
    times = []
    for _ in range(WARM_UP + UPDATES):
        now[0] += UPDATE_S
        stage.fleet.drive(UPDATE_S)
        buffer.add(robots=wire.table_from_rows(stage.fleet.reports(), now[0]))
        marks = [time.thread_time()]
        for step in (
            lambda: desk.state.robots.merge(buffer.collect().robots),
            view.show_now,
            stage.canvas.viewport().repaint,
            lambda: view.layer.go_on(desk.state.robots, now[0]),
        ):
            step()
            marks.append(time.thread_time())
        view.layer.begin(len(desk.state.robots))
        times.append(np.diff(marks) * 1e3)
    parts = np.array(times)[WARM_UP:]
    total = parts.sum(axis=1)
    taken_in, prepared, painted, written = (spread(column) for column in parts.T.tolist())
    view.overlay.hide()
    stage.end(
        {
            "ms": spread(total.tolist()),
            "p99": float(np.percentile(total, 99)),
            "parts": {
                "taken in": taken_in,
                "prepared": prepared,
                "painted": painted,
                "of it the map": _repainting(stage),
                "layer": written,
            },
        }
    )


def density(data: str, number: int) -> None:
    """Print the window's thread's milliseconds of computing for an update of a density.

    ``number`` robots are on a square as wide as the canvas: printed is also how many are on the canvas.
    """
    stage = Stage(data, FEW)
    now = [1000.0]
    desk, view, _ = open_desk(stage, SimpleNamespace(steady=lambda: now[0]))
    wire = importlib.import_module("fleet_supervisor.plugin.gateway_client.robot_states")
    state = importlib.import_module("fleet_supervisor.plugin.gateway_client.fleet_state")
    fleet = Fleet(number, max(stage.area[2:]), SPEED * UPDATE_S)
    x, y, width, height = stage.area
    watch = fleet.watch((x, y, x + width, y + height))
    times = []
    for _ in range(WARM_UP + UPDATES):
        now[0] += UPDATE_S
        fleet.move()
        fleet.look_up()
        frame = watch.next_frame()
        began = time.thread_time()
        desk.state.merge(state.StateUpdate(desk.state.link, robots=wire.table_from_frame(frame, now[0])))
        view.show_now()
        stage.canvas.viewport().repaint()
        times.append((time.thread_time() - began) * 1e3)
    shown = desk.state.robots.fleet
    assert shown.density is not None, "a density is shown"
    stage.end({"ms": spread(times[WARM_UP:]), "inside": shown.inside, "megabytes": megabytes()})


def _repainting(stage: Stage) -> Spread:
    """Return the milliseconds that painting the canvas takes after other work."""
    times = []
    for _ in range(UPDATES):
        stage.fleet.reports()
        began = time.thread_time()
        stage.canvas.viewport().repaint()
        times.append((time.thread_time() - began) * 1e3)
    return spread(times)


def layer(data: str, number: int) -> None:
    """Print what the same costs as a memory layer, repainted for each update."""
    stage = Stage(data, number)
    made = QgsVectorLayer(f"Point?crs={CRS}&field=robot:string", "robots", "memory")
    features = []
    for point in stage.fleet.xy + stage.origin:
        feature = QgsFeature(made.fields())
        feature.setGeometry(QgsGeometry.fromPointXY(QgsPointXY(*point)))
        features.append(feature)
    _, stored = made.dataProvider().addFeatures(features)
    ids = [feature.id() for feature in stored]
    QgsProject.instance().addMapLayer(made)
    stage.canvas.setLayers([made, *stage.layers])
    stage.wait(lambda: not stage.canvas.isDrawing())
    times, finished = [], []
    stage.canvas.renderComplete.connect(lambda _: finished.append(time.perf_counter()))

    def update() -> None:
        stage.fleet.drive(UPDATE_S)
        places = (stage.fleet.xy + stage.origin).tolist()
        began = time.thread_time()
        moved = {k: QgsGeometry.fromPointXY(QgsPointXY(x, y)) for k, (x, y) in zip(ids, places, strict=True)}
        made.dataProvider().changeGeometryValues(moved)
        made.triggerRepaint()
        times.append((time.thread_time() - began) * 1e3)

    timer = QTimer()
    timer.timeout.connect(update)
    timer.start(round(FRAME_S * 1000))
    frames = []
    for _ in range(ROUNDS):
        before = len(finished)
        stage.run(SECONDS)
        frames.append((len(finished) - before) / SECONDS)
    timer.stop()
    stage.end({"ms": spread(times), "frames": spread(frames)})


def live(data: str, number: int, rate: float = 10.0) -> None:
    """Print frames a second, what one takes, and the milliseconds from sending to painting."""
    stage = Stage(data, number)
    watch_live(stage, open_desk(stage), number, rate)


def watch_live(stage: Stage, opened: tuple[Any, Any, Any], number: int, rate: float) -> None:
    """Print the same of what was ``opened``: a desk, its live view, and the site."""
    desk, view, site = opened
    told = json.dumps(dataclasses.asdict(site))
    given = [told, *map(str, (number, rate, *stage.area))]
    command = [sys.executable, "-m", "benchmarks.desk_feed", *given]
    feed = subprocess.Popen(dying_with_this(command), stdout=subprocess.PIPE, text=True, cwd=ROOT)
    try:
        desk.open_link(f"ws://127.0.0.1:{feed.stdout.readline().strip()}/desk", "bench")
        stage.wait(lambda: len(desk.state.robots) == number)
        stage.run(3.0)
        delays, seen = [], [view.overlay.frames, view.shown]

        def look() -> None:
            if view.overlay.frames != seen[0] and view.shown != seen[1]:
                seen[:] = view.overlay.frames, view.shown
                newest = desk.state.robots.view("robot-0", 0.0)
                delays.append((time.monotonic() - newest.values["device_time"]) * 1e3)

        rounds: list[tuple[float, float, float]] = []
        for _ in range(ROUNDS):
            before, known, began = view.overlay.frames, len(delays), time.thread_time()
            stage.run(SECONDS, look)
            busy, painted = time.thread_time() - began, view.overlay.frames - before
            rounds.append((painted / SECONDS, (len(delays) - known) / SECONDS, busy / max(painted, 1) * 1e3))
    finally:
        feed.kill()
        feed.wait()
    rates = dict(zip(("frames", "new", "computing"), map(spread, zip(*rounds, strict=True)), strict=True))
    stage.end({**rates, "p50": spread(delays), "p99": float(np.percentile(delays, 99))})


def hour(data: str, number: int) -> None:
    """Print the memory in MB before and after an hour of updates, one a second by the desk's clock."""
    stage = Stage(data, number)
    now = [1000.0]
    desk, view, _ = open_desk(stage, SimpleNamespace(steady=lambda: now[0]))
    wire = importlib.import_module("fleet_supervisor.plugin.gateway_client.robot_states")
    memory = []
    for second in range(HOUR):
        now[0] += 1.0
        stage.fleet.drive(1.0)
        desk.state.robots.merge(wire.table_from_rows(stage.fleet.reports(), now[0]))
        view.show_now()
        stage.canvas.viewport().repaint()
        view.layer.begin(len(desk.state.robots))
        view.layer.go_on(desk.state.robots, now[0])
        if second % 20 == 0:
            stage.application.processEvents()
        if second in (SETTLED, HOUR - 1):
            # A map being rendered has several images as large as the canvas.
            stage.wait(lambda: not stage.canvas.isDrawing())
            memory.append(megabytes())
    stage.end(memory)


def open_desk(stage: Stage, clock: Any = None) -> tuple[Any, Any, Any]:
    """Return a desk that knows its site, its live view, and the site."""
    register_plugin()
    from fleet_supervisor.plugin.control.fleet_controller import FleetController
    from fleet_supervisor.plugin.map.live_view import LiveView

    site = site_of(stage)
    desk = FleetController(stage.canvas, QgsProject.instance(), clock=clock)
    view = LiveView(desk)
    desk.state.merge_site(site, "")
    stage.canvas.setLayers([view.layer.layer, *stage.layers])
    stage.run(0.2)
    stage.wait(lambda: not stage.canvas.isDrawing())
    return desk, view, site


def site_of(stage: Stage) -> Any:
    """Return the site that a gateway would tell of: what the canvas shows."""
    from fleet_supervisor.robot_bridge.core.messages.administration import SiteReport

    x, y, width, height = stage.area
    bounds = (x, y, x + width, y + height)
    return SiteReport("track", "Track", 1, CRS, stage.origin, 0.0, bounds, 0.2, 3.0, 10.0)

"""One canvas with the real track on it, and the desk's live map or a memory layer over it.

Each is called by :mod:`.desk` in a process of its own.
"""

from __future__ import annotations

import dataclasses
import importlib.util
import json
import os
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
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
from stage.processes import dying_with_this

from .clock import megabytes
from .desk_fleet import DrivingFleet

ROOT = Path(__file__).parents[2]
WINDOW = (1280, 800)
CRS = "EPSG:32633"
SECONDS = 6.0
UPDATES = 40
WARM_UP = 15


class Stage:
    """A canvas of 1280 × 800 with orthophoto and lanes, and robots all over what it shows."""

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
    desk, view, _ = open_desk(stage, lambda: now[0])
    wire = importlib.import_module("fleet_supervisor.plugin.wire.position_rows")
    times = []
    for _ in range(WARM_UP + UPDATES):
        now[0] += 0.1
        stage.fleet.drive(0.1)
        told = wire.sightings(stage.fleet.told(), now[0])
        marks = [time.thread_time()]
        for step in (
            lambda told=told: desk.picture.merge(told),
            view.show_now,
            stage.canvas.viewport().repaint,
            lambda: view.layer.go_on(desk.picture, now[0]),
        ):
            step()
            marks.append(time.thread_time())
        view.layer.begin(len(desk.picture))
        times.append(np.diff(marks) * 1e3)
    parts = np.array(times)[WARM_UP:]
    total = parts.sum(axis=1)
    taken_in, prepared, painted, written = np.median(parts, axis=0).tolist()
    view.overlay.hide()
    stage.end(
        {
            "ms": float(np.median(total)),
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


def _repainting(stage: Stage) -> float:
    """Return the median of the milliseconds that painting the canvas takes after other work."""
    times = []
    for _ in range(UPDATES):
        stage.fleet.told()
        began = time.thread_time()
        stage.canvas.viewport().repaint()
        times.append((time.thread_time() - began) * 1e3)
    return float(np.median(times))


def layer(data: str, number: int) -> None:
    """Print what the same costs as a memory layer, repainted for each update twenty times a second."""
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
        stage.fleet.drive(0.1)
        places = (stage.fleet.xy + stage.origin).tolist()
        began = time.thread_time()
        moved = {k: QgsGeometry.fromPointXY(QgsPointXY(x, y)) for k, (x, y) in zip(ids, places, strict=True)}
        made.dataProvider().changeGeometryValues(moved)
        made.triggerRepaint()
        times.append((time.thread_time() - began) * 1e3)

    timer = QTimer()
    timer.timeout.connect(update)
    timer.start(50)
    stage.run(SECONDS)
    timer.stop()
    stage.end({"ms": float(np.median(times)), "updates": len(times), "frames": len(finished) / SECONDS})


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
    feed = subprocess.Popen(dying_with_this(command), stdout=subprocess.PIPE, text=True, cwd=ROOT / "scripts")
    try:
        desk.open_link(f"ws://127.0.0.1:{feed.stdout.readline().strip()}/desk", "bench")
        stage.wait(lambda: len(desk.picture) == number)
        stage.run(3.0)
        delays, seen = [], [view.overlay.frames, view.shown]

        def look() -> None:
            if view.overlay.frames != seen[0] and view.shown != seen[1]:
                seen[:] = view.overlay.frames, view.shown
                newest = desk.picture.view("robot-0", 0.0)
                delays.append((time.monotonic() - newest.told["device_time"]) * 1e3)

        before, began = view.overlay.frames, time.thread_time()
        stage.run(SECONDS, look)
        busy, painted = time.thread_time() - began, view.overlay.frames - before
    finally:
        feed.kill()
        feed.wait()
    p50, p99 = np.percentile(delays, (50, 99)).tolist()
    rates = {"frames": painted / SECONDS, "new": len(delays) / SECONDS, "computing": busy / painted * 1e3}
    stage.end({**rates, "p50": p50, "p99": p99})


def hour(data: str, number: int) -> None:
    """Print the memory in MB before and after an hour of updates, one a second by the desk's clock."""
    stage = Stage(data, number)
    now = [1000.0]
    desk, view, _ = open_desk(stage, lambda: now[0])
    wire = importlib.import_module("fleet_supervisor.plugin.wire.position_rows")
    memory = []
    for second in range(3600):
        now[0] += 1.0
        stage.fleet.drive(1.0)
        desk.picture.merge(wire.sightings(stage.fleet.told(), now[0]))
        view.show_now()
        stage.canvas.viewport().repaint()
        view.layer.begin(len(desk.picture))
        view.layer.go_on(desk.picture, now[0])
        if second % 20 == 0:
            stage.application.processEvents()
        if second in (300, 3599):
            memory.append(megabytes())
    stage.end(memory)


def open_desk(stage: Stage, clock: Callable[[], float] = time.monotonic) -> tuple[Any, Any, Any]:
    """Return a desk that knows its site, its live view, and the site."""
    register()
    from fleet_supervisor.plugin.desk.desk import Desk
    from fleet_supervisor.plugin.desk.live.live_view import LiveView

    site = site_of(stage)
    desk = Desk(stage.canvas, QgsProject.instance(), clock=clock)
    view = LiveView(desk)
    desk._take_site(site, is_greeting=True)
    stage.canvas.setLayers([view.layer.layer, *stage.layers])
    stage.run(0.2)
    stage.wait(lambda: not stage.canvas.isDrawing())
    return desk, view, site


def site_of(stage: Stage) -> Any:
    """Return the site that a gateway would tell of: what the canvas shows."""
    from fleet_supervisor.robot_bridge.messages import SiteReport

    x, y, width, height = stage.area
    bounds = (x, y, x + width, y + height)
    return SiteReport("track", "Track", 1, CRS, stage.origin, 0.0, bounds, 0.2, 3.0, 10.0)


def register() -> None:
    """Make the repository's root importable under the name that QGIS gives it."""
    name = "fleet_supervisor"
    spec = importlib.util.spec_from_file_location(
        name, ROOT / "__init__.py", submodule_search_locations=[str(ROOT)]
    )
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    spec.loader.exec_module(module)

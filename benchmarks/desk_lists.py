"""The desk's lists with the robots of the live map: the robot table and the alarms.

Called by :mod:`.desk` in a process of its own.
"""

from __future__ import annotations

import importlib
import time
from collections.abc import Callable

from benchmarks.clock import spread
from benchmarks.desk_canvas import Stage, open_desk
from benchmarks.trial import size

UPDATES = size(30, 4)
SEARCH = "robot-7 fresh"


def lists(data: str, number: int) -> None:
    """Print milliseconds on the window's thread of what the lists do when the robots have moved."""
    stage = Stage(data, number)
    desk, _, _ = open_desk(stage)
    panel = "fleet_supervisor.plugin.panel"
    wire = importlib.import_module("fleet_supervisor.plugin.gateway_client.robot_states")
    table = importlib.import_module(f"{panel}.robot_table").RobotTableView(desk)
    columns = importlib.import_module(f"{panel}.robot_model")
    alarms = importlib.import_module(f"{panel}.alarms.board").AlarmBoard()
    ground = importlib.import_module(f"{panel}.alarms.watch").RoadGround
    surfaces = importlib.import_module("fleet_supervisor.plugin.layers.road_surfaces").SurfaceStore
    situations = importlib.import_module(f"{panel}.alarms.watch").SnapshotBuilder
    looking = situations(desk.state, desk.site_to_canvas, ground(surfaces(desk.project)))

    def look() -> None:
        now = time.monotonic()
        alarms.evaluate(looking.at(now, alarms.limits), now, time.time())

    def search() -> None:
        table.robots.text = SEARCH
        table.refresh()
        table.robots.text = ""

    def sort_by(title: str) -> Callable[[], None]:
        def sort() -> None:
            table.robots.sort(columns.TITLES.index(title))

        return sort

    table.resize(560, 400)
    table.show()
    steps = {
        "table renewed": table.refresh,
        "sorted by task": sort_by("Task"),
        "sorted by age": sort_by("Age"),
        "searched": search,
        "alarms": look,
    }
    times: dict[str, list[float]] = {name: [] for name in steps}
    for _ in range(UPDATES):
        stage.fleet.drive(0.5)
        desk.state.robots.merge(wire.table_from_rows(stage.fleet.reports(), time.monotonic()))
        for name, step in steps.items():
            began = time.thread_time()
            step()
            times[name].append((time.thread_time() - began) * 1e3)
        table.refresh()
        stage.application.processEvents()
    stage.end({name: spread(taken) for name, taken in times.items()})

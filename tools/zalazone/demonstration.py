"""The steps of `make demo PARTS=zalazone`, in the order of the paper on map services and ROS 2 robots.

Each is done and then told in words, with what was measured; the first that does not happen ends it.
"""

from __future__ import annotations

import math
import os
import shutil
import subprocess
import sys
from dataclasses import asdict
from pathlib import Path

import numpy as np

from robot_bridge.core.sites.site import read_site
from tests.support.errors import StageError
from tests.support.fleet import start_gateway
from tests.support.operators import ask, open_desk
from tests.support.picture import reduce_colours
from tests.support.processes import Processes
from tests.support.qgis import virtual_screen
from tests.support.session import play
from tests.support.wire import RefusedError
from tools.demonstration_steps import DemonstrationSteps
from tools.plugin_files import ROOT
from tools.zalazone.links import Links, peer
from tools.zalazone.places import AWAY, CONE, GOAL, GRASS, ROAD_CLASS, START, same_ground, spellings
from tools.zalazone.recording import Sample, compare, read_recording

FOLDER = Path(os.environ.get("FLEET_ZALAZONE_FOLDER") or ROOT / "build" / "zalazone")
DATA = Path(os.environ.get("FLEET_DATA") or ROOT.parent / "shared" / "data")
RECORDING = "trajectories/openacc_zalazone_part17_6veh_10hz.csv.gz"
NEEDED = (
    "zalazone/university_track_centrelines.geojson",
    "zalazone/university_track_surfaces_derived_utm33.gpkg",
    "zalazone/zalazone_university_track_utm33_35cm.tif",
    RECORDING,
)
WINDOW = (1600, 1000)
TRACK = (44.0, 110.0, 290.0, 306.0)
"""What the map shows, in the site frame: the university track."""
CARS_EXTENT = (240.0, 1560.0, 640.0, 1920.0)
"""What the second map shows: the platform on which the cars were recorded."""
CARS = {str(number): f"car-{number}" for number in range(1, 7)}
FIRST, SECOND = "carrier_1", "carrier_2"
SPEEDS = {FIRST: 12.0, SECOND: 14.0}
"""m/s."""
CONES = 6
"""Typed in three reference systems, and clicked on maps in the same three."""
WATCHED_S = 6.0
LOOKS = 5
"""On a machine that is busy otherwise an operator is told less at times."""
RECORDED_HZ, WATCH_HZ = 10.0, 20.0
LEAST_RATE = 9.0
LARGEST_ERROR_M = 0.05
QGIS_TIMEOUT = 600.0


class ZalaZone:
    """Does one step after the other, and tells of each when it has happened."""

    def __init__(self, processes: Processes):
        self._processes = processes
        self._steps = DemonstrationSteps(FOLDER, processes)

    def run(self) -> None:
        """Do everything.

        :raises StageError: at the first step that does not happen.
        """
        check_data()
        python = peer()
        self._publish()
        self._address = start_gateway(self._processes, FOLDER / "fleet.db", FOLDER / "site")
        self._steps.happened(f"the gateway serves it at {self._address}")
        self._links = Links(self._processes, python, FOLDER / "links", self._address, self._site.settings)
        self._replay()
        self._robots()
        self._questions()
        self._desk()
        self._cones()
        self._route()

    def _publish(self) -> None:
        done = subprocess.run(
            [sys.executable, "-m", "tools.proving_ground", FOLDER / "site", DATA, DATA / RECORDING],
            cwd=ROOT,
            capture_output=True,
            text=True,
            check=False,
        )
        if done.returncode:
            raise StageError(f"the site could not be made; it said:\n{done.stderr[-1500:]}")
        self._site = read_site(FOLDER / "site")
        roads = self._site.centrelines
        length = sum(float(np.hypot(*np.diff(road.points, axis=0).T).sum()) for road in roads)
        box = self._site.bounds
        self._steps.happened(
            f"published {self._site.name!r}: {len(roads)} road centrelines ({length / 1000:.1f} km), "
            f"{len(self._site.surfaces)} road surfaces, {box.x_max - box.x_min:.0f} × "
            f"{box.y_max - box.y_min:.0f} m, with the drone's orthophoto of the university track"
        )

    def _replay(self) -> None:
        self._links.start_replay(DATA / RECORDING, CARS)
        names = [f"replay-{name}" for name in CARS.values()]
        self._steps.wait("the six recorded cars", lambda: self._fresh(names))
        recorded = read_recording(DATA / RECORDING, 200.0)
        for _ in range(LOOKS):
            told = self._watched(WATCHED_S)
            found = compare(recorded, {car: told.get(f"replay-{name}", []) for car, name in CARS.items()})
            if found.rate >= LEAST_RATE:
                break
        if found.rate < LEAST_RATE or found.furthest > LARGEST_ERROR_M:
            raise StageError(
                f"the cars are told {found.rate:.1f} times a second, up to {found.furthest:.2f} m beside the "
                f"recording; right is {RECORDED_HZ:g}, and {LARGEST_ERROR_M} m"
            )
        self._steps.happened(
            f"six recorded cars drive on the dynamic platform, replayed at {found.rate:.1f} Hz (recorded at "
            f"{RECORDED_HZ:g}): {found.samples} places, each within {found.furthest * 1000:.1f} mm of the "
            f"recorded line, 95 % within {found.jitter * 1000:.0f} ms of their time"
        )
        self._steps.happened(
            f"they are marked as replay and cannot be commanded: {self._refusal(names[0])!r}"
        )

    def _robots(self) -> None:
        self._links.start_robot(FIRST, AWAY, SPEEDS[FIRST])
        self._links.start_robot(SECOND, START, SPEEDS[SECOND])
        self._links.start_ros()
        self._steps.wait("the two ROS 2 robots", lambda: self._fresh([FIRST, SECOND]))
        self._steps.happened(
            f"two ROS 2 robots, rclpy nodes with Nav2's actions, were found on their network: "
            f"{FIRST}, {SECOND}"
        )

    def _questions(self) -> None:
        """Ask what the paper says that robots ask: the surface at a place, the shortest route."""
        self._spelled = spellings(self._site.frame, CONE)
        for place in self._spelled:
            (asked,) = ask(self._address, ("get_surface", {"points": [[place.x, place.y]], "crs": place.crs}))
            (surface,) = asked["surfaces"]
            if surface is None or surface["surface"] != ROAD_CLASS:
                raise StageError(f"at {place.text} ({place.crs}) the gateway knows {surface}, not asphalt")
        (grass,) = ask(self._address, ("get_surface", {"points": [list(GRASS)]}))
        if grass["surfaces"] != [None]:
            raise StageError(f"on the grass at {GRASS} the gateway knows {grass['surfaces']}")
        asked_in = ", ".join(f"{place.text} ({place.called})" for place in self._spelled)
        self._steps.happened(
            f"which surface is there? asphalt at {asked_in}; no road on the grass beside the course"
        )
        (way,) = ask(self._address, ("get_route", {"start": list(START), "x": GOAL[0], "y": GOAL[1]}))
        self._check_way(way)

    def _check_way(self, way: dict) -> None:
        points = np.array(way["points"])
        length = float(np.hypot(*np.diff(points, axis=0).T).sum())
        if way["note"] or abs(length - way["metres"]) > 1.0 or length < math.dist(START, GOAL):
            raise StageError(
                f"the way is told as {way['metres']} m and is {length:.1f} m long; {way['note']}"
            )
        between = np.concatenate([points[1:], (points[1:] + points[:-1]) / 2])
        (asked,) = ask(self._address, ("get_surface", {"points": between.tolist()}))
        on_road = sum(surface is not None for surface in asked["surfaces"]) / len(between)
        if on_road < 0.95:
            raise StageError(f"only {on_road:.0%} of the way lies on a road surface")
        self._metres = way["metres"]
        ground = ", ".join(f"{part['metres']:.0f} m {part['surface']}" for part in way["surfaces"])
        self._steps.happened(
            f"the shortest route across the course: {way['metres']:.0f} m along the roads ({ground}), "
            f"{math.dist(START, GOAL):.0f} m as the crow flies; {on_road:.0%} of it on a road surface"
        )

    def _desk(self) -> None:
        plan = self._plan()
        display, session = virtual_screen(self._processes, *WINDOW), "zalazone_session.py"
        for entry in play(self._processes, FOLDER, session, plan, QGIS_TIMEOUT, display=display):
            self._steps.happened(entry["text"])
        reduce_colours(Path(str(plan["picture"])))

    def _plan(self) -> dict[str, object]:
        frame = self._site.frame

        def corners(box: tuple[float, float, float, float]) -> list[float]:
            return frame.to_crs(np.array([box[:2], box[2:]])).ravel().tolist()

        def place(point: tuple[float, float]) -> list[float]:
            return frame.to_crs(np.array([point]))[0].tolist()

        return {
            "project": str(FOLDER / "site" / "proving_ground.qgz"),
            "gateway": self._address,
            "window": WINDOW,
            "crs": frame.crs,
            "track": corners(TRACK),
            "platform": corners(CARS_EXTENT),
            "first": FIRST,
            "second": SECOND,
            "robots": [FIRST, SECOND, *(f"replay-{name}" for name in CARS.values())],
            "cones": [asdict(spelling) for spelling in self._spelled],
            "surface_at": place(CONE),
            "away": place(AWAY),
            "goal": place(GOAL),
            "picture": str(FOLDER / "window.png"),
        }

    def _cones(self) -> None:
        """Hold what the gateway sent and what the robot itself says against the one point on the ground."""
        (commands,) = ask(self._address, ("get_commands", {}))
        cones = [c for c in commands["commands"] if c["robot"] == FIRST and c["params"].get("cone")]
        cones = [c for c in cones if math.dist(_end_of(c), CONE) < 1.0]
        states = [c["state"] for c in cones]
        if states != ["reached"] * CONES:
            raise StageError(f"{CONES} cones were sent to one place; the gateway says {states or 'of none'}")
        sent = [_end_of(c) for c in cones]
        placed = [(cone["x"], cone["y"]) for cone in self._links.said(FIRST, "cone")]
        placed = [place for place in placed if math.dist(place, CONE) < 1.0]
        apart, stood, off = same_ground(sent, placed, CONE, CONES)
        self._steps.happened(
            f"the {CONES} cones stand on one point: targets {apart * 1000:.0f} mm apart, placed by the "
            f"robot's own word {stood * 1000:.0f} mm apart and {off * 1000:.0f} mm from the point at most"
        )

    def _route(self) -> None:
        commands, positions = ask(self._address, ("get_commands", {}), ("get_positions", {}))
        (route,) = [c for c in commands["commands"] if c["robot"] == SECOND and c["op"] == "SetPath"]
        (robot,) = [r for r in positions["robots"] if r["robot"] == SECOND]
        off = math.dist((robot["x"], robot["y"]), _end_of(route))
        (goal,) = self._links.said(SECOND, "goal")
        if route["state"] != "reached" or off > self._site.settings.reached_tolerance_m:
            raise StageError(f"{SECOND}'s route is {route['state']}; it stands {off:.2f} m from its end")
        self._steps.happened(
            f"{SECOND} drove the route by Nav2's {goal['kind']}, {len(goal['points'])} points, and stands "
            f"{off:.2f} m from its end"
        )

    def _refusal(self, robot: str) -> str:
        x, y = CONE
        try:
            with open_desk(self._address) as desk:
                desk.send("demo-refused-0001", robot, "SetPosEnd", x=x, y=y)
        except RefusedError as error:
            if "only seen" in str(error):
                return str(error)
            raise
        raise StageError(f"{robot} is a recording, and the gateway took a command for it")

    def _fresh(self, names: list[str]) -> bool:
        (told,) = ask(self._address, ("get_positions", {}))
        fresh = {r["robot"] for r in told["robots"] if r["state"] == "fresh" and r.get("x") is not None}
        return fresh >= set(names)

    def _watched(self, seconds: float) -> dict[str, list[Sample]]:
        """Return each robot's places, those that are told twice once."""
        east, north = self._site.settings.origin
        seen: dict[str, list[Sample]] = {}
        with open_desk(self._address) as desk:
            desk.ask("subscribe", {"rate": WATCH_HZ})
            desk.listen(seconds)
        for snapshot in desk.snapshots:
            for robot in snapshot["robots"]:
                if robot.get("x") is None:
                    continue
                at = snapshot["t"] - robot["pose_age"]
                sample = Sample(at, robot["x"] + east, robot["y"] + north)
                places = seen.setdefault(robot["robot"], [])
                if not places or (places[-1].x, places[-1].y) != (sample.x, sample.y):
                    places.append(sample)
        return seen


def check_data() -> None:
    """Raise StageError when the real data is not beside the project."""
    missing = [name for name in NEEDED if not (DATA / name).is_file()]
    if missing:
        raise StageError(
            f"the real data is not there: {DATA} has no {', '.join(missing)}. It is never copied into the "
            "project; put it there, or name its folder in FLEET_DATA."
        )


def run() -> None:
    """Do it all, and leave what it made in ``FOLDER``."""
    shutil.rmtree(FOLDER, ignore_errors=True)
    FOLDER.mkdir(parents=True)
    with Processes(FOLDER / "logs") as processes:
        ZalaZone(processes).run()
    print(f"see {FOLDER}: window.png, steps.txt, site/proving_ground.qgz")


def _end_of(command: dict) -> tuple[float, float]:
    params = command["params"]
    x, y = params["points"][-1] if command["op"] == "SetPath" else (params["x"], params["y"])
    return float(x), float(y)

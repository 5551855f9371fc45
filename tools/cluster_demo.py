"""`make demo PARTS=cluster`: four gateways serve one fleet, and a desk in QGIS sees that one of them dies.

PostgreSQL, a NATS cluster of three, four gateways, eight robots that were each given the address of one, and
a QGIS on a virtual screen; all on this computer, on loopback and free ports. A server of the bus is killed,
then a gateway, then that of the desk, then an operator makes an emergency stop. It leaves build/cluster/.
"""

from __future__ import annotations

import os
import shutil
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import numpy as np

from robot_bridge.core.sites.site import read_site
from robot_bridge.gateway.storage import revisions
from robot_bridge.gateway.storage.database import run_once
from tests.support.databases.postgresql import PostgreSql
from tests.support.errors import StageError
from tests.support.fleet import PROJECT, SITE, Served, Start, serve, start_robots
from tests.support.nats_server import NatsCluster
from tests.support.operators import open_desk
from tests.support.picture import reduce_colours
from tests.support.processes import Processes
from tests.support.qgis import virtual_screen
from tests.support.robots.robot_wires import RobotWire
from tests.support.session import play
from tools.demonstration_steps import DemonstrationSteps
from tools.plugin_files import ROOT

FOLDER = Path(os.environ.get("FLEET_CLUSTER_FOLDER") or ROOT / "build" / "cluster")
WINDOW = (1600, 900)
EXTENT = (0.0, 0.0, 200.0, 160.0)
"""What the map shows, metres in the site frame: the whole site."""
DESK, SENDER, DOOMED = "north", "west", "south"
"""The gateways of the desk in QGIS, of the program that sends robots, and the one that is killed first."""
FIRST_KILLED = "nats-1"
PLACES: dict[str, tuple[tuple[str, tuple[float, float, float], tuple[float, float]], ...]] = {
    DESK: (("r1", (20.0, 8.0, 0.0), (118.0, 8.0)), ("r2", (6.0, 44.0, -1.2), (92.0, 22.0))),
    "east": (("r3", (42.0, 44.0, 0.0), (124.0, 44.0)), ("r4", (14.0, 101.0, 0.0), (66.0, 119.0))),
    DOOMED: (("r5", (124.0, 50.0, 2.0), (8.0, 50.0)), ("r6", (10.0, 84.0, 0.0), (136.0, 84.0))),
    SENDER: (("r7", (190.0, 84.0, 3.14), (126.0, 119.5)), ("r8", (64.0, 121.0, 3.14), (12.0, 103.0))),
}
"""Of each gateway's robots the name, the pose at first and the target, metres and radians."""
SENT = "r5"
"""The robot that the operator sends by a click."""
SPEED = 1.5
STANDING = 0.05
"""m/s."""
QGIS_TIMEOUT = 300.0


class ClusterDemonstration:
    """Does one step after the other, and tells of each when it has happened."""

    def __init__(self, processes: Processes, database: str, nats: NatsCluster) -> None:
        self._processes = processes
        self._database = database
        self._nats = nats
        self._site = read_site(SITE)
        self._gateways: dict[str, Served] = {}
        self._steps = DemonstrationSteps(FOLDER, processes)

    def run(self) -> None:
        """Do everything.

        :raises StageError: at the first step that does not happen.
        """
        self._steps.happened(f"PostgreSQL and a NATS cluster of {len(self._nats.servers)} servers run")
        for name in PLACES:
            self._serve(name)
        self._steps.wait("each gateway telling robots of all", self._all_are_told)
        listed = ", ".join(f"{name} at {one.address}" for name, one in self._gateways.items())
        self._steps.happened(f"{len(PLACES)} gateways serve {self._site.name!r} together: {listed}")
        for name, robots in PLACES.items():
            starts = [Start(robot, pose) for robot, pose, _ in robots]
            start_robots(self._processes, self._gateways[name].address, Path(), SPEED, starts)
        self._steps.happened("two robots connect to each; every robot was given the address of one gateway")
        display, session = virtual_screen(self._processes, *WINDOW), "cluster_session.py"
        entries = play(
            self._processes,
            FOLDER,
            session,
            self._plan(),
            QGIS_TIMEOUT,
            display=display,
            killed=[f"gateway-{DOOMED}", f"gateway-{DESK}"],
        )
        for entry in entries:
            self._steps.happened(entry["text"])
            self._follow(entry["step"])
        for picture in FOLDER.glob("*.png"):
            reduce_colours(picture)
        self._judge()

    def _serve(self, name: str) -> None:
        state = FOLDER / "state" / name
        state.mkdir(parents=True)
        options: list[Any] = ["--state", state, "--gateway-name", name, "--bus", self._nats.url]
        self._gateways[name] = serve(
            self._processes, SITE, self._database, *options, name=f"gateway-{name}", forked=True
        )

    def _all_are_told(self) -> bool:
        return all(len(_told_gateways(one.address)) == len(PLACES) for one in self._gateways.values())

    def _follow(self, step: str) -> None:
        """Do what has its time when the session in QGIS has come so far."""
        if step == "robots":
            self._send()
        elif step == "driving":
            self._nats.servers[FIRST_KILLED].kill()
            self._steps.happened(f"{FIRST_KILLED} is killed (SIGKILL)")
        elif step == "bus":
            self._kill(DOOMED)
        elif step == "elsewhere":
            self._kill(DESK)

    def _kill(self, name: str) -> None:
        self._gateways[name].process.kill()
        self._steps.happened(f"gateway {name} is killed (SIGKILL)")

    def _send(self) -> None:
        """Send all robots but one, those of other gateways too."""
        with open_desk(self._gateways[SENDER].address) as desk:
            sent = [(robot, end) for robots in PLACES.values() for robot, _, end in robots if robot != SENT]
            for robot, (x, y) in sent:
                desk.send(f"demo-cluster-{robot}", robot, "SetPosEnd", x=x, y=y)
        self._steps.happened(f"a program at {SENDER} sends {len(sent)} robots, two of them its own")

    def _judge(self) -> None:
        """Hold what other gateways say against what the desk showed."""
        robots = {robot for robots in PLACES.values() for robot, *_ in robots}
        for name in PLACES.keys() - {DOOMED, DESK}:
            with open_desk(self._gateways[name].address) as desk:
                told = desk.ask("get_positions", {})["robots"]
                standing = {robot["robot"] for robot in told if abs(robot["v"]) <= STANDING}
                if not desk.emergency["in_force"] or standing != robots:
                    raise StageError(f"gateway {name}: stop {desk.emergency}; {standing or 'nobody'} stands")
        self._steps.happened(f"each gateway says the same: the stop is in force, {len(robots)} robots stand")

    def _plan(self) -> dict[str, object]:
        frame = self._site.frame
        targets = {robot: end for robots in PLACES.values() for robot, _, end in robots}
        return {
            "project": str(PROJECT),
            "gateway": self._gateways[DESK].address,
            "name": DESK,
            "doomed": DOOMED,
            "robots": list(targets),
            "orphans": [robot for robot, *_ in PLACES[DOOMED]],
            "sent": SENT,
            "target": frame.to_crs(np.array([targets[SENT]]))[0].tolist(),
            "window": WINDOW,
            "crs": frame.crs,
            "extent": frame.to_crs(np.array([EXTENT[:2], EXTENT[2:]])).ravel().tolist(),
            "pictures": str(FOLDER),
        }


def _told_gateways(address: str) -> list[str]:
    """Return the gateways of which a robot is told that connects to ``address``."""
    with RobotWire(f"{address}/robot?robot=probe") as robot:
        return list(robot.wait_for("Start")["params"].get("gateways", []))


def run() -> None:
    """Do it all, and leave what it made in ``FOLDER``."""
    shutil.rmtree(FOLDER, ignore_errors=True)
    FOLDER.mkdir(parents=True)
    with ExitStack() as stack:
        server = stack.enter_context(PostgreSql())
        database = server.new_database()
        run_once(database, revisions.create)
        nats = stack.enter_context(NatsCluster(FOLDER / "nats"))
        processes = stack.enter_context(Processes(FOLDER / "logs"))
        ClusterDemonstration(processes, database, nats).run()
    print(f"see {FOLDER}: driving.png, gateway-killed.png, emergency-stop.png, steps.txt")

"""The real loop: a gateway process, robots as processes of their own, and the plugin on a QGIS canvas."""

from __future__ import annotations

import shutil
import sqlite3
import time
from contextlib import closing, suppress

import pytest

from robot_bridge.gateway.storage import revisions
from robot_bridge.gateway.storage.database import run_once
from tests.support.errors import StageError
from tests.support.inside_qgis.operator_at_desk import OperatorAtDesk
from tests.support.operators import ask
from tests.support.patience import BUSY
from tests.support.processes import Processes

CRS = "EPSG:32633"
LOOKED_AT = 1.0
"""Seconds for which the window is painted while something is waited for."""


class Loop:
    """One gateway and its robots, and the desk that looks at them."""

    def __init__(self, processes, site, folder):
        self._processes = processes
        self._site = site
        self.file = folder / "fleet.db"
        self._database = f"sqlite:///{self.file}"
        self.address = ""
        self._runs = 0

    def start_gateway(self, port=0, *more):
        self._runs += 1
        options = ["--site", self._site, "--port", str(port), "--database", self._database, *more]
        self.gateway = self._processes.start_bridge(f"gateway-{self._runs}", ["serve", *options])
        found = self._processes.wait_for_line(f"gateway-{self._runs}", r"listening on (wss?://\S+:(\d+))", 30)
        self.address, self.port = found.group(1), int(found.group(2))

    def start_on_empty_database(self):
        """Start a gateway on the same port for another fleet, as one of another frame has to."""
        self.file = self.file.with_name("other.db")
        self._database = f"sqlite:///{self.file}"
        self.start_gateway(self.port)

    def find_first_way(self):
        """Have a way found: on a busy machine the first takes longer than a desk waits for it."""
        with suppress(StageError):
            ask(self.address, ("get_route", {"start": [10.0, 8.0], "x": 126.0, "y": 8.0}))

    def start_robot(self, name, pose, *, sql=False, speed=2.5, rate=5, more=()):
        way = ["--database", self._database] if sql else ["--url", f"{self.address}/robot"]
        where = ",".join(str(number) for number in pose)
        nimble = ["--speed", str(speed), "--turn-rate", "6", "--acceleration", "8"]
        options = ["--name", name, f"--pose={where}", *nimble, "--rate", str(rate), *more]
        return self._processes.start_bridge(name, ["robot", *way, *options])


@pytest.fixture(scope="session")
def empty_database(tmp_path_factory):
    """A file with the gateway's tables: to make them takes a gateway longer than to copy it takes a test."""
    file = tmp_path_factory.mktemp("database") / "fleet.db"
    run_once(f"sqlite:///{file}", revisions.create)
    with closing(sqlite3.connect(file)) as connection:
        connection.execute("pragma wal_checkpoint(truncate)")
    return file


@pytest.fixture
def start_loop(tmp_path, empty_database):
    """Start a gateway on a site; everything ends with the test."""
    shutil.copy(empty_database, tmp_path / "fleet.db")
    with Processes(tmp_path / "logs") as processes:

        def start(site, *options):
            loop = Loop(processes, site, tmp_path)
            loop.start_gateway(0, *options)
            return loop

        yield start


@pytest.fixture
def loop(start_loop, root):
    """A gateway on the sample site."""
    return start_loop(root / "resources" / "sample_site")


@pytest.fixture
def impatient_loop(start_loop, root, tmp_path):
    """A gateway on the sample site, where robots are stale after 3 s and lost after 6 s.

    Sooner, a busy machine would have them stale between a click and its check, and nothing is sent then.
    """
    site = tmp_path / "site"
    site.mkdir()
    sample = root / "resources" / "sample_site"
    shutil.copy(sample / "site.gpkg", site)
    settings = (sample / "site.toml").read_text().partition("[liveness]")[0]
    (site / "site.toml").write_text(f"{settings}\n[liveness]\nstale_after_s = 3.0\nlost_after_s = 6.0\n")
    return start_loop(site)


class Operator(OperatorAtDesk):
    """The demonstration's operator, who also reads what the desk knows to the millimetre."""

    def __init__(self, plugin, iface):
        super().__init__(iface)
        self.desk = plugin.window.desk
        self._reports = {}
        self.desk.state.commands_changed.connect(self._note)

    def _note(self, reports):
        self._reports.update({report.command: report for report in reports})

    def wait(self, what, condition, seconds):
        """Wait as the demonstration does, on a machine that other tests keep busy.

        What takes longer is painted for a while only: the window would take more of the processor than
        gateway and robots, for pictures that nobody looks at.
        """
        began = time.monotonic()

        def holds():
            if time.monotonic() - began > LOOKED_AT:
                self._window.setUpdatesEnabled(False)
            return condition()

        try:
            return super().wait(what, holds, BUSY * seconds)
        finally:
            self._window.setUpdatesEnabled(True)

    def wait_for_picture(self, what, condition, seconds):
        """Wait for what is painted: the window is painted all the time."""
        return super().wait(what, condition, BUSY * seconds)

    def connect_to(self, loop, robots, *, declare_paths=True):
        """Connect, wait for the robots, and look at the whole site."""
        self.connect(f"{loop.address}/desk", "anna")
        self.wait(f"seeing {robots}", lambda: set(self.states()) == set(robots), 15)
        if declare_paths:
            # Who clicks before they have done so sends them straight to their targets.
            self.wait("robots that drive paths", lambda: all(self.report(one).paths for one in robots), 15)
            loop.find_first_way()
        self.show_site()

    def show_site(self, margin=0.0):
        x_min, y_min, x_max, y_max = self.desk.state.site.bounds
        e, n = self.desk.state.site.origin
        self.show_map((e + x_min - margin, n + y_min - margin, e + x_max + margin, n + y_max + margin), CRS)

    def report(self, robot):
        return self.desk.state.robots.view(robot, self.desk.clock.steady()).report

    def states(self):
        return {
            view.name: view.state.value for view in self.desk.state.robots.views(self.desk.clock.steady())
        }

    def click_site(self, x, y):
        e, n = self.desk.state.site.origin
        self.click_map(e + x, n + y, CRS)

    def set_cone(self, robot, x, y):
        self.select(robot)
        self.choose("fleet_cone_target")
        self.click_site(x, y)
        self.press("fleet_send")
        # Who goes on to another robot before it was checked is told that nothing was sent.
        self.wait("the check of the target", lambda: not self.is_looking, 20)

    def wait_for_draft(self, what):
        """Wait until there is a draft that has been looked at, as an operator who reads before sending."""
        self.wait(what, lambda: self.desk.drafts.draft and not self.is_looking, 20)

    def press(self, action):
        # Who presses before the draft was checked is told that nothing was sent, if there is a warning.
        if action == "fleet_send":
            self.wait("the check of the draft", lambda: not self.is_looking, 20)
        super().press(action)

    @property
    def is_looking(self):
        """Whether what was drafted is looked at, or its way sought."""
        return self.desk.checks.is_under_way or self.desk.sending.awaits_way

    def sent_to(self, robot):
        return [command for command in self._reports.values() if command.robot == robot]

    def wait_for_state(self, robot, op, state, seconds=40):
        def now():
            return [c for c in self.sent_to(robot) if c.op == op and c.state is state]

        self.wait(f"{op} of {robot} being {state.value}", now, seconds)
        return now()[0]


@pytest.fixture
def operator(plugin, iface):
    return Operator(plugin, iface)

"""Two real gateways of one fleet on PostgreSQL, a robot at each, and a desk in QGIS whose gateway dies."""

from __future__ import annotations

import time

import pytest
from fleet_supervisor.plugin.gateway_client.connection import ConnectionThread
from fleet_supervisor.plugin.gateway_client.connection_status import ConnectionPhase, OperatorCredentials
from fleet_supervisor.robot_bridge.core.messages.safety import RobotState
from qgis.PyQt.QtWidgets import QLabel

from robot_bridge.gateway.storage import revisions
from robot_bridge.gateway.storage.database import run_once
from tests.support.bridge.command_line import run_command
from tests.support.fleet import SITE, Start, serve, start_robots
from tests.support.fleet_panel import state_line
from tests.support.operators import ask
from tests.support.patience import BUSY
from tests.support.processes import Processes

ROBOTS = {"a": Start("r1", (20.0, 8.0, 0.0)), "b": Start("r2", (48.0, 84.0, 0.0))}
SOON = 2.0
"""Seconds, of an idle machine, after which a desk is at another gateway."""


class TwoGateways:
    """Gateways a and b, each a process; one that was killed comes back on its port."""

    def __init__(self, processes, database, folder, options=()):
        self._processes, self._database, self._folder = processes, database, folder
        self._options = options
        self._served, self._runs = {}, {}

    def address(self, name):
        return self._served[name].address

    def place(self, name):
        return self.address(name).partition("//")[2]

    def start(self, name):
        state = self._folder / name
        state.mkdir(exist_ok=True)
        run = self._runs[name] = self._runs.get(name, 0) + 1
        port = self._served[name].port if name in self._served else 0
        options = ["--state", state, "--gateway-name", name, *self._options]
        self._served[name] = serve(
            self._processes, SITE, self._database, *options, port=port, name=f"{name}-{run}", forked=True
        )

    def kill(self, name):
        self._served[name].process.kill()
        self._served[name].process.wait()

    def standing_still(self, name):
        """Have a gateway do nothing inside the block: it takes connections, and greets nobody."""
        return self._processes.halted(f"{name}-{self._runs[name]}")

    def told_at(self, name):
        """Return what a desk that connects there is told of gateways."""
        return ask(self.address(name), ("hello", {"operator": "probe"}))[0]["gateways"]

    def operators_at(self, name):
        """Return whose sessions are open, as a desk is told that connects there."""
        (answer,) = ask(self.address(name), ("get_sessions", {}))
        return {session["operator"] for session in answer["sessions"]}


@pytest.fixture
def database(postgresql_server):
    url = postgresql_server.new_database()
    run_once(url, revisions.create)
    return url


@pytest.fixture
def fleet(database, tmp_path, wait):
    with Processes(tmp_path / "logs") as processes:
        both = TwoGateways(processes, database, tmp_path)
        for name in ROBOTS:
            both.start(name)
        wait(lambda: len(both.told_at("a")) == 2, 15, what="gateway a knowing of b")
        for name, robot in ROBOTS.items():
            start_robots(processes, both.address(name), tmp_path, starts=[robot])
        yield both


def test_a_desk_goes_on_at_another_gateway_and_stops_the_robots_from_there(fleet, operator, plugin, iface):
    window, desk = plugin.window, operator.desk
    both = [f"{fleet.address(name)}/desk" for name in ("a", "b")]
    operator.connect(both[0], "anna")
    fresh = {"r1": RobotState.FRESH.value, "r2": RobotState.FRESH.value}
    operator.wait("both robots", lambda: operator.states() == fresh, 15)
    assert "did not answer" not in state_line(window)

    seen, killed_at = {}, time.monotonic()
    fleet.kill("a")

    def is_at_b():
        if desk.state.link.phase is not ConnectionPhase.CONNECTED:
            seen.setdefault("lost", time.monotonic())
        return bool(desk.state.link.instead)

    operator.wait("the desk at b", is_at_b, 10)
    # The loss is over before anybody looks where this program stands still meanwhile.
    assert time.monotonic() - seen.get("lost", killed_at) < SOON * BUSY
    operator.wait("the line", lambda: f"at b ({fleet.place('b')}); a did not answer" in state_line(window), 5)
    operator.wait("its robots at b", lambda: operator.states() == fresh, 15)
    # That anybody else is asked of robots than before nobody has to know.
    assert not [text for text in iface.texts() if "database" in text or "site" in text]

    # A gateway that starts ends no session of another.
    fleet.start("a")
    operator.wait("the session", lambda: "anna" in fleet.operators_at("a"), 15)
    assert desk.state.link.phase is ConnectionPhase.CONNECTED

    # Neither answers for a moment, and in that the operator presses.
    operator.wait("b knowing of a", lambda: sorted(fleet.told_at("b")) == sorted(both), 15)
    with fleet.standing_still("a"):
        fleet.kill("b")
        operator.wait("the loss of b", lambda: desk.state.link.phase is not ConnectionPhase.CONNECTED, 10)
        window.actions.abort_all.trigger()
        window.actions.emergency.trigger()
        for what in ("The Abort", "EMERGENCY STOP"):
            assert any(f"{what} is NOT sent yet" in text for text in iface.texts())
        assert len(desk.orders) == 2

    def stopped():
        report = desk.state.emergency
        return report is not None and report.in_force and report.acknowledged == len(ROBOTS)

    operator.wait("a stop that all robots have acknowledged", stopped, 40)
    operator.wait("the answers", lambda: len(desk.orders) == 0, 20)
    assert "did not answer" not in state_line(window)
    assert not [text for text in iface.texts() if "NOT sent" in text]
    said = window.dock.findChild(QLabel, "fleet_emergency_text").text()
    assert "2 of 2 robots acknowledged" in said


def test_token_and_authority_go_with_a_desk_to_the_other_gateway(database, tmp_path, qgis_app, wait):
    def run(*words):
        done = run_command(*words)
        assert done.returncode == 0, done.stderr
        return done.stdout.strip()

    tls = tmp_path / "tls"
    run("tls", "create", tls, "--ip", "127.0.0.1")
    token = run("operators", "add", "Ada", "--role", "viewer", "--database", database)
    options = ["--certificate", tls / "server.pem", "--key", tls / "server-key.pem"]
    connection = ConnectionThread()

    def connected(instead):
        link = connection.collect_updates().link
        assert link.phase is not ConnectionPhase.FAILED, link.reason
        return (
            link.phase is ConnectionPhase.CONNECTED and link.who == "Ada, viewer" and instead in link.instead
        )

    with Processes(tmp_path / "logs") as processes:
        both = TwoGateways(processes, database, tmp_path, options)
        both.start("b")
        both.start("a")
        credentials = OperatorCredentials(token, str(tls / "ca.pem"))
        try:
            connection.open(f"{both.address('a')}/desk", "whoever", credentials)
            wait(lambda: connected(""), 10, what="the desk at a")
            known = connection._worker._client._addresses
            wait(lambda: len(known.known) == 2, what="the address of b")
            both.kill("a")
            wait(lambda: connected(f"at b ({both.place('b')}); a did not answer"), 10, what="the desk at b")
        finally:
            connection.shut_down()

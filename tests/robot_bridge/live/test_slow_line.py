"""Stops of a robot that is being sent the map of a city over a slow line."""

from __future__ import annotations

import json
import socket
import threading
import time

import numpy as np
import pytest

from robot_bridge.core.robotmap.outlines import OutlineRow, Outlines
from robot_bridge.core.sites.frame import SiteBounds
from robot_bridge.core.sites.settings import SiteSettings
from robot_bridge.core.sites.site import write_site
from tests.support.bridge.bridge_programs import wait_until
from tests.support.bridge.bridge_sockets import frame, plain_socket

BYTES_PER_S = 200_000
OUTLINES, POINTS, SIDE = 60, 1_000, 400.0
OVERTAKES = 200_000
"""bytes that a robot may be sent between a stop's request and the stop, with what is on its way already."""


class SlowRobot:
    """A robot that reads as much as a slow line brings; it answers nothing but what :meth:`say` says.

    ``received`` counts its bytes, and ``stopped_at`` is that count when an Abort had arrived.
    """

    def __init__(self, bridge, name):
        self._socket = plain_socket(bridge, f"/robot?robot={name}")
        self.received = 0
        self.stopped_at: int | None = None
        self.is_cut = False
        self._thread = threading.Thread(target=self._read, daemon=True)
        self._thread.start()

    def say_ready(self):
        self.say(method="Ready", params={"magic": 1}, id=1)

    def say(self, **call):
        self._socket.sendall(frame(json.dumps({"jsonrpc": "2.0", **call})))

    def close(self):
        self._socket.shutdown(socket.SHUT_RDWR)
        self._thread.join()
        self._socket.close()

    def _read(self):
        tail = b""
        try:
            while data := self._socket.recv(4096):
                self.received += len(data)
                if self.stopped_at is None and b'"Abort"' in tail + data:
                    self.stopped_at = self.received
                tail = data[-10:]
                time.sleep(len(data) / BYTES_PER_S)
        except ConnectionError:
            pass
        self.is_cut = True


@pytest.fixture(scope="module")
def city(tmp_path_factory):
    folder = tmp_path_factory.mktemp("sites") / "city"
    folder.mkdir()
    angles = np.linspace(0.0, 2 * np.pi, POINTS)
    shore = np.column_stack([np.cos(angles), np.sin(angles)])
    rows = [
        OutlineRow(SIDE / 2 + (10.0 + n) * shore, 1, 6.0, "shore", f"shores:{n}") for n in range(OUTLINES)
    ]
    bounds = SiteBounds(0.0, 0.0, SIDE, SIDE)
    settings = SiteSettings("city", "City", 1, "EPSG:32633", (430000.0, 5100000.0), bounds)
    write_site(folder, settings, Outlines.from_rows(rows))
    return folder


@pytest.fixture(scope="module")
def bridge(start_bridge, city):
    return start_bridge(city)


@pytest.fixture
def connect(bridge):
    """Connect a slow robot: ``connect(name)``."""
    robots = []

    def connected(name):
        robots.append(SlowRobot(bridge, name))
        robots[-1].say_ready()
        return robots[-1]

    yield connected
    for robot in robots:
        robot.close()


@pytest.mark.parametrize("asked", ["abort", "emergency_stop"])
def test_a_stop_does_not_wait_for_the_map_that_a_robot_is_being_sent(bridge, connect, asked):
    name = f"robot-{asked}"
    robot, desk = connect(name), bridge.desk()
    wait_until(lambda: robot.received > 60_000, 20)
    before = robot.received
    desk.ask(asked, {} if asked == "emergency_stop" else {"command": "abort-it-1", "robot": name})
    # The line is too slow for the rest of the map: the robot has to connect again.
    wait_until(lambda: robot.is_cut, 20)
    assert robot.stopped_at is None and robot.received < before + OVERTAKES
    again = connect(name)
    wait_until(lambda: again.stopped_at, 20)
    assert again.stopped_at < OVERTAKES, "it was sent the map first"
    wait_until(lambda: again.received > OVERTAKES, 20, "the map comes after the stop")
    assert f"robot {name} from 127.0.0.1 is cut off" in bridge.gateway_output()

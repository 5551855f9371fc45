"""Stops of a robot that is being sent the map of a city over a slow line."""

from __future__ import annotations

import json
import socket
import threading
import time

import numpy as np
import pytest

from robot_bridge.core.messages.links import LINK_PROTOCOL
from robot_bridge.core.robotmap.outlines import OutlineRow, Outlines
from robot_bridge.core.sites.frame import SiteBounds
from robot_bridge.core.sites.settings import SiteSettings
from robot_bridge.core.sites.settings_tables import LimitSettings
from robot_bridge.core.sites.site import write_site
from tests.support.bridge.bridge_programs import wait_until
from tests.support.bridge.bridge_sockets import frame, plain_socket

BYTES_PER_S = 200_000
OUTLINES, POINTS, SIDE = 60, 1_000, 400.0
OVERTAKES = 200_000
"""bytes that a robot may be sent between a stop's request and the stop, with what is on its way already."""


class SlowClient:
    """A robot, or a link, that reads as much as a slow line brings, and answers nothing.

    ``received`` counts its bytes, ``stopped_at`` is that count when an Abort had arrived, and ``results``
    counts the results of its calls.
    """

    def __init__(self, bridge, path):
        self._socket = plain_socket(bridge, path)
        self.received = self.results = 0
        self.stopped_at: int | None = None
        self.is_cut = False
        self._thread = threading.Thread(target=self._read, daemon=True)
        self._thread.start()

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
                self.results += (tail[-8:] + data).count(b'"result"')
                tail = data[-10:]
                # Not for anything to happen: this is how slow the line is.
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
    # A client that answers nothing, no ping either, must not be cut off before the stop.
    limits = LimitSettings(stuck_s=600.0)
    settings = SiteSettings("city", "City", 1, "EPSG:32633", (430000.0, 5100000.0), bounds, limits=limits)
    write_site(folder, settings, Outlines.from_rows(rows))
    return folder


@pytest.fixture(scope="module")
def bridge(start_bridge, city):
    return start_bridge(city)


@pytest.fixture
def connect(bridge):
    """Connect a slow robot, or a slow link with several: ``connect(*names)``."""
    clients = []

    def connected(name, *others):
        is_link = bool(others)
        clients.append(client := SlowClient(bridge, "/link" if is_link else f"/robot?robot={name}"))
        if is_link:
            client.say(method="hello", params={"protocol": LINK_PROTOCOL, "kind": "slow"}, id=0)
            wait_until(lambda: client.results == 1)
        for number, robot in enumerate((name, *others), 1):
            more = {"robot": robot} if is_link else {}
            client.say(method="Ready", params={"magic": 1, **more}, id=number)
            # By then the gateway sends the first its map, unless it waits for the others.
            wait_until(lambda number=number: client.results == number + is_link, 20)
        return client

    yield connected
    for client in clients:
        client.close()


def cuts(bridge):
    return bridge.gateway_output().count(" from 127.0.0.1 is cut off: a stop would wait")


@pytest.mark.parametrize(
    ("asked", "names"),
    [
        ("abort", ("alone",)),
        ("abort", ("one", "other", "stopped")),
        ("emergency_stop", ("first", "second", "last")),
    ],
    ids=["abort", "abort of one of a link", "emergency stop of a link"],
)
def test_a_stop_does_not_wait_for_the_map_that_a_robot_is_being_sent(bridge, connect, asked, names):
    cuts_before = cuts(bridge)
    client, desk, robot = connect(*names), bridge.desk(), names[-1]
    wait_until(lambda: client.received > 60_000, 20)
    before = client.received
    command = {"command": f"abort-{robot}", "robot": robot}
    desk.ask(asked, {} if asked == "emergency_stop" else command)
    # The line is too slow for the rest of the map: the client has to connect again.
    wait_until(lambda: client.is_cut, 20)
    assert client.stopped_at is None and client.received < before + OVERTAKES
    again = connect(*names)
    wait_until(lambda: again.stopped_at, 20)
    assert again.stopped_at < OVERTAKES, "it was sent a map first"
    wait_until(lambda: again.received > OVERTAKES, 20, "the map comes after the stop")
    assert cuts(bridge) == cuts_before + 1

"""The faults, each followed by nothing but time: whoever broke something puts back only what broke.

Moments are random by the yard's seed.
"""

from __future__ import annotations

import time

from tests.support.faults.disk import Disk, DiskWithPower
from tests.support.faults.yard import GATEWAY_KILLED, ROBOTS_KILLED, Yard

SERVER_KILLED = "database server killed"
STALLED, REFUSED = "network to the database stalled", "network to the database reset"
DISK_FULL = "disk full"
POWER_CUT = "power cut"
SILENT_S = 3.5
"""seconds after which another robot may come under the name of one on SQL."""


def kill_gateway(yard: Yard, times: int, longest: float = 2.5) -> None:
    """Kill the gateway at random moments, ``longest`` seconds of work apart, and start it again each time."""
    for _ in range(times):
        yard.work(0.2, longest)
        with yard.fault(GATEWAY_KILLED):
            yard.kill_gateway()
            yard.start_gateway()


def kill_server(yard: Yard, times: int, longest: float = 4.0) -> None:
    """Kill the database server at random moments and start it again after a while."""
    server = yard.place.server
    assert server is not None
    for _ in range(times):
        yard.work(1.0, longest)
        with yard.fault(SERVER_KILLED):
            server.kill()
            yard.work(0.0, 2.0)
            server.start()


def kill_robots(yard: Yard, times: int, rest: float = SILENT_S) -> None:
    """Kill two robots, one of each link; they come back in turn without and with what they knew."""
    crew = yard.crews[-1]
    for _ in range(times):
        yard.work(0.5, 2.0)
        with yard.fault(ROBOTS_KILLED):
            yard.kill_crew(crew)
            yard.work(0.0, 1.0)
            yard.start_crew(crew, remembers=crew.life % 2 == 0)
        time.sleep(rest)


def stall_network(yard: Yard, seconds: float) -> None:
    """Let nothing pass between gateway and database for a while; connections stay open."""
    network = yard.place.network
    assert network is not None
    yard.work(0.5, 2.0)
    with yard.fault(STALLED):
        network.stall()
        time.sleep(seconds)
        network.forward()


def reset_network(yard: Yard, seconds: float) -> None:
    """Reset every connection between gateway and database, and each new one for a while."""
    network = yard.place.network
    assert network is not None
    yard.work(0.5, 2.0)
    with yard.fault(REFUSED):
        network.refuse()
        time.sleep(seconds)
        network.forward()


def fill_disk(yard: Yard, disk: Disk, seconds: float) -> None:
    """Leave no room on the disk for a while."""
    yard.work(0.5, 2.0)
    with yard.fault(DISK_FULL):
        disk.fill()
        time.sleep(seconds)
        disk.free()


def cut_power(yard: Yard, disk: DiskWithPower) -> None:
    """End everybody, lose what had not reached the disk, and start everybody again."""
    with yard.fault(POWER_CUT):
        yard.kill_gateway()
        for crew in yard.crews:
            yard.kill_crew(crew)
        disk.cut_power()
        yard.start_gateway()
        for crew in yard.crews:
            yard.start_crew(crew, remembers=True)

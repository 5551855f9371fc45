"""Real ROS 2 robots as processes, on loopback, in DDS domains that are of nobody else on this computer."""

from __future__ import annotations

import json
import os
import socket
from functools import cached_property
from pathlib import Path

from tests.support.bridge.bridge_programs import wait_until
from tests.support.errors import StageError
from tests.support.forked_programs import Program
from tests.support.operators import Desk
from tests.support.patience import START
from tests.support.processes import Processes
from tests.support.robots.ros_peer import DISTRIBUTION

ROBOT = Path(__file__).parent / "ros_robot.py"
SHORT_LEASE = ROBOT.with_name("short_lease.xml")
DOMAINS = range(1, 102)
"""Those whose ports lie below the ephemeral ones."""
FIRST_PORT, PORTS = 7410, 250
"""Port of who came first into domain 0, by multicast or without, and the ports of one domain."""

_claims: list[socket.socket] = []


def own_domain() -> int:
    """Return a DDS domain in which nobody is on this computer; it is this process's until that ends.

    Chosen by the process id alone two that run at the same time may meet, and drive each other's robots.

    :raises StageError: when there is none.
    """
    first = os.getpid()
    for number in range(len(DOMAINS)):
        domain = DOMAINS[(first + number) % len(DOMAINS)]
        claim = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
            try:
                # A name without a file: it is gone with this process, however that ends.
                claim.bind(f"\0fleet-supervisor-dds-{domain}")
                probe.bind(("", FIRST_PORT + PORTS * domain))
            except OSError:
                claim.close()
                continue
        _claims.append(claim)
        return domain
    raise StageError(f"somebody is in each DDS domain from {DOMAINS[0]} to {DOMAINS[-1]} on this computer")


class Nodes:
    """Starts and ends robots; ``events(name)`` is what a robot has said of itself."""

    def __init__(self, processes: Processes, python: Path) -> None:
        self._processes = processes
        self._python = python
        self._robot = Program((ROBOT.stem,), python, ROBOT.parent)
        self._started: dict[str, int] = {}
        self.domain = own_domain()
        self.distribution = DISTRIBUTION

    @cached_property
    def other_domain(self) -> int:
        """A second domain, in which no robot is but those that are started there."""
        return own_domain()

    def start(
        self,
        name: str,
        *options: str,
        domain: int | None = None,
        node: str | None = None,
        network: Path | None = None,
        short_lease: bool = False,
    ) -> None:
        """Start a robot, in the domain of this module or another; wait until it says that it is up.

        ``node`` is the name of its topics, where several nodes are to have the same ones; ``network`` is the
        file of a namespace of networks, where it is to run in one of its own. With a ``short_lease`` it
        counts as gone 6 s after it was ended, else after 20 s.
        """
        number = self._started[name] = self._started.get(name, 0) + 1
        log = f"{name}-{number}"
        environment, words = self.environment(domain), [node or name, *options]
        if short_lease:
            environment["FASTDDS_DEFAULT_PROFILES_FILE"] = str(SHORT_LEASE)
        if network:
            environment["ROS_AUTOMATIC_DISCOVERY_RANGE"] = "SUBNET"
        self._processes.start_forked(self._robot, log, words, env=environment, network=network)
        self._processes.wait_for_line(log, '"up"', START)

    def start_script(self, name: str, script: Path, *arguments: str) -> None:
        """Start a program that uses rclpy, in the domain of this module."""
        self._started[name] = self._started.get(name, 0) + 1
        command = [self._python, script, *arguments]
        self._processes.start(f"{name}-{self._started[name]}", command, env=self.environment())

    def environment(self, domain: int | None = None) -> dict[str, str]:
        """Return what tells a ROS program to be in the domain, and on this computer only."""
        here = str(self.domain if domain is None else domain)
        return {"ROS_DOMAIN_ID": here, "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}

    def end(self, name: str) -> None:
        """End the robot that was started last under a name."""
        self._processes.end(f"{name}-{self._started[name]}")

    def events(self, name: str) -> list[dict]:
        """Return what the robot that was started last under a name has said."""
        text = self._processes.log(f"{name}-{self._started[name]}").read_text(encoding="utf-8")
        lines = [line for line in text.splitlines() if line.startswith("{") and line.endswith("}")]
        return [json.loads(line) for line in lines]


def events(nodes: Nodes, name: str, kind: str) -> list[dict]:
    """Return the events of one kind that a robot has printed."""
    return [event for event in nodes.events(name) if event["event"] == kind]


def abort_before_the_goal(desk: Desk, nodes: Nodes, name: str) -> None:
    """Abort a target while the robot thinks about its goal; assert that it stands all the same.

    The robot is SLOW and has late goals: by itself it would drive for 80 s.
    """
    desk.send(f"go-{name}", name, "SetPosEnd", x=60.0, y=8.0)
    wait_until(lambda: events(nodes, name, "goal asked"))
    desk.send(f"stop-{name}", name, "Abort")
    desk.wait_for_step(f"stop-{name}", "acknowledged")
    assert not events(nodes, name, "goal")
    # Its stop service may reach it before the cancel does.
    wait_until(lambda: events(nodes, name, "goal ended"))
    desk.until(lambda: desk.robots[name]["v"] == 0.0)
    assert desk.robots[name]["x"] < 45.0

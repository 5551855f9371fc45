"""Real ROS 2 robots as processes, on loopback, in a DDS domain of the process that starts them."""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from pathlib import Path

from tests.support.patience import START
from tests.support.processes import Processes
from tests.support.robots.ros_peer import DISTRIBUTION

ROBOT = Path(__file__).parent / "ros_robot.py"


class Nodes:
    """Starts and ends robots; ``events(name)`` is what a robot has said of itself."""

    def __init__(self, processes: Processes, python: Path) -> None:
        self._processes = processes
        self._python = python
        self._started: dict[str, int] = {}
        # The domain of no other test process on this computer; ROS allows 0 to 101 beside ephemeral ports.
        self.domain = 1 + os.getpid() % 50
        self.distribution = DISTRIBUTION

    def start(
        self,
        name: str,
        *options: str,
        domain: int | None = None,
        node: str | None = None,
        through: Sequence[str] = (),
    ) -> None:
        """Start a robot, in the domain of this module or another; wait until it says that it is up.

        ``node`` is the name of its topics, where several nodes are to have the same ones; ``through`` begins
        the command, where it is to run on a network of its own.
        """
        number = self._started[name] = self._started.get(name, 0) + 1
        log = f"{name}-{number}"
        environment = self.environment(domain)
        if through:
            environment["ROS_AUTOMATIC_DISCOVERY_RANGE"] = "SUBNET"
        self._processes.start(log, [*through, self._python, ROBOT, node or name, *options], env=environment)
        self._processes.wait_for_line(log, '"up"', START)

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

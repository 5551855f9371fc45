"""Real ROS 2 robots behind a real rosbridge server, which has none of this project's code."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.support.errors import StageError
from tests.support.patience import BUSY, START
from tests.support.processes import Processes, free_port
from tests.support.robots.ros_nodes import Nodes
from tests.support.robots.ros_peer import ros_python
from tests.support.robots.rosbridge_peer import rosbridge_command

DOCS = Path(__file__).resolve().parents[4] / "docs"


class Server:
    """A rosbridge server on a port of its own, which it has again when it is started again."""

    def __init__(self, processes: Processes, environment: dict[str, str]) -> None:
        self._processes, self._environment = processes, environment
        self.port = free_port()
        self.url = f"ws://127.0.0.1:{self.port}"
        self._number = 0

    def start(self) -> None:
        """Start it and wait until it listens."""
        self._number += 1
        name = f"server-{self.port}-{self._number}"
        self._process = self._processes.start(name, rosbridge_command(self.port), env=self._environment)
        self._processes.wait_for_line(name, "listening", START)

    def kill(self) -> None:
        """End it the way a power cut does."""
        self._process.kill()
        self._process.wait(BUSY * 5)


@pytest.fixture(scope="session")
def guide():
    """Blocks of settings of the guide: ``guide(name)``."""
    text = (DOCS / "links-rosbridge.md").read_text(encoding="utf-8")
    return lambda name: re.search(rf"```toml {name}\n(.*?)```", text, re.DOTALL)[1]


@pytest.fixture(scope="module")
def nodes(tmp_path_factory):
    """Real ROS 2 robots of this module; all end with it."""
    try:
        python = ros_python()
        rosbridge_command(0)
    except StageError as error:
        pytest.skip(str(error))
    with Processes(tmp_path_factory.mktemp("ros")) as processes:
        yield Nodes(processes, python)


@pytest.fixture(scope="module")
def start_server(nodes, tmp_path_factory):
    """Start a server in the domain of the nodes, or another: ``start_server(domain)``."""
    with Processes(tmp_path_factory.mktemp("server")) as processes:

        def start(domain=None):
            server = Server(processes, nodes.environment(domain))
            server.start()
            return server

        yield start


@pytest.fixture(scope="module")
def server(start_server):
    """The rosbridge server in the domain of the nodes."""
    return start_server()

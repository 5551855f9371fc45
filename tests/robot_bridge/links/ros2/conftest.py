"""Real ROS 2 nodes: rclpy in an environment of its own, on loopback, in a DDS domain of this test process."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.support.errors import StageError
from tests.support.processes import Processes
from tests.support.robots.ros_nodes import Nodes
from tests.support.robots.ros_peer import ros_python

DOCS = Path(__file__).resolve().parents[4] / "docs"


@pytest.fixture(scope="session")
def guide():
    """Blocks of the guide by name: settings, or a program where ``language`` says so."""
    text = (DOCS / "links-ros2.md").read_text(encoding="utf-8")
    return lambda name, language="toml": re.search(rf"```{language} {name}\n(.*?)```", text, re.DOTALL)[1]


@pytest.fixture(scope="module")
def nodes(tmp_path_factory):
    """Real ROS 2 robots of this module; all end with it."""
    for package in ("cyclonedds", "rosbags"):
        pytest.importorskip(package, reason=f"{package} is not installed; run make setup")
    try:
        python = ros_python()
    except StageError as error:
        pytest.skip(str(error))
    with Processes(tmp_path_factory.mktemp("ros")) as processes:
        yield Nodes(processes, python)

"""The cars and the robots: two links as an integrator starts them, and the ROS 2 nodes at the end of one."""

from __future__ import annotations

import json
from pathlib import Path

from robot_bridge.core.sites.settings import SiteSettings
from tests.support.errors import StageError
from tests.support.processes import Processes
from tests.support.robots.ros_nodes import Nodes
from tests.support.robots.ros_peer import DISTRIBUTION, ros_python
from tools.zalazone.places import Place

CARS = """\
[gateway]
url = "{address}/link"

[replay]
file = "{recording}"
robots = {{ {names} }}
loop = true
columns = {{ time = "t_s", robot = "vehicle", x = "x_utm33", y = "y_utm33", v = "speed_mps" }}

[frame]
crs = "EPSG:32633"
"""
ROBOTS = """\
[gateway]
url = "{address}/link"

[ros2]
domain = {domain}
range = "localhost"
distribution = "{distribution}"

[ros2.topics]
stop = "/{{robot}}/stop"
place_cone = "/{{robot}}/place_cone"

[frame]
crs = "{crs}"
origin = [{east}, {north}]
"""
WITHOUT_PEER = (
    "the ROS 2 robots of this demonstration are real rclpy nodes, and they cannot be had here: {why}\n"
    "They are made once, in ~/.cache/fleet-supervisor, from packages of PyPI. That needs the network, "
    "cmake and g++ (apt-get install cmake g++), and about two minutes. Nothing takes their place."
)


class Links:
    """Starts what speaks for cars and robots; everything ends with ``processes``."""

    def __init__(
        self, processes: Processes, python: Path, folder: Path, address: str, site: SiteSettings
    ) -> None:
        self._processes = processes
        self._folder = folder
        self._address = address
        self._site = site
        self._nodes = Nodes(processes, python)
        folder.mkdir(parents=True, exist_ok=True)

    def start_replay(self, recording: Path, cars: dict[str, str]) -> None:
        """Play ``recording``; ``cars`` are the robots' names by vehicle, without ``replay-``."""
        names = ", ".join(f"{vehicle} = {json.dumps(name)}" for vehicle, name in cars.items())
        text = CARS.format(address=self._address, recording=recording, names=names)
        self._start("replay", "cars", text)

    def start_ros(self) -> None:
        """Start the adapter on the robots' DDS network. Their map begins at the site's origin."""
        east, north = self._site.origin
        places = {"crs": self._site.crs, "east": east, "north": north}
        text = ROBOTS.format(
            address=self._address, domain=self._nodes.domain, distribution=DISTRIBUTION, **places
        )
        self._start("ros2", "nav2", text)

    def start_robot(self, name: str, place: Place, speed: float) -> None:
        """Start a ROS 2 robot of that name, which stands at ``place``, and wait until it is up."""
        self._nodes.start(name, f"--x={place[0]}", f"--y={place[1]}", f"--speed={speed}", "--rate=10")

    def said(self, name: str, event: str) -> list[dict]:
        """Return what the robot itself has said of an event."""
        return [entry for entry in self._nodes.events(name) if entry["event"] == event]

    def _start(self, kind: str, name: str, settings: str) -> None:
        file = self._folder / f"{name}.toml"
        file.write_text(settings, encoding="utf-8")
        state = {"ROBOT_BRIDGE_STATE": str(self._folder)}
        self._processes.start_bridge(f"link-{name}", ["link", kind, "--config", file], env=state)


def peer() -> Path:
    """Return the Python of the ROS 2 nodes.

    :raises StageError: when there is none and none can be made, with what to install.
    """
    try:
        return ros_python()
    except StageError as error:
        raise StageError(WITHOUT_PEER.format(why=error)) from None

"""The real other side: a mosquitto of the tests' own, virtual vehicles of vda-5050-lib, and the adapter."""

from __future__ import annotations

import itertools
import json
import os
import subprocess
from pathlib import Path
from typing import Any

import paho.mqtt.client as mqtt
import pytest

from tests.support.databases.database_server import find_program
from tests.support.errors import StageError
from tests.support.forked_programs import Program
from tests.support.patience import BUSY, START
from tests.support.processes import Processes, free_port

VEHICLE = Path(__file__).with_name("virtual_vehicle.js")
SDK_VEHICLE, VEHICLE_3_0 = (Program((name,), path=VEHICLE.parent) for name in ("sdk_vehicle", "vehicle_3_0"))
RUNS = itertools.count(1)


class Yard:
    """A broker, vehicles and an adapter, each a process that a test may kill."""

    def __init__(self, processes: Processes, folder: Path, modules: str) -> None:
        self._processes, self._modules = processes, modules
        self.folder = folder
        self.port = free_port()
        self.broker_options = ["allow_anonymous true"]
        self.running: dict[str, Any] = {}
        self.names: dict[str, str] = {}

    def start_broker(self) -> None:
        """Start it on the port it had before; what it retained is gone."""
        settings = self.folder / "mosquitto.conf"
        lines = [f"listener {self.port} 127.0.0.1", *self.broker_options, "persistence false"]
        if os.geteuid() == 0:
            lines.append("user root")  # its own account may not read the test's folder
        settings.write_text("\n".join(lines) + "\n", encoding="utf-8")
        self._start("broker", [find_program("mosquitto", "/usr/sbin"), "-v", "-c", settings])
        self._processes.wait_for_line(self.names["broker"], r"mosquitto version .* running", START)

    def start_vehicle(
        self, serial: str, x: float, y: float, *, called: str | None = None, **options: Any
    ) -> None:
        """Start a vehicle at (x, y) of its map; its process is ``called`` by its serial number otherwise."""
        called = called or serial
        given = {"port": self.port, "serial": serial, "x": x, "y": y, **options}
        debug = {"NODE_PATH": self._modules, "DEBUG": "vda-5050:*:AgvController", "DEBUG_COLORS": "0"}
        self._start(called, ["node", VEHICLE, json.dumps(given)], **debug)
        self._processes.wait_for_line(self.names[called], "vehicle is there", START)

    def start_adapter(self, gateway: str, *lines: str, name: str = "yard") -> None:
        """Start the adapter with the shortest settings and more ``lines`` of them."""
        file = self.folder / f"{name}.toml"
        own = (
            [] if any("broker =" in line for line in lines) else [f'broker = "mqtt://127.0.0.1:{self.port}"']
        )
        text = ["answer_within_s = 8.0", "[gateway]", f'url = "{gateway}/link"', "[vda5050]", *own, *lines]
        file.write_text("\n".join(text) + "\n", encoding="utf-8")
        self.run_adapter(file)

    def run_adapter(self, file: Path) -> None:
        """Start the adapter with the settings in ``file``."""
        unique = self._unique("adapter")
        self.running["adapter"] = self._processes.start_bridge(unique, ["link", "vda5050", "--config", file])

    def start_sdk_vehicle(self, serial: str, x: float, y: float, **options: Any) -> None:
        """Start a vehicle of version 2.1 at (x, y) of its map."""
        self._start_python(SDK_VEHICLE, serial, x, y, options)

    def start_vehicle_3_0(self, serial: str, x: float, y: float, **options: Any) -> None:
        """Start a vehicle of version 3.0 at (x, y) of its map."""
        self._start_python(VEHICLE_3_0, serial, x, y, options)

    def publish(self, topic: str, payload: str) -> None:
        """Publish what anybody at the broker can."""
        client = mqtt.Client(mqtt.CallbackAPIVersion.VERSION2)
        client.connect("127.0.0.1", self.port)
        client.loop_start()
        client.publish(topic, payload, qos=1).wait_for_publish(10)
        client.disconnect()
        client.loop_stop()

    def kill(self, name: str) -> None:
        """End a process the way a power cut does."""
        self.running[name].kill()
        self.running[name].wait(BUSY * 5)

    def output(self, name: str) -> str:
        """Return what a process has printed since it was started last."""
        return self._processes.log(self.names[name]).read_text(encoding="utf-8", errors="replace")

    def end_vehicles(self) -> None:
        """End the vehicles, the way a power cut does."""
        for name in self.running.keys() - {"broker", "adapter"}:
            self.kill(name)
            del self.running[name]

    def end(self) -> None:
        """End all of them."""
        self.end_vehicles()
        for name in reversed(self.names.values()):
            self._processes.end(name)

    def _start_python(
        self, program: Program, serial: str, x: float, y: float, options: dict[str, Any]
    ) -> None:
        given = {"port": self.port, "serial": serial, "x": x, "y": y, **options}
        unique = self._unique(serial)
        self.running[serial] = self._processes.start_forked(program, unique, [json.dumps(given)])
        self._processes.wait_for_line(self.names[serial], "vehicle is there", START)

    def _start(self, name: str, command: list[Any], **environment: str) -> None:
        unique = self._unique(name)
        self.running[name] = self._processes.start(unique, command, env=environment)

    def _unique(self, name: str) -> str:
        self.names[name] = f"{name}-{next(RUNS)}"
        return self.names[name]


def require_broker() -> None:
    """Skip where there is no broker."""
    try:
        find_program("mosquitto", "/usr/sbin")
    except StageError as error:
        pytest.skip(str(error))


def require_peers(root: Path) -> str:
    """Return where the modules of the vehicles are; skip where broker or vehicles cannot be had."""
    require_broker()
    done = subprocess.run(
        [root / "tools" / "vda5050_vehicles.sh"], capture_output=True, text=True, check=False
    )
    if done.returncode == 3:
        pytest.skip(done.stderr.strip().splitlines()[-1])
    assert done.returncode == 0, done.stderr
    return done.stdout.strip()

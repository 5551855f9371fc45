"""What an operator's program says to the gateway and is told: for tests, demonstrations and benchmarks."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

from tests.support.errors import StageError
from tests.support.wire import RefusedError, Wire

FEEDS = {
    "emergency": ("emergency", None),
    "geofence": ("geofence", None),
    "nearness": ("nearness", None),
    "suspensions": ("suspended", "robots"),
    "links": ("links", "links"),
    "gateways": ("gateways", "gateways"),
}
"""Where a desk keeps what is told of all robots together, by method: its attribute, and which parameter."""


class Desk(Wire):
    """An operator's connection; keeps the newest report of each robot, queue and command, all snapshots."""

    def __init__(self, url: str, operator: str, **options: Any):
        super().__init__(url, **options)
        self.robots: dict[str, dict[str, Any]] = {}
        self.commands: dict[str, dict[str, Any]] = {}
        self.queues: dict[str, dict[str, Any]] = {}
        self.observations: dict[int, dict[str, Any]] = {}
        self.plans: dict[str, dict[str, Any]] = {}
        self.placements: dict[int, dict[str, Any]] = {}
        self.snapshots: list[dict[str, Any]] = []
        self.geofence: dict[str, Any] = {}
        self.nearness: dict[str, Any] = {}
        self.suspended: list[dict[str, Any]] = []
        self.links: list[dict[str, Any]] = []
        self.gateways: list[str] = []
        self.hello = self.ask("hello", {"operator": operator})
        self.site, self.emergency = self.hello["site"], self.hello["emergency"]

    def send(self, command: str, robot: str, op: str, **params: Any) -> dict[str, Any]:
        """Send a command and return its report."""
        report = self.ask("send", {"command": command, "robot": robot, "op": op, "params": params})
        self.commands.setdefault(command, report)
        return report

    def wait_for_robots(self, *names: str, seconds: float = 15.0) -> None:
        """Wait until each robot has said where it is."""
        self.until(lambda: all(self.robots.get(name, {}).get("x") is not None for name in names), seconds)

    def wait_for_abilities(self, robot: str, *abilities: str, seconds: float = 20.0) -> None:
        """Wait until a robot has declared ``abilities``: a link finds a robot's servers one by one."""
        self.until(lambda: set(abilities) <= self._abilities(robot), seconds)

    def wait_for_step(self, command: str, state: str, seconds: float = 30.0) -> dict[str, Any]:
        """Wait until a command is in ``state``; return its report."""
        self.until(lambda: self.commands.get(command, {}).get("state") == state, seconds)
        return self.commands[command]

    def state(self) -> str:
        known = {"plans": self.plans, "robots": self.robots, "commands": self.commands}
        return json.dumps({**known, "queues": self.queues}, indent=1)

    def _abilities(self, robot: str) -> set[str]:
        return set((self.robots.get(robot, {}).get("abilities") or "").split())

    def _hear(self, frame: dict[str, Any]) -> None:
        method, params = frame["method"], frame.get("params")
        if method == "positions":
            self.snapshots.append(params)
            self.robots.update({robot["robot"]: robot for robot in params["robots"]})
        elif method == "observation":
            self.observations[params["observation"]] = params
        elif method == "plan":
            self.plans[params["plan"]] = params
        elif method == "placement":
            self.placements[params["placement"]] = params
        elif method == "queue":
            self.queues[params["robot"]] = params
        elif method == "command":
            self.commands[params["command"]] = params
        elif method in FEEDS:
            attribute, key = FEEDS[method]
            setattr(self, attribute, params if key is None else params[key])


def open_desk(address: str, token: str = "", operator: str = "demo check") -> Desk:
    """Return an operator's connection to the gateway at ``address``.

    :param token: the operator's, where the gateway has accounts.
    """
    headers = {"Authorization": f"Bearer {token}"} if token else {}
    return Desk(f"{address}/desk", operator, additional_headers=headers)


def ask(address: str, *questions: tuple[str, Mapping[str, Any]], token: str = "") -> list[dict[str, Any]]:
    """Return what the gateway at ``address`` answers an operator to each question, past the window.

    :raises StageError: when it refuses one.
    """
    with open_desk(address, token) as desk:
        try:
            return [desk.ask(method, params) for method, params in questions]
        except RefusedError as error:
            raise StageError(f"the gateway refused a demonstration's question: {error}") from error

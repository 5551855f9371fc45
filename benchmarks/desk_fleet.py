"""Robots that drive about on a track, as a gateway tells of them."""

from __future__ import annotations

from typing import Any

import msgspec
import numpy as np

from robot_bridge.core.messages.positions import PositionColumns
from robot_bridge.core.position_frame import METHOD, packed_frame

SPEED = 1.5
SILENT = 0.03
"""The part of the robots that have fallen silent."""


class DrivingFleet:
    """``number`` robots in an area (x, y, width, height) of the site frame, in metres; the same each time."""

    def __init__(self, number: int, area: tuple[float, float, float, float]) -> None:
        self._random = np.random.default_rng(6)
        x, y, width, height = area
        self.xy = self._random.uniform((x, y), (x + width, y + height), (number, 2))
        self.theta = self._random.uniform(-np.pi, np.pi, number)
        self._silent = self._random.uniform(size=number) < SILENT

    def drive(self, seconds: float) -> None:
        """Let them go on, in gentle bends."""
        self.theta += self._random.normal(0.0, 0.1, len(self.theta))
        step = np.column_stack([np.cos(self.theta), np.sin(self.theta)]) * SPEED * seconds
        self.xy[~self._silent] += step[~self._silent]

    def reports(self, sent: float = 0.0) -> list[dict[str, Any]]:
        """Return the reports of all; ``sent`` stands in for their clocks."""
        places, turns = self.xy.round(3).tolist(), self.theta.round(4).tolist()
        rows = zip(places, turns, self._silent.tolist(), strict=True)
        return [
            {
                "robot": f"robot-{number}",
                "state": "fresh",
                "age": 6.0 + number % 9 if silent else 0.05,
                "link": "websocket",
                "x": x,
                "y": y,
                "theta": theta,
                "v": SPEED,
                "battery": 0.8,
                "accuracy": 0.4,
                "pose_age": 0.05,
                "status": "driving",
                "device_time": sent,
            }
            for number, ((x, y), theta, silent) in enumerate(rows)
        ]

    def frame(self) -> bytes:
        """Return the table of numbers that a gateway sends, all but its last column, the robots' clocks."""
        count = len(self.xy)
        numbers = {"v": SPEED, "battery": 0.8, "accuracy": 0.4, "pose_age": 0.05, "stopped": 0.0}
        places = {"state": 0.0, "link": 1.0, "status": 2.0}
        columns = {
            "age": np.where(self._silent, 6.0 + np.arange(count) % 9, 0.05),
            "x": self.xy[:, 0].round(3),
            "y": self.xy[:, 1].round(3),
            "theta": self.theta.round(4),
            **{name: np.full(count, value) for name, value in {**numbers, **places}.items()},
        }
        names = [f"robot-{number}" for number in range(count)]
        head = PositionColumns(0.0, names, [*columns, "device_time"], ["fresh", "websocket", "driving"])
        text = msgspec.json.encode({"jsonrpc": "2.0", "method": METHOD, "params": head})
        return packed_frame(text, columns.values())

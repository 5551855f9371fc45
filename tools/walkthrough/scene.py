"""What every act of the walk-through has: the operator, the film, the gateway."""

from __future__ import annotations

import math
from contextlib import AbstractContextManager
from dataclasses import dataclass
from pathlib import Path

from tests.support.processes import Processes
from tools.walkthrough.film import Film
from tools.walkthrough.gateway import Gateway
from tools.walkthrough.operator_at_screen import OperatorAtScreen

NAME = "anna"
"""The operator's."""
ROBOTS = ("r1", "r2", "r3")


@dataclass(frozen=True)
class Scene:
    """One operator with a ``home`` folder before one window on one gateway, which stores in ``database``.

    ``processes`` are what runs beside the window: the gateway and the robots.
    """

    operator: OperatorAtScreen
    film: Film
    gateway: Gateway
    home: Path
    database: Path
    processes: Processes

    def halted_gateway(self) -> AbstractContextManager[None]:
        """Let the gateway answer nothing inside the block; a question waits 5 s before it is given up."""
        return self.processes.halted("gateway")

    def wait_until_live(self) -> None:
        """Look until the desk is connected and every robot is fresh."""
        self.operator.wait_for_text("fleet_link_state", "Connected")

        def all_fresh() -> bool:
            rows = self.operator.desk()["robots"]
            return {name: row["State"] for name, row in rows.items()} == dict.fromkeys(ROBOTS, "fresh")

        self.operator.wait("every robot being fresh", all_fresh)

    def select_in_table(self, robot: str) -> None:
        """Click a robot's row."""
        self.operator.click_row("fleet_robot_table", robot)
        self.wait_for_selection(robot)

    def wait_for_selection(self, robot: str) -> None:
        """Look until that robot alone is selected."""
        self.operator.wait(f"{robot} being selected", lambda: self.operator.desk()["selected"] == [robot])

    def distance(self, robot: str, other: str) -> float:
        """Return the metres between two robots."""
        return math.dist(self.gateway.place_of(robot), self.gateway.place_of(other))

    def wait_until_driving(self, robot: str) -> None:
        """Look until a robot's row says that it drives."""
        self.operator.wait(f"{robot} driving", lambda: self._speed(robot) > 0.5)

    def wait_until_standing(self, robot: str) -> None:
        """Look until a robot's row says that it stands."""
        self.operator.wait(f"{robot} standing", lambda: self._speed(robot) < 0.05)

    def _speed(self, robot: str) -> float:
        return float(self.operator.desk()["robots"][robot]["Speed"].removesuffix(" m/s") or 0.0)

"""What the gateway itself says, past the window: what is seen there must have happened here."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from tests.support.errors import StageError
from tests.support.operators import ask, open_desk

Place = tuple[float, float]
"""Metres in the site frame."""


@dataclass(frozen=True)
class Gateway:
    """The gateway at ``address``, ``ws://host:port``; ``token`` is an operator's, where it has accounts."""

    address: str
    token: str = ""

    def place_of(self, robot: str) -> Place:
        """Return where a robot is."""
        (positions,) = ask(self.address, ("get_positions", {}), token=self.token)
        found = next(each for each in positions["robots"] if each["robot"] == robot)
        return found["x"], found["y"]

    def newest_command(self, robot: str, state: str | None = None) -> dict[str, Any]:
        """Return the command that a robot was given last, aborts left out, of those that ended in ``state``.

        :raises StageError: when it was given none.
        """
        (answer,) = ask(self.address, ("get_commands", {}), token=self.token)
        mine = [each for each in answer["commands"] if each["robot"] == robot and each["op"] != "Abort"]
        mine = [each for each in mine if state in (None, each["steps"][-1]["state"])]
        if not mine:
            raise StageError(f"the gateway knows no command for {robot} that is {state or 'there'}")
        return max(mine, key=lambda command: command["steps"][0]["at"])

    def require_state(self, robot: str, state: str) -> None:
        """Raise StageError unless a robot's newest command has come to ``state``."""
        steps = [step["state"] for step in self.newest_command(robot)["steps"]]
        if steps[-1] != state:
            raise StageError(f"the window says {state} for {robot}, the gateway {' → '.join(steps)}")

    def emergency(self) -> dict[str, Any]:
        """Return the emergency stop in force, or the last one."""
        with open_desk(self.address, self.token) as desk:
            return dict(desk.emergency)

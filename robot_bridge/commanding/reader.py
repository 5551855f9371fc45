"""What the commands with a step to come tell of the robots; nothing here changes any."""

from __future__ import annotations

from collections import Counter

from ..command_life.open_command import OpenCommand
from ..command_life.open_commands import OpenCommands
from ..messages import CommandState, SetPath, SetPosEnd
from ..polyline import Polyline


class CommandReader:
    """Answers from the open commands what robots are doing."""

    def __init__(self, open_commands: OpenCommands) -> None:
        self._open = open_commands

    def count(self) -> Counter[CommandState]:
        """Return how many open commands are in each state."""
        return Counter(command.report.state for command in self._open)

    def busy_with(self, robot: str) -> str | None:
        """Return the id of the command that makes the robot drive, if any."""
        moving = [c.report.command for c in self._open.of(robot) if c.is_motion]
        return moving[-1] if moving else None

    def task(self, robot: str) -> tuple[SetPosEnd | SetPath, float] | None:
        """Return what the robot is to drive, and how many metres of it (of a path) it has driven."""
        for command in reversed(self._open.of(robot)):
            if isinstance(command.message, (SetPosEnd, SetPath)):
                return command.message, command.driven or 0.0
        return None

    def line(self, robot: str) -> Polyline | None:
        """Return the path that the robot has taken on as a line, None where it has none."""
        moving = [c for c in self._open.of(robot) if c.is_motion]
        return moving[-1].line if moving else None

    def is_carrying_out(self, robot: str, command: str) -> bool:
        """Tell whether the command is the robot's task, and nobody has asked for its end."""
        mine = self._open.of(robot)
        task = self._open.get(command)
        aborted = any(c.is_abort and task is not None and c.sa_id > task.sa_id for c in mine)
        return command == self.busy_with(robot) and not aborted

    def is_being_aborted(self, robot: str, command: str) -> bool:
        """Tell whether an Abort is to end the command as soon as the robot says that it has taken that on.

        Not that of an emergency stop, after which nobody goes on before it is cleared.
        """
        task = self._open.get(command)
        aborts = [c for c in self._open.of(robot) if c.is_abort and task is not None and c.sa_id > task.sa_id]
        return bool(aborts) and not any(abort.is_emergency for abort in aborts)

    def carried_out(self, robot: str) -> OpenCommand | None:
        """Return the command that makes the robot drive, None also where somebody has asked for its end."""
        id = self.busy_with(robot)
        return self._open.get(id) if id is not None and self.is_carrying_out(robot, id) else None

    def is_open(self, command: str) -> bool:
        """Tell whether a command has a step to come."""
        return self._open.get(command) is not None

    def robot_of(self, command: str) -> str | None:
        """Return the robot of an open command."""
        known = self._open.get(command)
        return None if known is None else known.report.robot

    def awaits_abort(self, robot: str) -> bool:
        """Tell whether an Abort that is no emergency stop's is on its way to the robot."""
        return any(c.is_abort and not c.is_emergency and c.is_on_its_way for c in self._open.of(robot))

    def awaits_any_abort(self, robot: str) -> bool:
        """Tell whether an Abort is on its way to the robot, an emergency stop's or another."""
        return self.awaits_abort(robot) or self.awaits_stop(robot)

    def awaits_stop(self, robot: str) -> bool:
        """Tell whether the Abort of an emergency stop is on its way to the robot."""
        return any(c.is_emergency and c.is_on_its_way for c in self._open.of(robot))

    def undelivered(self) -> dict[int, str]:
        """Return the robot of every message that waits in SA, by the message's id."""
        return {sa_id: command.report.robot for sa_id, command in self._open.queued.items()}

    def robots(self) -> set[str]:
        """Return the robots that have a command with a step to come."""
        return {command.report.robot for command in self._open}

"""The open commands by their ids, by their robots and by their messages; no I/O."""

from __future__ import annotations

from collections.abc import Iterator, KeysView, Mapping

from ..messages import CommandState
from .open_command import OpenCommand


class OpenCommands:
    """Holds them so that what a pose or an OpAck concerns is found without looking at all of them.

    ``queued`` are those whose message waits in SA, by its id.
    """

    def __init__(self) -> None:
        self.queued: dict[int, OpenCommand] = {}
        self._by_id: dict[str, OpenCommand] = {}
        self._by_robot: dict[str, dict[str, OpenCommand]] = {}
        self._stored_driven: dict[str, float] = {}

    def __iter__(self) -> Iterator[OpenCommand]:
        return iter(list(self._by_id.values()))

    def get(self, command: str) -> OpenCommand | None:
        """Return a command by its id."""
        return self._by_id.get(command)

    @property
    def robots(self) -> KeysView[str]:
        """The robots that have open commands."""
        return self._by_robot.keys()

    def of(self, robot: str) -> list[OpenCommand]:
        """Return the commands of a robot, the oldest first."""
        mine = self._by_robot.get(robot)
        return list(mine.values()) if mine else []

    def put(self, command: OpenCommand) -> None:
        """Take in a command, in place of what was known of it."""
        report = command.report
        former = self._by_id.get(report.command)
        if former is not None:
            self.queued.pop(former.sa_id, None)
        self._by_id[report.command] = command
        self._by_robot.setdefault(report.robot, {})[report.command] = command
        if report.state is CommandState.QUEUED:
            self.queued[command.sa_id] = command
        if command.driven is None:
            self._stored_driven.pop(report.command, None)
        else:
            self._stored_driven[report.command] = command.driven

    def remove(self, command: str) -> None:
        """Forget a command that has ended."""
        former = self._by_id.pop(command, None)
        self._stored_driven.pop(command, None)
        if former is not None:
            self.queued.pop(former.sa_id, None)
            mine = self._by_robot[former.report.robot]
            del mine[command]
            if not mine:
                del self._by_robot[former.report.robot]

    def progress(self, least: float) -> dict[str, float]:
        """Return the metres driven of paths that have grown by ``least`` since they were noted."""
        return {
            id: driven
            for id, stored in self._stored_driven.items()
            if (driven := self._by_id[id].driven) is not None and driven - stored >= least
        }

    def note_progress(self, driven: Mapping[str, float]) -> None:
        """Take note of metres driven that are stored now."""
        self._stored_driven.update({id: metres for id, metres in driven.items() if id in self._stored_driven})

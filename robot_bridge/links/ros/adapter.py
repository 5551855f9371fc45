"""Base of the adapters of ROS robots: discovery of robots by topics, and stored notes on each."""

from __future__ import annotations

import json
import logging
from collections.abc import Callable, Mapping, Set
from functools import partial
from pathlib import Path
from typing import Any, Generic, TypeVar

from ...core.files import write_state
from ...core.json_decoder import DecodingError, decode_json
from ...core.messages.base import MessageError, check_robot_name
from ..base.adapter import Adapter, Command, Link, summary
from ..base.errors import CommandRefusedError, LinkError
from .messages import ACTIONS
from .robot import RosRobot
from .settings import RobotSettings

# --- Notes on each robot, stored for the next process of the link: one file, written whole ---

log = logging.getLogger(__name__)

Note = TypeVar("Note")


class RobotNotes:
    """A file of notes by robot. A full disk must not end a link, which must still stop its robots.

    ``fault`` is why the newest notes are not in the file, or None.
    """

    def __init__(self, file: Path) -> None:
        self._file = file
        self.fault: str | None = None

    def read(self, decode: Callable[[Any], Note]) -> dict[str, Note]:
        """Return the notes of an earlier process; none if unreadable.

        ``decode`` raises ValueError, TypeError or KeyError for an invalid note.
        """
        try:
            known = decode_json(self._file.read_bytes())
            return {str(robot): decode(note) for robot, note in known.items()}
        except FileNotFoundError:
            return {}
        except (OSError, DecodingError, ValueError, AttributeError, TypeError, KeyError) as error:
            log.warning("%s is left out: %s", self._file, error)
            return {}

    def write(self, notes: Mapping[str, Any]) -> None:
        """Replace the stored notes; an error is logged once, and kept as ``fault``."""
        try:
            write_state(self._file, json.dumps(notes).encode(), synced=False)
        except OSError as error:
            fault = f"{self._file} cannot be written: {error.strerror or error}"
            if self.fault is None:
                log.error("%s", fault)
            self.fault = fault
        else:
            self.fault = None


# --- Common base of ROS adapters: discovers robots, controls each separately, reports them together ---

MOST_ROBOTS = 5000
FAULT_LASTS = 5.0
"""seconds without another unforeseen error after which the alarm about a robot ends."""

Network = TypeVar("Network")
Make = Callable[[str], RosRobot[Network]]
UNKNOWN = "no robot of this name was found on the ROS network"


class RosAdapter(Adapter, Generic[Network]):
    """The robots of one network; with ``keeps_servers`` its notes are the identities of their servers."""

    def __init__(self, settings: RobotSettings, notes: RobotNotes, *, keeps_servers: bool = True) -> None:
        self.holds_s = settings.hold_s
        self._patterns = settings.patterns
        self._named = settings.robots
        self._notes = notes
        self._keeps_servers = keeps_servers
        self._robots: dict[str, RosRobot[Network]] = {}
        self._servers: dict[str, str] = notes.read(_server) if keeps_servers else {}
        self._refused: set[str] = set()
        self._failed: dict[tuple[str, str], float] = {}
        """When each step for a robot last failed; until it succeeds again."""
        self._met_servers: Set[str] = frozenset()
        servers = (*ACTIONS.values(), "stop")
        self._server_patterns = [self._patterns[one] for one in servers if one in self._patterns]

    async def command(self, command: Command) -> None:
        """Have a robot accept a command."""
        robot = self._robots.get(command.robot)
        if robot is None:
            raise CommandRefusedError(UNKNOWN)
        await robot.command(command)

    async def stop(self, robot: str, *, emergency: bool) -> None:
        """Stop a robot."""
        known = self._robots.get(robot)
        if known is None:
            raise CommandRefusedError(UNKNOWN)
        await known.stop()

    def admitted(self, robot: str) -> None:
        """Report the position of an admitted robot."""
        if robot in self._robots:
            self._robots[robot].admitted()

    def _find(
        self, topics: list[str], servers: Set[str], network: Network, make: Make[Network], now: float
    ) -> None:
        """Create robots by their position topics and servers, and connect all to the present network.

        A robot found by an action server or stop service alone says no position, and has to be stopped, too.
        """
        if not self._named:
            found = [self._patterns["position"].robot_of(topic) for topic in topics]
            for server in servers - self._met_servers:
                found += [pattern.robot_of(server) for pattern in self._server_patterns]
            self._met_servers = servers
            for name in found:
                if name is not None and name not in self._robots and name not in self._refused:
                    self._meet(name, make)
        for robot in self._robots.values():
            self._lead(robot, "connect", partial(robot.connect, network), now)
        self._note_servers()

    def _step(self, now: float) -> None:
        """Have each robot process what it received and continue."""
        for robot in self._robots.values():
            self._lead(robot, "receive", partial(robot.receive, now), now, FAULT_LASTS)
            self._lead(robot, "act", partial(robot.act, now), now, FAULT_LASTS)

    def _lead(
        self, robot: RosRobot[Network], step: str, work: Callable[[], None], now: float, lasts: float = 0.0
    ) -> None:
        """Do a step for a robot; an unforeseen error affects that step alone, and is logged once.

        It is an alarm until the step has succeeded for ``lasts`` seconds.
        """
        key = robot.name, step
        try:
            work()
        except LinkError:
            raise
        except Exception:
            if key not in self._failed:
                log.exception("robot %s: the link fails here, and goes on with the others", robot.name)
            self._failed[key] = now
        else:
            if now - self._failed.get(key, now) >= lasts:
                self._failed.pop(key, None)

    def _meet(self, name: str, make: Make[Network]) -> None:
        try:
            check_robot_name(name)
            if len(self._robots) >= MOST_ROBOTS:
                raise MessageError(f"more than {MOST_ROBOTS} robots were found; name yours in robots")
        except MessageError as error:
            self._refused.add(name)
            log.error("%s", error)
            return
        robot = self._robots[name] = make(name)
        known = self._servers.get(name)
        robot.expect_server(bytes.fromhex(known) if known else None)

    def _report(self, link: Link) -> None:
        unreached = self._network_faults()
        faults = [*unreached]
        faults += [f"{robot.name}: {text}" for robot in self._robots.values() for text in robot.faults]
        faults += [
            f"{name}: the link failed; its log says more"
            for name in sorted({name for name, _ in self._failed})
        ]
        faults += [] if self._notes.fault is None else [self._notes.fault]
        counts = {"found": float(len(self._robots))}
        link.report(ok=not faults, text=summary(faults), counts=counts, reached=not unreached)

    def _network_faults(self) -> list[str]:
        """Return the faults of the connection to all robots, as texts."""
        return []

    def _note_servers(self) -> None:
        """Store who serves the robots' tasks, so that the next process of this link detects restarts."""
        if not self._keeps_servers:
            return
        servers = {name: robot.server.hex() for name, robot in self._robots.items() if robot.server}
        if servers.items() <= self._servers.items() and self._notes.fault is None:
            return
        self._servers |= servers
        self._notes.write(self._servers)


def _server(key: str) -> str:
    """Return a participant's stored key; raises ValueError or TypeError if invalid."""
    return bytes.fromhex(key).hex()

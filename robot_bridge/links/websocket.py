"""Robots on WebSocket: JSON-RPC 2.0 with the operation codes of the paper as methods.

A robot's requests are calls (SendPos and Alive may be notifications), and the gateway's OpAck is the
result. The gateway's messages are calls whose id is that of the message; the robot's OpAck is the result,
or an error where it will not do it.
"""

from __future__ import annotations

from collections import Counter

from ..access.visitor import Visitor
from ..fleet import Fleet
from .robot_session import RobotSession


class WebSocketLink:
    """Serves the connections of robots; the one on which a robot said Ready last is the one that counts."""

    def __init__(self, fleet: Fleet) -> None:
        self._fleet = fleet
        self._names: Counter[str] = Counter()
        self._sessions: set[RobotSession] = set()
        self._holders: dict[str, RobotSession] = {}
        fleet.emergency.reach(self._stop_all)

    async def serve(self, connection: Visitor, robot: str | None) -> None:
        """Serve one connection to its end; without a name the robot is given one."""
        name = robot or self._free_name()
        session = RobotSession(self._fleet, connection, name, self._admit)
        self._names[name] += 1
        self._sessions.add(session)
        try:
            in_order = await session.run()
        finally:
            self._sessions.discard(session)
            self._names -= Counter([name])
            held = self._holders.get(name) is session
            if held:
                self._fleet.reception.holds.free(name, session)
                del self._holders[name]
        if in_order and held:
            self._fleet.closed(name)

    def measure(self) -> None:
        """Note the latency of every robot's connection."""
        for session in self._holders.values():
            session.measure()

    def _stop_all(self, call_id: str) -> None:
        for session in self._sessions:
            session.stop_now(call_id)

    def _admit(self, session: RobotSession) -> None:
        """Let ``session`` be the connection of its robot, and end the one before."""
        former = self._holders.get(session.robot)
        self._holders[session.robot] = session
        self._fleet.reception.holds.take(session.robot, session)
        if former is not None and former is not session:
            former.replace()

    def _free_name(self) -> str:
        taken = {*self._fleet.robots.names(), *self._names}
        return next(name for n in range(1, len(taken) + 2) if (name := f"robot-{n}") not in taken)

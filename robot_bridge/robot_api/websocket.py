"""Robots on WebSocket, by connections of their own and by links: which of them holds which robot."""

from __future__ import annotations

import logging
from collections import Counter

from ..access.gate import Gate
from ..access.visitor import Visitor
from ..fleet import Fleet
from ..link_watch import ConnectedLink
from ..monitoring.unforeseen import going_on
from .link_connection import LinkConnection
from .own_connection import OwnConnection
from .robot_session import RobotSession

log = logging.getLogger(__name__)


class WebSocketLink:
    """Serves the connections of robots; the one on which a robot said Ready last is the one that counts."""

    def __init__(self, fleet: Fleet) -> None:
        self._fleet = fleet
        self._names: Counter[str] = Counter()
        self._sessions: set[RobotSession] = set()
        self._links: set[LinkConnection] = set()
        self._holders: dict[str, RobotSession] = {}
        fleet.emergency.reach(self._stop_all)
        fleet.orders.reach(self._abort)

    async def serve(self, connection: Visitor, robot: str | None) -> None:
        """Serve one connection to its end; without a name the robot is given one."""
        name = robot or self._free_name()
        own = OwnConnection(self._fleet, connection, name, self._admit)
        self._names[name] += 1
        self._sessions.add(own.session)
        try:
            in_order = await own.run()
        finally:
            self._sessions.discard(own.session)
            self._names -= Counter([name])
            held = self._let_go(own.session)
        if in_order and held:
            self._fleet.closed(name)

    async def serve_link(self, connection: Visitor, gate: Gate) -> None:
        """Serve a link to its end. Its robots may drive on: they are lost by the ordinary clocks."""
        link = LinkConnection(self._fleet, connection, gate, self._admit, self._let_go)
        self._links.add(link)
        try:
            await link.run()
        finally:
            self._links.discard(link)
            for session in link.sessions():
                self._let_go(session)

    def links(self) -> list[ConnectedLink]:
        """Return the links that are connected now."""
        return [
            ConnectedLink(link.name, link.kind, link.status, len(link.sessions())) for link in self._links
        ]

    def update(self) -> None:
        """Note the latency of every robot's connection, and let go what links may not speak for any more."""
        for link in list(self._links):
            with going_on(log, f"looking after link {link.name}"):
                link.update()
        for session in self._holders.values():
            session.measure()

    def _stop_all(self, call_id: str) -> None:
        for link in list(self._links):
            with going_on(log, f"telling link {link.name} of an emergency stop"):
                link.stop_all(call_id)
        for session in list(self._sessions):
            with going_on(log, f"telling robot {session.robot!r} of an emergency stop"):
                session.stop_now(call_id)

    def _abort(self, robot: str, call_id: str) -> bool:
        """Send an Abort that cannot be stored; return whether the robot is connected."""
        session = self._holders.get(robot)
        if session is not None:
            session.stop_now(call_id, emergency=False)
        return session is not None

    def _admit(self, session: RobotSession) -> None:
        """Let ``session`` be the connection of its robot, and end the one before."""
        former = self._holders.get(session.robot)
        self._holders[session.robot] = session
        self._fleet.reception.holds.take(session.robot, session)
        if former is not None and former is not session:
            former.replace()

    def _let_go(self, session: RobotSession) -> bool:
        """Note that ``session`` is gone; return whether its robot was connected by it."""
        held = self._holders.get(session.robot) is session
        if held:
            self._fleet.reception.holds.free(session.robot, session)
            del self._holders[session.robot]
        return held

    def _free_name(self) -> str:
        taken = {*self._fleet.robots.names(), *self._names}
        return next(name for n in range(1, len(taken) + 2) if (name := f"robot-{n}") not in taken)

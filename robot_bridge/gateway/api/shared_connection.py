"""The place of one robot in a link: its channel, what it said that is still to be dealt with, its limits."""

from __future__ import annotations

import asyncio
import logging
from collections import deque
from collections.abc import Coroutine
from contextlib import AbstractAsyncContextManager
from typing import Any, Protocol

from websockets.exceptions import ConnectionClosed

from ...core.logs import log_and_continue
from ...core.messages.base import to_json
from ...core.messages.links import Released
from ...core.sites.settings_tables import LimitSettings
from ...protocol import jsonrpc
from ..auth.accounts import TokenKind
from ..auth.authorisation import PATHS
from ..auth.client_connection import RateLimit
from ..fleet.service import Fleet
from .robot_session import RobotSession, RobotSessions

log = logging.getLogger(__name__)

MOST_WAITING = 200
"""messages of one robot that wait to be dealt with; more are refused."""
SEPARATOR = "/"
"""Between the robot's name and the id of its message, in the ids of calls to a link: no name holds it."""

Work = Coroutine[Any, Any, None]


class SharedConnection(Protocol):
    """What the robots of a link share."""

    @property
    def name(self) -> str:
        """The name of the link."""

    @property
    def round_trip(self) -> float | None:
        """Seconds that the last ping took there and back."""

    def lane(self, *, urgent: bool, large: bool) -> AbstractAsyncContextManager[None]:
        """Wait for the turn of a message."""

    async def send(self, frame: str) -> None:
        """Write a frame."""

    def send_at_once(self, frame: str) -> bool:
        """Write a frame now; false where that cannot be."""

    async def answers(self) -> bool:
        """Tell whether the link is there."""

    def forget(self, place: LinkedRobotChannel) -> None:
        """Carry nothing more for the robot of ``place``."""


class LinkedRobotChannel:
    """One robot of a link, as its :class:`.robot_session.Channel`.

    A call to the link has the robot's name among its params, and before the id of the message in its own id;
    an error that answers no call says in its data which robot it is about.
    """

    def __init__(
        self,
        fleet: Fleet,
        shared: SharedConnection,
        robot: str,
        limits: LimitSettings,
        sessions: RobotSessions,
    ) -> None:
        self.robot = robot
        self._shared = shared
        rate, burst = limits.robot_messages_per_s, float(limits.robot_burst)
        self._messages, self._replies = RateLimit(rate, burst), RateLimit(rate, burst)
        self._waiting: deque[Work] = deque()
        self._working: asyncio.Task[None] | None = None
        self.session = RobotSession(fleet, self, robot, sessions)

    # --- the channel ----------------------------------------------------------------------------------------

    @property
    def name(self) -> str:
        """The name of the link."""
        return self._shared.name

    @property
    def endpoint(self) -> str:
        """The path that links connect to."""
        return PATHS[TokenKind.LINK]

    @property
    def round_trip(self) -> float | None:
        """Seconds that the link's last ping took there and back."""
        return self._shared.round_trip

    def call(self, method: str, params: Any = None, id: int | str | None = None) -> str:
        """Return the frame of a request about this robot."""
        call_id = None if id is None else f"{self.robot}{SEPARATOR}{id}"
        return jsonrpc.call(method, {"robot": self.robot, **(params or {})}, call_id)

    def result(self, id: int | str | None, value: Any) -> str:
        """Return the frame of a result."""
        return jsonrpc.result(id, value)

    def error(self, id: int | str | None, code: int, text: str) -> str:
        """Return the frame of an error, which names the robot."""
        return jsonrpc.error(id, code, text, {"robot": self.robot})

    def lane(self, *, urgent: bool, large: bool) -> AbstractAsyncContextManager[None]:
        """Wait for the turn of a message among those of the link's robots."""
        return self._shared.lane(urgent=urgent, large=large)

    async def send(self, frame: str) -> None:
        """Write a frame."""
        await self._shared.send(frame)

    def send_at_once(self, frame: str) -> bool:
        """Write a frame now; false where that cannot be."""
        return self._shared.send_at_once(frame)

    async def answers(self) -> bool:
        """Tell whether the link is there: whether the robot behind it is, only the link can know."""
        return await self._shared.answers()

    async def release(self, reason: str, *, again: bool = False) -> None:
        """Tell the link that it speaks for the robot no more."""
        self.end()
        self._shared.forget(self)
        released = to_json(Released(self.robot, reason))
        try:
            await self._shared.send(jsonrpc.call(Released.__name__, released))
        except ConnectionClosed:
            return

    # --- what comes in --------------------------------------------------------------------------------------

    def count(self) -> bool:
        """Count a message of the robot, and tell whether it is dealt with: it may have said too much."""
        return len(self._waiting) < MOST_WAITING and self._messages.consume()

    def count_reply(self) -> bool:
        """As :meth:`count`, of a reply: what the robot says of its place keeps no acknowledgement out.

        One that is kept out is asked for again.
        """
        is_room = len(self._waiting) < MOST_WAITING and self._replies.consume()
        if not is_room:
            self.session.ask_again()
        return is_room

    @property
    def wait(self) -> float:
        """Seconds after which the robot may say more."""
        return max(self._messages.wait(), 0.01)

    def listens(self) -> bool:
        """Tell whether a position can be taken in at once: nothing that came before it still waits."""
        return self._working is None and self.session.listens()

    def add(self, work: Work) -> None:
        """Deal with what the robot said behind all that it said before; no other robot waits for it."""
        self._waiting.append(work)
        if self._working is None:
            self._working = asyncio.create_task(self._work())

    async def _work(self) -> None:
        try:
            while self._waiting:
                what = f"link {self.name}: what robot {self.robot!r} said"
                with log_and_continue(log, what, except_for=ConnectionClosed):
                    await self._waiting.popleft()
        except ConnectionClosed:
            self._drop_waiting()
        finally:
            self._working = None

    def _drop_waiting(self) -> None:
        while self._waiting:
            self._waiting.popleft().close()

    def end(self) -> None:
        """Carry nothing more; what is being dealt with goes on to its end."""
        self.session.end()
        self._drop_waiting()

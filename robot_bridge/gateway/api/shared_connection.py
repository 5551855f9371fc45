"""The place of one robot in a link: its channel, its waiting messages, its limits."""

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
from .delivery import Interruptible
from .robot_session import RobotSession, RobotSessions

log = logging.getLogger(__name__)

MOST_WAITING = 200
"""messages of one robot that wait to be processed; more are refused."""
SEPARATOR = "/"
"""Separates the robot's name and the message id in the ids of calls to a link: no name contains it."""

Work = Coroutine[Any, Any, None]


class SharedConnection(Interruptible, Protocol):
    """The connection shared by the robots of a link."""

    @property
    def name(self) -> str:
        """The name of the link."""

    @property
    def round_trip(self) -> float | None:
        """Round-trip time of the last ping in seconds."""

    def lane(self, *, urgent: bool, large: bool) -> AbstractAsyncContextManager[None]:
        """Wait for the turn of a message."""

    def send_at_once(self, frame: str) -> bool:
        """Write a frame now; return false if that is impossible."""

    async def answers(self) -> bool:
        """Return whether the link is alive."""

    def forget(self, place: LinkedRobotChannel) -> None:
        """Stop carrying messages of the robot of ``place``."""


class LinkedRobotChannel:
    """One robot of a link, as its :class:`.robot_session.Channel`.

    A call to the link has the robot's name in its params, and before the message id in its own id; an error
    without a call names the robot in its data.
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
        """Round-trip time of the link's last ping in seconds."""
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
        """Write a frame now; return false if that is impossible."""
        return self._shared.send_at_once(frame)

    @property
    def is_busy(self) -> bool:
        """Whether a message of any robot of the link is being sent, or waits for its turn."""
        return self._shared.is_busy

    async def cut_if_busy(self) -> None:
        """Wait for the end of a long message of any robot of the link, or cut the connection."""
        await self._shared.cut_if_busy()

    async def answers(self) -> bool:
        """Return whether the link is alive: only the link knows whether the robot behind it is."""
        return await self._shared.answers()

    async def release(self, reason: str, *, again: bool = False) -> None:
        """Notify the link that it no longer speaks for the robot."""
        self.end()
        self._shared.forget(self)
        released = to_json(Released(self.robot, reason))
        try:
            await self._shared.send(jsonrpc.call(Released.__name__, released))
        except ConnectionClosed:
            return

    # --- incoming messages ---

    def count(self) -> bool:
        """Count a message of the robot; return whether it is processed, or exceeds the rate limit."""
        return len(self._waiting) < MOST_WAITING and self._messages.consume()

    def count_reply(self) -> bool:
        """As :meth:`count`, for a reply: positions of the robot must not crowd out acknowledgements.

        A refused reply is requested again.
        """
        is_room = len(self._waiting) < MOST_WAITING and self._replies.consume()
        if not is_room:
            self.session.ask_again()
        return is_room

    @property
    def wait(self) -> float:
        """Return the seconds until the robot may send more."""
        return max(self._messages.wait(), 0.01)

    def listens(self) -> bool:
        """Return whether a position can be processed at once: no earlier message waits."""
        return self._working is None and self.session.listens()

    def add(self, work: Work) -> None:
        """Queue work of the robot after its earlier messages; no other robot waits for it."""
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
        """Stop carrying messages; the one being processed is finished."""
        self.session.end()
        self._drop_waiting()

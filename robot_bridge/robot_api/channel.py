"""What carries the messages of one robot: a WebSocket of its own, or its place in a link of many."""

from __future__ import annotations

from contextlib import AbstractAsyncContextManager
from typing import Any, Protocol


class Channel(Protocol):
    """The way to and from one robot; frames are JSON-RPC 2.0 texts."""

    @property
    def name(self) -> str:
        """What operators see as the robot's link: ``websocket``, or the name of the link."""

    @property
    def round_trip(self) -> float | None:
        """Seconds that the last ping took there and back, None before the first."""

    def call(self, method: str, params: Any = None, id: int | str | None = None) -> str:
        """Return the frame of a request, or of a notification where ``id`` is None."""

    def result(self, id: int | str | None, value: Any) -> str:
        """Return the frame that answers the robot's call ``id``."""

    def error(self, id: int | str | None, code: int, text: str) -> str:
        """Return the frame that tells why the robot's call ``id`` failed."""

    def lane(self, *, urgent: bool, large: bool) -> AbstractAsyncContextManager[None]:
        """Wait for the turn of a message from the outbox: what is ``urgent`` waits for nothing.

        Many robots may share one connection: a ``large`` message of one is not to keep the others waiting.
        """

    async def send(self, frame: str) -> None:
        """Write a frame without waiting for a turn; raises ConnectionClosed."""

    async def answers(self) -> bool:
        """Tell whether the other end is there; takes a second at most."""

    async def release(self, reason: str) -> None:
        """Tell the other end that the robot has another connection now, and carry nothing more for it."""

"""Names across gateways: whether another robot runs under one is asked of the gateway that has it."""

from __future__ import annotations

import asyncio
import logging
import uuid
from typing import Protocol

from ...core.logs import log_and_continue
from .bus import own_subject
from .exchange import Exchange
from .messages import NameAnswer, NameQuery

log = logging.getLogger(__name__)

ANSWER_WITHIN_S = 1.5
"""seconds that a Ready waits for another gateway, which may take one to ask its robot."""


class NameHolder(Protocol):
    """The robots that say Ready to this gateway."""

    async def refusal(self, robot: str, magic: int) -> str | None:
        """Return why a Ready with ``magic`` is refused: another robot of that name is here. None if not."""


class NameClaims:
    """Asks other gateways of a robot's name, and answers them by ``holder``."""

    def __init__(self, exchange: Exchange, holder: NameHolder) -> None:
        self._exchange = exchange
        self._holder = holder
        self._asked: dict[str, asyncio.Future[str | None]] = {}
        self._answering: set[asyncio.Task[None]] = set()
        exchange.subscribe(NameQuery, self._begin_answer)
        exchange.subscribe(NameAnswer, self._answered)

    async def refusal(self, robot: str, magic: int, gateway: str) -> str | None:
        """Return why ``gateway``, which has ``robot``, keeps its name from a Ready with ``magic``.

        One that does not answer keeps nothing: its robots are to go on here.
        """
        id = uuid.uuid4().hex
        asked = self._asked[id] = asyncio.get_running_loop().create_future()
        try:
            if not self._exchange.send(
                own_subject(gateway), NameQuery(self._exchange.gateway, id, robot, magic)
            ):
                return None
            async with asyncio.timeout(ANSWER_WITHIN_S):
                refusal = await asked
        except TimeoutError:
            log.warning("gateway %s does not say whether another robot runs there as %r", gateway, robot)
            return None
        finally:
            del self._asked[id]
        return None if refusal is None else f"at gateway {gateway} {refusal}"

    def _begin_answer(self, query: NameQuery) -> None:
        task = asyncio.create_task(self._answer(query))
        self._answering.add(task)
        task.add_done_callback(self._answering.discard)

    async def _answer(self, query: NameQuery) -> None:
        with log_and_continue(log, f"answering gateway {query.gw} about robot {query.robot!r}"):
            refusal = await self._holder.refusal(query.robot, query.magic)
            answer = NameAnswer(self._exchange.gateway, query.id, refusal)
            self._exchange.send(own_subject(query.gw), answer)

    def _answered(self, answer: NameAnswer) -> None:
        asked = self._asked.get(answer.id)
        if asked is not None and not asked.done():
            asked.set_result(answer.refusal)

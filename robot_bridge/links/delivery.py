"""How a robot's outbox goes out over its connection, and an emergency stop before anything else."""

from __future__ import annotations

import asyncio
import logging
from typing import Any

from websockets.asyncio.server import ServerConnection
from websockets.exceptions import ConnectionClosed

from .. import jsonrpc
from ..emergency.stops import HELD_BACK
from ..errors import StoreError
from ..fleet import Fleet
from ..messages import Abort, to_json
from ..store.answers import AnswerRow
from ..wire import parse_params, with_base64

log = logging.getLogger(__name__)

RETRY_AFTER = 1.0
"""seconds after which the outbox is looked at again when the database could not be read."""


class Delivery:
    """Sends one robot what waits for it, for as long as its connection is open."""

    def __init__(self, fleet: Fleet, connection: ServerConnection, robot: str) -> None:
        self._fleet = fleet
        self._connection = connection
        self._robot = robot
        self._work: asyncio.Task[None] | None = None
        self._stops = 0
        self._stopping: set[asyncio.Task[None]] = set()

    def begin(self) -> None:
        """Deliver the outbox from its beginning: what was not acknowledged is sent again."""
        self.end()
        self._work = asyncio.create_task(self._deliver())

    def end(self) -> None:
        """Deliver nothing more."""
        if self._work is not None:
            self._work.cancel()

    def stop_now(self, call_id: str) -> None:
        """Send the robot the Abort of an emergency stop, before anything that was not sent yet.

        It does not wait for the database; the same Abort follows from the outbox under an id of its own.
        """
        self._stops += 1
        frame = jsonrpc.call(Abort.__name__, to_json(Abort(emergency=True)), call_id)
        task = asyncio.create_task(self._send(frame))
        self._stopping.add(task)
        task.add_done_callback(self._stopping.discard)

    async def _send(self, frame: str) -> None:
        try:
            await self._connection.send(frame)
        except ConnectionClosed:
            return

    async def _deliver(self) -> None:
        event = self._fleet.mailboxes.event(self._robot)
        last = {False: 0, True: 0}
        while True:
            event.clear()
            try:
                if await self._send_waiting(last):
                    await event.wait()
            except ConnectionClosed:
                return
            except StoreError as error:
                log.error("link websocket: robot %r: %s", self._robot, error)
                await asyncio.sleep(RETRY_AFTER)

    async def _send_waiting(self, last: dict[bool, int]) -> bool:
        """Send the messages above ``last``, by urgency; return false when a stop made them out of date."""
        stops = self._stops
        for row in await self._fleet.mailboxes.outbox(self._robot, last[False], last[True]):
            # Noted first: it must never be taken back as something that the robot cannot have. All else is
            # noted afterwards, so that no Abort waits for the database, nor behind what does.
            drives = row.op in HELD_BACK
            is_due = not drives or await self._fleet.mailboxes.hand_over(self._robot, row.id)
            if self._stops != stops:
                return False
            if is_due:
                await self._connection.send(jsonrpc.call(row.op, _params(row), row.id))
            last[row.urgent] = row.id
            if not drives:
                await self._fleet.mailboxes.delivered([row.id])
        return True


def _params(row: AnswerRow) -> dict[str, Any]:
    params: dict[str, Any] = parse_params(row.op, row.params) or {}
    return with_base64(row.op, params, row.payload)

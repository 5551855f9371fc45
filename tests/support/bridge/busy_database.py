"""A database whose thread is busy, so that all that is asked meanwhile waits for it together."""

from __future__ import annotations

import asyncio
import contextlib
import threading
from collections.abc import AsyncIterator, Coroutine
from typing import Any

from robot_bridge.gateway.storage.database import Database


@contextlib.asynccontextmanager
async def kept_busy(database: Database) -> AsyncIterator[threading.Event]:
    """Let the thread of ``database`` wait until the event is set, or the context ends."""
    begun, go = threading.Event(), threading.Event()

    def wait(_connection: object) -> None:
        begun.set()
        go.wait(20)

    waiting = asyncio.ensure_future(database.run(wait))
    await asyncio.to_thread(begun.wait)
    try:
        yield go
    finally:
        go.set()
        await waiting


async def done_together(database: Database, *asked: Coroutine[Any, Any, Any]) -> list[Any]:
    """Return results and errors of what each asks of ``database``, when all of it waits for it at once."""
    async with kept_busy(database) as go:
        tasks = [asyncio.ensure_future(one) for one in asked]
        while database.waiting < len(asked):
            await asyncio.sleep(0)
        go.set()
        return await asyncio.gather(*tasks, return_exceptions=True)

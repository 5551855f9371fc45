"""An adapter as a process: from its settings to its exit status."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import signal
from collections.abc import Callable, Coroutine
from typing import Any

from ...core.systemd import call_at_end_of_input, notify
from .adapter import Adapter
from .client import LinkClient
from .errors import FrameChangedError, LinkError
from .memory import LinkMemory, only_process
from .settings import LinkSettings

log = logging.getLogger(__name__)

Load = Callable[[], tuple[LinkSettings, Adapter]]


def run(load: Load, *, until_stdin_closes: bool = False) -> None:
    """Run an adapter until SIGTERM or SIGINT; raises BridgeError for faults to put right.

    Also ``until_stdin_closes``, which happens when the gateway that started this ends in any way.
    ``load`` returns its settings and the adapter: again for a site of another frame.
    """
    asyncio.run(_run_until_stdin_closes(_serve_frames(load), until_stdin_closes))


async def _serve_frames(load: Load) -> None:
    """Run adapters, each on sites of one frame: no coordinates are kept for the next one."""
    while True:
        settings, adapter = load()
        try:
            await serve(settings, adapter)
        except FrameChangedError as error:
            log.warning("%s", error)


async def serve(settings: LinkSettings, adapter: Adapter) -> None:
    """Run an adapter and its connection to the gateway until one of them fails, or this is cancelled."""
    async with only_process(settings.memory_file):
        await _connect(settings, adapter)


async def _connect(settings: LinkSettings, adapter: Adapter) -> None:
    client = LinkClient(settings, adapter, LinkMemory(settings.memory_file))
    connecting = asyncio.create_task(client.run())
    adapting = asyncio.create_task(_adapt(client, adapter))
    try:
        done, _ = await asyncio.wait({connecting, adapting}, return_when=asyncio.FIRST_COMPLETED)
        for task in done:
            task.result()
        raise LinkError(f"link {settings.name}: the {adapter.kind} side ended")
    finally:
        for task in (connecting, adapting):
            task.cancel()
        await asyncio.gather(connecting, adapting, return_exceptions=True)


async def _adapt(client: LinkClient, adapter: Adapter) -> None:
    await client.site_known()
    notify("READY=1", f"STATUS=connected to {client.settings.gateway.url}")
    await adapter.run(client)


async def _run_until_stdin_closes(work: Coroutine[Any, Any, None], until_stdin_closes: bool) -> None:
    stop = asyncio.Event()
    if until_stdin_closes:
        call_at_end_of_input(stop.set)
    for number in (signal.SIGINT, signal.SIGTERM):
        asyncio.get_running_loop().add_signal_handler(number, stop.set)
    working, stopping = asyncio.create_task(work), asyncio.create_task(stop.wait())
    await asyncio.wait({working, stopping}, return_when=asyncio.FIRST_COMPLETED)
    stopping.cancel()
    if working.done():
        await working
    working.cancel()
    with contextlib.suppress(asyncio.CancelledError):
        await working

"""A real link in the test's own process: an adapter whose robots obey, or do not, as the test says."""

from __future__ import annotations

import asyncio
import contextlib
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from robot_bridge.core.clock import LONGEST_PAUSE_S
from robot_bridge.links.base.adapter import Adapter, Command
from robot_bridge.links.base.client import LinkClient
from robot_bridge.links.base.memory import LinkMemory
from robot_bridge.links.base.settings import read_settings


class ObedientAdapter(Adapter):
    """Keeps what its robots are told; ``during`` is awaited while one is told something."""

    def __init__(self, kind: str = "obedient") -> None:
        self.kind = kind
        self.commands: list[Command] = []
        self.stops: list[tuple[str, bool]] = []
        self.stops_of_unannounced = 0
        self.refusals: list[tuple[str, str]] = []
        self.during: Callable[[Command], Any] | None = None

    async def run(self, link: LinkClient) -> None:
        await asyncio.Event().wait()

    async def command(self, command: Command) -> None:
        self.commands.append(command)
        if self.during is not None:
            await self.during(command)

    async def stop(self, robot: str, *, emergency: bool) -> None:
        self.stops.append((robot, emergency))

    def stop_unannounced(self) -> None:
        self.stops_of_unannounced += 1

    def refused(self, robot: str, reason: str) -> None:
        self.refusals.append((robot, reason))


class LinkOnTheLine:
    """A :class:`LinkClient` that runs in a thread of its own, and is asked from the test's."""

    def __init__(
        self,
        bridge: Any,
        folder: Path,
        name: str = "test",
        token: str | None = None,
        kind: str = "obedient",
        longest_pause_s: float = LONGEST_PAUSE_S,
    ) -> None:
        self._longest_pause_s = longest_pause_s
        lines = ["[gateway]", f'url = "{bridge.address}/link"']
        if token is not None:
            (folder / f"{name}.token").write_text(token, encoding="utf-8")
            (folder / f"{name}.token").chmod(0o600)
            lines.append(f'token_file = "{name}.token"')
        file = folder / f"{name}.toml"
        file.write_text("\n".join(lines), encoding="utf-8")
        from robot_bridge.links.tracker.adapter import TrackerSettings

        self._settings, _ = read_settings(file, "tracker", TrackerSettings)
        self.adapter = ObedientAdapter(kind)
        self.start()

    def start(self) -> None:
        """Begin to connect, with what is remembered on the disk."""
        self._loop = asyncio.new_event_loop()
        memory = LinkMemory(self._settings.memory_file)
        self.client = LinkClient(self._settings, self.adapter, memory, self._longest_pause_s)
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def _run(self) -> None:
        asyncio.set_event_loop(self._loop)
        self._task = self._loop.create_task(self.client.run())
        with contextlib.suppress(asyncio.CancelledError):
            self._loop.run_until_complete(self._task)

    def do(self, method: str, *arguments: Any, **options: Any) -> Any:
        """Call a method of the client in its loop; await what it returns."""

        async def work() -> Any:
            done = getattr(self.client, method)(*arguments, **options)
            return await done if asyncio.iscoroutine(done) else done

        return asyncio.run_coroutine_threadsafe(work(), self._loop).result(20)

    @contextlib.contextmanager
    def standing_still(self, seconds: float) -> Iterator[None]:
        """Have it do nothing until the block ends, for ``seconds`` at least, as a program that is held."""
        goes_on, until = threading.Event(), time.monotonic() + seconds
        self._loop.call_soon_threadsafe(goes_on.wait)
        try:
            yield
            # How long it stood is what it judges by when it goes on.
            time.sleep(max(0.0, until - time.monotonic()))
        finally:
            goes_on.set()

    def kill(self) -> None:
        """End it with all that it is doing."""

        def cancel_all() -> None:
            for task in asyncio.all_tasks(self._loop):
                task.cancel()

        if self._thread.is_alive():
            self._loop.call_soon_threadsafe(cancel_all)
            self._thread.join(10)

    def end(self) -> None:
        """End it for good."""
        self.kill()
        self._loop.close()

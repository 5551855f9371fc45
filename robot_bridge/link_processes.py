"""Links that a site names: each is started as a process of its own, and started again when it ends."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import os
import sys
import time
from collections.abc import Mapping, Sequence
from pathlib import Path

from .link_watch import LinkProcess
from .sites.settings_tables import LinkOptions

log = logging.getLogger(__name__)

FIRST_WAIT, LONGEST_WAIT = 1.0, 60.0
"""seconds between two starts; each time twice as long, until one has lasted for LONGEST_WAIT."""
END_WITHIN = 1.0
"""seconds that a process has to end in good order: a gateway ends within five in all."""
URL = "ROBOT_BRIDGE_LINK_URL"
"""The environment variable that tells a link where its gateway is, unless its settings do."""


class LinkProcesses:
    """Keeps the links going that ``options`` name, with settings in the site's ``folder``."""

    def __init__(self, options: LinkOptions, folder: Path) -> None:
        self._processes = [
            LinkProcess(Path(file).stem, kind, folder / file) for kind, file in options.files()
        ]

    @property
    def states(self) -> Sequence[LinkProcess]:
        """How each of them is."""
        return self._processes

    async def run(self, url: str) -> None:
        """Keep them going until cancelled, with the gateway at ``url``; then end them."""
        async with asyncio.TaskGroup() as group:
            for one in self._processes:
                group.create_task(self._keep(one, url))
            # Without any, nothing would be left to wait for.
            await asyncio.Event().wait()

    async def _keep(self, one: LinkProcess, url: str) -> None:
        wait = FIRST_WAIT
        while True:
            began = time.monotonic()
            try:
                one.fault = await self._run_once(one, url)
            except Exception as error:
                # What goes wrong with one link ends no other, whose robots could not be stopped then.
                log.exception("link %s: unexpected %s", one.name, type(error).__name__)
                one.fault = f"it cannot be kept going: {error}"
            if time.monotonic() - began > LONGEST_WAIT:
                wait = FIRST_WAIT
            log.error("link %s ended: %s; it is started again in %g s", one.name, one.fault, wait)
            await asyncio.sleep(wait)
            wait = min(wait * 2, LONGEST_WAIT)

    async def _run_once(self, one: LinkProcess, url: str) -> str:
        """Run a link to its end; return why it ended."""
        try:
            process = await asyncio.create_subprocess_exec(
                *(sys.executable, "-m", "robot_bridge", "link", one.kind, "--config", str(one.file)),
                "--until-stdin-closes",
                stdin=asyncio.subprocess.PIPE,
                stderr=asyncio.subprocess.PIPE,
                env=_environment(url),
            )
        except OSError as error:
            return f"it cannot be started: {error.strerror or error}"
        one.starts, one.pid, one.fault = one.starts + 1, process.pid, None
        log.info("link %s runs as process %d", one.name, process.pid)
        passing = asyncio.create_task(_pass_on(process.stderr))
        try:
            status = await process.wait()
            return await passing or f"exit status {status}"
        finally:
            one.pid = None
            await _end(process)
            passing.cancel()


def _environment(url: str) -> Mapping[str, str]:
    """Return the environment of a link: whom systemd watches is the gateway alone."""
    left_out = ("NOTIFY_SOCKET", "WATCHDOG_USEC")
    own = {name: value for name, value in os.environ.items() if name not in left_out}
    return {**own, URL: url}


async def _pass_on(lines: asyncio.StreamReader | None) -> str:
    """Write what a link says into this log's stream; return its last line, which says why it ended."""
    last = ""
    while lines is not None and (line := await _line(lines)):
        sys.stderr.write(line)
        last = line.strip() or last
    return last.removeprefix("robot-bridge: ")[:300]


async def _line(lines: asyncio.StreamReader) -> str:
    try:
        return (await lines.readline()).decode("utf-8", "replace")
    except ValueError:  # longer than any line of a log
        return (await lines.read(65_536)).decode("utf-8", "replace")


async def _end(process: asyncio.subprocess.Process) -> None:
    if process.returncode is not None:
        return
    with contextlib.suppress(ProcessLookupError):
        process.terminate()
    try:
        async with asyncio.timeout(END_WITHIN):
            await process.wait()
    except TimeoutError:
        with contextlib.suppress(ProcessLookupError):
            process.kill()
        await process.wait()

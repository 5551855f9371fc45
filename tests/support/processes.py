"""Processes that end when what started them ends, however it ends; and ports for them."""

from __future__ import annotations

import contextlib
import os
import random
import re
import shutil
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Collection, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from types import FrameType
from typing import Any, ClassVar
from weakref import WeakSet

from tests.support.errors import StageError
from tests.support.forked_programs import BRIDGE, LINK_MODULES, Program, start_forked
from tests.support.patience import BUSY

PATIENCE_S = 5.0
"""How long a process may take to end after SIGTERM before it is killed."""


def dying_with_this(command: Sequence[str | Path]) -> list[str]:
    """Return a command that is killed when this program ends, even when that is killed itself.

    The system goes by the thread that starts the command.

    :raises StageError: when the system has no setpriv.
    """
    # Not by PATH: whoever starts a stage may narrow that to what its programs shall find.
    setpriv = shutil.which("setpriv", path=os.defpath)
    if setpriv is None:
        raise StageError(f"setpriv is not in {os.defpath}: install util-linux")
    return [setpriv, "--pdeathsig", "KILL", *map(str, command)]


class Processes:
    """A context that starts processes, keeps their output in files, and ends each by its id at the end."""

    open_ones: ClassVar[WeakSet[Processes]] = WeakSet()

    def __init__(self, logs: Path):
        self._logs = logs
        self._running: dict[str, subprocess.Popen[bytes]] = {}
        self.open_ones.add(self)

    def __enter__(self) -> Processes:
        self._logs.mkdir(parents=True, exist_ok=True)
        return self

    def __exit__(self, *_: object) -> None:
        for name in reversed(list(self._running)):
            self.end(name)

    def start(
        self, name: str, command: Sequence[str | Path], *, env: Mapping[str, str] | None = None
    ) -> subprocess.Popen[bytes]:
        """Start ``command`` with ``env`` added to the environment; its output goes to ``NAME.log``."""
        with self.log(name).open("wb") as log:
            process = subprocess.Popen(
                dying_with_this(command),
                stdin=subprocess.DEVNULL,
                stdout=log,
                stderr=subprocess.STDOUT,
                env={**os.environ, "PYTHONUNBUFFERED": "1", **(env or {})},
            )
        self._running[name] = process
        return process

    def start_bridge(
        self, name: str, words: Sequence[Any], *, env: Mapping[str, str] | None = None
    ) -> subprocess.Popen[bytes]:
        """Start ``robot-bridge`` with ``words``, as :meth:`start` does, and without loading its modules."""
        link, kind = [*map(str, words), "", ""][:2]
        modules = LINK_MODULES.get(kind, ()) if link == "link" else ()
        return self.start_forked(BRIDGE, name, words, env=env, modules=modules)

    def start_forked(
        self,
        program: Program,
        name: str,
        words: Sequence[Any],
        *,
        env: Mapping[str, str] | None = None,
        modules: Sequence[str] = (),
        network: Path | None = None,
    ) -> subprocess.Popen[bytes]:
        """Start a program with ``words``, as :meth:`start` does, and without loading its ``modules``.

        ``network`` is the file of a namespace of networks, where it is to run in one of its own.
        """
        said = {"PYTHONUNBUFFERED": "1", **(env or {})}
        with self.log(name).open("wb") as log:
            process = start_forked(program, words, log, said, modules=modules, network=network)
        self._running[name] = process
        return process

    def log(self, name: str) -> Path:
        """Return the file that holds what process ``name`` printed."""
        return self._logs / f"{name}.log"

    def wait_for_line(self, name: str, pattern: str, seconds: float) -> re.Match[str]:
        """Return the match of ``pattern`` in the output of ``name``.

        :raises StageError: when the process ends, or ``seconds`` pass, before it printed that.
        """
        until = time.monotonic() + seconds
        while True:
            ended = self._running[name].poll()
            text = self.log(name).read_text(encoding="utf-8", errors="replace")
            if found := re.search(pattern, text):
                return found
            if ended is not None:
                raise StageError(f"{name} ended with status {ended} before it was ready{_said(text)}")
            if time.monotonic() > until:
                raise StageError(f"{name} was not ready after {seconds:.0f} s{_said(text)}")
            time.sleep(0.05)

    def wait(self, name: str, seconds: float | None = None) -> int:
        """Return the exit status of ``name``.

        :raises StageError: when it is still running after ``seconds``.
        """
        try:
            return self._running[name].wait(seconds)
        except subprocess.TimeoutExpired:
            text = self.log(name).read_text(encoding="utf-8", errors="replace")
            raise StageError(f"{name} was still running after {seconds:.0f} s{_said(text)}") from None

    def require_running(self, *, but: Collection[str] = ()) -> None:
        """Raise StageError when a process has ended that is none of ``but``."""
        for name, process in self._running.items():
            if name not in but and process.poll() is not None:
                text = self.log(name).read_text(encoding="utf-8", errors="replace")
                raise StageError(f"{name} ended with status {process.returncode}{_said(text)}")

    def reports(self, lines: int) -> Iterator[tuple[str, str]]:
        """Yield of each process its name with whether it runs, and the last ``lines`` that it printed."""
        for name, process in self._running.items():
            status = process.poll()
            state = "runs" if status is None else f"ended with status {status}"
            text = self.log(name).read_text(encoding="utf-8", errors="replace")
            yield f"{name}, which {state}", "\n".join(text.splitlines()[-lines:])

    @contextmanager
    def halted(self, name: str) -> Iterator[None]:
        """Let process ``name`` stand still inside the block, as one that has no time."""
        freeze(self._running[name].pid)
        try:
            yield
        finally:
            self._running[name].send_signal(signal.SIGCONT)

    def end(self, name: str) -> None:
        """End process ``name`` if it still runs, gently first."""
        process = self._running.pop(name)
        if process.poll() is not None:
            return
        process.terminate()
        try:
            process.wait(PATIENCE_S)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()


def _said(text: str) -> str:
    last = [line for line in text.splitlines() if line.strip()][-5:]
    return "; it said:\n  " + "\n  ".join(last) if last else "; it said nothing"


def free_port() -> int:
    """Return a port on loopback that nobody listens on and no client is given while a server is down."""
    lowest = int(Path("/proc/sys/net/ipv4/ip_local_port_range").read_text(encoding="ascii").split()[0])
    for port in random.sample(range(10_000, max(lowest, 20_000)), 100):
        with socket.socket() as probe, contextlib.suppress(OSError):
            probe.bind(("127.0.0.1", port))
            return port
    raise StageError("100 ports of 127.0.0.1 from 10000 on were all taken")


def is_running(pid: int) -> bool:
    """Whether a process is there and has not ended; one that nobody has waited for yet has."""
    return _state(Path(f"/proc/{pid}")) not in "ZX"


def freeze(pid: int) -> None:
    """Let a process stand still: all its threads do when this returns. ``SIGCONT`` wakes it.

    :raises ProcessLookupError: when it has ended; StageError when it does not stop.
    """
    os.kill(pid, signal.SIGSTOP)
    until = time.monotonic() + BUSY * PATIENCE_S
    # Each thread stops when it is given time next, and does something until then.
    while any(_state(thread) not in "TtXZ" for thread in Path(f"/proc/{pid}/task").glob("[0-9]*")):
        if time.monotonic() > until:
            raise StageError(f"process {pid} does not stop")
        # The kernel tells nobody but the parent that a thread has stopped.
        time.sleep(0.001)


def _state(process: Path) -> str:
    """Return the state of a process or a thread by its folder, as ``ps`` names it; X where it is gone."""
    try:
        stat = (process / "stat").read_text(encoding="ascii", errors="replace")
    except (FileNotFoundError, ProcessLookupError):
        return "X"
    return stat.rpartition(")")[2].split()[0]


def left_running(folder: Path) -> set[int]:
    """Return the processes that have ``folder`` in their environment or command."""
    found = set()
    for process in Path("/proc").glob("[0-9]*"):
        try:
            text = (process / "environ").read_bytes() + (process / "cmdline").read_bytes()
        except OSError:
            continue
        if str(folder).encode() in text:
            found.add(int(process.name))
    return found


def leave_on_signals() -> None:
    """Make SIGTERM and a closed terminal end this program the way an exception does, so that contexts end."""
    for number in (signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, _leave)


def _leave(number: int, _: FrameType | None) -> None:
    sys.exit(128 + number)

"""A database server that no longer answers."""

from __future__ import annotations

import contextlib
import os
import signal
from collections.abc import Iterator
from pathlib import Path

from tests.support.databases.database_server import DatabaseServer


def tree_of(pid: int) -> list[int]:
    """Return a process and all that it has started."""
    children = Path(f"/proc/{pid}/task/{pid}/children").read_text(encoding="ascii").split()
    return [pid, *(found for child in children for found in tree_of(int(child)))]


@contextlib.contextmanager
def frozen(server: DatabaseServer) -> Iterator[None]:
    """A server that does nothing, while its computer keeps its connections open."""
    processes = tree_of(server.pid)
    for pid in processes:
        os.kill(pid, signal.SIGSTOP)
    try:
        yield
    finally:
        for pid in processes:
            with contextlib.suppress(ProcessLookupError):
                os.kill(pid, signal.SIGCONT)

"""A database server that no longer answers."""

from __future__ import annotations

import contextlib
import os
import signal
from collections.abc import Iterator

from tests.support.databases.database_server import DatabaseServer, children_of
from tests.support.processes import freeze


def stop_tree(pid: int) -> list[int]:
    """Stop a process and all that it has started; return those that were there.

    Each is stopped before its children are listed: it starts no others meanwhile. A child may have ended.
    """
    try:
        freeze(pid)
        children = children_of(pid)
    except (ProcessLookupError, FileNotFoundError):
        return []
    return [pid, *(found for child in children for found in stop_tree(child))]


@contextlib.contextmanager
def frozen(server: DatabaseServer) -> Iterator[None]:
    """A server that does nothing, while its computer keeps its connections open."""
    processes = stop_tree(server.pid)
    try:
        yield
    finally:
        for pid in processes:
            with contextlib.suppress(ProcessLookupError):
                os.kill(pid, signal.SIGCONT)

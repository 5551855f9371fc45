"""Notifications to systemd (sd_notify(3)), and the end of standard input when the parent process is gone."""

from __future__ import annotations

import asyncio
import contextlib
import os
import socket
from collections.abc import Callable

# --- systemd: the service is ready, alive or ending ---


def notify(*states: str) -> None:
    """Send the service manager ``states`` such as ``READY=1``, if it started this process and listens."""
    address = os.environ.get("NOTIFY_SOCKET", "")
    if not address.startswith(("/", "@")):
        return
    # A leading @ stands for the zero byte of a name in the abstract namespace.
    path = "\0" + address[1:] if address.startswith("@") else address
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as link, contextlib.suppress(OSError):
        link.settimeout(1)
        link.sendto("\n".join(states).encode(), path)


def watchdog_interval() -> float | None:
    """Return the interval in seconds for sending WATCHDOG=1: half of systemd's limit; None for never."""
    limit, process = os.environ.get("WATCHDOG_USEC", ""), os.environ.get("WATCHDOG_PID", "")
    if not limit.isdigit() or process not in ("", str(os.getpid())):
        return None
    return int(limit) / 1e6 / 2


# --- Standard input: the parent holds its other end, and is gone when that closes ---

_STDIN = 0


def call_at_end_of_input(called: Callable[[], object]) -> None:
    """Have the running event loop call ``called`` once standard input, a pipe, is closed at its other end.

    That happens however the program at that end terminated, also when it was killed.
    """
    loop = asyncio.get_running_loop()

    def read() -> None:
        if not os.read(_STDIN, 4096):
            loop.remove_reader(_STDIN)
            called()

    loop.add_reader(_STDIN, read)

"""Parent process of a program: notifications to systemd (sd_notify(3)), and the end of standard input."""

from __future__ import annotations

import asyncio
import contextlib
import os
import socket
from collections.abc import Callable

# --- systemd: the service is ready, alive or ending ---


def notify(*states: str) -> None:
    """Tell the service manager ``states`` such as ``READY=1``, when it started this process and listens."""
    address = os.environ.get("NOTIFY_SOCKET", "")
    if not address.startswith(("/", "@")):
        return
    # A name that begins with @ stands for one in the abstract namespace, which begins with a zero byte.
    path = "\0" + address[1:] if address.startswith("@") else address
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as link, contextlib.suppress(OSError):
        link.settimeout(1)
        link.sendto("\n".join(states).encode(), path)


def watchdog_interval() -> float | None:
    """Return after how many seconds systemd is sent WATCHDOG=1: half its limit; None for never."""
    limit, process = os.environ.get("WATCHDOG_USEC", ""), os.environ.get("WATCHDOG_PID", "")
    if not limit.isdigit() or process not in ("", str(os.getpid())):
        return None
    return int(limit) / 1e6 / 2


# --- Standard input: whoever started the program holds its other side, and is gone when it closes ---

_STDIN = 0


def call_at_end_of_input(called: Callable[[], object]) -> None:
    """Have the running event loop call ``called`` once standard input, a pipe, is closed at its other side.

    That happens however the program at that side ended, also when it was killed.
    """
    loop = asyncio.get_running_loop()

    def read() -> None:
        if not os.read(_STDIN, 4096):
            loop.remove_reader(_STDIN)
            called()

    loop.add_reader(_STDIN, read)

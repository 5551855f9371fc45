"""Notifications to systemd that the service is ready, alive or ending; see sd_notify(3)."""

from __future__ import annotations

import contextlib
import os
import socket


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

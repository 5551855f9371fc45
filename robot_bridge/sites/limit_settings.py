"""Table ``[limits]`` of ``site.toml``: what the gateway takes from whoever connects."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any


def _number(default: float, least: float, most: float) -> Any:
    return field(default=default, metadata={"least": least, "above": False, "most": most})


@dataclass(frozen=True)
class LimitSettings:
    """What the gateway takes from whoever connects, before it refuses and then closes.

    ``robot_messages_per_s`` and ``desk_messages_per_s`` are for each connection, with a burst of so many at
    once; each robot of a link has those of a robot, and the link ``link_messages_per_s`` for all its frames.
    ``robots``, ``desks`` and ``links`` are connections in all, ``per_address`` those of one kind from one
    IP address, ``desks_per_account`` those of one operator. ``pending_per_address`` counts those
    from one address that have not been let in yet; they have ``handshake_s`` for that, and the oldest
    makes room for one more. Whoever was let in has ``first_message_s`` to say something; until then a
    desk makes room for another one. A robot may be silent for ``silent_s`` at most. A client that takes
    nothing of what is sent to it for ``stuck_s`` is cut off; ``send_buffer_bytes`` is what may wait for
    it in the system. ``origins`` are the web pages, as ``https://host:port``, whose scripts may connect.
    ``hosts`` are names of this computer under which the gateway's own pages may be asked for, beside those
    of its certificate.

    A robot that says to be more than ``place_within_m`` outside the site's bounds, or more than ``leap_m``
    from where it was a moment ago, is not believed and keeps its place on the map.
    """

    largest_message_bytes: int = _number(1_048_576, 1024, 256_000_000)
    robot_messages_per_s: float = _number(100.0, 1.0, 1e6)
    robot_burst: int = _number(300, 1, 1_000_000)
    desk_messages_per_s: float = _number(50.0, 1.0, 1e6)
    desk_burst: int = _number(200, 1, 1_000_000)
    robots: int = _number(2000, 1, 100_000)
    link_messages_per_s: float = _number(20_000.0, 1.0, 1e6)
    link_burst: int = _number(20_000, 1, 1_000_000)
    desks: int = _number(200, 1, 100_000)
    links: int = _number(50, 1, 10_000)
    per_address: int = _number(1200, 1, 100_000)
    desks_per_account: int = _number(10, 1, 1000)
    pending_per_address: int = _number(1000, 1, 100_000)
    handshake_s: float = _number(5.0, 0.1, 60.0)
    first_message_s: float = _number(30.0, 0.1, 3600.0)
    silent_s: float = _number(300.0, 1.0, 86400.0)
    stuck_s: float = _number(10.0, 0.1, 600.0)
    send_buffer_bytes: int = _number(262_144, 16_384, 64_000_000)
    failed_logins_per_minute: float = _number(10.0, 1.0, 1e6)
    place_within_m: float = _number(10_000.0, 1.0, 1e7)
    leap_m: float = _number(100.0, 0.1, 1e7)
    origins: tuple[str, ...] = ()
    hosts: tuple[str, ...] = ()

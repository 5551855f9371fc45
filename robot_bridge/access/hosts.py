"""Under which names the gateway's pages are asked for.

A web page somewhere can have its own name resolved to this computer's address (DNS rebinding), and its script
may then read what is served here as if it were its own. Such a request names the page's host in ``Host``.
"""

from __future__ import annotations

import ipaddress
from collections.abc import Collection, Iterable
from urllib.parse import urlsplit

LOCAL = ("localhost", "localhost.localdomain", "ip6-localhost")
_SHOWN = 80
"""characters of a host that are told back."""


def host_fault(headers: Iterable[str], names: Collection[str]) -> str | None:
    """Return why a request with these ``Host`` headers is refused, None for one that is meant for us.

    It is when it names an address, this computer, or one of ``names``, of which ``*.example.org`` stands for
    one name in front of that. An address is no name that somebody else could have resolved to ours.
    """
    hosts = list(headers)
    if not hosts:
        # No browser leaves it out.
        return None
    if len(hosts) > 1:
        return "the request has several Host headers; send one"
    host = _name_in(hosts[0])
    if host is not None and (_is_address(host) or host in LOCAL or any(_fits(host, name) for name in names)):
        return None
    return (
        f"Host {hosts[0][:_SHOWN]!r} is no name of this gateway; ask by its address, or have whoever runs "
        "the site name it under 'hosts' in [limits] of site.toml"
    )


def _name_in(host: str) -> str | None:
    try:
        return (urlsplit(f"//{host}").hostname or "").rstrip(".").lower() or None
    except ValueError:
        return None


def _is_address(host: str) -> bool:
    try:
        ipaddress.ip_address(host)
    except ValueError:
        return False
    return True


def _fits(host: str, name: str) -> bool:
    name = name.lower().rstrip(".")
    return host == name or (name.startswith("*.") and host.partition(".")[2] == name[2:])

"""How far a gateway may be reached, and what it needs for that."""

from __future__ import annotations

import ipaddress

from .errors import AccessError


def is_loopback(host: str) -> bool:
    """Tell whether an address to listen on is this computer's own; raises AccessError for none."""
    try:
        return ipaddress.ip_address("127.0.0.1" if host == "localhost" else host).is_loopback
    except ValueError:
        raise AccessError(
            f"host {host!r} is not an IP address; use 127.0.0.1, or 0.0.0.0 for every IPv4 address of this "
            "computer"
        ) from None


def check_reach(host: str, *, tls: bool, accounts: bool) -> None:
    """Refuse to listen beyond this computer without TLS and an operator's account; raises AccessError."""
    if is_loopback(host):
        return
    if not tls:
        raise AccessError(
            f"host {host} can be reached from other computers, and without TLS everybody on the way reads "
            "along; make certificates with 'robot-bridge tls create DIR --name HOST' and give --certificate "
            "and --key, or use 127.0.0.1"
        )
    if not accounts:
        raise AccessError(
            f"host {host} can be reached from other computers, and no operator has an account; make one with "
            "'robot-bridge operators add NAME --role supervisor', or use 127.0.0.1"
        )

"""Accounts of links: which adapter may speak for which robots.

Every function works inside the transaction of the connection it is given.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase

from sqlalchemy import Connection, insert, select, update

from ..store.schema import links
from .accounts import Grant, grants, issue, revoke
from .errors import AccessError
from .tokens import TokenKind

RESERVED = ("sql", "websocket")
"""Names under which operators see robots that connect by themselves."""
MOST_PATTERNS = 100
_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.-]{0,15}")
_PATTERN = re.compile(r"[A-Za-z0-9_.*?-]{1,63}")


@dataclass(frozen=True)
class LinkAccount:
    """A link's account; ``robots`` are patterns of names such as ``agv-*``, ``token`` is its newest one."""

    name: str
    robots: tuple[str, ...]
    token: Grant | None


def add_link(
    connection: Connection, name: str, robots: Sequence[str], now: float, expires_at: float | None = None
) -> str:
    """Make an account and return its token; raises AccessError for what cannot be a link's."""
    check_link_name(name)
    known = [one for one in connection.execute(select(links.c.name)).scalars() if one.lower() == name.lower()]
    if known:
        raise AccessError(
            f"link {known[0]!r} is there already; 'robot-bridge links rotate' gives a new token, "
            "'robot-bridge links robots' other robots"
        )
    connection.execute(insert(links).values(name=name, robots=_joined(robots), created_at=now))
    return issue(connection, TokenKind.LINK, name, now, expires_at)


def rotate_link(connection: Connection, name: str, now: float, expires_at: float | None = None) -> str:
    """Return a new token in place of every token the link had; raises AccessError when unknown."""
    _check_known(connection, name)
    revoke(connection, TokenKind.LINK, name, now)
    return issue(connection, TokenKind.LINK, name, now, expires_at)


def revoke_link(connection: Connection, name: str, now: float) -> int:
    """Revoke every token of a link and return how many; raises AccessError when unknown."""
    _check_known(connection, name)
    return revoke(connection, TokenKind.LINK, name, now)


def set_robots(connection: Connection, name: str, robots: Sequence[str]) -> None:
    """Let a link speak for other robots; raises AccessError when unknown."""
    _check_known(connection, name)
    connection.execute(update(links).where(links.c.name == name).values(robots=_joined(robots)))


def all_links(connection: Connection) -> list[LinkAccount]:
    """Return every link by name, each with its newest token."""
    newest = {grant.owner: grant for grant in grants(connection) if grant.kind is TokenKind.LINK}
    rows = connection.execute(select(links.c.name, links.c.robots).order_by(links.c.name))
    return [LinkAccount(name, tuple(robots.split()), newest.get(name)) for name, robots in rows]


def check_link_name(name: str) -> str:
    """Return ``name`` if it can be a link's, else raise AccessError."""
    if not _NAME.fullmatch(name) or name.lower() in RESERVED:
        raise AccessError(
            f"link name {name[:40]!r} cannot be used; take 1 to 16 letters, digits, '_', '.' or '-', "
            f"beginning with a letter or digit, and neither of {' and '.join(RESERVED)}"
        )
    return name


def speaks_for(robots: Sequence[str], robot: str) -> bool:
    """Tell whether a link with the patterns ``robots`` may speak for ``robot``."""
    return any(fnmatchcase(robot, pattern) for pattern in robots)


def _joined(robots: Sequence[str]) -> str:
    if not robots or len(robots) > MOST_PATTERNS:
        raise AccessError(
            f"a link speaks for 1 to {MOST_PATTERNS} patterns of robots' names; give --robots 'agv-*'"
        )
    for pattern in robots:
        if not _PATTERN.fullmatch(pattern):
            raise AccessError(
                f"{pattern[:80]!r} is no pattern of robots' names; write a name in which * stands for "
                "anything and ? for one character, such as 'agv-*'"
            )
    return " ".join(dict.fromkeys(robots))


def _check_known(connection: Connection, name: str) -> None:
    known = sorted(connection.execute(select(links.c.name)).scalars())
    if name not in known:
        raise AccessError(
            f"link {name!r} is not known; known are: {', '.join(known) or 'none yet'}. "
            "'robot-bridge links add' makes one"
        )

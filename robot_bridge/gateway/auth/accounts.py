"""Accounts and tokens of operators and robots."""

from __future__ import annotations

import hashlib
import re
import secrets
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from enum import Enum
from fnmatch import fnmatchcase
from typing import Any, TypeVar

from sqlalchemy import Connection, func, insert, literal, null, select, union_all, update

from ...core.errors import AccessError
from ...core.messages.base import Role, check_robot_name
from ..storage.database import Database
from ..storage.schema import links, operators, tokens

# --- Tokens: 256 random bits, shown once, stored as their SHA-256 ---
# A slow hash protects passwords; these bits cannot be guessed, and a slow hash would let strangers keep the
# gateway's processor busy.

BITS = 256
PROTOCOL = "robot-bridge"
"""The WebSocket subprotocol with which web pages must be answered."""
_TOKEN_OFFER = "token."  # nosec B105 # no password
_PROTOCOL_NAME = re.compile(r"[\w!#$%&'*+.^`|~-]+", re.ASCII)


class TokenKind(str, Enum):
    """Kind of a token's owner: an operator at the desk, a robot on its WebSocket, a link for many robots."""

    OPERATOR = "operator"
    ROBOT = "robot"
    LINK = "link"


# A prefix lets people, and programs that scan for leaked secrets, recognise it.
PREFIXES = {
    TokenKind.OPERATOR: "fleet_op_",
    TokenKind.ROBOT: "fleet_robot_",
    TokenKind.LINK: "fleet_link_",
}


def new_token(kind: TokenKind) -> str:
    """Return a new random token."""
    return PREFIXES[kind] + secrets.token_urlsafe(BITS // 8)


def new_id() -> str:
    """Return an id for a token or a session; it is not secret."""
    return secrets.token_hex(8)


def digest(token: str) -> str:
    """Return the hash of a token that the database stores, in hexadecimal digits."""
    return hashlib.sha256(token.encode("utf-8", "surrogateescape")).hexdigest()


def bearer(header: str | None) -> str | None:
    """Return the token in the value of an ``Authorization`` header, or None."""
    scheme, _, token = (header or "").strip().partition(" ")
    return token.strip() or None if scheme.lower() == "bearer" else None


def token_in(authorizations: Sequence[str], offers: Sequence[str]) -> str | None:
    """Return the token that a request carries, or None.

    ``authorizations`` are its ``Authorization`` headers, ``offers`` its ``Sec-WebSocket-Protocol`` headers: a
    web page's script can send no others, and offers ``robot-bridge`` with ``token.`` and its token.

    :raises AccessError: when it is ambiguous which token is meant; the text contains none of them.
    """
    if len(authorizations) > 1:
        raise AccessError("The request has several Authorization headers; send one.")
    names = [name.strip(" \t") for offer in offers for name in offer.split(",")]
    if not all(_PROTOCOL_NAME.fullmatch(name) for name in names):
        raise AccessError(
            "Sec-WebSocket-Protocol holds what is no name of a protocol; send the token as it is."
        )
    tokens = [name.removeprefix(_TOKEN_OFFER) for name in names if name.startswith(_TOKEN_OFFER)]
    if tokens and PROTOCOL not in names:
        raise AccessError(f"Sec-WebSocket-Protocol offers a token alone; offer {PROTOCOL} beside it.")
    if len(tokens) + len(authorizations) > 1:
        raise AccessError("The request carries several tokens; send one, in one header.")
    return tokens[0] or None if tokens else bearer(authorizations[0] if authorizations else None)


def chosen_protocol(offered: Sequence[str]) -> str | None:
    """Return the subprotocol of the answer to a connection: a token is never sent back."""
    return PROTOCOL if PROTOCOL in offered else None


# --- Accounts in the database: operators with their roles, and the tokens of operators and robots ---
# Every function works inside the transaction of the connection it is given.

LONGEST_NAME = 128


@dataclass(frozen=True)
class Grant:
    """A token as stored, and its permissions; ``role`` is that of an operator.

    ``robots`` are the patterns of the names that a link speaks for.
    """

    token: str
    hash: str
    kind: TokenKind
    owner: str
    role: Role | None
    created_at: float
    expires_at: float | None = None
    revoked_at: float | None = None
    used_at: float | None = None
    robots: tuple[str, ...] = ()

    def fault(self, now: float) -> str | None:
        """Return why the token is not valid at ``now``, or None."""
        if self.revoked_at is not None:
            return f"this token of {self.owner} was revoked"
        if self.expires_at is not None and self.expires_at <= now:
            return f"this token of {self.owner} has expired"
        return None


@dataclass(frozen=True)
class Operator:
    """An operator's account; ``token`` is its newest one."""

    name: str
    role: Role
    created_at: float
    token: Grant | None


# --- operators ------------------------------------------------------------------------------------------


def add_operator(
    connection: Connection, name: str, role: Role, now: float, expires_at: float | None = None
) -> str:
    """Create an account and return its token; raises AccessError for a taken or invalid name."""
    name = check_operator_name(name)
    for known in connection.execute(select(operators.c.name)).scalars():
        if known.casefold() == name.casefold():
            raise AccessError(
                f"operator {known!r} is there already; 'robot-bridge operators rotate' gives a new token, "
                "'robot-bridge operators role' another role"
            )
    connection.execute(insert(operators).values(name=name, role=role.value, created_at=now))
    return issue(connection, TokenKind.OPERATOR, name, now, expires_at)


def rotate_operator(connection: Connection, name: str, now: float, expires_at: float | None = None) -> str:
    """Return a new token that replaces all of the operator's; raises AccessError when unknown."""
    name = _known_operator(connection, name)
    revoke(connection, TokenKind.OPERATOR, name, now)
    return issue(connection, TokenKind.OPERATOR, name, now, expires_at)


def revoke_operator(connection: Connection, name: str, now: float) -> int:
    """Revoke every token of an operator and return how many; raises AccessError when unknown."""
    return revoke(connection, TokenKind.OPERATOR, _known_operator(connection, name), now)


def set_role(connection: Connection, name: str, role: Role) -> None:
    """Give an operator another role; raises AccessError when unknown."""
    name = _known_operator(connection, name)
    connection.execute(update(operators).where(operators.c.name == name).values(role=role.value))


def all_operators(connection: Connection) -> list[Operator]:
    """Return every operator by name, each with the newest token."""
    newest = {grant.owner: grant for grant in grants(connection) if grant.kind is TokenKind.OPERATOR}
    rows = connection.execute(select(operators).order_by(operators.c.name)).mappings()
    return [
        Operator(row["name"], Role(row["role"]), row["created_at"], newest.get(row["name"])) for row in rows
    ]


def find_operator(connection: Connection, name: str) -> Operator:
    """Return an operator's account; raises AccessError when unknown."""
    name = _known_operator(connection, name)
    return next(operator for operator in all_operators(connection) if operator.name == name)


def has_supervisor(connection: Connection, now: float) -> bool:
    """Return whether a supervisor has a token that is valid at ``now``."""
    return any(grant.role is Role.SUPERVISOR and grant.fault(now) is None for grant in grants(connection))


def check_operator_name(name: str) -> str:
    """Return ``name`` without surrounding blanks if valid for an operator, else raise AccessError."""
    name = name.strip()
    if not name or len(name) > LONGEST_NAME or not name.isprintable():
        raise AccessError(
            f"operator name {name[:LONGEST_NAME]!r} cannot be used; write 1 to {LONGEST_NAME} printable "
            "characters on one line"
        )
    return name


# --- robots ---------------------------------------------------------------------------------------------


def issue_robot_token(connection: Connection, robot: str, now: float, expires_at: float | None = None) -> str:
    """Return a new token for a robot's WebSocket, replacing its old one; raises MessageError."""
    revoke(connection, TokenKind.ROBOT, check_robot_name(robot), now)
    return issue(connection, TokenKind.ROBOT, robot, now, expires_at)


def revoke_robot_token(connection: Connection, robot: str, now: float) -> int:
    """Revoke a robot's token; raises AccessError when it has none."""
    revoked = revoke(connection, TokenKind.ROBOT, robot, now)
    if not revoked:
        raise AccessError(f"robot {robot!r} has no token to revoke; 'robot-bridge robots tokens' lists them")
    return revoked


def robot_tokens(connection: Connection) -> list[Grant]:
    """Return the newest token of every robot, by name."""
    newest = {grant.owner: grant for grant in grants(connection) if grant.kind is TokenKind.ROBOT}
    return [newest[name] for name in sorted(newest)]


# --- all of them ----------------------------------------------------------------------------------------

_NO_TOKENS = (null(),) * 4
_FINGERPRINT = union_all(
    # The numbers first: PostgreSQL cannot infer a numeric type from nulls alone.
    select(
        literal("tokens"),
        func.count(),
        func.max(tokens.c.created_at),
        func.count(tokens.c.revoked_at),
        func.max(tokens.c.revoked_at),
        literal(""),
        literal(""),
    ).select_from(tokens),
    select(literal("operator"), *_NO_TOKENS, operators.c.name, operators.c.role),
    select(literal("link"), *_NO_TOKENS, links.c.name, links.c.robots),
)
"""One statement, since it runs every few tenths of a second."""


def grants(connection: Connection) -> list[Grant]:
    """Return every token ever issued, oldest first; the secrets themselves are not stored."""
    roles = {
        name: Role(role) for name, role in connection.execute(select(operators.c.name, operators.c.role))
    }
    robots_of_link = {
        name: tuple(robots.split())
        for name, robots in connection.execute(select(links.c.name, links.c.robots))
    }
    rows = connection.execute(select(tokens).order_by(tokens.c.created_at, tokens.c.id)).mappings()
    return [
        Grant(
            token=row["id"],
            hash=row["hash"],
            kind=TokenKind(row["kind"]),
            owner=row["owner"],
            role=roles.get(row["owner"]) if row["kind"] == TokenKind.OPERATOR.value else None,
            created_at=row["created_at"],
            expires_at=row["expires_at"],
            revoked_at=row["revoked_at"],
            used_at=row["used_at"],
            robots=robots_of_link.get(row["owner"], ()) if row["kind"] == TokenKind.LINK.value else (),
        )
        for row in rows
    ]


def accounts_fingerprint(connection: Connection) -> tuple[object, ...]:
    """Return a value that changes when a token is made, revoked or deleted, or a role or link changes."""
    return tuple(sorted(map(tuple, connection.execute(_FINGERPRINT))))


def note_use(connection: Connection, used: Sequence[tuple[str, float]]) -> None:
    """Record when tokens (id, time) opened a connection."""
    for token, at in used:
        connection.execute(update(tokens).where(tokens.c.id == token).values(used_at=at))


def _known_operator(connection: Connection, name: str) -> str:
    known = sorted(connection.execute(select(operators.c.name)).scalars())
    if name.strip() not in known:
        raise AccessError(
            f"operator {name!r} is not known; known are: {', '.join(known) or 'none yet'}. "
            "'robot-bridge operators add' makes one"
        )
    return name.strip()


def issue(connection: Connection, kind: TokenKind, owner: str, now: float, expires_at: float | None) -> str:
    """Return a new token of ``owner``; the secret is not stored."""
    token = new_token(kind)
    connection.execute(
        insert(tokens).values(
            id=new_id(),
            kind=kind.value,
            owner=owner,
            hash=digest(token),
            created_at=now,
            expires_at=expires_at,
        )
    )
    return token


def revoke(connection: Connection, kind: TokenKind, owner: str, now: float) -> int:
    """Revoke every token of ``owner``; return how many were valid."""
    done = connection.execute(
        update(tokens)
        .where(tokens.c.kind == kind.value, tokens.c.owner == owner, tokens.c.revoked_at.is_(None))
        .values(revoked_at=now)
    )
    return done.rowcount


# --- Accounts cached by a running gateway: reread when they change, also by another program

T = TypeVar("T")


class AccountCache:
    """All tokens in memory, so that connection attempts do not load the database.

    While the database is away known accounts continue.
    """

    def __init__(self, database: Database) -> None:
        self._database = database
        self._fingerprint: tuple[object, ...] | None = None
        self._by_hash: dict[str, Grant] = {}
        self._by_token: dict[str, Grant] = {}

    async def refresh(self) -> bool:
        """Apply changes and return whether there were any; raises StoreError."""
        return self._apply(await self._database.read(_read, self._fingerprint))

    async def refresh_with(self, work: Callable[..., T], *arguments: Any) -> T:
        """As :meth:`refresh`; return what ``work`` reads, done in the same visit to the database."""
        result: T
        found, result = await self._database.read(_read_with, self._fingerprint, work, arguments)
        self._apply(found)
        return result

    def _apply(self, found: tuple[tuple[object, ...], list[Grant]] | None) -> bool:
        if found is None:
            return False
        self._fingerprint, grants = found
        self._by_hash = {grant.hash: grant for grant in grants}
        self._by_token = {grant.token: grant for grant in grants}
        return True

    def is_open(self, kind: TokenKind) -> bool:
        """Return whether no token of ``kind`` was ever made, so that clients cannot be identified."""
        return not any(grant.kind is kind for grant in self._by_hash.values())

    def find(self, token: str) -> Grant | None:
        """Return the grant of ``token``, None for an unknown one."""
        return self._by_hash.get(digest(token))

    def grant(self, token_id: str) -> Grant | None:
        """Return the token with an id."""
        return self._by_token.get(token_id)

    def has_operator(self, now: float, role: Role = Role.VIEWER) -> bool:
        """Return whether an operator with at least ``role`` has a token that is valid at ``now``."""
        return has_operator(self._by_hash.values(), now, role)


def has_operator(known: Iterable[Grant], now: float, role: Role = Role.VIEWER) -> bool:
    """Return whether a token of an operator with at least ``role`` is valid at ``now``."""
    return any(
        grant.role is not None and grant.role.includes(role) and grant.fault(now) is None for grant in known
    )


def _read(
    connection: Connection, known: tuple[object, ...] | None
) -> tuple[tuple[object, ...], list[Grant]] | None:
    fingerprint = accounts_fingerprint(connection)
    return None if fingerprint == known else (fingerprint, grants(connection))


def _read_with(
    connection: Connection,
    known: tuple[object, ...] | None,
    work: Callable[..., T],
    arguments: tuple[Any, ...],
) -> tuple[tuple[tuple[object, ...], list[Grant]] | None, T]:
    return _read(connection, known), work(connection, *arguments)


# --- Accounts of links: which adapter may speak for which robots ---
# Every function works inside the transaction of the connection it is given.

RESERVED = ("sql", "websocket")
"""Link names shown to operators for robots that connect by themselves."""
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
    """Create an account and return its token; raises AccessError for invalid arguments."""
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
    """Return a new token that replaces all of the link's; raises AccessError when unknown."""
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
    """Return ``name`` if valid for a link, else raise AccessError."""
    if not _NAME.fullmatch(name) or name.lower() in RESERVED:
        raise AccessError(
            f"link name {name[:40]!r} cannot be used; take 1 to 16 letters, digits, '_', '.' or '-', "
            f"beginning with a letter or digit, and neither of {' and '.join(RESERVED)}"
        )
    return name


def speaks_for(robots: Sequence[str], robot: str) -> bool:
    """Return whether a link with the patterns ``robots`` may speak for ``robot``."""
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

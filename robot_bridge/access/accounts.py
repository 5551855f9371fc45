"""Accounts in the database: operators with their roles, and the tokens of operators and robots.

Every function works inside the transaction of the connection it is given.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from sqlalchemy import Connection, func, insert, select, update

from ..messages import Role, check_robot_name
from ..store.schema import links, operators, tokens
from .errors import AccessError
from .tokens import TokenKind, digest, new_id, new_token

LONGEST_NAME = 128


@dataclass(frozen=True)
class Grant:
    """A token as the database knows it, and what it opens; ``role`` is that of an operator.

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
        """Return why the token opens nothing at ``now``, or None when it does."""
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
    """Make an account and return its token; raises AccessError for a name that is taken or cannot be one."""
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
    """Return a new token in place of every token the operator had; raises AccessError when unknown."""
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
    """Tell whether a supervisor has a token that holds at ``now``."""
    return any(grant.role is Role.SUPERVISOR and grant.fault(now) is None for grant in grants(connection))


def check_operator_name(name: str) -> str:
    """Return ``name`` without blanks around it if it can be an operator's, else raise AccessError."""
    name = name.strip()
    if not name or len(name) > LONGEST_NAME or not name.isprintable():
        raise AccessError(
            f"operator name {name[:LONGEST_NAME]!r} cannot be used; write 1 to {LONGEST_NAME} printable "
            "characters on one line"
        )
    return name


# --- robots ---------------------------------------------------------------------------------------------


def issue_robot_token(connection: Connection, robot: str, now: float, expires_at: float | None = None) -> str:
    """Return a new token for a robot's WebSocket, in place of the one it had; raises MessageError."""
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


def grants(connection: Connection) -> list[Grant]:
    """Return every token there ever was, oldest first; the token itself is kept nowhere."""
    roles = {
        name: Role(role) for name, role in connection.execute(select(operators.c.name, operators.c.role))
    }
    spoken_for = {
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
            robots=spoken_for.get(row["owner"], ()) if row["kind"] == TokenKind.LINK.value else (),
        )
        for row in rows
    ]


def fingerprint(connection: Connection) -> tuple[object, ...]:
    """Return what differs whenever a token was made, revoked or forgotten, a role or a link changed."""
    counts = select(
        func.count(),
        func.max(tokens.c.created_at),
        func.count(tokens.c.revoked_at),
        func.max(tokens.c.revoked_at),
    ).select_from(tokens)
    roles = select(operators.c.name, operators.c.role).order_by(operators.c.name)
    spoken_for = select(links.c.name, links.c.robots).order_by(links.c.name)
    found = (*connection.execute(roles), *connection.execute(spoken_for))
    return (*connection.execute(counts).one(), *map(tuple, found))


def note_use(connection: Connection, used: Sequence[tuple[str, float]]) -> None:
    """Note when tokens (id, time) opened a connection."""
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
    """Return a new token of ``owner``, which is kept nowhere."""
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
    """Revoke every token of ``owner``; return how many held."""
    done = connection.execute(
        update(tokens)
        .where(tokens.c.kind == kind.value, tokens.c.owner == owner, tokens.c.revoked_at.is_(None))
        .values(revoked_at=now)
    )
    return done.rowcount

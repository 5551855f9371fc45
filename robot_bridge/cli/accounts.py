"""``robot-bridge robots``, ``operators``, ``links`` and ``sessions``: accounts and connections."""

from __future__ import annotations

import secrets
import time
from collections.abc import Callable
from pathlib import Path
from typing import Annotated

import typer
from sqlalchemy import Connection

from ..core.errors import AccessError
from ..core.messages.base import Role, check_robot_name
from ..gateway.auth import accounts, audit
from ..gateway.storage.database import read_password, shown
from ..gateway.storage.repositories import robots as stored_robots
from ..gateway.storage.roles.choice import has_accounts, role_manager_on
from .audit import act_audited, after_days, local_time, read_database
from .options import DEFAULT, DatabaseOption, PasswordFileOption, database_address

# --- The password of a new account: from a file, or a random one that is shown once

RANDOM_BYTES = 24

NewPasswordOption = Annotated[
    Path | None,
    typer.Option(
        "--password-file",
        help="File whose first line becomes the password; without it one is made and shown.",
    ),
]


def new_password(file: Path | None) -> str:
    """Return the password in ``file``, or a random one; raises StoreError when the file cannot be used."""
    return secrets.token_urlsafe(RANDOM_BYTES) if file is None else read_password(file)


# --- The two commands shared by operators and robots: issue a token, and revoke it ---

Name = Annotated[str, typer.Argument(help="Its name, as it stands in every log.")]
Expires = Annotated[float | None, typer.Option(help="Days until the token expires.", min=0.0)]


def issuing(
    kind: str, action: str, issue: Callable[[Connection, str, float, float | None], str]
) -> Callable[..., None]:
    """Return the command ``action`` that prints a new token of an account of ``kind``.

    ``issue(connection, name, now, until)`` replaces the old one, times in seconds since 1970.
    """

    def command(
        name: Name,
        expires_days: Expires = None,
        database: DatabaseOption = DEFAULT,
        database_password_file: PasswordFileOption = None,
    ) -> None:
        until = after_days(expires_days)
        address = database_address(database, database_password_file)
        token = act_audited(
            address, action, name, None, lambda connection: issue(connection, name, time.time(), until)
        )
        show_token(token, f"{kind} {name}")

    return command


def revoking(
    kind: str, action: str, revoke: Callable[[Connection, str, float], object], renewing: str
) -> Callable[..., None]:
    """Return the command ``action`` that revokes an account's token; ``renewing`` issues a new one.

    ``revoke(connection, name, now)`` does it, now in seconds since 1970.
    """

    def command(
        name: Name, database: DatabaseOption = DEFAULT, database_password_file: PasswordFileOption = None
    ) -> None:
        address = database_address(database, database_password_file)
        act_audited(address, action, name, None, lambda connection: revoke(connection, name, time.time()))
        typer.echo(f"{kind} {name} is revoked; 'robot-bridge {renewing}' gives a new token")

    return command


def show_token(token: str, of: str) -> None:
    """Print a token, alone on standard output so that it can be written into a file."""
    typer.echo(f"The token of {of}; it is shown this once:", err=True)
    typer.echo(token)


def state_of(token: accounts.Grant | None) -> str:
    """Return the state of a token in words."""
    if token is None:
        return "no token"
    if token.revoked_at is not None:
        return f"revoked {local_time(token.revoked_at)}"
    expires = f", expires {local_time(token.expires_at)}" if token.expires_at is not None else ""
    fault = token.fault(time.time())
    return f"{'expired' if fault else 'valid'}{expires}, last used {local_time(token.used_at)}"


# --- Operators: accounts for the desk, and their roles ---

operators = typer.Typer(help="Accounts of operators: their roles and tokens.", no_args_is_help=True)

RoleOption = Annotated[
    Role, typer.Option(help="viewer sees, operator sends, supervisor clears stops and manages accounts.")
]


@operators.command("add")
def add_operator(
    name: Name,
    role: RoleOption,
    expires_days: Expires = None,
    database: DatabaseOption = DEFAULT,
    database_password_file: PasswordFileOption = None,
) -> None:
    """Make an account and print its token, which is kept nowhere and shown this once."""
    until = after_days(expires_days)
    address = database_address(database, database_password_file)
    token = act_audited(
        address,
        "operators add",
        name,
        role.value,
        lambda connection: accounts.add_operator(connection, name, role, time.time(), until),
    )
    show_token(token, f"operator {name}, {role.value}")


operators.command(
    "rotate", help="Print a new token in place of the operator's old one, whose connections end."
)(issuing("operator", "operators rotate", accounts.rotate_operator))
operators.command("revoke", help="Revoke the operator's token; open connections end within a second.")(
    revoking("operator", "operators revoke", accounts.revoke_operator, "operators rotate")
)


@operators.command("role")
def set_role(
    name: Name,
    role: Annotated[Role, typer.Argument(help="The new role.")],
    database: DatabaseOption = DEFAULT,
    database_password_file: PasswordFileOption = None,
) -> None:
    """Give the operator another role; it holds within a second, also for open connections."""
    address = database_address(database, database_password_file)
    act_audited(
        address,
        "operators role",
        name,
        role.value,
        lambda connection: accounts.set_role(connection, name, role),
    )
    typer.echo(f"operator {name} is {role.value} now")


@operators.command("list")
def list_operators(
    database: DatabaseOption = DEFAULT, database_password_file: PasswordFileOption = None
) -> None:
    """List the operators."""
    address = database_address(database, database_password_file)
    for operator in read_database(address, accounts.all_operators):
        typer.echo(f"{operator.name}\t{operator.role.value}\t{state_of(operator.token)}")


# --- Links: accounts of adapters, and the robots that each may speak for ---

links = typer.Typer(help="Accounts of links, which speak for many robots.", no_args_is_help=True)

RobotsOption = Annotated[
    list[str], typer.Option("--robots", help="Pattern of robots' names, as 'agv-*'; may be given again.")
]


@links.command("add")
def add_link(
    name: Name,
    robots: RobotsOption,
    expires_days: Expires = None,
    database: DatabaseOption = DEFAULT,
    database_password_file: PasswordFileOption = None,
) -> None:
    """Make an account and print its token, which is kept nowhere and shown this once."""
    until = after_days(expires_days)
    token = act_audited(
        database_address(database, database_password_file),
        "links add",
        name,
        " ".join(robots),
        lambda connection: accounts.add_link(connection, name, robots, time.time(), until),
    )
    show_token(token, f"link {name}, for {' '.join(robots)}")


@links.command("robots")
def set_robots(
    name: Name,
    robots: RobotsOption,
    database: DatabaseOption = DEFAULT,
    database_password_file: PasswordFileOption = None,
) -> None:
    """Let the link speak for these robots and no others; it holds within a second."""
    act_audited(
        database_address(database, database_password_file),
        "links robots",
        name,
        " ".join(robots),
        lambda connection: accounts.set_robots(connection, name, robots),
    )
    typer.echo(f"link {name} speaks for {' '.join(robots)} now")


links.command("rotate", help="Print a new token in place of the link's old one, whose connection ends.")(
    issuing("link", "links rotate", accounts.rotate_link)
)
links.command("revoke", help="Revoke the link's token; its connection ends within a second.")(
    revoking("link", "links revoke", accounts.revoke_link, "links rotate")
)


@links.command("list")
def list_links(database: DatabaseOption = DEFAULT, database_password_file: PasswordFileOption = None) -> None:
    """List the links."""
    address = database_address(database, database_password_file)
    for link in read_database(address, accounts.all_links):
        typer.echo(f"{link.name}\t{' '.join(link.robots)}\t{state_of(link.token)}")


# --- Sessions: connected operators ---

sessions = typer.Typer(help="Connections of operators to the desk.", no_args_is_help=True)


@sessions.command("list")
def list_sessions(
    everything: Annotated[bool, typer.Option("--all", help="Also those that have ended.")] = False,
    limit: Annotated[int, typer.Option(help="How many at most.", min=1)] = 200,
    database: DatabaseOption = DEFAULT,
    database_password_file: PasswordFileOption = None,
) -> None:
    """List the open sessions, newest first."""
    address = database_address(database, database_password_file)
    found = read_database(address, lambda c: audit.list_sessions(c, everything=everything, limit=limit))
    for session in found:
        ended = ""
        if session.ended_at is not None:
            ended = f"\tended {local_time(session.ended_at)}: {session.reason or 'no reason given'}"
        row = (session.id, session.operator, session.role, session.address, local_time(session.began_at))
        typer.echo("\t".join(row) + ended)


@sessions.command("end")
def end_session(
    session: Annotated[str, typer.Argument(help="The session's id, or how it begins.")],
    reason: Annotated[str, typer.Option(help="Why; the operator is told.")] = "ended by the site",
    database: DatabaseOption = DEFAULT,
    database_password_file: PasswordFileOption = None,
) -> None:
    """End a session within a second; the token stays valid."""
    address = database_address(database, database_password_file)
    ended = act_audited(
        address, "sessions end", session, reason, lambda c: audit.end_session(c, session, time.time(), reason)
    )
    typer.echo(f"session {ended.id} of {ended.operator} is ended")


# --- Robots: accounts in the database server, or tokens with which they connect over WebSocket ---

robots = typer.Typer(help="Who may connect as a robot.", no_args_is_help=True)

RobotName = Annotated[str, typer.Argument(help="The robot's name, which is its account's.")]


@robots.command("add")
def add_robot(
    name: RobotName,
    password_file: NewPasswordOption = None,
    database: DatabaseOption = DEFAULT,
    database_password_file: PasswordFileOption = None,
) -> None:
    """Make a robot's account: in the database server on PostgreSQL and MariaDB, for WebSocket on SQLite.

    As an administrator of the server. The password, or the token, is printed once, alone on standard output.
    """
    check_robot_name(name)
    address = database_address(database, database_password_file)
    if not has_accounts(address.drivername):
        _refuse_password(password_file)
        print(act_audited(address, "robots add", name, None, lambda connection: _add_token(connection, name)))
        _report(f"robot {name} has a token, which it shows when it connects over WebSocket")
        return
    password = new_password(password_file)

    def work(connection: Connection) -> str:
        role_manager_on(connection).add_robot(name, password)
        return role_manager_on(connection).robots_database()

    found = act_audited(address, "robots add", name, None, work)
    if password_file is None:
        print(password)
    robots_address = address._replace(username=name, password=None, database=found)
    _report(f"robot {name} has an account; it connects to {shown(robots_address)}")


@robots.command("rotate")
def rotate_robot(
    name: RobotName,
    password_file: NewPasswordOption = None,
    database: DatabaseOption = DEFAULT,
    database_password_file: PasswordFileOption = None,
) -> None:
    """Give a robot another password (on SQLite another token); connections made with the old one end."""
    address = database_address(database, database_password_file)
    if not has_accounts(address.drivername):
        _refuse_password(password_file)
        print(
            act_audited(
                address, "robots rotate", name, None, lambda connection: _rotate_token(connection, name)
            )
        )
        return
    password = new_password(password_file)
    act_audited(
        address,
        "robots rotate",
        name,
        None,
        lambda connection: role_manager_on(connection).rotate_robot(name, password),
    )
    if password_file is None:
        print(password)
    _report(f"robot {name} has another password")


@robots.command("remove")
def remove_robot(
    name: RobotName, database: DatabaseOption = DEFAULT, database_password_file: PasswordFileOption = None
) -> None:
    """Take a robot's account, its token, its connections and what waits for it away; its history stays.

    On SQLite also a robot that never had a token. A gateway that runs notices within a second or two,
    ends the robot's commands, and takes it off every desk.
    """
    address = database_address(database, database_password_file)

    def work(connection: Connection) -> None:
        was_known = stored_robots.forget(connection, name)
        if has_accounts(address.drivername):
            role_manager_on(connection).remove_robot(name)
        elif not was_known and not _has_token(connection, name):
            raise AccessError(
                f"robot {name!r} is not known and has no token; the desks list the robots that are known, "
                "'robot-bridge robots tokens' those that have a token"
            )
        if _has_token(connection, name):
            accounts.revoke_robot_token(connection, name, time.time())

    act_audited(address, "robots remove", name, None, work)
    _report(f"robot {name} is removed")


@robots.command("list")
def list_robots(
    database: DatabaseOption = DEFAULT, database_password_file: PasswordFileOption = None
) -> None:
    """Print who may connect: a line for each robot, with its name and by what."""
    address = database_address(database, database_password_file)
    for name, ways in sorted(read_database(address, _ways).items()):
        print(f"{name}\t{', '.join(ways)}")


def _ways(connection: Connection) -> dict[str, list[str]]:
    ways: dict[str, list[str]] = {}
    if has_accounts(connection.dialect.name):
        ways = {name: ["database account"] for name in role_manager_on(connection).robots()}
    for grant in accounts.robot_tokens(connection):
        if grant.fault(time.time()) is None:
            ways.setdefault(grant.owner, []).append("token")
    return ways


def _add_token(connection: Connection, name: str) -> str:
    if _has_token(connection, name):
        raise AccessError(
            f"robot {name!r} has a token already; 'robot-bridge robots rotate {name}' gives it another one, "
            f"'robot-bridge robots remove {name}' takes it away"
        )
    return accounts.issue_robot_token(connection, name, time.time())


def _rotate_token(connection: Connection, name: str) -> str:
    if not _has_token(connection, name):
        raise AccessError(f"robot {name!r} has no token; 'robot-bridge robots add {name}' makes one")
    return accounts.issue_robot_token(connection, name, time.time())


def _has_token(connection: Connection, name: str) -> bool:
    grants = accounts.robot_tokens(connection)
    return any(grant.owner == name and grant.fault(time.time()) is None for grant in grants)


def _refuse_password(file: Path | None) -> None:
    if file is not None:
        raise AccessError(
            "SQLite has no accounts: leave --password-file out, and a token is made and printed"
        )


def _report(text: str) -> None:
    typer.echo(text, err=True)


robots.command(
    "token",
    help="Print a new token for the robot's WebSocket, in place of its old one; it is shown this once.",
)(issuing("robot", "robots token", accounts.issue_robot_token))
robots.command("revoke", help="Revoke the robot's token; its connection ends within a second.")(
    revoking("robot", "robots revoke", accounts.revoke_robot_token, "robots token")
)


@robots.command("tokens")
def list_robot_tokens(
    database: DatabaseOption = DEFAULT, database_password_file: PasswordFileOption = None
) -> None:
    """List the robots that have, or had, a token."""
    address = database_address(database, database_password_file)
    for grant in read_database(address, accounts.robot_tokens):
        typer.echo(f"{grant.owner}\t{state_of(grant)}")

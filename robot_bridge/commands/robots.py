"""``robot-bridge robots``: who may connect as a robot."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Annotated

import typer
from sqlalchemy import Connection

from ..access import accounts as tokens
from ..access.errors import AccessError
from ..messages import check_robot_name
from ..store import robots as stored_robots
from ..store.accounts.choice import has_accounts, keeper_on
from ..store.address import shown
from . import robot_tokens
from .database_option import DEFAULT, DatabaseOption, PasswordFileOption, database_address
from .noted import act, read
from .passwords import NewPasswordOption, new_password

app = typer.Typer(help="Who may connect as a robot.", no_args_is_help=True)

NameArgument = Annotated[str, typer.Argument(help="The robot's name, which is its account's.")]


@app.command()
def add(
    name: NameArgument,
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
        print(act(address, "robots add", name, None, lambda connection: _add_token(connection, name)))
        _say(f"robot {name} has a token, which it shows when it connects over WebSocket")
        return
    password = new_password(password_file)

    def work(connection: Connection) -> str:
        keeper_on(connection).add_robot(name, password)
        return keeper_on(connection).robots_database()

    found = act(address, "robots add", name, None, work)
    if password_file is None:
        print(password)
    robots_address = address._replace(username=name, password=None, database=found)
    _say(f"robot {name} has an account; it connects to {shown(robots_address)}")


@app.command()
def rotate(
    name: NameArgument,
    password_file: NewPasswordOption = None,
    database: DatabaseOption = DEFAULT,
    database_password_file: PasswordFileOption = None,
) -> None:
    """Give a robot another password (on SQLite another token); connections made with the old one end."""
    address = database_address(database, database_password_file)
    if not has_accounts(address.drivername):
        _refuse_password(password_file)
        print(act(address, "robots rotate", name, None, lambda connection: _rotate_token(connection, name)))
        return
    password = new_password(password_file)
    act(
        address,
        "robots rotate",
        name,
        None,
        lambda connection: keeper_on(connection).rotate_robot(name, password),
    )
    if password_file is None:
        print(password)
    _say(f"robot {name} has another password")


@app.command()
def remove(
    name: NameArgument, database: DatabaseOption = DEFAULT, database_password_file: PasswordFileOption = None
) -> None:
    """Take a robot's account, its token, its connections and what waits for it away; its history stays.

    On SQLite also a robot that never had a token. A gateway that runs notices within a second or two,
    ends the robot's commands, and takes it off every desk.
    """
    address = database_address(database, database_password_file)

    def work(connection: Connection) -> None:
        was_known = stored_robots.forget(connection, name)
        if has_accounts(address.drivername):
            keeper_on(connection).remove_robot(name)
        elif not was_known and not _has_token(connection, name):
            raise AccessError(
                f"robot {name!r} is not known and has no token; the desks list the robots that are known, "
                "'robot-bridge robots tokens' those that have a token"
            )
        if _has_token(connection, name):
            tokens.revoke_robot_token(connection, name, time.time())

    act(address, "robots remove", name, None, work)
    _say(f"robot {name} is removed")


@app.command("list")
def list_(database: DatabaseOption = DEFAULT, database_password_file: PasswordFileOption = None) -> None:
    """Print who may connect: a line for each robot, with its name and by what."""
    address = database_address(database, database_password_file)
    for name, ways in sorted(read(address, _ways).items()):
        print(f"{name}\t{', '.join(ways)}")


def _ways(connection: Connection) -> dict[str, list[str]]:
    ways: dict[str, list[str]] = {}
    if has_accounts(connection.dialect.name):
        ways = {name: ["database account"] for name in keeper_on(connection).robots()}
    for grant in tokens.robot_tokens(connection):
        if grant.fault(time.time()) is None:
            ways.setdefault(grant.owner, []).append("token")
    return ways


def _add_token(connection: Connection, name: str) -> str:
    if _has_token(connection, name):
        raise AccessError(
            f"robot {name!r} has a token already; 'robot-bridge robots rotate {name}' gives it another one, "
            f"'robot-bridge robots remove {name}' takes it away"
        )
    return tokens.issue_robot_token(connection, name, time.time())


def _rotate_token(connection: Connection, name: str) -> str:
    if not _has_token(connection, name):
        raise AccessError(f"robot {name!r} has no token; 'robot-bridge robots add {name}' makes one")
    return tokens.issue_robot_token(connection, name, time.time())


def _has_token(connection: Connection, name: str) -> bool:
    grants = tokens.robot_tokens(connection)
    return any(grant.owner == name and grant.fault(time.time()) is None for grant in grants)


def _refuse_password(file: Path | None) -> None:
    if file is not None:
        raise AccessError(
            "SQLite has no accounts: leave --password-file out, and a token is made and printed"
        )


def _say(text: str) -> None:
    typer.echo(text, err=True)


robot_tokens.add_to(app)

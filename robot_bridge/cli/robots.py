"""``robot-bridge robots``: who may connect as a robot."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Annotated

import typer
from sqlalchemy import Connection

from ..core.messages.validation import check_robot_name
from ..gateway.auth import accounts
from ..gateway.storage.database import shown
from ..gateway.storage.repositories import robots as stored_robots
from ..gateway.storage.roles.choice import has_accounts, role_manager_on
from ..protocol.credentials import AccessError
from .accounts import NewPasswordOption, issuing, new_password, revoking, state_of
from .audit import act_audited, read_database
from .options import DEFAULT, DatabaseOption, PasswordFileOption, database_address

# --- ``robot-bridge robots token|revoke|tokens``: which robots may connect over WebSocket ---

ISSUE_HELP = "Print a new token for the robot's WebSocket, in place of its old one; it is shown this once."
REVOKE_HELP = "Revoke the robot's token; its connection ends within a second."


def tokens(database: DatabaseOption = DEFAULT, database_password_file: PasswordFileOption = None) -> None:
    """List the robots that have, or had, a token."""
    address = database_address(database, database_password_file)
    for grant in read_database(address, accounts.robot_tokens):
        typer.echo(f"{grant.owner}\t{state_of(grant)}")


def add_token_commands(app: typer.Typer) -> None:
    """Put the three commands into the group ``robots``."""
    issue = issuing("robot", "robots token", accounts.issue_robot_token)
    revoke = revoking("robot", "robots revoke", accounts.revoke_robot_token, "robots token")
    app.command("token", help=ISSUE_HELP)(issue)
    app.command("revoke", help=REVOKE_HELP)(revoke)
    app.command()(tokens)


# --- ``robot-bridge robots``: who may connect as a robot ---

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
        print(act_audited(address, "robots add", name, None, lambda connection: _add_token(connection, name)))
        _say(f"robot {name} has a token, which it shows when it connects over WebSocket")
        return
    password = new_password(password_file)

    def work(connection: Connection) -> str:
        role_manager_on(connection).add_robot(name, password)
        return role_manager_on(connection).robots_database()

    found = act_audited(address, "robots add", name, None, work)
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
            role_manager_on(connection).remove_robot(name)
        elif not was_known and not _has_token(connection, name):
            raise AccessError(
                f"robot {name!r} is not known and has no token; the desks list the robots that are known, "
                "'robot-bridge robots tokens' those that have a token"
            )
        if _has_token(connection, name):
            accounts.revoke_robot_token(connection, name, time.time())

    act_audited(address, "robots remove", name, None, work)
    _say(f"robot {name} is removed")


@app.command("list")
def list_(database: DatabaseOption = DEFAULT, database_password_file: PasswordFileOption = None) -> None:
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


def _say(text: str) -> None:
    typer.echo(text, err=True)


add_token_commands(app)

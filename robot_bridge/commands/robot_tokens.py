"""``robot-bridge robots token|revoke|tokens``: which robots may connect over WebSocket."""

from __future__ import annotations

import time
from typing import Annotated

import typer

from ..access import accounts
from .database_option import DEFAULT, DatabaseOption, PasswordFileOption, database_address
from .noted import act, after_days, read
from .operators import Expires, show_token, state_of

Name = Annotated[str, typer.Argument(help="The robot's name.")]


def token(
    name: Name,
    expires_days: Expires = None,
    database: DatabaseOption = DEFAULT,
    database_password_file: PasswordFileOption = None,
) -> None:
    """Print a new token for the robot's WebSocket, in place of its old one; it is shown this once."""
    until = after_days(expires_days)
    address = database_address(database, database_password_file)
    made = act(
        address,
        "robots token",
        name,
        None,
        lambda connection: accounts.issue_robot_token(connection, name, time.time(), until),
    )
    show_token(made, f"robot {name}")


def revoke(
    name: Name, database: DatabaseOption = DEFAULT, database_password_file: PasswordFileOption = None
) -> None:
    """Revoke the robot's token; its connection ends within a second."""
    address = database_address(database, database_password_file)
    act(
        address,
        "robots revoke",
        name,
        None,
        lambda connection: accounts.revoke_robot_token(connection, name, time.time()),
    )
    typer.echo(f"robot {name} is revoked; 'robot-bridge robots token' gives a new token")


def tokens(database: DatabaseOption = DEFAULT, database_password_file: PasswordFileOption = None) -> None:
    """List the robots that have, or had, a token."""
    address = database_address(database, database_password_file)
    for grant in read(address, accounts.robot_tokens):
        typer.echo(f"{grant.owner}\t{state_of(grant)}")


def add_to(app: typer.Typer) -> None:
    """Put the three commands into the group ``robots``."""
    app.command()(token)
    app.command()(revoke)
    app.command()(tokens)

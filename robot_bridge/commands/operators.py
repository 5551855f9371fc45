"""``robot-bridge operators``: who may connect to the desk, and what they may do."""

from __future__ import annotations

import time
from typing import Annotated

import typer

from ..access import accounts
from ..messages import Role
from .database_option import DEFAULT, DatabaseOption, PasswordFileOption, database_address
from .noted import act, after_days, moment, read

app = typer.Typer(help="Accounts of operators: their roles and tokens.", no_args_is_help=True)

Name = Annotated[str, typer.Argument(help="The operator's name, as it stands in every log.")]
RoleOption = Annotated[
    Role, typer.Option(help="viewer sees, operator sends, supervisor clears stops and manages accounts.")
]
Expires = Annotated[float | None, typer.Option(help="Days until the token expires.", min=0.0)]


@app.command()
def add(
    name: Name,
    role: RoleOption,
    expires_days: Expires = None,
    database: DatabaseOption = DEFAULT,
    database_password_file: PasswordFileOption = None,
) -> None:
    """Make an account and print its token, which is kept nowhere and shown this once."""
    until = after_days(expires_days)
    address = database_address(database, database_password_file)
    token = act(
        address,
        "operators add",
        name,
        role.value,
        lambda connection: accounts.add_operator(connection, name, role, time.time(), until),
    )
    show_token(token, f"operator {name}, {role.value}")


@app.command()
def rotate(
    name: Name,
    expires_days: Expires = None,
    database: DatabaseOption = DEFAULT,
    database_password_file: PasswordFileOption = None,
) -> None:
    """Print a new token in place of the operator's old one, whose connections end."""
    until = after_days(expires_days)
    address = database_address(database, database_password_file)
    token = act(
        address,
        "operators rotate",
        name,
        None,
        lambda connection: accounts.rotate_operator(connection, name, time.time(), until),
    )
    show_token(token, f"operator {name}")


@app.command()
def revoke(
    name: Name, database: DatabaseOption = DEFAULT, database_password_file: PasswordFileOption = None
) -> None:
    """Revoke the operator's token; open connections end within a second."""
    address = database_address(database, database_password_file)
    act(
        address,
        "operators revoke",
        name,
        None,
        lambda connection: accounts.revoke_operator(connection, name, time.time()),
    )
    typer.echo(f"operator {name} is revoked; 'robot-bridge operators rotate' gives a new token")


@app.command()
def role(
    name: Name,
    role: Annotated[Role, typer.Argument(help="The new role.")],
    database: DatabaseOption = DEFAULT,
    database_password_file: PasswordFileOption = None,
) -> None:
    """Give the operator another role; it holds within a second, also for open connections."""
    address = database_address(database, database_password_file)
    act(
        address,
        "operators role",
        name,
        role.value,
        lambda connection: accounts.set_role(connection, name, role),
    )
    typer.echo(f"operator {name} is {role.value} now")


@app.command("list")
def list_all(database: DatabaseOption = DEFAULT, database_password_file: PasswordFileOption = None) -> None:
    """List the operators."""
    address = database_address(database, database_password_file)
    for operator in read(address, accounts.all_operators):
        typer.echo(f"{operator.name}\t{operator.role.value}\t{state_of(operator.token)}")


def show_token(token: str, of: str) -> None:
    """Print a token, alone on standard output so that it can be written into a file."""
    typer.echo(f"The token of {of}; it is shown this once:", err=True)
    typer.echo(token)


def state_of(token: accounts.Grant | None) -> str:
    """Return in words how a token stands."""
    if token is None:
        return "no token"
    if token.revoked_at is not None:
        return f"revoked {moment(token.revoked_at)}"
    expires = f", expires {moment(token.expires_at)}" if token.expires_at is not None else ""
    fault = token.fault(time.time())
    return f"{'expired' if fault else 'valid'}{expires}, last used {moment(token.used_at)}"

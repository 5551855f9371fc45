"""``robot-bridge operators``: who may connect to the desk, and what they may do."""

from __future__ import annotations

import time
from typing import Annotated

import typer

from ..core.messages import Role
from ..gateway.auth import accounts
from .audited import act_audited, after_days, read_database
from .options import DEFAULT, DatabaseOption, PasswordFileOption, database_address
from .tokens import Expires, Name, issuing, revoking, show_token, state_of

app = typer.Typer(help="Accounts of operators: their roles and tokens.", no_args_is_help=True)

RoleOption = Annotated[
    Role, typer.Option(help="viewer sees, operator sends, supervisor clears stops and manages accounts.")
]


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
    token = act_audited(
        address,
        "operators add",
        name,
        role.value,
        lambda connection: accounts.add_operator(connection, name, role, time.time(), until),
    )
    show_token(token, f"operator {name}, {role.value}")


app.command("rotate", help="Print a new token in place of the operator's old one, whose connections end.")(
    issuing("operator", "operators rotate", accounts.rotate_operator)
)
app.command("revoke", help="Revoke the operator's token; open connections end within a second.")(
    revoking("operator", "operators revoke", accounts.revoke_operator, "operators rotate")
)


@app.command()
def role(
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


@app.command("list")
def list_all(database: DatabaseOption = DEFAULT, database_password_file: PasswordFileOption = None) -> None:
    """List the operators."""
    address = database_address(database, database_password_file)
    for operator in read_database(address, accounts.all_operators):
        typer.echo(f"{operator.name}\t{operator.role.value}\t{state_of(operator.token)}")

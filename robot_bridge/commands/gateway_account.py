"""``robot-bridge database account``: the account that the gateway runs under."""

from __future__ import annotations

from typing import Annotated

import typer

from ..messages import check_robot_name
from ..store.accounts.choice import keeper_on
from ..store.address import shown
from .database_option import DEFAULT, DatabaseOption, PasswordFileOption, database_address
from .noted import act
from .passwords import NewPasswordOption, new_password


def account(
    name: Annotated[str, typer.Argument(help="The account's name.")],
    password_file: NewPasswordOption = None,
    database: DatabaseOption = DEFAULT,
    database_password_file: PasswordFileOption = None,
) -> None:
    """Make the account that the gateway runs under: it reads and writes rows and changes no table.

    For PostgreSQL and MariaDB, as an administrator of the server. The password is printed once, alone on
    standard output.
    """
    check_robot_name(name)
    address = database_address(database, database_password_file)
    password = new_password(password_file)
    act(
        address,
        "database account",
        name,
        None,
        lambda connection: keeper_on(connection).add_gateway(name, password),
    )
    if password_file is None:
        print(password)
    gateway = address._replace(username=name, password=None)
    typer.echo(f"account {name} is there: robot-bridge serve --database {shown(gateway)}", err=True)

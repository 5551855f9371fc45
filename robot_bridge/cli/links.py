"""``robot-bridge links``: which adapters may connect, and the robots that each may speak for."""

from __future__ import annotations

import time
from typing import Annotated

import typer

from ..gateway.auth import accounts
from .audited import act_audited, after_days, read_database
from .options import DEFAULT, DatabaseOption, PasswordFileOption, database_address
from .tokens import Expires, Name, issuing, revoking, show_token, state_of

app = typer.Typer(help="Accounts of links, which speak for many robots.", no_args_is_help=True)

RobotsOption = Annotated[
    list[str], typer.Option("--robots", help="Pattern of robots' names, as 'agv-*'; may be given again.")
]


@app.command()
def add(
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


@app.command()
def robots(
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


app.command("rotate", help="Print a new token in place of the link's old one, whose connection ends.")(
    issuing("link", "links rotate", accounts.rotate_link)
)
app.command("revoke", help="Revoke the link's token; its connection ends within a second.")(
    revoking("link", "links revoke", accounts.revoke_link, "links rotate")
)


@app.command("list")
def list_all(database: DatabaseOption = DEFAULT, database_password_file: PasswordFileOption = None) -> None:
    """List the links."""
    address = database_address(database, database_password_file)
    for link in read_database(address, accounts.all_links):
        typer.echo(f"{link.name}\t{' '.join(link.robots)}\t{state_of(link.token)}")

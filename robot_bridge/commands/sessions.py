"""``robot-bridge sessions``: which operators are connected."""

from __future__ import annotations

import time
from typing import Annotated

import typer

from ..access import session_rows
from .database_option import DEFAULT, DatabaseOption, PasswordFileOption, database_address
from .noted import act, moment, read

app = typer.Typer(help="Connections of operators to the desk.", no_args_is_help=True)


@app.command("list")
def list_open(
    everything: Annotated[bool, typer.Option("--all", help="Also those that have ended.")] = False,
    limit: Annotated[int, typer.Option(help="How many at most.", min=1)] = 200,
    database: DatabaseOption = DEFAULT,
    database_password_file: PasswordFileOption = None,
) -> None:
    """List the open sessions, newest first."""
    address = database_address(database, database_password_file)
    found = read(address, lambda c: session_rows.listed(c, everything=everything, limit=limit))
    for session in found:
        ended = ""
        if session.ended_at is not None:
            ended = f"\tended {moment(session.ended_at)}: {session.reason or 'no reason given'}"
        row = (session.id, session.operator, session.role, session.address, moment(session.began_at))
        typer.echo("\t".join(row) + ended)


@app.command()
def end(
    session: Annotated[str, typer.Argument(help="The session's id, or how it begins.")],
    reason: Annotated[str, typer.Option(help="Why; the operator is told.")] = "ended by the site",
    database: DatabaseOption = DEFAULT,
    database_password_file: PasswordFileOption = None,
) -> None:
    """End a session within a second; the token stays valid."""
    address = database_address(database, database_password_file)
    ended = act(
        address, "sessions end", session, reason, lambda c: session_rows.end(c, session, time.time(), reason)
    )
    typer.echo(f"session {ended.id} of {ended.operator} is ended")

"""``robot-bridge sessions``: which operators are connected."""

from __future__ import annotations

import time
from typing import Annotated

import typer

from ..gateway.auth import audit
from .audited import act_audited, local_time, read_database
from .options import DEFAULT, DatabaseOption, PasswordFileOption, database_address

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
    found = read_database(address, lambda c: audit.list_sessions(c, everything=everything, limit=limit))
    for session in found:
        ended = ""
        if session.ended_at is not None:
            ended = f"\tended {local_time(session.ended_at)}: {session.reason or 'no reason given'}"
        row = (session.id, session.operator, session.role, session.address, local_time(session.began_at))
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
    ended = act_audited(
        address, "sessions end", session, reason, lambda c: audit.end_session(c, session, time.time(), reason)
    )
    typer.echo(f"session {ended.id} of {ended.operator} is ended")

"""``robot-bridge robots token|revoke|tokens``: which robots may connect over WebSocket."""

from __future__ import annotations

import typer

from ..access import accounts
from .database_option import DEFAULT, DatabaseOption, PasswordFileOption, database_address
from .noted import read
from .token_commands import issuing, revoking, state_of

ISSUE_HELP = "Print a new token for the robot's WebSocket, in place of its old one; it is shown this once."
REVOKE_HELP = "Revoke the robot's token; its connection ends within a second."


def tokens(database: DatabaseOption = DEFAULT, database_password_file: PasswordFileOption = None) -> None:
    """List the robots that have, or had, a token."""
    address = database_address(database, database_password_file)
    for grant in read(address, accounts.robot_tokens):
        typer.echo(f"{grant.owner}\t{state_of(grant)}")


def add_to(app: typer.Typer) -> None:
    """Put the three commands into the group ``robots``."""
    issue = issuing("robot", "robots token", accounts.issue_robot_token)
    revoke = revoking("robot", "robots revoke", accounts.revoke_robot_token, "robots token")
    app.command("token", help=ISSUE_HELP)(issue)
    app.command("revoke", help=REVOKE_HELP)(revoke)
    app.command()(tokens)

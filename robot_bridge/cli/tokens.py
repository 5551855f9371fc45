"""Commands for tokens of operators, robots and links, and new passwords."""

from __future__ import annotations

import secrets
import time
from collections.abc import Callable
from pathlib import Path
from typing import Annotated

import typer
from sqlalchemy import Connection

from ..gateway.auth import accounts
from ..gateway.storage.database import read_password
from .audited import act_audited, after_days, local_time
from .options import DEFAULT, DatabaseOption, PasswordFileOption, database_address

# --- The password of an account that a command makes: out of a file, or a random one that is shown once

RANDOM_BYTES = 24

NewPasswordOption = Annotated[
    Path | None,
    typer.Option(
        "--password-file",
        help="File whose first line becomes the password; without it one is made and shown.",
    ),
]


def new_password(file: Path | None) -> str:
    """Return the password in ``file``, or a random one; raises StoreError when the file cannot be used."""
    return secrets.token_urlsafe(RANDOM_BYTES) if file is None else read_password(file)


# --- The two commands that operators and robots have in common: a new token, and none any more ---

Name = Annotated[str, typer.Argument(help="Its name, as it stands in every log.")]
Expires = Annotated[float | None, typer.Option(help="Days until the token expires.", min=0.0)]


def issuing(
    kind: str, action: str, issue: Callable[[Connection, str, float, float | None], str]
) -> Callable[..., None]:
    """Return the command ``action`` that prints a new token of an account of ``kind``.

    ``issue(connection, name, now, until)`` makes it in place of the old one, times in seconds since 1970.
    """

    def command(
        name: Name,
        expires_days: Expires = None,
        database: DatabaseOption = DEFAULT,
        database_password_file: PasswordFileOption = None,
    ) -> None:
        until = after_days(expires_days)
        address = database_address(database, database_password_file)
        token = act_audited(
            address, action, name, None, lambda connection: issue(connection, name, time.time(), until)
        )
        show_token(token, f"{kind} {name}")

    return command


def revoking(
    kind: str, action: str, revoke: Callable[[Connection, str, float], object], renewing: str
) -> Callable[..., None]:
    """Return the command ``action`` that takes an account's token away; ``renewing`` gives a new one.

    ``revoke(connection, name, now)`` does it, now in seconds since 1970.
    """

    def command(
        name: Name, database: DatabaseOption = DEFAULT, database_password_file: PasswordFileOption = None
    ) -> None:
        address = database_address(database, database_password_file)
        act_audited(address, action, name, None, lambda connection: revoke(connection, name, time.time()))
        typer.echo(f"{kind} {name} is revoked; 'robot-bridge {renewing}' gives a new token")

    return command


def show_token(token: str, of: str) -> None:
    """Print a token, alone on standard output so that it can be written into a file."""
    typer.echo(f"The token of {of}; it is shown this once:", err=True)
    typer.echo(token)


def state_of(token: accounts.Grant | None) -> str:
    """Return in words how a token stands."""
    if token is None:
        return "no token"
    if token.revoked_at is not None:
        return f"revoked {local_time(token.revoked_at)}"
    expires = f", expires {local_time(token.expires_at)}" if token.expires_at is not None else ""
    fault = token.fault(time.time())
    return f"{'expired' if fault else 'valid'}{expires}, last used {local_time(token.used_at)}"

"""The options by which every command is told its database."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from sqlalchemy import URL

DEFAULT = "sqlite:///robot-bridge.db"

DatabaseOption = Annotated[
    str,
    typer.Option(
        "--database",
        envvar="ROBOT_BRIDGE_DATABASE",
        help="sqlite:////PATH, postgresql://ACCOUNT@HOST/NAME or mariadb://ACCOUNT@HOST/NAME.",
    ),
]
PasswordFileOption = Annotated[
    Path | None,
    typer.Option(
        "--database-password-file",
        envvar="ROBOT_BRIDGE_DATABASE_PASSWORD_FILE",
        help="File with the database account's password; a command line can be seen by others.",
    ),
]


def database_address(database: str, password_file: Path | None) -> URL:
    """Return the address that the two options give; raises StoreError."""
    from ..store.address import read_address

    return read_address(database, password_file)

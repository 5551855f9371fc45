"""The password of an account that a command makes: out of a file, or a random one that is shown once."""

from __future__ import annotations

import secrets
from pathlib import Path
from typing import Annotated

import typer

from ..store.address import read_password

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

"""``robot-bridge schemas``: the JSON Schema of every message, and the AsyncAPI document, as files."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..core.errors import BridgeError
from ..core.files import replacement


def schemas(
    folder: Annotated[Path, typer.Argument(help="Where to write them; made if it is not there.")],
) -> None:
    """Write the JSON Schema of every message, and the AsyncAPI document of all endpoints."""
    from ..protocol.asyncapi import documents

    for path, text in documents().items():
        file = folder / path
        try:
            file.parent.mkdir(parents=True, exist_ok=True)
            with replacement(file) as made:
                made.write_text(text, encoding="utf-8")
        except OSError as error:
            raise BridgeError(
                f"{file} cannot be written: {error.strerror or error}; choose another folder"
            ) from error
    print(f"{len(documents())} documents in {folder}")

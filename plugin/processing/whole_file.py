"""Files that are there whole or not at all."""

from __future__ import annotations

import os
from contextlib import suppress
from pathlib import Path

from ..errors import FleetError


class OutputError(FleetError):
    """The output file cannot be written."""


def write_whole(target: Path, content: bytes) -> None:
    """Write ``content`` to ``target`` by way of a file beside it: what stood there stays until the end.

    :raises OutputError: naming the file and what to do; nothing is left behind.
    """
    part = target.with_name(f".{target.name}.{os.getpid()}.part")
    try:
        part.write_bytes(content)
        part.replace(target)
    except OSError as error:
        with suppress(OSError):
            part.unlink()
        raise OutputError(
            f"The robot map cannot be written to {target}: {error.strerror or error}. "
            "Choose a file in a folder that exists and may be written to."
        ) from error

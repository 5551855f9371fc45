"""Files that are there whole or not at all."""

from __future__ import annotations

import os
from contextlib import suppress
from pathlib import Path

from ..errors import FleetError
from ..language import tr


class OutputError(FleetError):
    """The output file cannot be written."""


def write_whole(target: Path, content: bytes, what: str = tr("The robot map")) -> None:
    """Write ``content`` to ``target`` by way of a file beside it: what stood there stays until the end.

    ``what`` it is, is said when it cannot be written.

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
            tr(
                "{what} cannot be written to {target}: {reason}. Choose a file in a folder that exists and "
                "may be written to.",
                what=what,
                target=target,
                reason=error.strerror or error,
            )
        ) from error

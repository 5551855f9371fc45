"""Files that are there whole or not at all."""

from __future__ import annotations

import os
from contextlib import suppress
from pathlib import Path
from uuid import uuid4

from ..errors import FleetError
from ..language import tr


class OutputError(FleetError):
    """The output file cannot be written."""


def check_target(target: Path, what: str) -> None:
    """Raise :class:`OutputError` unless ``what`` can be written to ``target``, as far as can be told before.

    What is no file, such as a pipe or /dev/null, is refused: it would be replaced by one.
    """
    try:
        hindrance = _hindrance(Path(os.path.realpath(target)))
    except OSError as error:
        hindrance = error.strerror or str(error)
    if hindrance:
        raise _not_written(what, target, hindrance)


def write_whole(target: Path, content: bytes, what: str = tr("The robot map")) -> None:
    """Write ``content`` to ``target`` by way of a file beside it: what stood there stays until the end.

    ``what`` it is, is said when it cannot be written. Of a link the file behind it is replaced.

    :raises OutputError: naming the file and what to do; nothing is left behind.
    """
    check_target(target, what)
    file = Path(os.path.realpath(target))
    # Not from the file's own name, which may be as long as names may be.
    part = file.with_name(f".{uuid4().hex}.part")
    try:
        part.write_bytes(content)
        part.replace(file)
    except OSError as error:
        with suppress(OSError):
            part.unlink()
        raise _not_written(what, target, error.strerror or str(error)) from error


def _hindrance(file: Path) -> str:
    """Return why ``file`` cannot be written, nothing where nothing is known to be in the way."""
    folder = file.parent
    if file.exists() and not file.is_file():
        return tr("it is there and is no file")
    if not folder.is_dir():
        return tr("there is no folder {folder}", folder=folder)
    return (
        "" if os.access(folder, os.W_OK) else tr("the folder {folder} may not be written to", folder=folder)
    )


def _not_written(what: str, target: Path, reason: str) -> OutputError:
    return OutputError(
        tr(
            "{what} cannot be written to {target}: {reason}. Choose a file in a folder that exists, may be "
            "written to, and has space.",
            what=what,
            target=target,
            reason=reason,
        )
    )

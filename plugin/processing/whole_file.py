"""Files that are there whole or not at all."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
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


@contextmanager
def replaced_whole(target: Path | None, what: str) -> Iterator[None]:
    """Let the block write the layer file ``target`` whole or not at all: if it fails all is as it was before.

    With None the block writes no file. ``what`` it is, is said when what stood there is in the way.

    :raises OutputError: naming the file and what to do.
    """
    file = None if target is None else Path(os.path.realpath(target))
    aside: dict[Path, Path] = {}
    try:
        for part in _parts_of(file):
            if part.exists():
                part.replace(aside.setdefault(part, part.with_name(f".{uuid4().hex}.part")))
    except OSError as error:
        _put_back(aside)
        raise _not_written(what, file, error.strerror or str(error)) from error
    try:
        yield
    except BaseException:
        for part in _parts_of(file):
            part.unlink(missing_ok=True)
        _put_back(aside)
        raise
    for kept in aside.values():
        kept.unlink(missing_ok=True)


def _parts_of(file: Path | None) -> list[Path]:
    """Return the files that a layer in ``file`` consists of, or that are beside it while it is written."""
    if file is None:
        return []
    beside = [Path(f"{file}{ending}") for ending in ("-journal", "-wal", "-shm")]
    if file.suffix.lower() == ".shp":
        beside = [file.with_suffix(suffix) for suffix in (".dbf", ".shx", ".prj", ".cpg")]
    return [file, *beside]


def _put_back(aside: Mapping[Path, Path]) -> None:
    for part, kept in aside.items():
        if kept.exists():
            kept.replace(part)


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

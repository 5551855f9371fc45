"""One publication at a time into a folder, whichever processes publish."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from qgis.PyQt.QtCore import QLockFile

from ..language import tr
from .errors import PublicationError

LOCK_FILE = ".publishing.lock"


@contextmanager
def only_publication(folder: Path) -> Iterator[None]:
    """Keep other publications out of ``folder``, which is made where it is missing, until the block ends.

    A lock that a process left behind when it was killed holds nobody up.

    :raises PublicationError: when another publication is under way, or the folder cannot be written.
    """
    is_new = not folder.exists()
    _check_is_folder(folder)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise unwritable(folder, error.strerror or str(error)) from error
    lock = QLockFile(str(folder / LOCK_FILE))
    # However long a publication takes: the lock is void only when its process has ended.
    lock.setStaleLockTime(0)
    if not lock.tryLock(0):
        raise _why_not(lock, folder)
    try:
        yield
    finally:
        lock.unlock()
        if is_new:
            with suppress(OSError):
                folder.rmdir()


def unwritable(folder: Path, reason: str) -> PublicationError:
    """Return the error of a ``folder`` that cannot be written for ``reason``."""
    return PublicationError(
        tr(
            "The site cannot be published in {folder}: {reason}. Check the folder's rights and the free "
            "space.",
            folder=folder,
            reason=reason,
        )
    )


def _check_is_folder(folder: Path) -> None:
    in_the_way = next(
        (path for path in (folder, *folder.parents) if path.exists() and not path.is_dir()), None
    )
    if in_the_way is not None:
        raise PublicationError(
            tr(
                "The site cannot be published in {folder}: {file} is a file. Choose a folder: a new one, or "
                "the one that the site was published in before.",
                folder=folder,
                file=in_the_way,
            )
        )


def _why_not(lock: QLockFile, folder: Path) -> PublicationError:
    if lock.error() != QLockFile.LockError.LockFailedError:
        return unwritable(folder, tr("no file {lock_file} can be made in it", lock_file=LOCK_FILE))
    known, process, host, _ = lock.getLockInfo()
    who = tr("process {process} on {host}", process=process, host=host) if known else tr("another process")
    return PublicationError(
        tr(
            "Another publication into {folder} is under way, by {who}: wait until it has ended, or choose "
            "another folder. If it ended on another computer without a word, remove {file}.",
            folder=folder,
            who=who,
            file=folder / LOCK_FILE,
        )
    )

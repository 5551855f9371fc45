"""A folder of files that appear all together or not at all."""

from __future__ import annotations

import os
import shutil
from contextlib import suppress
from pathlib import Path

from ..language import tr
from .whole_file import OutputError


class WholeFolder:
    """Collects files beside ``target``'s own and moves them there at the end.

    To be used in a ``with`` block. What was not published when it ends is removed, and so is a folder that
    was made for it; what was published when it ends by an exception is taken back, and what was there before
    put in its place. Files of other names in ``target`` are left alone.

    :raises OutputError: when the folder or a file in it cannot be written.
    """

    def __init__(self, target: Path, what: str):
        """Collect files for the folder ``target``; ``what`` they are is said when they cannot be written."""
        self.target, self._what = target, what
        self._stage = target / f".fleet.{os.getpid()}.part"
        self._new, self._earlier = self._stage / "new", self._stage / "earlier"
        self._made: list[Path] = []
        self._published: list[str] = []

    def __enter__(self) -> WholeFolder:
        self._made = [path for path in (self.target, *self.target.parents) if not path.exists()]
        try:
            self._new.mkdir(parents=True)
            self._earlier.mkdir()
        except OSError as error:
            self._clear()
            raise self._failed(error) from error
        return self

    def add(self, name: str, content: bytes) -> None:
        """Keep ``content`` to become the file ``name``."""
        if (self.target / name).is_dir():
            raise OutputError(
                tr(
                    "{path} is a folder, where a file is to be written: choose another OUTPUT.",
                    path=self.target / name,
                )
            )
        try:
            (self._new / name).write_bytes(content)
        except OSError as error:
            raise self._failed(error) from error

    def publish(self) -> None:
        """Put every file into its place."""
        try:
            for file in sorted(self._new.iterdir()):
                place = self.target / file.name
                if place.exists():
                    place.replace(self._earlier / file.name)
                self._published.append(file.name)
                file.replace(place)
        except OSError as error:
            raise self._failed(error) from error

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        if kind is not None:
            self._take_back()
        self._clear()

    def _take_back(self) -> None:
        for name in self._published:
            with suppress(OSError):
                (self.target / name).unlink()
        self._published = []
        for file in self._earlier.glob("*"):
            with suppress(OSError):
                file.replace(self.target / file.name)

    def _clear(self) -> None:
        shutil.rmtree(self._stage, ignore_errors=True)
        if self._published:
            return
        for folder in self._made:
            with suppress(OSError):
                folder.rmdir()

    def _failed(self, error: OSError) -> OutputError:
        return OutputError(
            tr(
                "{what} cannot be written to {folder}: {reason}. Choose a folder that may be written to, and "
                "check the free space.",
                what=self._what,
                folder=self.target,
                reason=error.strerror or error,
            )
        )

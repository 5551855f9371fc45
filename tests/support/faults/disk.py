"""A small disk of one's own that can be filled up: a tmpfs, which takes the right to mount."""

from __future__ import annotations

import subprocess
from pathlib import Path

from tests.support.errors import StageError

CHUNK = 4096


class Disk:
    """A context in which ``folder`` is a disk of ``megabytes``; it is gone when this program is."""

    def __init__(self, folder: Path, megabytes: int = 64) -> None:
        self.folder = folder
        self._megabytes = megabytes

    def __enter__(self) -> Disk:
        self.folder.mkdir()
        options = ["-t", "tmpfs", "-o", f"size={self._megabytes}m,mode=700", "tmpfs", str(self.folder)]
        done = subprocess.run(["mount", *options], capture_output=True, text=True, check=False)
        if done.returncode:
            raise StageError(f"a disk to fill up takes the right to mount one: {done.stderr.strip()}")
        self._remover = subprocess.Popen(
            ["sh", "-c", 'read -r _; umount -l "$0"', str(self.folder)],
            stdin=subprocess.PIPE,
            start_new_session=True,
        )
        return self

    def __exit__(self, *_: object) -> None:
        assert self._remover.stdin is not None
        self._remover.stdin.close()
        self._remover.wait()

    def fill(self) -> None:
        """Write until there is no room left."""
        with (self.folder / "filler").open("wb", buffering=0) as filler:
            try:
                while True:
                    filler.write(bytes(CHUNK))
            except OSError:
                return

    def free(self) -> None:
        """Give the room back."""
        (self.folder / "filler").unlink()

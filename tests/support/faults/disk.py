"""Small disks of one's own that can be filled up, and one that can lose its power; root mounts them."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

from tests.support.errors import StageError

CHUNK = 4096
STILL = 50
"""times that a disk is copied until nothing was written to it meanwhile."""


class Disk:
    """A context in which ``folder`` is a disk of ``megabytes``; it is gone when this program is."""

    def __init__(self, folder: Path, megabytes: int = 64) -> None:
        self.folder = folder
        self._megabytes = megabytes

    def __enter__(self) -> Disk:
        self.folder.mkdir()
        self._mount()
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

    def _mount(self) -> None:
        options = [f"size={self._megabytes}m,mode=700", "tmpfs", str(self.folder)]
        _run("mount", "-t", "tmpfs", "-o", *options)


class DiskWithPower(Disk):
    """A :class:`Disk` of ext4 in a file, whose power can be cut: what was not written to it yet is lost.

    What was written to it is there afterwards, in whatever order: it has no cache of its own that would be
    lost or that says what is not so.
    """

    def cut_power(self) -> None:
        """Have it be what it is at this moment, in place of what it would become; nobody uses it by now.

        :raises StageError: when it cannot be read then, or something goes on writing to it.
        """
        then = self._image.with_suffix(".then")
        for _ in range(STILL):
            before = self._writes()
            shutil.copyfile(self._image, then)
            if before == self._writes():
                break
        else:
            raise StageError(f"something goes on writing to {self.folder}, on which nobody works any more")
        _run("umount", str(self.folder))
        then.replace(self._image)
        # As at the start of a computer; 1 says that something was put right.
        _run("fsck.ext4", "-p", str(self._image), good=(0, 1))
        self._attach()

    def _mount(self) -> None:
        self._image = self.folder.with_suffix(".image")
        with self._image.open("wb") as image:
            image.truncate(self._megabytes << 20)
        _run("mkfs.ext4", "-q", "-F", "-m", "0", str(self._image))
        self._attach()

    def _attach(self) -> None:
        _run("mount", "-t", "ext4", "-o", "loop,nodiscard", str(self._image), str(self.folder))
        self._device = Path("/sys/dev/block") / _device_of(self.folder)

    def _writes(self) -> tuple[str, ...]:
        """Return how many writes the disk has taken, and how many are on their way."""
        figures = (self._device / "stat").read_text(encoding="ascii").split()
        return figures[4], figures[6], figures[8]


def _device_of(folder: Path) -> str:
    """Return the number of the device that is mounted on ``folder``, as in ``7:0``."""
    for line in Path("/proc/self/mountinfo").read_text(encoding="utf-8").splitlines():
        words = line.split()
        if words[4] == str(folder):
            return words[2]
    raise StageError(f"{folder} is not mounted")


def _run(*command: str, good: tuple[int, ...] = (0,)) -> None:
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=False)
    except FileNotFoundError:
        raise StageError(f"{command[0]} is not on this machine") from None
    if done.returncode not in good:
        said = (done.stderr or done.stdout).strip()
        raise StageError(f"a disk to break takes the right to mount one: {said}")

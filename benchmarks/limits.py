"""A smaller computer than this one: control groups of Linux that hold processes to some of it."""

from __future__ import annotations

import contextlib
import subprocess
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

MOUNT = Path("/sys/fs/cgroup")
OWN = Path("/proc/self/cgroup")
PERIOD_US = 10_000
"""A group's processor time is counted anew so often; the longer, the longer it stands still at once."""
_KINDS = ("cpu", "cpuacct", "cpuset", "memory")
"""Controllers, each with a tree of its own in the first version of control groups."""
_ENTER = 'for group in $GROUPS_TO_ENTER; do echo $$ >"$group/cgroup.procs" || exit; done; exec "$@"'
_REMOVE = (
    'read -r _; for time in once again and again and then once more; do for group; do [ ! -d "$group" ] || '
    'rmdir "$group"; done; [ -d "$group" ] || break; sleep 0.2; done 2>/dev/null'
)
"""Once nobody writes to it any more."""


class LimitError(Exception):
    """Why no such computer can be made here, and what to do."""


@dataclass(frozen=True)
class Throttling:
    """Periods of PERIOD_US, those in which a group had used up its time, and the seconds it stood still."""

    periods: int
    throttled: int
    seconds: float

    def __sub__(self, before: Throttling) -> Throttling:
        return Throttling(
            self.periods - before.periods, self.throttled - before.throttled, self.seconds - before.seconds
        )


class Group:
    """Processes that are held and counted together: ``folders`` by controller.

    There is one folder for all controllers in the second version of control groups.
    """

    def __init__(self, folders: dict[str, Path]) -> None:
        self._folders = folders
        self._is_second = len(set(folders.values())) == 1

    @property
    def through(self) -> list[str]:
        """What begins a command, so that it runs inside."""
        groups = " ".join(str(folder) for folder in dict.fromkeys(self._folders.values()))
        return ["env", f"GROUPS_TO_ENTER={groups}", "sh", "-c", _ENTER, "enter"]

    def hold(self, *, cores: float | None = None, megabytes: float | None = None, cpus: str = "") -> None:
        """Let it have no more than ``cores`` of processor time, so much memory, and these processors."""
        if cores is not None:
            quota = round(cores * PERIOD_US)
            if self._is_second:
                self._write("cpu", "cpu.max", f"{quota} {PERIOD_US}")
            else:
                self._write("cpu", "cpu.cfs_period_us", str(PERIOD_US))
                self._write("cpu", "cpu.cfs_quota_us", str(quota))
        if megabytes is not None:
            name = "memory.max" if self._is_second else "memory.limit_in_bytes"
            self._write("memory", name, str(round(megabytes * 1e6)))
        if cpus:
            self._write("cpuset", "cpuset.cpus", cpus)

    def cpu_seconds(self) -> float:
        """Return the processor time that its processes have used, ended ones included."""
        if self._is_second:
            return self._numbers("cpu", "cpu.stat")["usage_usec"] / 1e6
        return int(self._read("cpuacct", "cpuacct.usage")) / 1e9

    def throttling(self) -> Throttling:
        """Return how long it was held since it was made."""
        found = self._numbers("cpu", "cpu.stat")
        seconds = found["throttled_usec"] / 1e6 if self._is_second else found["throttled_time"] / 1e9
        return Throttling(found["nr_periods"], found["nr_throttled"], seconds)

    def megabytes(self) -> float:
        """Return the memory that its processes hold now, without files that the system keeps for them."""
        found = self._numbers("memory", "memory.stat")
        if self._is_second:
            return (found["anon"] + found["shmem"]) / 1e6
        return (found["total_rss"] + found["total_shmem"]) / 1e6

    def megabytes_with_files(self) -> float:
        """Return all the memory that counts for it now."""
        name = "memory.current" if self._is_second else "memory.usage_in_bytes"
        return int(self._read("memory", name)) / 1e6

    def killed(self) -> int:
        """Return how many of its processes the system killed for want of memory.

        Those of groups below it count in the second version of control groups only.
        """
        name = "memory.events" if self._is_second else "memory.oom_control"
        return self._numbers("memory", name)["oom_kill"]

    def _read(self, kind: str, name: str) -> str:
        return (self._folders[kind] / name).read_text(encoding="ascii")

    def _numbers(self, kind: str, name: str) -> dict[str, int]:
        return {key: int(value) for key, value in map(str.split, self._read(kind, name).splitlines())}

    def _write(self, kind: str, name: str, value: str) -> None:
        try:
            (self._folders[kind] / name).write_text(value, encoding="ascii")
        except OSError as error:
            raise LimitError(f"{self._folders[kind] / name} takes no {value}: {error.strerror}") from None


@contextlib.contextmanager
def small_computer(
    name: str, parts: Sequence[str], *, cores: float, megabytes: float, cpus: str
) -> Iterator[tuple[Group, dict[str, Group]]]:
    """Give a group that holds all of ``parts`` to so much together, and a group of each part below it.

    In the first version of control groups it is below the groups that this process is in, so that what holds
    this process holds all; in the second, where a group with processes has none below it, at the root.

    :raises LimitError: where this system or this account makes no groups.
    """
    roots = _roots()
    made = {kind: root / name for kind, root in roots.items()}
    folders = [made, *({kind: folder / part for kind, folder in made.items()} for part in parts)]
    with _removing([folder for each in reversed(folders) for folder in dict.fromkeys(each.values())]):
        whole, *below = (Group(each) for each in folders)
        _make(made)
        # Before there are groups below it, which would have what is taken from it.
        whole.hold(cores=cores, megabytes=megabytes, cpus=cpus)
        for each in folders[1:]:
            _make(each)
        yield whole, dict(zip(parts, below, strict=True))


def _roots() -> dict[str, Path]:
    """Return below which folder groups are made, by controller."""
    if (MOUNT / "cgroup.controllers").is_file():
        return dict.fromkeys(_KINDS, MOUNT)
    own = {}
    for line in OWN.read_text(encoding="ascii").splitlines():
        _, kinds, path = line.split(":", 2)
        own |= dict.fromkeys(kinds.split(","), path)
    roots = {}
    for kind in _KINDS:
        if not (MOUNT / kind).is_dir() or kind not in own:
            raise LimitError(f"this system has no control groups for {kind}: there is no {MOUNT / kind}")
        # In a container the path may be that of the computer around it.
        inside = MOUNT / kind / own[kind].lstrip("/")
        roots[kind] = (inside if inside.is_dir() else MOUNT / kind).resolve()
    return roots


def _make(folders: dict[str, Path]) -> None:
    different = list(dict.fromkeys(folders.values()))
    for folder in different:
        try:
            if len(different) == 1:
                (folder.parent / "cgroup.subtree_control").write_text("+cpu +cpuset +memory", "ascii")
            folder.mkdir()
            if len(different) > 1 and folder == folders["cpuset"]:
                # A new group has no processors and no memory until it is given some.
                for name in ("cpuset.cpus", "cpuset.mems"):
                    (folder / name).write_text((folder.parent / name).read_text("ascii"), "ascii")
        except OSError as error:
            text = f"control group {folder} cannot be made ({error.strerror}); run it as root"
            raise LimitError(text) from None


@contextlib.contextmanager
def _removing(folders: list[Path]) -> Iterator[None]:
    """Remove groups at the end, also where this program is killed; their processes have ended by then."""
    remover = subprocess.Popen(
        ["sh", "-c", _REMOVE, "remove", *map(str, folders)], stdin=subprocess.PIPE, start_new_session=True
    )
    try:
        yield
    finally:
        remover.communicate()

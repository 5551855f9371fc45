"""Memory of a link on the disk, so that a restarted process executes nothing twice."""

from __future__ import annotations

import asyncio
import contextlib
import errno
import fcntl
import itertools
import json
import logging
import os
import secrets
import time
from collections import OrderedDict
from collections.abc import AsyncIterator, Iterable, Iterator
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import Any

from ...core.files import place_beside, sync_folder, write_beside, write_state
from ...core.json_decoder import SHORT, DecodingError, decode_json
from .errors import LinkError

log = logging.getLogger(__name__)

MOST_OPEN = 20
"""unfinished messages of one robot: its map, its start, a target."""
MOST_DONE = 1000
"""remembered messages of one robot: many more than a gateway ever has in flight."""
LARGER = 4
"""times as large as its state the file may be; then it is rewritten."""
SMALL_FILE = 1 << 20
"""bytes of a file that is not rewritten."""
LOCKED_FOR = 5.0
"""seconds for the link's previous process to end."""
PASSING = frozenset({errno.ENOSPC, errno.EDQUOT, errno.EROFS, errno.EIO})
"""errors of a file set up correctly, with a full or broken disk. A link still stops its robots."""


@dataclass(frozen=True)
class CompletedCall:
    """Outcome of a message: ``refusal`` is None if the robot accepted it."""

    refusal: str | None = None


@dataclass
class _Robot:
    magic: int
    begun: OrderedDict[int, CompletedCall | None] = field(default_factory=OrderedDict)
    """outcome of each message, None while unknown."""


class LinkMemory:
    """The runs of robots, and the outcomes of their messages, in a file.

    Lines are appended, and the file is rewritten with the present state when it is much larger than that.
    Without a file it lasts as long as the process. While its disk is full or broken no message is begun,
    since another process would repeat it; stops need no memory.
    """

    def __init__(self, file: Path | None = None) -> None:
        self._file = file
        self._database: str | None = None
        self._frame: str | None = None
        self._adrift: set[str] = set()
        self._robots: dict[str, _Robot] = {}
        self._writing = asyncio.Lock()
        self._fault: OSError | None = None
        self._revision = 0
        """number of changes that :meth:`_append_if_possible` was called for."""
        self._size, self._largest = 0, SMALL_FILE
        """bytes of the file, and those at which it is rewritten."""
        if file is not None:
            self._load(file)
            self._begin_file(file)

    @property
    def fault(self) -> str | None:
        """Why nothing can be written now, None if everything is in the file."""
        if self._fault is None:
            return None
        return f"memory {self._file} cannot be written: {self._fault.strerror or self._fault}"

    def magic(self, robot: str) -> int:
        """Return the number of the robot's run; a new one for an unknown robot."""
        known = self._robots.get(robot)
        return known.magic if known is not None else self.renew(robot)

    def renew(self, robot: str) -> int:
        """Return a new run number for a robot that has restarted and forgotten its tasks."""
        magic = secrets.randbits(53)
        begun = self._robots[robot].begun if robot in self._robots else OrderedDict()
        self._robots[robot] = _Robot(magic, begun)
        self._append_if_possible({"robot": robot, "magic": magic})
        return magic

    def use_database(self, database: str, frame: str = "") -> bool:
        """Forget the messages of another database: its ids start again.

        ``frame`` is the frame of robots' coordinates. Robots with commands from another database, or in
        another frame, are adrift; return whether the database is another one.
        """
        before = self._database, self._frame
        if before == (database, frame):
            return False
        is_other = before[0] not in (None, database) or before[1] not in (None, frame)
        if is_other:
            # Before the rest: a process restarted after a kill in between finds another database again.
            for name in [name for name, robot in self._robots.items() if robot.begun]:
                self.set_adrift(name)
        self._serve(database, frame)
        self._append_if_possible({"database": database, "frame": frame})
        return is_other

    def _serve(self, database: str, frame: str | None) -> None:
        if database != self._database:
            for robot in self._robots.values():
                robot.begun.clear()
        self._database, self._frame = database, frame

    def is_adrift(self, robot: str) -> bool:
        """Return whether a robot may execute a task from another database, or in another frame."""
        return robot in self._adrift

    def set_adrift(self, robot: str) -> None:
        """Record that a robot is adrift, until :meth:`clear_adrift`, also over restarts."""
        if robot not in self._adrift:
            self._adrift.add(robot)
            self._append_if_possible({"robot": robot, "adrift": True})

    def clear_adrift(self, robot: str) -> None:
        """Record that a robot was stopped."""
        if robot in self._adrift:
            self._adrift.discard(robot)
            self._append_if_possible({"robot": robot, "adrift": False})

    def find(self, robot: str, id: int) -> CompletedCall | None:
        """Return the outcome of a message, None if it was never finished."""
        known = self._robots.get(robot)
        return None if known is None else known.begun.get(id)

    def has_begun(self, robot: str, id: int) -> bool:
        """Return whether a message of this database was ever begun."""
        return robot in self._robots and id in self._robots[robot].begun

    def taken_on(self, robot: str) -> list[int]:
        """Return the newest messages that a robot accepted: its present task is one of them."""
        known = self._robots.get(robot)
        begun = () if known is None else known.begun.items()
        return [id for id, done in begun if done == CompletedCall()][-MOST_OPEN:]

    async def begin(self, robot: str, id: int) -> bool:
        """Record that a message is about to be executed; return whether it was begun before.

        :raises LinkError: when that cannot be written; the message must not be executed then.
        """
        begun = self._robots[robot].begun
        if id in begun:
            return True
        self._note(robot, id, None)
        await self._append_surely({"robot": robot, "begun": id})
        return False

    async def finish(self, robot: str, id: int, done: CompletedCall) -> None:
        """Record the outcome of a message; it is on the disk on return, if the disk is writable."""
        self._note(robot, id, done)
        refusal = {} if done.refusal is None else {"refusal": done.refusal}
        with contextlib.suppress(LinkError):
            await self._append_surely({"robot": robot, "done": id, **refusal})

    def _note(self, robot: str, id: int, done: CompletedCall | None) -> None:
        begun = self._robots[robot].begun
        begun[id] = done
        while len(begun) > MOST_DONE:
            begun.popitem(last=False)

    # --- the file -------------------------------------------------------------------------------------------

    async def recover(self) -> None:
        """Write the data that failed before, if possible by now."""
        if self._fault is not None:
            with contextlib.suppress(LinkError):
                await self._append_surely({})

    def _append_if_possible(self, line: dict[str, Any]) -> None:
        self._revision += 1
        if self._fault is None:
            with contextlib.suppress(LinkError):
                self._append(line)

    async def _append_surely(self, line: dict[str, Any]) -> None:
        """Append a line, or the whole state if an earlier append failed; raises LinkError."""
        if self._file is not None:
            # The lock is held to the end of the writing, also when the message is given up.
            await asyncio.shield(self._write_surely(line))

    async def _write_surely(self, line: dict[str, Any]) -> None:
        async with self._writing:
            try:
                if self._fault is None:
                    await asyncio.to_thread(self._append, line, surely=True)
                else:
                    await asyncio.to_thread(self._rewrite, self._lines(), self._revision)
            except LinkError:
                # Before the next message writes the state.
                if "begun" in line:
                    self._robots[line["robot"]].begun.pop(line["begun"], None)
                raise
            if self._size > self._largest:
                await self._compact()

    def _append(self, line: dict[str, Any], *, surely: bool = False) -> None:
        if self._file is None:
            return
        try:
            with self._file.open("ab") as out:
                out.write(_encoded(line))
                out.flush()
                self._size = out.tell()
                if surely:
                    os.fsync(out.fileno())
        except OSError as error:
            raise self._failed(error) from None

    def _rewrite(self, lines: Iterable[dict[str, Any]], revision: int) -> None:
        assert self._file is not None
        try:
            self._begin_size(_write_lines(self._file, lines))
        except OSError as error:
            raise self._failed(error) from None
        if revision == self._revision:
            log.warning("memory %s can be written again", self._file)
            self._fault = None

    async def _compact(self) -> None:
        """Replace the file by its present state; appending to it goes on where that is impossible."""
        assert self._file is not None
        revision = self._revision
        try:
            beside, size = await asyncio.to_thread(_write_lines_beside, self._file, self._lines())
            if revision != self._revision:
                # Something was appended meanwhile, which the next message includes.
                return
            beside.replace(self._file)
        except OSError as error:
            log.warning("memory %s cannot be made smaller: %s", self._file, error.strerror or error)
            self._largest = 2 * self._size
            # A part of it would take the room that the next message needs.
            with contextlib.suppress(OSError):
                place_beside(self._file).unlink(missing_ok=True)
            return
        self._begin_size(size)
        await asyncio.to_thread(sync_folder, self._file.parent)

    def _begin_size(self, size: int) -> None:
        self._size, self._largest = size, max(SMALL_FILE, LARGER * size)

    def _failed(self, error: OSError) -> LinkError:
        if self._fault is None:
            log.error("memory %s cannot be written: %s", self._file, error.strerror or error)
        self._fault = error
        return LinkError(f"{self.fault}; robots can be stopped, and take on nothing until it can")

    def _load(self, file: Path) -> None:
        left_out = 0
        try:
            with file.open("rb") as lines:
                # In pieces, whatever is in the file: it is made smaller after that.
                for number, line in enumerate(iter(partial(lines.readline, SHORT.length), b""), 1):
                    try:
                        self._apply_line(decode_json(line, SHORT))
                    except (DecodingError, KeyError, TypeError, ValueError) as error:
                        # The last line of a process killed during a write.
                        if not left_out:
                            log.warning("memory %s, line %d is left out: %s", file, number, error)
                        left_out += 1
        except FileNotFoundError:
            return
        except OSError as error:
            raise LinkError(f"memory {file} cannot be read: {error.strerror or error}") from None
        if left_out > 1:
            log.warning("memory %s: %d more lines are left out", file, left_out - 1)

    def _apply_line(self, line: dict[str, Any]) -> None:
        if "database" in line:
            frame = line.get("frame")
            self._serve(str(line["database"]), None if frame is None else str(frame))
        elif "adrift" in line:
            (self._adrift.add if line["adrift"] else self._adrift.discard)(str(line["robot"]))
        elif "magic" in line:
            known = self._robots.get(line["robot"])
            self._robots[line["robot"]] = _Robot(int(line["magic"]), known.begun if known else OrderedDict())
        elif "done" in line:
            self._note(line["robot"], int(line["done"]), CompletedCall(line.get("refusal")))
        else:
            self._note(line["robot"], int(line["begun"]), None)

    def _begin_file(self, file: Path) -> None:
        """Rewrite the file with the present state, which also checks that it is writable."""
        try:
            self._begin_size(_write_lines(file, self._lines()))
        except OSError as error:
            if error.errno not in PASSING:
                raise LinkError(
                    f"memory {file} cannot be written: {error.strerror or error}; give a folder that can "
                    "with state_folder in the link's settings, or in ROBOT_BRIDGE_STATE"
                ) from None
            self._failed(error)

    def _lines(self) -> Iterator[dict[str, Any]]:
        """Return the lines of the present state, for another thread: this one changes it meanwhile."""
        first: list[dict[str, Any]] = []
        if self._database is not None:
            frame = {} if self._frame is None else {"frame": self._frame}
            first.append({"database": self._database, **frame})
        first += [{"robot": name, "adrift": True} for name in self._adrift]
        robots = [(name, robot.magic, list(robot.begun.items())) for name, robot in self._robots.items()]
        return itertools.chain(first, *(_lines_of(*robot) for robot in robots))


def _lines_of(
    name: str, magic: int, begun: list[tuple[int, CompletedCall | None]]
) -> Iterator[dict[str, Any]]:
    yield {"robot": name, "magic": magic}
    for id, done in begun:
        if done is None:
            yield {"robot": name, "begun": id}
        else:
            refusal = {} if done.refusal is None else {"refusal": done.refusal}
            yield {"robot": name, "done": id, **refusal}


@contextlib.asynccontextmanager
async def only_process(memory: Path, within: float = LOCKED_FOR) -> AsyncIterator[None]:
    """Keep other processes from running the link of this memory: they would command the same robots.

    The previous process may still be ending, for ``within`` seconds.

    :raises LinkError: where another one runs.
    """
    lock = memory.with_suffix(".lock")
    try:
        file = os.open(lock, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o600)
    except OSError as error:
        # The memory's fault reports the same, with advice; a full disk must not keep a link from stopping
        # robots.
        log.warning("%s cannot be written, so a second process would not be noticed: %s", lock, error)
        yield
        return
    try:
        until = time.monotonic() + within
        while not _locked(file):
            if time.monotonic() >= until:
                pid = os.pread(file, 20, 0).decode("ascii", "replace").strip() or "unknown"
                raise LinkError(
                    f"link {memory.stem} runs already on this computer, as process {pid}, and two would "
                    f"command the same robots; end that one (it holds {lock})"
                )
            await asyncio.sleep(0.1)
        with contextlib.suppress(OSError):
            os.ftruncate(file, 0)
            os.pwrite(file, str(os.getpid()).encode(), 0)
        yield
    finally:
        os.close(file)


def _locked(file: int) -> bool:
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError as error:
        # Some network file systems have no locks.
        log.warning("a second process of this link would not be noticed: %s", error.strerror or error)
    return True


def _write_lines(file: Path, lines: Iterable[dict[str, Any]]) -> int:
    """Replace ``file`` by ``lines``; return its size in bytes; raises OSError."""
    content = b"".join(map(_encoded, lines))
    write_state(file, content)
    return len(content)


def _write_lines_beside(file: Path, lines: Iterable[dict[str, Any]]) -> tuple[Path, int]:
    content = b"".join(map(_encoded, lines))
    return write_beside(file, content), len(content)


def _encoded(line: dict[str, Any]) -> bytes:
    return (json.dumps(line) + "\n").encode()

"""Programs, forked off a process that has loaded their modules: a start costs no imports.

A test session starts hundreds of gateways and robots, and most of what each costs is the loading of modules.
Each is a process of its own all the same, a child of the test's, that is signalled, killed and waited for.
What is to be shown of a start itself is started as a user does, with ``python -m robot_bridge``.

Run as a program this is the process that forks: it takes orders on the socket whose number it is given.
It knows nothing of this project, so that a Python of another environment may run it.
"""

from __future__ import annotations

import contextlib
import ctypes
import functools
import gc
import importlib
import json
import os
import signal
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any

PR_SET_PDEATHSIG, PR_SET_CHILD_SUBREAPER = 1, 36
LARGEST_ORDER = 1 << 20
_libc = ctypes.CDLL(None, use_errno=True)


@dataclass(frozen=True)
class Program:
    """What is forked: ``main()`` of the first of the modules, when all are loaded."""

    modules: tuple[str, ...]
    python: Path = Path(sys.executable)
    path: Path | None = None
    """A folder of modules of its own."""


BRIDGE = Program(
    (
        "robot_bridge.__main__",
        "robot_bridge.cli.link",
        "robot_bridge.cli.robot",
        "robot_bridge.cli.serve",
        "robot_bridge.gateway.app",
        "robot_bridge.reference_robot.runner",
        "robot_bridge.reference_robot.sql_link",
        "sqlalchemy.dialects.sqlite",
        # What is imported only where it is needed, by nearly each of them.
        "alembic.context",
        "encodings.idna",
        "psycopg",
        "pydantic",
        "pymysql",
        "pyogrio",
        "pyproj",
        "scipy.sparse.csgraph",
        "shapely",
        "sqlalchemy.dialects.mysql.pymysql",
        "sqlalchemy.dialects.postgresql.psycopg",
        "typer._adapters",
        "uvloop",
        "websockets.asyncio.client",
    )
)


class ForkedProcess(subprocess.Popen[bytes]):
    """A process that somebody else started as a child of this one."""

    def __init__(self, pid: int, args: Sequence[str]) -> None:
        self.args = list(args)
        self.pid = pid
        self.returncode: int | None = None
        self.stdin = self.stdout = self.stderr = None
        self._child_created = True
        self._waitpid_lock = threading.Lock()


@functools.cache
def _forking(program: Program) -> tuple[socket.socket, threading.Lock]:
    """Return the way to this session's process that forks the program, which ends with the session."""
    ours, its = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    path = {"PYTHONPATH": str(program.path)} if program.path else {}
    # By its file: another Python has no package of tests.
    command = [program.python, __file__, str(its.fileno()), *program.modules]
    with its:
        subprocess.Popen(
            command, pass_fds=[its.fileno()], env={**os.environ, "PYTHONUNBUFFERED": "1", **path}
        )
    return ours, threading.Lock()


@contextlib.contextmanager
def _adopting() -> Iterator[None]:
    """Let the processes that lose their parent become children of this one; only for as long as it takes.

    Others that lose theirs would stay as zombies, since nobody here waits for them.
    """
    if _libc.prctl(PR_SET_CHILD_SUBREAPER, 1, 0, 0, 0):
        raise OSError(ctypes.get_errno(), "this system has no subreaper of processes")
    try:
        yield
    finally:
        _libc.prctl(PR_SET_CHILD_SUBREAPER, 0, 0, 0, 0)


def start_forked(
    program: Program, words: Sequence[Any], log: IO[bytes], env: Mapping[str, str]
) -> ForkedProcess:
    """Start a program with ``words`` and ``env`` added to the environment.

    It prints into ``log``, and is killed when this process ends.
    """
    ours, lock = _forking(program)
    command = [str(word) for word in words]
    order = {
        "words": command,
        "env": {**os.environ, **env},
        "folder": str(Path.cwd()),
        "parent": os.getpid(),
    }
    with lock, _adopting():
        socket.send_fds(ours, [json.dumps(order).encode()], [log.fileno()])
        pid = int(ours.recv(64))
    return ForkedProcess(pid, [program.modules[0], *command])


def _serve(orders: socket.socket, modules: Sequence[str]) -> None:
    """Fork a program for each order; return in the forked one, and end with the other side of the socket."""
    for name in modules:
        importlib.import_module(name)
    gc.collect()
    gc.freeze()
    while True:
        text, files, _, _ = socket.recv_fds(orders, LARGEST_ORDER, 1)
        if not text:
            sys.exit()
        between = os.fork()
        if between:
            os.waitpid(between, 0)
            os.close(files[0])
            continue
        if os.fork():
            os._exit(0)
        _become(json.loads(text), modules[0], files[0], orders)
        return


def _become(order: dict[str, Any], module: str, output: int, orders: socket.socket) -> None:
    """Make of this process what it would be if it had been started with ``order``."""
    while os.getppid() != order["parent"]:
        time.sleep(0.0005)
    _libc.prctl(PR_SET_PDEATHSIG, signal.SIGKILL, 0, 0, 0)
    # Not before: whoever waits for a process that is not its child yet is told that there is none.
    orders.send(str(os.getpid()).encode())
    orders.close()
    for number in (1, 2):
        os.dup2(output, number)
    os.close(output)
    with open(os.devnull) as nothing:  # noqa: PTH123
        os.dup2(nothing.fileno(), 0)
    os.chdir(order["folder"])
    # A Python may have set for itself where its libraries are.
    libraries = {name: os.environ[name] for name in ("LD_LIBRARY_PATH",) if name in os.environ}
    os.environ.clear()
    os.environ.update({**order["env"], **libraries})
    time.tzset()
    sys.argv = [sys.modules[module].__file__ or "", *order["words"]]


def _main() -> None:
    socket_number, *modules = sys.argv[1:]
    _serve(socket.socket(fileno=int(socket_number)), modules)
    sys.modules[modules[0]].main()


if __name__ == "__main__":
    # The folder of this file is none of modules.
    sys.path[0] = str(Path.cwd())
    _main()

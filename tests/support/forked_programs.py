"""Programs, forked off a process that has loaded their modules: a start costs no imports.

A test session starts hundreds of gateways and robots, and most of what each costs is the loading of modules.
Each is a process of its own all the same, a child of the test's, that is signalled, killed and waited for.
What is to be shown of a start itself is started as a user does, with ``python -m robot_bridge``.
A shell runs them, too: ``write_shell_command`` makes it a command that has one forked and waits for its end.

Run as a program this is the process that forks: it takes orders on the sockets whose numbers it is given.
It knows nothing of this project, so that a Python of another environment may run it.
"""

from __future__ import annotations

import atexit
import contextlib
import ctypes
import functools
import gc
import importlib
import json
import os
import select
import signal
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any

PR_SET_PDEATHSIG, PR_SET_CHILD_SUBREAPER = 1, 36
CLONE_NEWNET = 0x40000000
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
        "robot_bridge.reference_robot.sql_link",
        "sqlalchemy.dialects.sqlite",
        # What is imported only where it is needed, by nearly each of them.
        "alembic.context",
        "cbor2",
        "encodings.idna",
        "nats.aio.client",
        "psycopg",
        "pydantic",
        "pymysql",
        "pyogrio",
        "pyproj",
        "scipy.sparse.csgraph",
        "shapely",
        "sqlalchemy.dialects.mysql.pymysql",
        "sqlalchemy.dialects.postgresql.psycopg",
        "tests.support.bridge.first_uses",
        "typer._adapters",
        "typer._click.decorators",
        "uvloop",
        "websockets.asyncio.client",
        "zstandard",
    )
)

LINK_MODULES = {
    "replay": ("robot_bridge.links.replay.adapter",),
    # A link loads a binding of DDS and definitions of messages only when it begins to run.
    "ros2": (
        "robot_bridge.links.ros2.adapter",
        "cyclonedds.builtin",
        "cyclonedds.domain",
        "cyclonedds.pub",
        "cyclonedds.sub",
        "cyclonedds.topic",
        "rosbags.typesys.stores.ros2_kilted",
    ),
    "rosbridge": ("robot_bridge.links.rosbridge.adapter",),
    "tracker": ("robot_bridge.links.tracker.adapter",),
    "vda5050": ("robot_bridge.links.vda5050.adapter",),
}
"""More modules of ``BRIDGE`` that only links need, by their kinds."""


class ForkedProcess(subprocess.Popen[bytes]):
    """A process that somebody else started as a child of this one."""

    def __init__(self, pid: int, args: Sequence[str]) -> None:
        self.args = list(args)
        self.pid = pid
        self.returncode: int | None = None
        self.stdin = self.stdout = self.stderr = None
        self._child_created = True
        self._waitpid_lock = threading.Lock()


@dataclass(frozen=True)
class Forking:
    """The ways to a process that forks a program."""

    orders: socket.socket
    lock: threading.Lock
    """Held from an order to its answer."""
    shells: str
    """The address at which shells have the program forked."""


@functools.cache
def _forking(program: Program) -> Forking:
    """Return the ways to this session's process that forks the program, which ends with the session."""
    ours, its = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    shells = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    # No file: the address is gone with the process.
    address = f"\0{program.modules[0]}-{os.getpid()}-{id(its):x}"
    shells.bind(address)
    shells.listen()
    path = {"PYTHONPATH": str(program.path)} if program.path else {}
    numbers = [its.fileno(), shells.fileno()]
    # By its file: another Python has no package of tests.
    command = [program.python, __file__, *map(str, numbers), *program.modules]
    with its, shells:
        subprocess.Popen(command, pass_fds=numbers, env={**os.environ, "PYTHONUNBUFFERED": "1", **path})
    return Forking(ours, threading.Lock(), address)


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
    program: Program,
    words: Sequence[Any],
    log: IO[bytes],
    env: Mapping[str, str],
    *,
    modules: Sequence[str] = (),
    network: Path | None = None,
) -> ForkedProcess:
    """Start a program with ``words`` and ``env`` added to the environment.

    It prints into ``log``, and is killed when this process ends. ``modules`` are more of its modules, which
    only some of its runs need: they are loaded when the first of those is started. ``network`` is the file
    of a namespace of networks, where it is to run in another than this process.
    """
    forking = _forking(program)
    command = [str(word) for word in words]
    order = {
        "words": command,
        "env": {**os.environ, **env},
        "folder": str(Path.cwd()),
        "parent": os.getpid(),
        "modules": modules,
        "network": str(network or ""),
    }
    with forking.lock, _adopting():
        socket.send_fds(forking.orders, [json.dumps(order).encode()], [log.fileno()])
        pid = int(forking.orders.recv(64))
    return ForkedProcess(pid, [program.modules[0], *command])


SHELL_COMMAND = """#!{python} -IS
import json, os, socket, sys
with socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET) as forking:
    forking.connect({address!r})
    order = {{"words": sys.argv[1:], "env": dict(os.environ), "folder": os.getcwd()}}
    socket.send_fds(forking, [json.dumps(order).encode()], [0, 1, 2])
    sys.exit(int(forking.recv(64)))
"""


def write_shell_command(file: Path, program: Program = BRIDGE) -> None:
    """Write a command for shells that runs the program, with the shell's environment, folder and files.

    It works for as long as this session lasts; the program is killed with the command.
    """
    text = SHELL_COMMAND.format(python=program.python, address=_forking(program).shells)
    file.write_text(text, encoding="utf-8")
    file.chmod(0o755)


def _serve(orders: socket.socket, shells: socket.socket, modules: Sequence[str]) -> None:
    """Fork a program for each order; return in the forked one, and end with the other side of ``orders``."""
    _load(modules)
    asking, text, files = _await_order(orders, shells)
    shells.close()
    order = json.loads(text)
    parent = order.get("parent") or os.getpid()
    program = os.fork()
    if program:
        if asking is not orders:
            _wait_for(program, asking)
        os._exit(0)
    _become(order, modules[0], parent)
    if asking is orders:
        # Not before: whoever waits for a process that is not its child yet is told that there is none.
        asking.send(str(os.getpid()).encode())
    orders.close()
    asking.close()
    _connect_to(files)


def _load(modules: Sequence[str]) -> None:
    """Load modules that are forked with this process; what cannot be loaded the program says by itself."""
    new = [name for name in modules if name not in sys.modules]
    for name in new:
        with contextlib.suppress(ImportError):
            importlib.import_module(name)
    if new:
        gc.collect()
        gc.freeze()


def _await_order(orders: socket.socket, shells: socket.socket) -> tuple[socket.socket, bytes, list[int]]:
    """Fork for each order, and return it in the forked process: who asks, the order and its files."""
    while True:
        ready, _, _ = select.select([orders, shells], [], [])
        asking = shells.accept()[0] if shells in ready else orders
        text, files, _, _ = socket.recv_fds(asking, LARGEST_ORDER, 3)
        if not text and asking is orders:
            sys.exit()
        _load(json.loads(text).get("modules", ()))
        between = os.fork()
        if not between:
            return asking, text, files
        if asking is orders:
            os.waitpid(between, 0)
        else:
            asking.close()
        for file in files:
            os.close(file)
        with contextlib.suppress(ChildProcessError):
            while os.waitpid(-1, os.WNOHANG)[0]:
                pass


def _wait_for(program: int, shell: socket.socket) -> None:
    """Send a shell the status of a program when it has ended; kill the program if the shell ends first."""
    end = os.pidfd_open(program)
    ready, _, _ = select.select([end, shell], [], [])
    if end not in ready:
        os.kill(program, signal.SIGKILL)
        return
    status = os.waitstatus_to_exitcode(os.waitpid(program, 0)[1])
    shell.send(str(status if status >= 0 else 128 - status).encode())


def _become(order: dict[str, Any], module: str, parent: int) -> None:
    """Make of this process what it would be if ``parent`` had started it with ``order``."""
    while os.getppid() != parent:
        time.sleep(0.0005)
    _libc.prctl(PR_SET_PDEATHSIG, signal.SIGKILL, 0, 0, 0)
    os.chdir(order["folder"])
    if network := order.get("network"):
        with Path(network).open() as file:
            if _libc.setns(file.fileno(), CLONE_NEWNET):
                raise OSError(ctypes.get_errno(), f"{network} cannot be entered")
    # A Python may have set for itself where its libraries are.
    libraries = {name: os.environ[name] for name in ("LD_LIBRARY_PATH",) if name in os.environ}
    os.environ.clear()
    os.environ.update({**order["env"], **libraries})
    time.tzset()
    sys.argv = [sys.modules[module].__file__ or "", *order["words"]]


def _connect_to(files: Sequence[int]) -> None:
    """Have the program read from and write to ``files``: one for all that it writes, or one of each."""
    with open(os.devnull) as nothing:  # noqa: PTH123
        streams = files if len(files) == 3 else (nothing.fileno(), *files, *files)
        for number, file in enumerate(streams):
            os.dup2(file, number)
    for file in files:
        os.close(file)


def _main() -> None:
    orders, shells, *modules = sys.argv[1:]
    _serve(socket.socket(fileno=int(orders)), socket.socket(fileno=int(shells)), modules)
    _end_after(sys.modules[modules[0]].main)


def _end_after(main: Callable[[], object]) -> None:
    """Run the program, and end as Python does, but for taking every module and object apart.

    A third of a short life goes into that: each page that it touches has to be copied first.
    """
    try:
        main()
        status = 0
    except SystemExit as leaving:
        if not isinstance(leaving.code, int | None):
            raise
        status = leaving.code or 0
    threading._shutdown()  # type: ignore[attr-defined]
    atexit._run_exitfuncs()
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(status)


if __name__ == "__main__":
    # The folder of this file is none of modules.
    sys.path[0] = str(Path.cwd())
    _main()

"""A real database server of one's own: in a temporary folder, on loopback, gone when this program is."""

from __future__ import annotations

import abc
import contextlib
import hashlib
import itertools
import os
import pwd
import secrets
import select
import shutil
import signal
import subprocess
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path

from sqlalchemy import URL, Connection, make_url

from robot_bridge.gateway.storage.database import run_once
from robot_bridge.gateway.storage.roles.choice import role_manager_on
from tests.support.errors import StageError
from tests.support.processes import free_port, freeze

OWNER = "fleet"
"""The account that owns every new database; it is no superuser and may make no accounts."""
MODELS = Path(__file__).parents[3] / "build" / "databases"
"""What new servers begin with."""
MEMORY = Path("/dev/shm")
ROOM_IN_MEMORY = 4 << 30
"""Bytes that must be free there before one more server is put there: a dozen may grow to 0.5 GB each."""


def add_accounts(url: str, admin_url: str, robots: Sequence[str], gateway: str = "") -> dict[str, str]:
    """Make accounts of robots, and of a gateway where one is named; return what each connects with.

    :param url: the owner's, of the database that they are for.
    """
    secret, database = secrets.token_urlsafe(12), make_url(url)

    def add(connection: Connection) -> dict[str, URL]:
        manager = role_manager_on(connection)
        for name in robots:
            manager.add_robot(name, secret)
        if gateway:
            manager.add_gateway(gateway, secret)
        return {**dict.fromkeys(robots, database.set(database=manager.robots_database())), gateway: database}

    return {
        name: url.set(username=name, password=secret).render_as_string(hide_password=False)
        for name, url in run_once(admin_url, add).items()
        if name
    }


class DatabaseServer(abc.ABC):
    """A context in which a server runs; ``kill`` and ``start`` make it die and come back on the same port.

    :param durable: wait for the disk at every commit, as in the field; tests of anything else need not.
    :param through: begins the command of the server.
    :param within: where its folder is made; by default in memory where it does not wait for the disk.
    """

    scheme: str
    account: str
    """Who the server runs as where this program runs as root: database servers refuse root."""
    admin: str
    """The superuser; its password is :attr:`admin_password`."""
    programs: Sequence[str]
    ending: signal.Signals = signal.SIGTERM

    def __init__(
        self, *, durable: bool = False, through: Sequence[str] = (), within: Path | None = None
    ) -> None:
        self.durable = durable
        self._within = within or (Path("/tmp") if durable else _quick_place())
        self._through = through
        self.port = 0
        self.admin_password = secrets.token_hex(8)
        self.owner_password = secrets.token_hex(8)
        self._numbers = itertools.count(1)
        self._process: subprocess.Popen[bytes] | None = None

    def __enter__(self) -> DatabaseServer:
        self.folder = Path(tempfile.mkdtemp(prefix=f"fleet-{self.scheme}-", dir=self._within))
        self._remover = _remove_when_this_program_ends(self.folder)
        try:
            self._give(self.folder)
            self._copy_or_initialise()
            self.port = free_port()
            self.start()
            self._make_owner()
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_: object) -> None:
        self.stop()
        shutil.rmtree(self.folder, ignore_errors=True)
        self._remover.kill()
        self._remover.communicate()

    def _copy_or_initialise(self) -> None:
        """Begin with a copy of what the first server of these programs began with: it takes a tenth."""
        data, model = self.folder / "data", self._model()
        if model.is_dir():
            _copy(model, data)
            return
        self._initialise()
        model.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=model.parent, prefix=f"{model.name}-") as place:
            copied = Path(place) / "data"
            _copy(data, copied)
            # Others may have been as fast.
            with contextlib.suppress(OSError):
                copied.rename(model)

    def _model(self) -> Path:
        """Return where a new server's files are kept, for these very programs and this account."""
        programs = [Path(self._program(name)).resolve() for name in self.programs]
        facts = [(str(file), file.stat().st_size, file.stat().st_mtime_ns) for file in programs]
        word = hashlib.sha256(repr((facts, os.geteuid(), *self._options())).encode()).hexdigest()[:16]
        return MODELS / f"{self.scheme}-{word}"

    def require_programs(self) -> None:
        """Raise StageError when a program that this server needs is not on this machine."""
        for name in self.programs:
            self._program(name)

    @property
    def pid(self) -> int:
        """The process id of the server, for tests that freeze or kill it."""
        assert self._process is not None
        return self._process.pid

    def start(self) -> None:
        """Start the server; return when it takes connections. Raises StageError."""
        until = time.monotonic() + 30
        self._launch()
        while not self._answers():
            if time.monotonic() > until:
                raise StageError(f"{self.scheme} server did not come up; it said:\n{self._log()}")
            time.sleep(0.05)
            # What a killed server leaves behind may hold up the next one for a moment.
            if self._process is None or self._process.poll() is not None:
                self._launch()

    def start_again(self) -> None:
        """Start the server unless it runs; return when it takes connections. Raises StageError."""
        if self._process is None or self._process.poll() is not None:
            self.start()

    def _launch(self) -> None:
        with (self.folder / "server.log").open("ab") as log:
            self._process = subprocess.Popen(
                [*self._through, *self._as_account("--pdeathsig", "KILL"), *self._command()],
                cwd=self.folder,
                stdin=subprocess.DEVNULL,
                stdout=log,
                stderr=subprocess.STDOUT,
                # A Ctrl-C is for the tests; they end the server afterwards.
                start_new_session=True,
            )

    def stop(self) -> None:
        """End the server in good order."""
        if self._process is None:
            return
        self._process.send_signal(signal.SIGCONT)
        self._process.send_signal(self.ending)
        try:
            self._process.wait(15)
        except subprocess.TimeoutExpired:
            self.kill()
        self._process = None

    def kill(self) -> None:
        """End the server and every process of it the way a power cut does."""
        assert self._process is not None
        # A stopped process starts no other one while they are listed. One left alive may wait for ever for
        # a lock of one that died, and keep the next server from the memory that they share.
        freeze(self._process.pid)
        workers = children_of(self._process.pid)
        self._process.kill()
        for worker in workers:
            _kill(worker)
        self._process.wait()

    def new_database(self, name: str | None = None) -> str:
        """Make an empty database that :data:`OWNER` owns and return its URL with that account."""
        name = name or f"fleet_{next(self._numbers)}"
        self._create_database(name)
        return self.url(name, OWNER, self.owner_password)

    def url(self, database: str, user: str, password: str) -> str:
        """Return the URL of ``database`` for ``user``, over TCP on loopback."""
        return f"{self.scheme}://{user}:{password}@127.0.0.1:{self.port}/{database}"

    def admin_url(self, url: str) -> str:
        """Return the URL of the same database as ``url``, for the superuser."""
        return self.url(url.rsplit("/", 1)[1], self.admin, self.admin_password)

    def _run(
        self, command: Sequence[str | Path], text: str = "", **environment: str
    ) -> subprocess.CompletedProcess[str]:
        return subprocess.run(
            [str(word) for word in command],
            input=text,
            env={**os.environ, **environment},
            capture_output=True,
            text=True,
            check=False,
        )

    def _require(self, command: Sequence[str | Path], text: str = "", **environment: str) -> str:
        done = self._run(command, text, **environment)
        if done.returncode:
            said = f"{done.stderr or done.stdout}\nThe server said last:\n{self._log()}"
            raise StageError(f"{Path(command[0]).name} failed: {said}")
        return done.stdout

    def _as_account(self, *options: str) -> list[str]:
        if os.geteuid() != 0:
            return ["setpriv", *options] if options else []
        user = self._user()
        return ["setpriv", f"--reuid={user.pw_uid}", f"--regid={user.pw_gid}", "--clear-groups", *options]

    def _give(self, path: Path) -> None:
        if os.geteuid() == 0:
            os.chown(path, self._user().pw_uid, self._user().pw_gid)

    def _user(self) -> pwd.struct_passwd:
        with contextlib.suppress(KeyError):
            return pwd.getpwnam(self.account)
        return pwd.getpwnam("nobody")

    def _log(self) -> str:
        log = self.folder / "server.log"
        return "\n".join(log.read_text(errors="replace").splitlines()[-15:]) if log.exists() else "nothing"

    def _program(self, name: str) -> str:
        return find_program(name)

    @abc.abstractmethod
    def sql(self, text: str, database: str | None = None) -> str:
        """Run statements as the superuser; return what they print. Raises StageError."""

    @abc.abstractmethod
    def _options(self) -> list[str]:
        """What :meth:`_initialise` is to make, apart from where; it is the same for each server."""

    @abc.abstractmethod
    def _initialise(self) -> None: ...

    @abc.abstractmethod
    def _command(self) -> list[str | Path]: ...

    @abc.abstractmethod
    def _answers(self) -> bool: ...

    @abc.abstractmethod
    def _make_owner(self) -> None: ...

    @abc.abstractmethod
    def _create_database(self, name: str) -> None: ...


def _copy(data: Path, to: Path) -> None:
    subprocess.run(["cp", "-a", "--reflink=auto", str(data), str(to)], check=True)


def _quick_place() -> Path:
    """Return where files that need not outlive a power cut are made: hundreds for each database."""
    has_room = os.access(MEMORY, os.W_OK) and shutil.disk_usage(MEMORY).free > ROOM_IN_MEMORY
    return MEMORY if has_room else Path("/tmp")


def find_program(name: str, *folders: str) -> str:
    """Return the path of ``name``, on PATH or in one of ``folders``. Raises StageError."""
    found = shutil.which(name, path=os.pathsep.join([*folders, os.environ.get("PATH", ""), "/usr/sbin"]))
    if found is None:
        raise StageError(f"{name} is not on this machine; make setup installs it where there is apt")
    return found


def children_of(pid: int) -> list[int]:
    """Return the processes that a process has started and that have not ended."""
    listed = Path(f"/proc/{pid}/task/{pid}/children").read_text(encoding="ascii")
    return [int(child) for child in listed.split()]


def _kill(pid: int) -> None:
    with contextlib.suppress(ProcessLookupError):
        process = os.pidfd_open(pid)
        try:
            os.kill(pid, signal.SIGKILL)
            select.select([process], [], [])  # readable when the process has ended
        finally:
            os.close(process)


def _remove_when_this_program_ends(folder: Path) -> subprocess.Popen[bytes]:
    # The pipe closes when this program ends, however it ends; the server has died by its parent's death.
    return subprocess.Popen(
        ["sh", "-c", 'read -r _; sleep 1; rm -rf -- "$0"', str(folder)],
        stdin=subprocess.PIPE,
        start_new_session=True,
    )

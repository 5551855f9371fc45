"""A real NATS server of one's own, or a cluster of them, on loopback, each ended by its id."""

from __future__ import annotations

import os
import shutil
import signal
import socket
import subprocess
import time
from collections.abc import Sequence
from contextlib import ExitStack
from pathlib import Path

from tests.support.errors import StageError
from tests.support.processes import dying_with_this, free_port, freeze
from tools.plugin_files import ROOT


def nats_program() -> str:
    """Return the path of a NATS server that is new enough; raises StageError."""
    own = ROOT / ".venv" / "nats" / "usr" / "sbin" / "nats-server"
    found = str(own) if os.access(own, os.X_OK) else shutil.which("nats-server")
    if found is None:
        raise StageError("nats-server is not on this machine; run: make setup")
    return found


class NatsServer:
    """A context in which a server runs; ``kill`` and ``start`` make it die and come back on the same port.

    ``config`` is what its configuration says beside the port.
    """

    def __init__(self, folder: Path, config: str = "") -> None:
        self._file = folder / "nats.conf"
        self._log = folder / "nats.log"
        self.port = free_port()
        self._write(config)
        self._program = nats_program()
        self._process: subprocess.Popen[bytes] | None = None

    @property
    def url(self) -> str:
        """Where it is."""
        return f"nats://127.0.0.1:{self.port}"

    @property
    def pid(self) -> int:
        """The id of the process that runs."""
        assert self._process is not None
        return self._process.pid

    def __enter__(self) -> NatsServer:
        self.start()
        return self

    def __exit__(self, *_: object) -> None:
        self.kill()

    def start(self) -> None:
        """Start the server; return when it takes connections. Raises StageError."""
        with self._log.open("ab") as log:
            self._process = subprocess.Popen(
                dying_with_this([self._program, "-c", str(self._file)]), stdout=log, stderr=subprocess.STDOUT
            )
        until = time.monotonic() + 30
        while True:
            try:
                socket.create_connection(("127.0.0.1", self.port), 1).close()
                return
            except OSError:
                if time.monotonic() > until or self._process.poll() is not None:
                    text = self._log.read_text(encoding="utf-8", errors="replace")
                    raise StageError(f"nats-server did not come up; it said:\n{text}") from None
                time.sleep(0.02)

    def reconfigure(self, config: str) -> None:
        """Have the server that runs take another configuration, which takes it a moment."""
        self._write(config)
        assert self._process is not None
        self._process.send_signal(signal.SIGHUP)

    def _write(self, config: str) -> None:
        self._file.write_text(f'listen: "127.0.0.1:{self.port}"\n{config}\n', encoding="utf-8")

    def freeze(self) -> None:
        """Let it stand still, as on a computer that hangs."""
        assert self._process is not None
        freeze(self._process.pid)

    def wake(self) -> None:
        """Let it go on."""
        assert self._process is not None
        self._process.send_signal(signal.SIGCONT)

    def kill(self) -> None:
        """End it the way a power cut does."""
        if self._process is not None:
            self._process.kill()
            self._process.wait()
            self._process = None


class NatsCluster:
    """A context in which some servers run that pass on what each other's clients publish."""

    def __init__(self, folder: Path, names: Sequence[str] = ("nats-1", "nats-2", "nats-3")) -> None:
        ports = {name: free_port() for name in names}
        routes = ", ".join(f'"nats://127.0.0.1:{port}"' for port in ports.values())
        self.servers: dict[str, NatsServer] = {}
        for name, port in ports.items():
            own = folder / name
            own.mkdir(parents=True)
            cluster = f'{{name: fleet, listen: "127.0.0.1:{port}", routes: [{routes}]}}'
            self.servers[name] = NatsServer(own, f"server_name: {name}\ncluster: {cluster}")
        self._running = ExitStack()

    @property
    def url(self) -> str:
        """Where they are, with commas between them."""
        return ",".join(server.url for server in self.servers.values())

    def __enter__(self) -> NatsCluster:
        with ExitStack() as stack:
            for server in self.servers.values():
                stack.enter_context(server)
            self._running = stack.pop_all()
        return self

    def __exit__(self, *_: object) -> None:
        self._running.close()

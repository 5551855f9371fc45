"""Lines that can be cut: bytes wait or are lost, and nobody is told."""

from __future__ import annotations

import contextlib
import itertools
import os
import socket
import struct
import subprocess
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from tests.support.bridge.bridge_programs import wait_until

ALL_AT_ONCE = 65_536, 0.0
HELD_BYTES = 8_192
KEPT = 4096
CUT = 10.0
"""seconds for which a line is cut; a robot of an impatient site is lost after 1.6 s."""


class CutLine:
    """Forwards TCP connections to ``port`` of this computer; ``address`` is where to connect instead."""

    def __init__(self, port: int) -> None:
        self._port = port
        self._pace = ALL_AT_ONCE
        self.passed_back = b""
        """The last bytes from the port that are at the other end of a line."""
        self._sockets: list[socket.socket] = []
        self._is_whole, self._is_whole_back = threading.Event(), threading.Event()
        self.mend()
        self._server = socket.create_server(("127.0.0.1", 0))
        # Else a slow line would hold more than a second of what it is sent.
        self._server.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, HELD_BYTES)
        self.port = self._server.getsockname()[1]
        self.address = f"ws://127.0.0.1:{self.port}"
        threading.Thread(target=self._accept, daemon=True).start()

    def cut(self, *, only_back: bool = False) -> None:
        """Let no byte through any more, in either direction; with ``only_back`` none from the port."""
        self._is_whole_back.clear()
        if not only_back:
            self._is_whole.clear()

    def slow_down(self, most: int, seconds: float) -> None:
        """Let ``most`` bytes at a time through to the port, and each part only after ``seconds``."""
        self._pace = most, seconds

    def mend(self, *, reset: bool = False) -> None:
        """Let bytes through again; with ``reset`` what waited is lost with its connections."""
        if reset:
            self._reset()
        self._is_whole.set()
        self._is_whole_back.set()

    def close(self) -> None:
        """End the line for good."""
        self._server.close()
        self.mend(reset=True)

    def _reset(self) -> None:
        sockets, self._sockets = self._sockets, []
        for end in sockets:
            # RST in place of FIN: what is in its buffers is thrown away.
            with contextlib.suppress(OSError):
                end.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
                end.close()

    def _accept(self) -> None:
        with contextlib.suppress(OSError):
            while True:
                near, _ = self._server.accept()
                self._is_whole.wait()
                far = socket.create_connection(("127.0.0.1", self._port))
                self._sockets += [near, far]
                for source, target in ((near, far), (far, near)):
                    threading.Thread(target=self._pump, args=(source, target, near), daemon=True).start()

    def _pump(self, source: socket.socket, target: socket.socket, near: socket.socket) -> None:
        is_whole = self._is_whole if source is near else self._is_whole_back
        with contextlib.suppress(OSError):
            while True:
                most, seconds = self._pace if source is near else ALL_AT_ONCE
                if not (data := source.recv(most)):
                    break
                time.sleep(seconds)
                is_whole.wait()
                target.sendall(data)
                if target is near:
                    self.passed_back = (self.passed_back + data)[-KEPT:]
            is_whole.wait()
            target.shutdown(socket.SHUT_WR)


class CutNetwork:
    """A network for one robot, with a wire to this computer that can be pulled out; takes root.

    ``namespace`` is the file by which programs enter it, ``through`` begins the commands that run there, and
    ``interface`` is this computer's end of the wire.
    """

    _numbers = itertools.count()

    def __init__(self) -> None:
        number = os.getpid() % 250, next(self._numbers)
        self.interface = f"fleet{number[0]}-{number[1]}"
        # A sleeping program holds the network until it is killed.
        self._holder = subprocess.Popen(["unshare", "--net", "sleep", "infinity"])
        self.namespace = Path(f"/proc/{self._holder.pid}/ns/net")
        self.through = ["nsenter", f"--net={self.namespace}"]
        try:
            self._wire(f"10.99.{number[0]}")
        except BaseException:
            self.close()
            raise

    @staticmethod
    def is_possible() -> bool:
        """Tell whether this account may make networks."""
        done = subprocess.run(["unshare", "--net", "true"], capture_output=True, check=False)
        return done.returncode == 0

    def _wire(self, net: str) -> None:
        until = time.monotonic() + 10
        own = Path("/proc/self/ns/net").readlink()
        while self.namespace.readlink() == own:
            assert time.monotonic() < until, "it has no network of its own"
            time.sleep(0.01)
        far = f"{self.interface}r"
        _ip("link", "add", self.interface, "type", "veth", "peer", "name", far)
        _ip("link", "set", far, "netns", str(self._holder.pid))
        _ip("address", "add", f"{net}.1/24", "dev", self.interface)
        _ip("link", "set", self.interface, "up")
        for command in (
            ["address", "add", f"{net}.2/24", "dev", far],
            ["link", "set", far, "up"],
            ["link", "set", "lo", "up"],
            ["route", "add", "default", "dev", far],
        ):
            subprocess.run([*self.through, "ip", *command], check=True)

    def cut(self) -> None:
        """Let nothing through, in either direction; nobody is told, as behind a switch that has no power."""
        for inside, end in (([], self.interface), (self.through, f"{self.interface}r")):
            # A bucket for less than any packet throws all of them away.
            bucket = ["root", "tbf", "rate", "1kbit", "burst", "10", "limit", "1"]
            subprocess.run([*inside, "tc", "qdisc", "add", "dev", end, *bucket], check=True)

    def mend(self) -> None:
        """Let all through again."""
        for inside, end in (([], self.interface), (self.through, f"{self.interface}r")):
            subprocess.run([*inside, "tc", "qdisc", "delete", "dev", end, "root"], check=True)

    def close(self) -> None:
        """End it for good."""
        subprocess.run(["ip", "link", "delete", self.interface], check=False, capture_output=True)
        self._holder.kill()
        self._holder.wait()


def _ip(*command: str) -> None:
    subprocess.run(["ip", *command], check=True)


def outlast_a_cut(
    desk: Any, nodes: Any, cut: Callable[[], None], mend: Callable[[], None], *names: str
) -> None:
    """Cut the network between ROS robots and their adapter for 10 s: nothing is lost, nothing done twice.

    Of the robots the first is on its way and arrives meanwhile, the second is aborted on its way, the third
    sent off. They stand at (20, 8) and drive 0.5 m/s.
    """
    driving, stopped, ordered = names

    def happened(name: str, kind: str) -> list[dict[str, Any]]:
        return [event for event in nodes.events(name) if event["event"] == kind]

    desk.send(f"go-{driving}", driving, "SetPosEnd", x=23.0, y=8.0)
    desk.send(f"go-{stopped}", stopped, "SetPosEnd", x=60.0, y=8.0)
    for name in (driving, stopped):
        desk.wait_for_step(f"go-{name}", "acknowledged", 10)
    cut()
    mended_at = time.monotonic() + CUT
    desk.send(f"stop-{stopped}", stopped, "Abort")
    desk.send(f"go-{ordered}", ordered, "SetPosEnd", x=60.0, y=8.0)
    for name in names:
        desk.until(lambda name=name: desk.robots[name]["state"] == "lost")
    # Nobody on the robots' side has answered: operators know that they have to go there.
    desk.wait_for_step(f"stop-{stopped}", "failed")
    desk.wait_for_step(f"go-{ordered}", "failed")
    desk.listen(mended_at - time.monotonic())
    assert not happened(stopped, "goal ended") and not happened(ordered, "goal")
    mend()

    desk.wait_for_step(f"go-{driving}", "reached", 60)
    (ended,) = wait_until(lambda: happened(stopped, "goal ended"), 60)
    assert ended["status"] == 5, f"it was not canceled: {ended}"
    for name in names:
        desk.until(lambda name=name: desk.robots[name]["state"] == "fresh", 60)
    # What was sent off is taken back, should it have come out of the line after all.
    wait_until(lambda: len(happened(ordered, "goal")) == len(happened(ordered, "goal ended")), 60)
    assert desk.commands[f"go-{ordered}"]["state"] == "failed"
    desk.send(f"on-{ordered}", ordered, "SetPosEnd", x=desk.robots[ordered]["x"] + 0.5, y=8.0)
    desk.wait_for_step(f"on-{ordered}", "reached", 30)
    desk.wait_for_step(f"go-{driving}", "reached")
    assert [len(happened(name, "goal")) for name in (driving, stopped)] == [1, 1]
    assert len(happened(ordered, "goal")) <= 2

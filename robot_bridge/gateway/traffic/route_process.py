"""RoutingKit in a process of its own: its native code can end that process and never the gateway.

It aborts where an exception would do, and orders a graph without letting other threads run: 84 760 arcs in
3.8 s, in which a gateway would neither read a position nor pass on a stop.
"""

from __future__ import annotations

import contextlib
import importlib.util
import itertools
import logging
import signal
import socket
import struct
import subprocess
import sys
import threading
import time
import weakref
from collections.abc import Callable
from dataclasses import dataclass
from multiprocessing.connection import Connection, Pipe
from typing import Any

import numpy as np

from ...core.roads.engines import ContractionEngines, Ends, Engine, RouteGraph, safe_engines
from ...core.roads.network import Floats, Ints

log = logging.getLogger(__name__)

LEAST_ARCS = 4000
"""Number of arcs of a graph from which a process is started: on fewer SciPy finds a way in about 1 ms."""
ANSWER_WITHIN_S = 5.0
"""Seconds after which a process that does not answer, or neither reads nor writes, is killed as stuck."""
LAID_WITHIN_S = 60.0
"""Seconds that it may take to apply one set of costs to the graph."""
READY_WITHIN_S = 600.0
"""Seconds that it may take to order a graph. Nothing waits for that."""
BUSY_S = 0.05
"""Seconds that a query waits for another one in the process, before it is answered here."""
FIRST_WAIT_S, LONGEST_WAIT_S = 1.0, 300.0
"""Seconds until a process that ended is started again; twice as long each time that it ends soon."""
_SOON_S = 60.0
_LARGEST_ANSWER = 1 << 26
_NO_WAY = b"-"


@dataclass(frozen=True)
class EngineReport:
    """The engine in use, whether it is the fastest here, and the number of starts of its process."""

    engine: str
    ok: bool = True
    starts: int = 0


# --- In the gateway ---


class ProcessEngines:
    """Makes engines on ``graph``: RoutingKit's in a process, each backed by one in this process.

    The latter finds ways on small graphs, where RoutingKit is not installed, until the process has the costs,
    while it is busy, and whenever it has ended. Safe to use from several threads. ``_lock`` guards costs and
    engines and is never held while the process is waited for.
    """

    def __init__(self, graph: RouteGraph) -> None:
        self._graph = graph
        self._local, self._local_name = safe_engines(graph), ""
        self._lock = threading.Lock()
        self._engines: weakref.WeakValueDictionary[int, ProcessEngine] = weakref.WeakValueDictionary()
        self._numbers = itertools.count()
        self._child: _Child | None = None
        self._closed = threading.Event()
        self._starts = 0
        self._enabled = (
            len(graph.tail) >= LEAST_ARCS and importlib.util.find_spec("routingkit_cch") is not None
        )
        if self._enabled:
            threading.Thread(target=self._keep, name="routes", daemon=True).start()

    def __call__(self, costs: Floats) -> ProcessEngine:
        """Return an engine that finds ways under ``costs``; the process gets them in the background."""
        engine = ProcessEngine(self, next(self._numbers), self._local(costs), costs)
        with self._lock:
            self._local_name = engine.local.name
            self._engines[engine.number] = engine
            child = self._child
            ready = child is not None and child.ready
        if child is not None and ready:
            threading.Thread(target=self._lay_if_there, args=(child, engine), daemon=True).start()
        return engine

    @property
    def report(self) -> EngineReport:
        """The engine in use."""
        ready = self._ready_child() is not None
        name = ContractionEngines.name if ready else self._local_name
        return EngineReport(name, ready or not self._enabled, self._starts)

    @property
    def process_id(self) -> int | None:
        """The id of the process that is ready to find ways, None without one."""
        child = self._ready_child()
        return None if child is None else child.process.pid

    def close(self) -> None:
        """End the process. Engines then find ways in this process."""
        self._closed.set()
        with self._lock:
            self._enabled = False
            if self._child is not None:
                self._child.process.kill()

    def way(self, engine: ProcessEngine, starts: Ends, goals: Ends) -> list[int] | None:
        """Return the arcs of the cheapest way, as the process finds it.

        :raises LookupError: when no process can answer now.
        """
        child = self._ready_child()
        if child is None or not child.lock.acquire(timeout=BUSY_S):
            raise _GoneError
        try:
            with self._lock:
                if engine.number not in child.unsent:
                    raise _GoneError
                arcs = np.array(sorted(child.unsent[engine.number]), np.int64)
                costs = engine.costs[arcs]
                child.unsent[engine.number].clear()
            if len(arcs):
                child.send(("costs", engine.number, arcs, costs))
            answer = child.ask(("way", engine.number, list(starts), list(goals)), ANSWER_WITHIN_S)
            if answer == _NO_WAY:
                return None
            if not self._leads(answer, starts, goals):
                raise child.fail(f"answered {len(answer)} bytes that are no way")
        finally:
            child.lock.release()
        way: list[int] = np.frombuffer(answer, np.int64).tolist()
        return way

    def way_here(self, engine: ProcessEngine, starts: Ends, goals: Ends) -> list[int] | None:
        """Return the arcs of the cheapest way as ``engine`` finds it in this process."""
        with engine.lock:
            with self._lock:
                arcs = np.array(sorted(engine.changed), np.int64)
                costs = engine.costs[arcs]
                engine.changed.clear()
            if len(arcs):
                engine.local.set_costs(arcs, costs)
            return engine.local.way(starts, goals)

    def set_costs(self, engine: ProcessEngine, arcs: Ints, costs: Floats) -> None:
        """Set the costs of ``arcs`` of ``engine``; they are sent with the next query for a way."""
        with self._lock:
            engine.costs[arcs] = costs
            engine.changed.update(arcs.tolist())
            if self._child is not None and engine.number in self._child.unsent:
                self._child.unsent[engine.number].update(arcs.tolist())

    def _ready_child(self) -> _Child | None:
        child = self._child
        return child if child is not None and child.ready and not child.failed else None

    def _leads(self, answer: bytes, starts: Ends, goals: Ends) -> bool:
        """Return whether ``answer`` is arcs of the graph, end to end, from one of ``starts`` to a goal."""
        if len(answer) % 8:
            return False
        way, graph = np.frombuffer(answer, np.int64), self._graph
        if not len(way):
            return not {node for node, _ in starts}.isdisjoint(node for node, _ in goals)
        if way.min() < 0 or way.max() >= len(graph.tail):
            return False
        tail, head = graph.tail[way], graph.head[way]
        ends = any(node == tail[0] for node, _ in starts) and any(node == head[-1] for node, _ in goals)
        return ends and bool((tail[1:] == head[:-1]).all())

    def _keep(self) -> None:
        """Start the process, and again every time it has ended, until closed."""
        wait = 0.0
        while not self._closed.is_set():
            began = time.monotonic()
            try:
                why = self._run()
            except ImportError as error:
                log.warning("routes: RoutingKit does not load here (%s); %s", error, self._fallback())
                return
            except OSError as error:
                why = f"cannot be started: {error}"
            if self._closed.is_set():
                return
            soon = wait > 0 and time.monotonic() - began < _SOON_S
            wait = min(2 * wait, LONGEST_WAIT_S) if soon else FIRST_WAIT_S
            log.warning(
                "routes: the process of RoutingKit %s; %s until it has been started again, in %g s",
                why,
                self._fallback(),
                wait,
            )
            self._closed.wait(wait)

    def _fallback(self) -> str:
        return f"{self.report.engine} finds ways"

    def _run(self) -> str:
        """Run one process to its end, and return the outcome; raises ImportError without RoutingKit."""
        child = _Child()
        try:
            with self._lock:
                self._child, self._starts = child, self._starts + 1
                closed = self._closed.is_set()
            if not closed:
                self._prepare(child)
                child.process.wait()
        except _GoneError:
            pass
        finally:
            with self._lock:
                self._child = None
            status = child.end()
        because = f" because it {child.fault}" if child.fault else ""
        return f"({child.process.pid}) ended with status {status}{because}"

    def _prepare(self, child: _Child) -> None:
        """Make the process order the graph and apply the costs; nothing waits for that."""
        child.receive(READY_WITHIN_S)  # it has started, so that it reads what it is sent
        missing = child.ask((self._graph.nodes, self._graph.tail, self._graph.head), READY_WITHIN_S)
        if missing:
            raise ImportError(missing.decode(errors="replace"))
        while not child.ready:
            with self._lock:
                left = [engine for number, engine in self._engines.items() if number not in child.unsent]
                child.ready = not left
            for engine in left:
                self._lay(child, engine)
        log.info("routes: %s finds ways in process %d", ContractionEngines.name, child.process.pid)

    def _lay(self, child: _Child, engine: ProcessEngine) -> None:
        with child.lock:
            with self._lock:
                child.unsent[engine.number] = set()
                message = ("engine", engine.number, engine.costs.copy(), list(self._engines))
            child.ask(message, LAID_WITHIN_S)

    def _lay_if_there(self, child: _Child, engine: ProcessEngine) -> None:
        with contextlib.suppress(_GoneError):
            self._lay(child, engine)


class _Child:
    """The process, and the gateway's end of its pipe: one query at a time, by the holder of ``lock``.

    Any error with it kills it, is kept in ``fault`` and raised as _GoneError.

    :raises OSError: when the process cannot be started.
    """

    def __init__(self) -> None:
        self.lock = threading.Lock()
        self.ready = self.failed = False
        self.fault = ""
        self.unsent: dict[int, set[int]] = {}
        """For each engine with costs in the process, the arcs with costs changed since."""
        self._connection, theirs = Pipe()
        with contextlib.closing(theirs):
            try:
                _limit_waits(self._connection.fileno())
                self.process = subprocess.Popen(  # nosec B603 # our own words, no shell
                    [sys.executable, "-c", _program(theirs.fileno())],
                    stdin=subprocess.DEVNULL,
                    stdout=subprocess.DEVNULL,
                    pass_fds=[theirs.fileno()],
                )
            except OSError:
                self._connection.close()
                raise

    def send(self, message: Any) -> None:
        """Send a message that has no answer."""
        if self.failed:
            # Its next output may answer an earlier query.
            raise _GoneError(self.fault)
        try:
            self._connection.send(message)
        except OSError as error:
            raise self.fail(f"did not read a message ({error})") from error

    def ask(self, message: Any, within: float) -> bytes:
        """Return the answer to a message, which must begin within ``within`` seconds."""
        self.send(message)
        return self.receive(within)

    def receive(self, within: float) -> bytes:
        """Return its next message."""
        try:
            if self._connection.poll(within):
                return self._connection.recv_bytes(_LARGEST_ANSWER)
        except EOFError as error:
            raise self.fail("broke off") from error
        except OSError as error:
            raise self.fail(f"sent no whole answer ({error})") from error
        raise self.fail(f"said nothing for {within:g} s")

    def fail(self, fault: str) -> _GoneError:
        """Kill the process, and return the error to raise."""
        self.failed, self.fault = True, self.fault or fault
        self.process.kill()
        return _GoneError(fault)

    def end(self) -> int:
        """End the process and return its status, once no caller waits for it."""
        self.failed = True
        self.process.kill()
        status = self.process.wait()
        with self.lock:
            self._connection.close()
        return status


def _limit_waits(handle: int) -> None:
    """Limit each wait of a socket for the other end to read or write: poll limits only the first one."""
    whole, part = divmod(ANSWER_WITHIN_S, 1)
    limit = struct.pack("ll", int(whole), int(part * 1e6))
    with socket.socket(fileno=handle) as pipe:
        try:
            pipe.setsockopt(socket.SOL_SOCKET, socket.SO_SNDTIMEO, limit)
            pipe.setsockopt(socket.SOL_SOCKET, socket.SO_RCVTIMEO, limit)
        finally:
            pipe.detach()


class _GoneError(LookupError):
    """There is no process that could find a way now."""


class ProcessEngine:
    """Finds ways under one set of costs; ``name`` is the engine that found the last one."""

    def __init__(self, made_by: ProcessEngines, number: int, local: Engine, costs: Floats) -> None:
        self.number = number
        self.local = local
        self.lock = threading.Lock()
        """Held while ``local`` is used."""
        self.costs = costs.copy()
        self.changed: set[int] = set()
        """The arcs whose costs ``local`` does not have yet."""
        self.name = local.name
        self._made_by = made_by

    def set_costs(self, arcs: Ints, costs: Floats) -> None:
        """Set the costs of ``arcs``."""
        self._made_by.set_costs(self, arcs, costs)

    def way(self, starts: Ends, goals: Ends) -> list[int] | None:
        """Return the arcs of the cheapest way, None for none."""
        try:
            way = self._made_by.way(self, starts, goals)
        except _GoneError:
            self.name = self.local.name
            return self._made_by.way_here(self, starts, goals)
        self.name = ContractionEngines.name
        return way


# --- In the process ---


def _program(handle: int) -> str:
    # sys.path of the gateway: the child finds the same modules, however the gateway was started.
    return f"import sys; sys.path = {sys.path!r}; from {__name__} import serve; serve({handle})"


def serve(handle: int) -> None:
    """Find ways for the gateway at the other end of the pipe ``handle``, until it closes that."""
    # The gateway ends this process: a signal to the whole group would come while it is still in use.
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.SIG_IGN)
    connection = Connection(handle)
    with contextlib.suppress(EOFError, BrokenPipeError):
        connection.send_bytes(b"")
        graph = RouteGraph(*connection.recv())
        try:
            factory = ContractionEngines(graph)
        except ImportError as error:
            connection.send_bytes(str(error).encode())
            return
        connection.send_bytes(b"")
        _answer(connection, factory)


def _answer(connection: Connection, factory: Callable[[Floats], Engine]) -> None:
    engines: dict[int, Engine] = {}
    while True:
        what, number, *given = connection.recv()
        if what == "engine":
            costs, in_use = given
            engines = {one: engine for one, engine in engines.items() if one in in_use}
            engines[number] = factory(costs)
            connection.send_bytes(b"")
        elif what == "costs":
            engines[number].set_costs(*given)
        else:
            way = engines[number].way(*given)
            connection.send_bytes(_NO_WAY if way is None else np.array(way, np.int64).tobytes())

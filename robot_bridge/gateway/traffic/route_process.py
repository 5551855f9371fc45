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

from ...core.roads.centrelines import Floats, Ints
from ...core.roads.engines import ContractionEngines, Ends, Engine, RouteGraph, safe_engines

log = logging.getLogger(__name__)

LEAST_ARCS = 4000
"""Arcs of a graph from which a process is started: SciPy finds a way on fewer in about 1 ms."""
ANSWER_WITHIN_S = 5.0
"""Seconds after which a process that owes a way counts as stuck, and is killed."""
READY_WITHIN_S = 600.0
"""Seconds that it may take to order a graph, or to lay costs over it."""
FIRST_WAIT_S, LONGEST_WAIT_S = 1.0, 300.0
"""Seconds until a process that ended is started again; twice as long each time that it ends soon."""
_SOON_S = 60.0


@dataclass(frozen=True)
class EngineReport:
    """What finds ways now, whether that is the fastest engine here, and how often its process was started."""

    engine: str
    ok: bool = True
    starts: int = 0


# --- In the gateway ---


class ProcessEngines:
    """Makes engines on ``graph``: RoutingKit's in a process, and behind each one that runs in this process.

    The latter finds ways on small graphs, where RoutingKit is not installed, until the process is ready, and
    whenever it has ended. Safe to use from several threads.
    """

    def __init__(self, graph: RouteGraph) -> None:
        self._graph = graph
        self._local, self._local_name = safe_engines(graph), ""
        self._lock = threading.Lock()
        self._engines: weakref.WeakValueDictionary[int, ProcessEngine] = weakref.WeakValueDictionary()
        self._numbers = itertools.count()
        self._connection: Connection | None = None
        self._process: subprocess.Popen[bytes] | None = None
        self._closed = threading.Event()
        self._starts = 0
        self._wanted = (
            len(graph.tail) >= LEAST_ARCS and importlib.util.find_spec("routingkit_cch") is not None
        )
        if self._wanted:
            threading.Thread(target=self._keep, name="routes", daemon=True).start()

    def __call__(self, costs: Floats) -> ProcessEngine:
        """Return an engine that finds ways under ``costs``."""
        engine = ProcessEngine(self, next(self._numbers), self._local(costs), costs)
        with self._lock:
            self._local_name = engine.local.name
            self._engines[engine.number] = engine
            if self._connection is not None:
                with contextlib.suppress(_GoneError):
                    self._make(self._connection, engine)
        return engine

    @property
    def report(self) -> EngineReport:
        """How ways are found now."""
        ready = self._connection is not None
        name = ContractionEngines.name if ready else self._local_name
        return EngineReport(name, ready or not self._wanted, self._starts)

    @property
    def process_id(self) -> int | None:
        """The id of the process that is ready to find ways, None where none is."""
        process = self._process
        return process.pid if process is not None and self._connection is not None else None

    def close(self) -> None:
        """End the process. Engines go on finding ways, in this process."""
        self._closed.set()
        with self._lock:
            self._wanted = False
            if self._process is not None:
                self._process.kill()

    def way(self, number: int, starts: Ends, goals: Ends) -> list[int] | None:
        """Return the arcs of the cheapest way under the costs of engine ``number``.

        :raises LookupError: when there is no process that can tell.
        """
        with self._lock:
            if self._connection is None:
                raise _GoneError
            self._send(self._connection, ("way", number, list(starts), list(goals)))
            way: list[int] | None = self._receive(self._connection, ANSWER_WITHIN_S)
            return way

    def way_here(self, engine: ProcessEngine, starts: Ends, goals: Ends) -> list[int] | None:
        """Return the arcs of the cheapest way as ``engine`` finds it in this process."""
        with self._lock:
            if engine.changed:
                arcs = np.array(sorted(engine.changed), np.int64)
                engine.local.set_costs(arcs, engine.costs[arcs])
                engine.changed.clear()
            return engine.local.way(starts, goals)

    def set_costs(self, engine: ProcessEngine, arcs: Ints, costs: Floats) -> None:
        """Give ``arcs`` of ``engine`` other costs, here as soon as they are needed here."""
        with self._lock:
            engine.costs[arcs] = costs
            engine.changed.update(arcs.tolist())
            if self._connection is not None:
                with contextlib.suppress(_GoneError):
                    self._send(self._connection, ("costs", engine.number, arcs, costs))

    def _keep(self) -> None:
        """Start the process, and again whenever it has ended, until all is closed."""
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
        """Run one process to its end, and return what became of it; raises ImportError without RoutingKit."""
        ours, theirs = Pipe()
        with contextlib.closing(ours):
            with contextlib.closing(theirs):
                process = subprocess.Popen(
                    [sys.executable, "-c", _program(theirs.fileno())],
                    stdin=subprocess.DEVNULL,
                    stdout=subprocess.DEVNULL,
                    pass_fds=[theirs.fileno()],
                )
            try:
                with self._lock:
                    self._process, self._starts = process, self._starts + 1
                    closed = self._closed.is_set()
                if not closed:
                    self._prepare(ours, process.pid)
                    process.wait()
            except _GoneError:
                process.kill()
            finally:
                with self._lock:
                    self._connection = self._process = None
                process.kill()
                status = process.wait()
        return f"({process.pid}) ended with status {status}"

    def _prepare(self, connection: Connection, pid: int) -> None:
        """Have the graph ordered, which other threads do not wait for, and the costs laid over it."""
        self._send(connection, (self._graph.nodes, self._graph.tail, self._graph.head))
        missing = self._receive(connection, READY_WITHIN_S)
        if missing:
            raise ImportError(missing)
        with self._lock:
            for engine in list(self._engines.values()):
                self._make(connection, engine)
            self._connection = connection
        log.info("routes: %s finds ways in process %d", ContractionEngines.name, pid)

    def _make(self, connection: Connection, engine: ProcessEngine) -> None:
        self._send(connection, ("engine", engine.number, engine.costs, list(self._engines)))
        self._receive(connection, READY_WITHIN_S)

    def _send(self, connection: Connection, message: Any) -> None:
        try:
            connection.send(message)
        except OSError as error:
            raise self._gone() from error

    def _receive(self, connection: Connection, within: float) -> Any:
        try:
            if connection.poll(within):
                return connection.recv()
        except (OSError, EOFError) as error:
            raise self._gone() from error
        log.warning("routes: the process of RoutingKit said nothing for %g s and is ended", within)
        raise self._gone()

    def _gone(self) -> _GoneError:
        self._connection = None
        if self._process is not None:
            self._process.kill()
        return _GoneError()


class _GoneError(LookupError):
    """There is no process that could find a way."""


class ProcessEngine:
    """Finds ways under one set of costs; ``name`` says what found the last one."""

    def __init__(self, made_by: ProcessEngines, number: int, local: Engine, costs: Floats) -> None:
        self.number = number
        self.local = local
        self.costs = costs.copy()
        self.changed: set[int] = set()
        self.name = local.name
        self._made_by = made_by

    def set_costs(self, arcs: Ints, costs: Floats) -> None:
        """Give ``arcs`` other costs."""
        self._made_by.set_costs(self, arcs, costs)

    def way(self, starts: Ends, goals: Ends) -> list[int] | None:
        """Return the arcs of the cheapest way, None for none."""
        try:
            way = self._made_by.way(self.number, starts, goals)
        except _GoneError:
            self.name = self.local.name
            return self._made_by.way_here(self, starts, goals)
        self.name = ContractionEngines.name
        return way


# --- In the process ---


def _program(handle: int) -> str:
    # The path of the gateway: the child finds the same modules, however that was started.
    return f"import sys; sys.path = {sys.path!r}; from {__name__} import serve; serve({handle})"


def serve(handle: int) -> None:
    """Find ways for the gateway at the other end of the pipe ``handle``, until it closes that."""
    # The gateway ends this process: a signal to all of its group comes before it has done with it.
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.SIG_IGN)
    connection = Connection(handle)
    with contextlib.suppress(EOFError, BrokenPipeError):
        graph = RouteGraph(*connection.recv())
        try:
            factory = ContractionEngines(graph)
        except ImportError as error:
            connection.send(str(error))
            return
        connection.send("")
        _answer(connection, factory)


def _answer(connection: Connection, factory: Callable[[Floats], Engine]) -> None:
    engines: dict[int, Engine] = {}
    while True:
        what, number, *given = connection.recv()
        if what == "engine":
            costs, in_use = given
            engines = {one: engine for one, engine in engines.items() if one in in_use}
            engines[number] = factory(costs)
            connection.send(None)
        elif what == "costs":
            engines[number].set_costs(*given)
        else:
            connection.send(engines[number].way(*given))

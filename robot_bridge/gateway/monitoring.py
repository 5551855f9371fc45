"""Monitoring of the gateway: counters, metrics, periodic tasks with retries, garbage collection."""

from __future__ import annotations

import asyncio
import contextlib
import functools
import gc
import importlib.metadata
import logging
import math
import time
from collections import Counter
from collections.abc import Awaitable, Callable, Coroutine, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from prometheus_client import CollectorRegistry, Histogram, ProcessCollector
from prometheus_client.core import CounterMetricFamily, GaugeMetricFamily, Metric
from prometheus_client.exposition import CONTENT_TYPE_LATEST, generate_latest

from ..core.clock import SYSTEM_CLOCK, Clock
from ..core.errors import BridgeError, FatalError
from ..core.logs import TroubleNews

log = logging.getLogger(__name__)

# --- Counters of the gateway: plain numbers, so that a message costs no more than an addition


@dataclass
class Counters:
    """Numbers since the start of the gateway; ``beats`` are the times of the last successes of its tasks.

    ``requests`` by link and operation, ``refused`` by link, ``desk`` by method, ``steps`` by command state,
    ``failures`` by task.
    """

    requests: Counter[tuple[str, str]] = field(default_factory=Counter)
    refused: Counter[str] = field(default_factory=Counter)
    desk: Counter[str] = field(default_factory=Counter)
    steps: Counter[str] = field(default_factory=Counter)
    failures: Counter[str] = field(default_factory=Counter)
    beats: dict[str, float] = field(default_factory=dict)

    def beat(self, task: str) -> None:
        """Record that ``task`` did its work just now."""
        self.beats[task] = time.monotonic()

    def age(self, task: str) -> float | None:
        """Return the seconds since ``task`` did its work, None if it never did."""
        last = self.beats.get(task)
        return None if last is None else time.monotonic() - last


@functools.cache
def gateway_version() -> str:
    """Return the version of the installed gateway, ``unknown`` where it runs from a folder."""
    try:
        return importlib.metadata.version("fleet-supervisor-robot-bridge")
    except importlib.metadata.PackageNotFoundError:
        return "unknown"


# --- Metrics of the gateway, in the format of Prometheus ---

CONTENT_TYPE = CONTENT_TYPE_LATEST
_DATABASE_BUCKETS = (0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.25, 0.5, 1.0, 2.5, 5.0, 10.0)

Values = Mapping[tuple[str, ...], float]


@dataclass(frozen=True)
class MetricReading:
    """A metric that is read on request: ``values`` by the values of its ``labels``."""

    name: str
    text: str
    labels: tuple[str, ...]
    values: Callable[[], Values]
    counts: bool = False


class Metrics:
    """The metrics of one gateway, in a registry of its own."""

    def __init__(self, counters: Counters) -> None:
        self._registry = CollectorRegistry()
        self._readings: list[MetricReading] = list(_counter_readings(counters))
        self.database = Histogram(
            "robot_bridge_database_transaction_seconds",
            "Time from handing a piece of work to the database to its commit.",
            buckets=_DATABASE_BUCKETS,
            registry=self._registry,
        )
        ProcessCollector(registry=self._registry)
        self._registry.register(_Collector(self._readings))

    def add(self, readings: Iterable[MetricReading]) -> None:
        """Add metrics that are read on request."""
        self._readings.extend(readings)

    def page(self) -> bytes:
        """Return all metrics as text; its content type is :data:`CONTENT_TYPE`."""
        return generate_latest(self._registry)


class _Collector:
    """Reads the readings for the registry."""

    def __init__(self, readings: list[MetricReading]) -> None:
        self._readings = readings

    def collect(self) -> Iterator[Metric]:
        for reading in self._readings:
            kind = CounterMetricFamily if reading.counts else GaugeMetricFamily
            family = kind(reading.name, reading.text, labels=reading.labels)
            # A copy: other threads continue counting while this is read.
            for labels, value in sorted(dict(reading.values()).items()):
                family.add_metric(labels, value)
            yield family

    def describe(self) -> list[Metric]:
        """Return nothing: the readings are not complete yet."""
        return []


def _counter_readings(counters: Counters) -> Iterator[MetricReading]:
    def single(counter: Mapping[str, int]) -> Callable[[], Values]:
        return lambda: {(label,): float(count) for label, count in counter.copy().items()}  # type: ignore[attr-defined]

    yield MetricReading(
        "robot_bridge_requests",
        "Requests of robots that were understood.",
        ("link", "op"),
        lambda: {labels: float(count) for labels, count in counters.requests.copy().items()},
        counts=True,
    )
    for name, text, label, counter in (
        ("refused_requests", "Requests of robots that were refused.", "link", counters.refused),
        ("desk_requests", "Requests of operators.", "method", counters.desk),
        (
            "command_steps",
            "Steps in the lives of commands, by the state they led to.",
            "state",
            counters.steps,
        ),
        (
            "task_failures",
            "Failures of the gateway's own tasks; each was tried again.",
            "task",
            counters.failures,
        ),
    ):
        yield MetricReading(f"robot_bridge_{name}", text, (label,), single(counter), counts=True)


# --- Background work that runs as long as the gateway: failures are logged, counted and retried ---

Work = Callable[[], Awaitable[None]]

FIRST_PAUSE, LONGEST_PAUSE = 0.25, 2.0
"""seconds before a retry after a foreseen failure, such as an unavailable database."""
LONGEST_PAUSE_UNFORESEEN = 30.0
LAST_ATTEMPT = 20
"""unforeseen failures in a row after which the process should be restarted."""
SOUND = 60.0
"""seconds of work without a failure after which earlier ones no longer count."""


async def keep_all_going(works: Mapping[str, Work], counters: Counters) -> None:
    """Run all works concurrently, as :func:`keep_going`, until one of them cannot continue.

    :raises FatalError: when one of them cannot continue.
    """
    tasks = [asyncio.create_task(keep_going(name, work, counters), name=name) for name, work in works.items()]
    try:
        await asyncio.gather(*tasks)
    finally:
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)


async def keep_going(name: str, work: Work, counters: Counters) -> None:
    """Run ``work``, and again after a growing pause when it raises; returns when it returns.

    :raises FatalError: when ``work`` raises it, or fails repeatedly for an unforeseen reason.
    """
    trouble = RetryState(name)
    while True:
        began = time.monotonic()
        try:
            return await work()
        except FatalError:
            raise
        except Exception as error:
            counters.failures[name] += 1
            pause = trouble.record_failure(error, lasted=time.monotonic() - began)
        await asyncio.sleep(pause)


class RetryState:
    """The failures of one work in a row: the wait after each, and which of them are logged."""

    def __init__(self, name: str) -> None:
        self._name = name
        self._pause = FIRST_PAUSE
        self._unforeseen = 0
        self._news = TroubleNews()

    def record_failure(self, error: Exception, lasted: float) -> float:
        """Log ``error`` and return the seconds to wait; ``lasted`` is the time that the work ran before it.

        :raises FatalError: when it has failed too often for unforeseen reasons.
        """
        if lasted > SOUND:
            self._pause, self._unforeseen = FIRST_PAUSE, 0
        foreseen = isinstance(error, BridgeError)
        self._unforeseen += 0 if foreseen else 1
        pause = self._pause
        self._pause = min(2 * pause, LONGEST_PAUSE if foreseen else LONGEST_PAUSE_UNFORESEEN)
        self._log_failure(error, foreseen, pause)
        if self._unforeseen >= LAST_ATTEMPT:
            raise FatalError(
                f"{self._name} failed {self._unforeseen} times, last with {type(error).__name__}: {error}; "
                "see the log, and report it"
            ) from error
        return pause

    def _log_failure(self, error: Exception, foreseen: bool, pause: float) -> None:
        if not foreseen:
            name = type(error).__name__
            log.exception("%s: unexpected %s; trying again in %g s", self._name, name, pause)
        elif self._news.has(self._name, str(error)):
            log.error("%s: %s; trying again until it works", self._name, error)


class Steps:
    """The steps of one work: each is done even if others fail."""

    def __init__(self, name: str) -> None:
        self._name = name
        self._news = TroubleNews()

    async def run(self, steps: Mapping[str, Work]) -> None:
        """Do every step in order; each that fails is logged, once a minute while it does.

        An unforeseen error is confined to its step: a cause in a robot or a row would end the gateway, and
        the next one too.

        :raises BridgeError: the first one of any step, after the last step.
        """
        failed: list[BridgeError] = []
        for step, work in steps.items():
            try:
                await work()
                self._news.is_over(step)
            except BridgeError as error:
                failed.append(error)
                if self._is_news(step, error):
                    log.error("%s, %s: %s; trying again until it works", self._name, step, error)
            except Exception as error:
                if self._is_news(step, error):
                    log.exception("%s, %s: unexpected %s", self._name, step, type(error).__name__)
        if failed:
            raise failed[0]

    def _is_news(self, step: str, error: Exception) -> bool:
        return self._news.has(step, f"{type(error).__name__} {error}")


class BackgroundTasks:
    """Tasks that are not awaited, kept until they end: the event loop has only weak references to them."""

    def __init__(self) -> None:
        self._tasks: set[asyncio.Task[None]] = set()

    def __len__(self) -> int:
        return len(self._tasks)

    def start(self, work: Coroutine[Any, Any, None], name: str | None = None) -> asyncio.Task[None]:
        """Start ``work`` as a task."""
        task = asyncio.create_task(work, name=name)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)
        return task

    async def wait(self, most: int = 0) -> None:
        """Wait until no more than ``most`` run, whatever their outcomes."""
        until = asyncio.FIRST_COMPLETED if most else asyncio.ALL_COMPLETED
        while len(self._tasks) > most:
            await asyncio.wait(self._tasks, return_when=until)


async def wait_at_most(event: asyncio.Event, seconds: float) -> None:
    """Wait until ``event`` is set, ``seconds`` at most; the event is not changed."""
    with contextlib.suppress(TimeoutError):
        async with asyncio.timeout(seconds):
            await event.wait()


async def every(seconds: float, work: Work, name: str, counters: Counters) -> None:
    """Run ``work`` every so many seconds forever, each success recorded as a beat of ``name``.

    Works have their turns at common ticks: see :func:`until_tick`.
    """
    while True:
        await asyncio.sleep(until_tick(seconds))
        await work()
        counters.beat(name)


# --- Ticks: all that is done at intervals wakes the process at the same moments

TICK_S = 0.25
_TICKS_SINCE = time.monotonic()
"""Ticks are counted from here, so that gateways on one computer do not all wake at the same moment."""
_ROUNDING_S = 0.002
"""An event loop may wake a millisecond early: that tick counts as over."""


def until_tick(seconds: float) -> float:
    """Return the time until the last tick that is at most ``seconds`` away, at least half of ``seconds``.

    Of a process with little to do most of the processor time goes into waking up: what is done at intervals
    is done together. Work that takes long rests for half its interval all the same. Less than a tick is
    returned as it is.
    """
    if seconds < TICK_S:
        return seconds
    now = time.monotonic() - _TICKS_SINCE
    tick = math.floor((now + seconds + _ROUNDING_S) / TICK_S) * TICK_S
    # An interval of less than two ticks may have none in its second half: half of it later there is one.
    return min(max(tick - now, seconds / 2), seconds)


# --- Garbage collection of reference cycles: rare, since all work waits meanwhile

YOUNG, MIDDLE, OLD = 50_000, 5, 4
"""Thresholds of :func:`gc.set_threshold`: objects, and rounds, before the next collection. A thousand robots
that send ten thousand positions a second have up to 20 000 objects waiting to be stored, which are freed
without a collection. With fewer YOUNG than that there was one every two seconds, and one of 30 ms every ten;
with Python's defaults it was one of 140 ms every five. Remains of closed connections wait for a collection of
the OLD, which comes after ten thousand of them: see :class:`GarbageCollection`."""
MOST_GONE = 1000
"""Closed connections before the next full collection, whatever else there is to do. Each leaves 90 objects
in reference cycles, 12 kB in all."""
REST = 50.0
"""Pause after a full collection as a multiple of its duration: all work waits during one."""


def freeze_permanent_objects() -> None:
    """Exclude all loaded objects from collection, and collect others less often; call it once loaded."""
    gc.collect()
    gc.freeze()
    gc.set_threshold(YOUNG, MIDDLE, OLD)


AFTER_STOP_S, MOST_POSTPONED_S = 5.0, 30.0
"""seconds without collections after an emergency stop has begun, and at most where one follows another:
stopping a thousand robots makes so many objects that there would be several, of 40 ms or more."""


class GarbageCollection:
    """Collects the remains of closed connections, which are in the oldest generation, rarely collected."""

    def __init__(self, clock: Clock = SYSTEM_CLOCK) -> None:
        self._clock = clock
        self._collected_at = 0
        self._rests_until = -math.inf
        self._postponed_since: float | None = None
        self._postponed_until = -math.inf

    def postpone(self) -> None:
        """Disable collections for a while; :meth:`clear_away` enables them again."""
        now = self._clock.steady()
        if self._postponed_since is None:
            self._postponed_since = now
            gc.disable()
        self._postponed_until = min(now + AFTER_STOP_S, self._postponed_since + MOST_POSTPONED_S)

    def clear_away(self, gone: int) -> None:
        """Do a full collection when ``gone``, connections closed since the start, has grown by MOST_GONE."""
        began = self._clock.steady()
        if self._postponed_since is not None:
            if began < self._postponed_until:
                return
            self._postponed_since = None
            gc.enable()
        if gone - self._collected_at < MOST_GONE or began < self._rests_until:
            return
        self._collected_at = gone
        gc.collect()
        now = self._clock.steady()
        self._rests_until = now + REST * (now - began)

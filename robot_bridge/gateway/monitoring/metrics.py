"""Counters of the gateway, and its metrics in the format that Prometheus reads."""

from __future__ import annotations

import importlib.metadata
import time
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field

from prometheus_client import CollectorRegistry, Histogram, ProcessCollector
from prometheus_client.core import CounterMetricFamily, GaugeMetricFamily, Metric
from prometheus_client.exposition import CONTENT_TYPE_LATEST, generate_latest

# --- What the gateway counts while it works: plain numbers, so that a message costs no more than an addition


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
        """Note that ``task`` did its work just now."""
        self.beats[task] = time.monotonic()

    def age(self, task: str) -> float | None:
        """Return the seconds since ``task`` did its work, None if it never did."""
        last = self.beats.get(task)
        return None if last is None else time.monotonic() - last


def gateway_version() -> str:
    """Return the version of the installed gateway, ``unknown`` where it runs from a folder."""
    try:
        return importlib.metadata.version("fleet-supervisor-robot-bridge")
    except importlib.metadata.PackageNotFoundError:
        return "unknown"


# --- What the gateway has to say in numbers, in the format that Prometheus reads ---

CONTENT_TYPE = CONTENT_TYPE_LATEST
_DATABASE_BUCKETS = (0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.25, 0.5, 1.0, 2.5, 5.0, 10.0)

Values = Mapping[tuple[str, ...], float]


@dataclass(frozen=True)
class MetricReading:
    """A number that is looked up when somebody asks: ``values`` by the values of its ``labels``."""

    name: str
    text: str
    labels: tuple[str, ...]
    values: Callable[[], Values]
    counts: bool = False


class Metrics:
    """The numbers of one gateway, in a registry of its own."""

    def __init__(self, tally: Counters) -> None:
        self._registry = CollectorRegistry()
        self._readings: list[MetricReading] = list(_tallied(tally))
        self.database = Histogram(
            "robot_bridge_database_transaction_seconds",
            "Time from handing a piece of work to the database to its commit.",
            buckets=_DATABASE_BUCKETS,
            registry=self._registry,
        )
        ProcessCollector(registry=self._registry)
        self._registry.register(_Collector(self._readings))

    def add(self, readings: Iterable[MetricReading]) -> None:
        """Add numbers that are looked up when somebody asks."""
        self._readings.extend(readings)

    def page(self) -> bytes:
        """Return all numbers as text; its content type is :data:`CONTENT_TYPE`."""
        return generate_latest(self._registry)


class _Collector:
    """Reads the readings for the registry."""

    def __init__(self, readings: list[MetricReading]) -> None:
        self._readings = readings

    def collect(self) -> Iterator[Metric]:
        for reading in self._readings:
            kind = CounterMetricFamily if reading.counts else GaugeMetricFamily
            family = kind(reading.name, reading.text, labels=reading.labels)
            # A copy: other threads count on while this is read.
            for labels, value in sorted(dict(reading.values()).items()):
                family.add_metric(labels, value)
            yield family

    def describe(self) -> list[Metric]:
        """Return nothing: the readings are not all there yet."""
        return []


def _tallied(tally: Counters) -> Iterator[MetricReading]:
    def single(counter: Mapping[str, int]) -> Callable[[], Values]:
        return lambda: {(label,): float(count) for label, count in counter.copy().items()}  # type: ignore[attr-defined]

    yield MetricReading(
        "robot_bridge_requests",
        "Requests of robots that were understood.",
        ("link", "op"),
        lambda: {labels: float(count) for labels, count in tally.requests.copy().items()},
        counts=True,
    )
    for name, text, label, counter in (
        ("refused_requests", "Requests of robots that were refused.", "link", tally.refused),
        ("desk_requests", "Requests of operators.", "method", tally.desk),
        ("command_steps", "Steps in the lives of commands, by the state they led to.", "state", tally.steps),
        (
            "task_failures",
            "Failures of the gateway's own tasks; each was tried again.",
            "task",
            tally.failures,
        ),
    ):
        yield MetricReading(f"robot_bridge_{name}", text, (label,), single(counter), counts=True)

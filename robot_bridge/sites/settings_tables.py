"""The tables of ``site.toml`` beside ``[site]``: what each key means, its default and what it may be."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field, fields
from typing import Any


def _number(default: Any, *, least: float = 0.0, above: bool = False, most: float = math.inf) -> Any:
    """Return a field for a number of at least ``least`` (or ``above`` it) and at most ``most``."""
    return field(default=default, metadata={"least": least, "above": above, "most": most})


@dataclass(frozen=True)
class LivenessLimits:
    """Seconds without a message after which a robot counts as stale and as lost (design, section 4)."""

    stale_after_s: float = _number(3.0, above=True)
    lost_after_s: float = _number(10.0, above=True)


@dataclass(frozen=True)
class CommandSettings:
    """``expire_after_s``: seconds after which a command that no robot fetched is given up."""

    expire_after_s: float = _number(300.0, above=True)


@dataclass(frozen=True)
class TrajectorySettings:
    """Which positions are stored, and for how long.

    A position is stored when the robot has moved ``min_distance_m`` or turned ``min_turn_deg`` since the last
    stored one, at most every ``min_interval_s``; and in any case after ``max_interval_s``. It is deleted
    after ``keep_days``. While the database is away up to ``largest_backlog`` positions wait in memory.
    """

    min_distance_m: float = _number(0.1)
    min_turn_deg: float = _number(5.0, most=360.0)
    min_interval_s: float = _number(0.2)
    max_interval_s: float = _number(10.0, above=True)
    keep_days: float = _number(30.0, above=True, most=36500.0)
    largest_backlog: int = _number(200_000, least=1000, most=100_000_000)


@dataclass(frozen=True)
class ObservationSettings:
    """What robots may tell: the largest image, how much of one robot waits, and the size of an object.

    ``most_pending`` observations of one robot may wait for review; more are refused. ``object_radius_m`` is
    that of an object whose size the robot did not say.
    """

    largest_image_bytes: int = _number(4_000_000, least=1024, most=64_000_000)
    most_pending: int = _number(1000, least=1, most=1_000_000)
    object_radius_m: float = _number(0.25, above=True, most=100.0)


@dataclass(frozen=True)
class GatewayOptions:
    """What ``robot-bridge serve`` takes where its command line does not say it; None for its own default.

    ``certificate`` and ``key`` are files in PEM; a relative one lies in the folder of ``site.toml``.
    """

    host: str | None = None
    port: int | None = _number(None, most=65535)
    database: str | None = None
    certificate: str | None = None
    key: str | None = None


def out_of_range(table: str, values: object) -> Iterator[str]:
    """Yield a sentence for every number of the dataclass ``values`` that its field does not allow."""
    for f in fields(values):  # type: ignore[arg-type]
        value = getattr(values, f.name)
        if "least" not in f.metadata or value is None:
            continue
        least, above, most = f.metadata["least"], f.metadata["above"], f.metadata["most"]
        name = f"{table}.{f.name} = {value}"
        if not math.isfinite(value):
            yield f"{name}: nan and inf are no numbers for a site; write a finite one."
        elif above and value <= least:
            yield f"{name} is not above {least:g}."
        elif value < least:
            yield f"{name} is below {least:g}."
        elif value > most:
            yield f"{name} is above {most:g}."

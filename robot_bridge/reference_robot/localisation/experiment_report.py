"""Results of an experiment: figures for each seed and for all together, as a table and as CSV."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass, fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .experiment import Record

FOUND = 0.5
"""metres: a robot this near to its estimate knows where it is."""
WRONG = 1.0
"""metres: one farther away that does not report being lost is misleading."""

_HEADS = {
    "seed": "seed",
    "driven_m": "driven [m]",
    "mean_m": "mean [m]",
    "p95_m": "p95 [m]",
    "max_m": "max [m]",
    "heading_mean_deg": "heading mean [°]",
    "heading_p95_deg": "heading p95 [°]",
    "heading_max_deg": "heading max [°]",
    "odometry_end_m": "odometry alone, at the end [m]",
    "lost": "scans lost",
    "wrong": "scans wrong, unsaid",
    "within": "within twice its accuracy",
    "found_m": "found after [m]",
    "update_ms": "update [ms]",
    "end_m": "end, off by [m]",
    "end_deg": "end, turned by [°]",
    "maps": "maps",
    "map_bytes": "bytes of maps",
    "clearance_m": "nearest to anything [m]",
    "accepted": "accepted observations",
}


@dataclass(frozen=True)
class Figures:
    """One row of the table.

    Errors are over the scans at which the robot does not report being lost; ``lost`` are the others,
    ``wrong`` those at which it is more than :data:`WRONG` away without reporting it. ``within`` is the share
    of scans at which it is at most twice as far away as the accuracy that it states, which is a standard
    deviation: of a normal distribution 0.95. ``found_m`` are metres from where it was switched on or carried
    to until it was within :data:`FOUND` for good. ``update_ms`` is the median of the processor's time.
    ``end_m`` and ``end_deg`` are its true final distance from the goal. None means not measured.
    """

    seed: str
    driven_m: float
    mean_m: float
    p95_m: float
    max_m: float
    heading_mean_deg: float
    heading_p95_deg: float
    heading_max_deg: float
    odometry_end_m: float
    lost: int
    wrong: int
    within: float
    found_m: float
    update_ms: float
    end_m: float | None = None
    end_deg: float | None = None
    maps: int | None = None
    map_bytes: int | None = None
    clearance_m: float | None = None
    accepted: int | None = None


def position_errors(record: Record) -> NDArray[Any]:
    """Return the distance of the estimate from the truth at each scan, (n,) metres."""
    away: NDArray[Any] = np.hypot(*(record.belief - record.truth)[:, :2].T)
    return away


def heading_errors(record: Record) -> NDArray[Any]:
    """Return the error of the estimated heading at each scan, (n,) degrees, not negative."""
    off = np.abs(record.belief[:, 2] - record.truth[:, 2]) % (2 * np.pi)
    wrong: NDArray[Any] = np.degrees(np.minimum(off, 2 * np.pi - off))
    return wrong


def figures(records: Sequence[Record]) -> list[Figures]:
    """Return a row for each record, and, if there are several, one of all their scans together."""
    rows = [_figures(str(record.seed), [record]) for record in records]
    return rows if len(rows) == 1 else [*rows, _figures("all", records)]


def _figures(name: str, records: Sequence[Record]) -> Figures:
    away = np.concatenate([position_errors(record) for record in records])
    turned = np.concatenate([heading_errors(record) for record in records])
    lost = np.concatenate([record.lost for record in records])
    sure, sure_turned = away[~lost], turned[~lost]
    accuracy = np.concatenate([record.accuracy for record in records])[~lost]
    within = float((sure <= 2 * accuracy).mean()) if len(sure) else math.nan
    if not len(sure):
        sure = sure_turned = np.array([math.nan])
    odometry = [math.dist(record.odometry[-1, :2], record.truth[-1, :2]) for record in records]
    return Figures(
        seed=name,
        driven_m=float(np.mean([record.driven[-1] for record in records])),
        mean_m=float(sure.mean()),
        p95_m=float(np.percentile(sure, 95)),
        max_m=float(sure.max()),
        heading_mean_deg=float(sure_turned.mean()),
        heading_p95_deg=float(np.percentile(sure_turned, 95)),
        heading_max_deg=float(sure_turned.max()),
        odometry_end_m=float(np.mean(odometry)),
        lost=int(lost.sum()),
        wrong=int((sure > WRONG).sum()),
        within=within,
        found_m=max(_found_after(record) for record in records),
        update_ms=float(np.median(np.concatenate([record.seconds for record in records]))) * 1e3,
        **_measured(records),
    )


def _measured(records: Sequence[Record]) -> dict[str, Any]:
    """Return figures that only some experiments measure: means of several drives, and the least clearance."""
    ends = np.array([_end(record) for record in records if record.goal is not None]).reshape(-1, 2)
    maps = [record.maps for record in records if record.maps is not None]
    sizes = [record.map_bytes for record in records if record.map_bytes is not None]
    rooms = [record.clearance for record in records if record.clearance is not None]
    accepted = [record.accepted for record in records if record.accepted is not None]
    return {
        "end_m": float(ends[:, 0].mean()) if len(ends) else None,
        "end_deg": float(ends[:, 1].mean()) if len(ends) else None,
        "maps": round(sum(maps) / len(maps)) if maps else None,
        "map_bytes": round(sum(sizes) / len(sizes)) if sizes else None,
        "clearance_m": min(rooms) if rooms else None,
        "accepted": round(sum(accepted) / len(accepted)) if accepted else None,
    }


def _end(record: Record) -> tuple[float, float]:
    """Return the true distance of the robot from its goal in metres and degrees."""
    assert record.goal is not None
    x, y, theta = record.truth[-1]
    off = math.remainder(theta - record.goal[2], math.tau)
    return math.dist((x, y), record.goal[:2]), abs(math.degrees(off))


def _found_after(record: Record) -> float:
    """Return metres until the robot knew its place for good, infinite if it never did."""
    begin = record.carried or 0
    away = position_errors(record)[begin:] > FOUND
    if away[-1]:
        return math.inf
    if not away.any():
        return 0.0
    return float(record.driven[begin + np.flatnonzero(away)[-1] + 1] - record.driven[begin])


def table_text(rows: Sequence[Figures]) -> str:
    """Return the table as Markdown."""
    used = [name for name in _HEADS if any(getattr(row, name) is not None for row in rows)]
    lines = ["| " + " | ".join(_HEADS[name] for name in used) + " |", "|---" * len(used) + "|"]
    lines += ["| " + " | ".join(_text(getattr(row, name)) for name in used) + " |" for row in rows]
    return "\n".join(lines)


def csv_text(rows: Sequence[Figures]) -> str:
    """Return the table as CSV with a head line, full digits."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow([field.name for field in fields(Figures)])
    writer.writerows(asdict(row).values() for row in rows)
    return text.getvalue()


def _text(value: str | int | float | None) -> str:
    if value is None:
        return "–"
    if not isinstance(value, float):
        return str(value)
    if not math.isfinite(value):
        return "–"
    return f"{value:.3f}" if value < 1 else f"{value:.1f}"

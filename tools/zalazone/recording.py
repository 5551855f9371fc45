"""What the recording says, and how well what operators see agrees with it."""

from __future__ import annotations

import csv
import gzip
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from tests.support.errors import StageError


@dataclass(frozen=True)
class Sample:
    """One place of a robot as an operator was told it: seconds, and metres in EPSG:32633."""

    t: float
    x: float
    y: float


@dataclass(frozen=True)
class Agreement:
    """How the replay of all cars agrees with their recording."""

    samples: int
    rate: float
    """Places a second that were told of each car, the median."""
    furthest: float
    """metres beside the recorded line, at most."""
    jitter: float
    """seconds by which a place came before or after the steady course of the replay; the 95th percentile."""


def read_recording(file: Path, until: float) -> dict[str, np.ndarray]:
    """Return rows (seconds, x, y in EPSG:32633) of each vehicle up to ``until`` seconds."""
    rows: dict[str, list[tuple[float, float, float]]] = {}
    with gzip.open(file, "rt", newline="") as text:
        for row in csv.DictReader(text):
            if float(row["t_s"]) <= until:
                place = float(row["t_s"]), float(row["x_utm33"]), float(row["y_utm33"])
                rows.setdefault(row["vehicle"], []).append(place)
    return {vehicle: np.array(places) for vehicle, places in rows.items()}


def compare(
    recorded: Mapping[str, np.ndarray], told: Mapping[str, Sequence[Sample]], least: int = 10
) -> Agreement:
    """Hold what was told of each vehicle against what was recorded of it.

    :raises StageError: when of one of them fewer than ``least`` places were told.
    """
    rates, beside, late = [], [], []
    for vehicle, rows in recorded.items():
        samples = told.get(vehicle, ())
        if len(samples) < least:
            raise StageError(
                f"of car {vehicle} only {len(samples)} places were told, and {least} are the least"
            )
        rates.append((len(samples) - 1) / (samples[-1].t - samples[0].t))
        found = [_nearest(rows, sample) for sample in samples]
        beside += [distance for distance, _ in found]
        lags = np.array([sample.t - at for sample, (_, at) in zip(samples, found, strict=True)])
        late += np.abs(lags - np.median(lags)).tolist()
    return Agreement(len(beside), float(np.median(rates)), max(beside), float(np.percentile(late, 95)))


def _nearest(rows: np.ndarray, sample: Sample) -> tuple[float, float]:
    """Return the distance of ``sample`` from the recorded line, metres, and the second of that place."""
    a, b = rows[:-1, 1:], rows[1:, 1:]
    along = b - a
    length = np.maximum((along**2).sum(axis=1), 1e-12)
    place = np.array([sample.x, sample.y])
    share = np.clip(((place - a) * along).sum(axis=1) / length, 0.0, 1.0)
    away = np.hypot(*(a + share[:, None] * along - place).T)
    best = int(away.argmin())
    return float(away[best]), float(rows[best, 0] + share[best] * (rows[best + 1, 0] - rows[best, 0]))

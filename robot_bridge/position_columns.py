"""Robots as the table of numbers that :mod:`.messages.position_columns` describes; no I/O."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from operator import attrgetter

import msgspec
import numpy as np
import numpy.typing as npt

from .messages import POSITION_ALWAYS, POSITION_HEAD, POSITION_TEXTS, POSITION_VALUE, PositionColumns
from .messages.position_columns import ALIGNMENT
from .robots import Robot

_OF_A_ROBOT = {
    **{name: name for name in ("latency", "link", "command")},
    "stopped": "ended_in_order",
    "state": "state._value_",
}
_OF_A_POSE = {
    **{name: name for name in ("x", "y", "theta", "v", "battery", "accuracy", "altitude")},
    **{name: name for name in ("status", "theta_from")},
    "device_time": "t",
    "fix_time": "fix_t",
}
"""Columns of a report, and where they stand."""
_ROBOT, _POSE = attrgetter(*_OF_A_ROBOT.values()), attrgetter(*_OF_A_POSE.values())
_NOWHERE = (None,) * len(_OF_A_POSE)


def table(robots: Sequence[Robot], now: float) -> tuple[dict[str, npt.NDArray[np.float64]], list[str]]:
    """Return what is told of ``robots`` at ``now``: (n,) by column, and the words of texts."""
    if not robots:
        return {name: np.empty(0) for name in POSITION_ALWAYS}, []
    facts = zip(*[_ROBOT(robot) for robot in robots], strict=True)
    poses = zip(*[_NOWHERE if robot.pose is None else _POSE(robot.pose) for robot in robots], strict=True)
    told = {**dict(zip(_OF_A_ROBOT, facts, strict=True)), **dict(zip(_OF_A_POSE, poses, strict=True))}
    words: dict[str | None, float] = {None: float("nan")}
    columns = {
        "age": _since(now, (robot.received_at for robot in robots), len(robots)),
        "pose_age": _since(now, (_pose_at(robot) for robot in robots), len(robots)),
    }
    for name, values in told.items():
        missing = values.count(None)
        if name in POSITION_TEXTS and missing < len(values):
            columns[name] = _places(values, words)
        elif missing < len(values):
            columns[name] = np.array(values, np.float64) if missing else np.fromiter(values, np.float64)
    if "latency" in columns:
        columns["latency"] = np.round(columns["latency"], 4)
    if np.isnan(columns["pose_age"]).all():
        del columns["pose_age"]
    return columns, [word for word in words if word is not None]


def frame(
    t: float, robots: Sequence[Robot], now: float, removed: Sequence[str] = (), *, everything: bool = False
) -> bytes:
    """Return the binary frame that tells of ``robots`` at ``now``, under the gateway's time ``t``.

    With ``everything`` they are all that there are; else ``removed`` are gone since what was told last.
    """
    columns, words = table(robots, now)
    names = [robot.name for robot in robots]
    head = PositionColumns(t, names, list(columns), words, list(removed), everything)
    return packed(head, columns.values())


def packed(head: PositionColumns, columns: Iterable[npt.NDArray[np.float64]]) -> bytes:
    """Return ``head`` and the columns that it names as one binary frame."""
    text = msgspec.json.encode({"jsonrpc": "2.0", "method": "positions", "params": head})
    length = -(-(POSITION_HEAD + len(text)) // ALIGNMENT) * ALIGNMENT - POSITION_HEAD
    values = (np.ascontiguousarray(column, dtype=POSITION_VALUE).tobytes() for column in columns)
    return b"".join([length.to_bytes(POSITION_HEAD, "little"), text.ljust(length), *values])


def _since(now: float, times: Iterable[float], count: int) -> npt.NDArray[np.float64]:
    """Return the seconds since ``times``, not below 0, in whole milliseconds."""
    since: npt.NDArray[np.float64] = np.maximum(now - np.fromiter(times, np.float64, count), 0.0)
    return since.round(3)


def _pose_at(robot: Robot) -> float:
    return float("nan") if robot.pose is None or robot.pose_at is None else robot.pose_at


def _places(texts: Iterable[str | None], words: dict[str | None, float]) -> npt.NDArray[np.float64]:
    """Return the place of each text among ``words``, which grow by those that are new; NaN for None."""
    # None is among them as well, so that a new word's place is one less than how many there are.
    return np.array([words.setdefault(text, len(words) - 1) for text in texts], dtype=np.float64)

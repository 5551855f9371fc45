"""Robots as the table of numbers that :mod:`.messages.position_columns` describes; no I/O."""

from __future__ import annotations

from collections.abc import Sequence
from operator import attrgetter

import msgspec
import numpy as np
import numpy.typing as npt

from .core.position_frame import METHOD, packed_frame
from .messages import POSITION_ALWAYS, POSITION_TEXTS, PositionColumns
from .robots import Robot

_OF_A_ROBOT = {
    "age": "received_at",
    "pose_age": "pose_at",
    **{name: name for name in ("latency", "link", "command", "paths", "abilities")},
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
_AGES = {"age", "pose_age"}
"""Columns of seconds since a time, in whole milliseconds."""
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
    columns = {}
    for name, values in told.items():
        if values.count(None) == len(values):
            continue
        columns[name] = _places(values, words) if name in POSITION_TEXTS else np.array(values, np.float64)
    for name in columns.keys() & _AGES:
        columns[name] = np.maximum(now - columns[name], 0.0).round(3)
    if "latency" in columns:
        columns["latency"] = np.round(columns["latency"], 4)
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
    text = msgspec.json.encode({"jsonrpc": "2.0", "method": METHOD, "params": head})
    return packed_frame(text, columns.values())


def _places(texts: Sequence[str | None], words: dict[str | None, float]) -> npt.NDArray[np.float64]:
    """Return the place of each text among ``words``, which grow by those that are new; NaN for None."""
    if texts.count(texts[0]) == len(texts):
        # Nearly all robots are in one state and on one link.
        return np.full(len(texts), words.setdefault(texts[0], len(words) - 1))
    # None is among them as well, so that a new word's place is one less than how many there are.
    return np.array([words.setdefault(text, len(words) - 1) for text in texts], dtype=np.float64)

"""Conversion of messages with one JSON object per robot to a table."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from ...robot_bridge.core.messages import positions
from .robot_states import AT, COLUMNS, STATE_CODES, WORDED, RobotTable, removed_robots


def table_from_rows(
    rows: Sequence[dict[str, Any]], received: float, params: dict[str, Any] | None = None
) -> RobotTable:
    """Return the reports of one message, all of which arrived at ``received``.

    Its ``params`` name the robots that no longer exist.

    :raises ValueError: naming the value and the robot, when a number is not finite or a text is none.
    :raises KeyError: when a report lacks its robot, state, age or link.
    """
    # Of duplicates the last one counts, in the place of the first.
    rows = list({values["robot"]: values for values in rows}.values())
    names = [values["robot"] for values in rows]
    if not all(isinstance(name, str) for name in names):
        raise ValueError("the name of a robot is not a text")
    if not all("link" in values and "age" in values for values in rows):
        raise KeyError("link or age of a robot")
    numbers = np.empty((len(COLUMNS), len(names)))
    words: dict[str | None, float] = {None: np.nan}
    for name in positions.POSITION_NUMBERS:
        numbers[AT[name]] = _numbers_of(name, names, [values.get(name) for values in rows])
    for name in WORDED:
        numbers[AT[name]] = _places_of(name, names, [values.get(name) for values in rows], words)
    numbers[AT["state"]] = [_state_code(values["state"]) for values in rows]
    numbers[AT["stopped"]] = [values.get("stopped", False) is True for values in rows]
    numbers[AT["received"]] = received
    known = [word for word in words if word is not None]
    return RobotTable(names, numbers, known, **removed_robots(params or {}))


def _numbers_of(name: str, names: list[str], values: list[Any]) -> npt.NDArray[np.float64]:
    column = _as_numbers(values, may_miss=name not in positions.POSITION_ALWAYS)
    if column is not None:
        return column
    for robot, value in zip(names, values, strict=True):
        if _as_numbers([value], may_miss=name not in positions.POSITION_ALWAYS) is None:
            raise ValueError(f"{name} of robot {robot} is {value!r}, not a finite number")
    raise AssertionError("each is a number by itself")


def _as_numbers(values: list[Any], *, may_miss: bool) -> npt.NDArray[np.float64] | None:
    """Return finite numbers, NaN for None if ``may_miss``; None when there is anything else among them."""
    kinds = set(map(type, values))
    if not kinds <= {float, int, type(None)}:
        return None
    missing = values.count(None) if type(None) in kinds else 0
    try:
        column = np.array(values, dtype=np.float64)
    except OverflowError:
        return None
    is_right = (may_miss or not missing) and np.isfinite(column).sum() + missing == len(values)
    return column if is_right else None


def _places_of(name: str, names: list[str], values: list[Any], words: dict[str | None, float]) -> list[float]:
    """Return the index of each text in ``words``, to which new ones are added."""
    for robot, value in zip(names, values, strict=True):
        if not isinstance(value, str) and (value is not None or name in positions.POSITION_ALWAYS):
            raise ValueError(f"{name} of robot {robot} is {value!r}, not a text")
    # None is a key as well, so that a new word's index is one less than the length.
    return [words.setdefault(value, len(words) - 1) for value in values]


def _state_code(state: Any) -> int:
    try:
        return STATE_CODES[state]
    except (KeyError, TypeError):
        raise ValueError(f"{state!r} is not a robot's state; known are {', '.join(STATE_CODES)}") from None

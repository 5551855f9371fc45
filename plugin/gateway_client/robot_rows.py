"""The robots of a message that tells each as a JSON object, made a table."""

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

    Its ``params`` tell which robots are there no more.

    :raises ValueError: when a number is none, or not finite, or a text is none; it names it and the robot.
    :raises KeyError: when a report lacks its robot, state, age or link.
    """
    # What is told twice counts as told last, in the place where it was told first.
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
    """Return finite numbers, and NaN for None where they may miss; None when anything else is among them."""
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
    """Return the place of each text among ``words``, which grow by those that are new."""
    for robot, value in zip(names, values, strict=True):
        if not isinstance(value, str) and (value is not None or name in positions.POSITION_ALWAYS):
            raise ValueError(f"{name} of robot {robot} is {value!r}, not a text")
    # None is among them as well, so that a new word's place is one less than how many there are.
    return [words.setdefault(value, len(words) - 1) for value in values]


def _state_code(state: Any) -> int:
    try:
        return STATE_CODES[state]
    except (KeyError, TypeError):
        raise ValueError(f"{state!r} is not a robot's state; known are {', '.join(STATE_CODES)}") from None

"""Positions that come as a table of numbers behind a JSON head: a binary frame, see
:mod:`~.robot_bridge.messages.position_columns`."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from ...robot_bridge.core.position_frame import split_frame
from ...robot_bridge.messages import POSITION_ALWAYS, POSITION_FLAGS, POSITION_NUMBERS, POSITION_TEXTS
from .absence import absence
from .sightings import AT, COLUMNS, STATES, Sightings

_STATE_CODES = {state.value: code for code, state in enumerate(STATES)}
_KNOWN = {*POSITION_NUMBERS, *POSITION_FLAGS, *POSITION_TEXTS}


def sightings_in(frame: bytes, received: float) -> Sightings:
    """Return the robots in one binary frame, all of which arrived at ``received``.

    :raises ValueError: when it is not such a frame, or something in it is not what it has to be.
    :raises KeyError: when the head lacks something.
    """
    params, robots, columns, words, table = split_frame(frame)
    missing = [name for name in POSITION_ALWAYS if name not in columns]
    if missing:
        raise KeyError(missing[0])
    numbers = np.full((len(COLUMNS), len(robots)), np.nan)
    for name, column in zip(columns, table, strict=True):
        if name in _KNOWN:
            _check(name, column, robots, len(words))
            numbers[AT[name]] = column
    numbers[AT["state"]] = np.array(_states(words))[numbers[AT["state"]].astype(np.intp)]
    _check("state", numbers[AT["state"]], robots, len(STATES))
    numbers[AT["received"]] = received
    return Sightings(robots, numbers, words, **absence(params))


def _states(words: list[str]) -> list[float]:
    """Return which of STATES each word is, NaN for one that is none."""
    return [_STATE_CODES.get(word, np.nan) for word in words]


def _check(name: str, column: npt.NDArray[np.float64], robots: list[str], words: int) -> None:
    """Raise ValueError unless everything in ``column`` can be what it has to be."""
    wrong = np.isinf(column)
    if name in POSITION_ALWAYS:
        wrong |= np.isnan(column)
    if name in POSITION_TEXTS:
        # What is NaN compares false.
        wrong |= (column < 0) | (column >= words) | (column > np.floor(column))
    if wrong.any():
        row = int(wrong.argmax())
        raise ValueError(f"{name} of robot {robots[row]} is {column[row]}, which it cannot be")

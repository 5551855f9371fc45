"""What a value in a message may be, whatever the message."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from typing import Any

Ranges = Mapping[str, tuple[float, float]]
"""The smallest and the largest value of numbers, by the name of the parameter."""
Texts = Mapping[str, int]
"""The most characters of texts, by the name of the parameter."""

_CRS = re.compile(r"EPSG:\d{4,6}")
ROBOT_NAME = re.compile(r"[A-Za-z0-9][A-Za-z0-9_.-]{0,62}")
LARGEST_NUMBER = 2**63 - 1
"""What an integer column of a database holds."""


class MessageError(ValueError):
    """A message that cannot be understood; the text names the operation, the parameter and what is right."""


def check_finite(**numbers: float | None) -> None:
    """Refuse NaN and infinity; raises MessageError naming the parameter."""
    for name, value in numbers.items():
        if value is not None and not math.isfinite(value):
            raise MessageError(f"{name} is {value}; give a finite number")


def check_stored_number(**numbers: int | None) -> None:
    """Refuse an integer that a database column cannot hold; raises MessageError naming the parameter."""
    for name, value in numbers.items():
        if value is not None and not 0 <= value <= LARGEST_NUMBER:
            raise MessageError(f"{name} is {value}; give a whole number from 0 to {LARGEST_NUMBER}")


def check_ranges(message: Any) -> None:
    """Refuse a number outside the ``ranges`` of its message, NaN included; raises MessageError."""
    for name, (low, high) in message.ranges.items():
        value = getattr(message, name)
        if value is not None and not low <= value <= high:
            raise MessageError(f"{name} is {value}; give a number from {low:g} to {high:g}")


def check_texts(message: Any) -> None:
    """Refuse what is empty, too long or has a line break among the ``texts`` of its message; MessageError."""
    for name, longest in message.texts.items():
        value = getattr(message, name)
        if value is not None and not (0 < len(value) <= longest and value.isprintable()):
            raise MessageError(f"{name} is {value[:40]!r}; give 1 to {longest} printable characters")


def check_robot_name(name: str) -> str:
    """Return ``name`` if it can name a robot, else raise MessageError."""
    if not ROBOT_NAME.fullmatch(name):
        raise MessageError(
            f"robot name {name!r} cannot be used; take 1 to 63 letters, digits, '_', '.' or '-', "
            "beginning with a letter or digit"
        )
    return name


def check_crs(crs: str | None) -> None:
    """Refuse what is no code of a CRS; raises MessageError. None is the site frame."""
    if crs is not None and _CRS.fullmatch(crs) is None:
        raise MessageError(f"crs is {crs[:40]!r}; give a code such as 'EPSG:4326', or none: the site frame")


def check_command_id(command: str) -> None:
    """Refuse an id that cannot tell one command from every other; raises MessageError."""
    if not (8 <= len(command) <= 64 and command.isprintable()):
        raise MessageError(f"command is {command!r}; give an id of 8 to 64 characters, say a UUID")


def check_expires_in(seconds: float | None, longest: float) -> None:
    """Refuse what is no time until something expires; None is never. Raises MessageError."""
    if seconds is not None and not 0 < seconds <= longest:
        raise MessageError(
            f"expires_in is {seconds}; give seconds, above 0 and up to {longest:g}, or leave it out"
        )

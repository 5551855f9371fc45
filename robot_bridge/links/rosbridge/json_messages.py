"""ROS messages as JSON, as they are sent to a rosbridge server: it fills in what is left out."""

from __future__ import annotations

from typing import Any

import msgspec
import numpy as np

LARGEST_SENT = 10_000_000
"""bytes of a message: what a rosbridge server takes in unless it is set otherwise."""
_WITH_GOALS = ("kilted", "lyrical")
"""Distributions whose NavigateThroughPoses takes nav_msgs/Goals."""


class JsonMessages:
    """Makes messages: objects by the names of their fields."""

    def __init__(self, distribution: str) -> None:
        self._distribution = distribution

    def knows(self, type_name: str) -> bool:
        """Tell whether the robots' distribution has a type."""
        return type_name != "nav_msgs/msg/Goals" or self._distribution in _WITH_GOALS

    def make(self, type_name: str, **fields: Any) -> Any:
        """Return a message; fields that are left out are zero, empty, or made of such."""
        return fields


def encode(_type_name: str, message: Any) -> bytes:
    """Return a message as JSON; raises ValueError for one that no server takes."""
    encoded = msgspec.json.encode(message, enc_hook=plain)
    if len(encoded) > LARGEST_SENT:
        raise ValueError(
            f"it has {len(encoded)} bytes as JSON, and {LARGEST_SENT} are the most; make "
            "rosbridge.map_resolution_m larger"
        )
    return encoded


def plain(value: Any) -> Any:
    """Return an array of numpy as a list."""
    if isinstance(value, np.ndarray):
        return value.tolist()
    raise TypeError(f"{type(value).__name__} cannot be written as JSON")

"""Positions as a table of numbers: what a desk asks for that shows thousands of robots.

A binary frame (:mod:`..core.position_frame`): a JSON-RPC notification ``positions`` whose params are
:class:`PositionColumns`, and behind it each of its columns, one 64-bit float for each robot. What is not
known of a robot is NaN. A column of :data:`POSITION_TEXTS` holds places in ``words``. A link tells the
gateway of its robots in the same form.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import Enum

POSITION_NUMBERS = (
    "age", "x", "y", "theta", "v", "device_time", "fix_time", "pose_age",
    "latency", "battery", "accuracy", "altitude",
)  # fmt: skip
POSITION_FLAGS = ("stopped",)
"""1 for true, 0 for false."""
POSITION_TEXTS = ("state", "link", "status", "command", "theta_from", "paths", "abilities")
POSITION_ALWAYS = ("age", "stopped", "state", "link")
"""What is known of every robot."""


class PositionForm(str, Enum):
    """How positions are told: a JSON object for each robot, or a table of numbers behind a JSON head."""

    ROWS = "rows"
    COLUMNS = "columns"


@dataclass(frozen=True)
class PositionColumns:
    """What the table behind it holds, at the gateway's time ``t``.

    ``columns`` are names of RobotReport's fields, in the order in which they follow, 64-bit little-endian
    floats, one for each of ``robots``; NaN is what is not known, and what is known of no robot is left out.
    In columns ``state``, ``link``, ``status``, ``command``, ``theta_from``, ``paths`` and ``abilities`` a
    number is a place in ``words``, counted from 0. With ``everything`` they are all robots that there are;
    otherwise ``removed`` are gone for good.
    """

    t: float
    robots: list[str]
    columns: list[str]
    words: list[str]
    removed: list[str] = field(default_factory=list)
    everything: bool = False

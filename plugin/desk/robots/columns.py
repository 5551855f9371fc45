"""The columns of the robot table: what stands in them, and what they are sorted by."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ....robot_bridge.messages import CommandReport, CommandState, SetPath, SetPosEnd
from ...language import tr
from ..last_heard import age_in_words
from ..state_words import COMMAND_STATES, ROBOT_STATES, longest


@dataclass(frozen=True)
class Column:
    """One column, by its ``title`` in the code and its ``head`` for the operator.

    ``widest`` is the longest text it has room for, ``first`` whether it is shown at first.
    """

    title: str
    head: str
    widest: str
    tip: str
    is_number: bool = False
    first: bool = True


COLUMNS = (
    Column("Robot", tr("Robot"), "robot-00", tr("The robot's name")),
    Column(
        "State",
        tr("State"),
        longest(ROBOT_STATES),
        tr("How far what is known of it can be trusted"),
    ),
    Column("Task", tr("Task"), "", tr("What it is doing, or what it says")),
    Column("Speed", tr("Speed"), "0.0 m/s", tr("Its speed, as it says"), True, False),
    Column("Batt.", tr("Batt."), "100%", tr("How full its battery is"), True),
    Column("Age", tr("Age"), "00 min", tr("How long ago anything was heard of it"), True),
    Column("Ping", tr("Ping"), "000 ms", tr("How long its link takes there and back"), True),
    Column(
        "Off",
        tr("Off"),
        "00.0 m",
        tr("How far it is beside its path, or from the target that it reached last"),
        True,
    ),
    Column("Link", tr("Link"), "ws", tr("How it is connected")),
    Column(
        "Position",
        tr("Position"),
        "500000.00, 5200000.00",
        tr("Where it is, in the CRS chosen under Columns"),
        True,
        False,
    ),
)
TITLES = tuple(column.title for column in COLUMNS)
TASK = TITLES.index("Task")
POSITION = TITLES.index("Position")
SHORT = {"websocket": "ws"}
"""Links whose names do not fit into a column."""


def short_link(told: dict) -> str:
    """Return how a robot is connected, short."""
    link = str(told.get("link", ""))
    return SHORT.get(link, link)


def idle_in_words(*, stopped: bool, paused: bool) -> str:
    """Return how a robot without a task stands: who was paused goes on when it is told so."""
    return tr("paused") if paused else tr("stopped") if stopped else ""


def task_in_words(task: CommandReport | None, told: dict, *, paused: bool = False) -> str:
    """Return what a robot is doing, else what it says of itself, else whether it was ``paused``."""
    if task is None:
        idle = idle_in_words(stopped=bool(told.get("stopped")), paused=paused)
        return str(told.get("status") or idle)
    if task.state is CommandState.ACKNOWLEDGED:
        if task.params.get("cone"):
            return tr("to cone")
        return tr("on route") if task.op == SetPath.__name__ else tr("to target")
    if task.params.get("cone"):
        return f"{tr('cone')} {COMMAND_STATES[task.state]}"
    target = tr("target")
    name = {SetPosEnd.__name__: target, SetPath.__name__: tr("route")}.get(task.op, task.op)
    return f"{name} {COMMAND_STATES[task.state]}"


def number_in_words(title: str, value: float) -> str:
    """Return a number of a column as text that fits into it, nothing for one that is not known."""
    if np.isnan(value):
        return ""
    if title == "Speed":
        return f"{value:.1f} m/s"
    if title == "Batt.":
        return f"{value:.0%}"
    if title == "Ping":
        return f"{value * 1000:.0f} ms" if value < 0.9995 else f"{value:.1f} s"
    if title == "Off":
        return f"{value:.2f} m" if value < 10 else f"{value:.1f} m"
    return age_in_words(value)

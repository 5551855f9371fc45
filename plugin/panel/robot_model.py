"""Model of the robot table: columns, rows as arrays, sorting and filtering."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from enum import Enum
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt
from qgis.PyQt.QtCore import QAbstractTableModel, QModelIndex, QObject, Qt

from ...robot_bridge.core.messages.commands import CommandReport, CommandState
from ...robot_bridge.core.messages.positions import gateway_of_link
from ...robot_bridge.core.messages.queues import QueueState
from ...robot_bridge.core.messages.robots import SetPath, SetPosEnd
from ...robot_bridge.core.messages.safety import RobotState
from ..gateway_client.command_cache import CommandCache, PathDeviations, command_in_words
from ..gateway_client.report_caches import QueueCache
from ..gateway_client.robot_states import LOOKS, STATES, UNSURE, RobotStates, RobotView
from ..gateway_client.state_words import (
    COMMAND_STATES,
    display_state_in_words,
    longest_word,
    robot_state_in_words,
)
from ..ui.glyphs import STATE_COLOURS, UNSURE_COLOUR, StateIcons, for_letters
from ..ui.language import age_in_words, last_seen_in_words, tr
from ..ui.tables import TO_THE_RIGHT


@dataclass(frozen=True)
class Column:
    """One column, by its ``title`` in the code and its ``head`` for the operator.

    ``widest`` is the longest text it has room for, ``first`` whether it is visible at first.
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
        longest_word(map(display_state_in_words, LOOKS)),
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
    Column("Link", tr("Link"), "@north", tr("How it is connected; @ and a name: at another gateway")),
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


def short_link(link: str) -> str:
    """Return the link of a robot short enough for the column, such as ``ws`` or ``@north``."""
    if (gateway := gateway_of_link(link)) is not None:
        return f"@{gateway}"
    return "ws" if link == "websocket" else link


def idle_in_words(*, stopped: bool, paused: bool) -> str:
    """Return the state of a robot without a task; a paused one continues on command only."""
    return tr("paused") if paused else tr("stopped") if stopped else ""


def task_in_words(task: CommandReport | None, values: dict, *, paused: bool = False) -> str:
    """Return a robot's task, else its own status, else whether it was ``paused``."""
    if task is None:
        idle = idle_in_words(stopped=bool(values.get("stopped")), paused=paused)
        return str(values.get("status") or idle)
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
    """Return a number of a column as text that fits into it, empty for an unknown one."""
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


Floats = npt.NDArray[np.float64]
Rows = npt.NDArray[np.intp]
Bools = npt.NDArray[np.bool_]
FRESH = STATES.index(RobotState.FRESH)


class RobotChoice(str, Enum):
    """Which robots are listed."""

    ALL = "all"
    TROUBLED = "troubled"
    BUSY = "busy"
    IDLE = "idle"


@dataclass
class FleetRows:
    """Row k is the robot in row k of the table. ``shown_as`` (n,) is as in :class:`.RobotArrays`;
    ``numbers`` has (n,) by column title, NaN where unknown."""

    picture: RobotStates
    cache: CommandCache
    deviations: PathDeviations
    names: list[str]
    shown_as: npt.NDArray[np.intp]
    xy: Floats
    numbers: dict[str, Floats]
    paused: frozenset[str]
    """Robots with a paused queue."""
    _off: dict[int, float] = field(default_factory=dict)
    _texts: dict[str, list[str]] = field(default_factory=dict)

    def __len__(self) -> int:
        return len(self.names)

    def row_values(self, row: int) -> dict[str, Any]:
        """Return the last values of a robot."""
        return self.picture.row_values(row)

    def task(self, row: int) -> str:
        """Return a robot's task in words."""
        name = self.names[row]
        return task_in_words(self.cache.task_of(name), self.row_values(row), paused=name in self.paused)

    def off(self, row: int) -> float:
        """Return the distance of a robot from its commanded place, NaN where unknown."""
        known = self._off.get(row)
        if known is None:
            x, y = self.xy[row].tolist()
            at = (x, y) if np.isfinite(x) and np.isfinite(y) else None
            found = self.deviations.of(self.names[row], at)
            known = self._off[row] = np.nan if found is None else found
        return known

    def shown(self, which: RobotChoice, text: str, troubled: set[str]) -> Rows:
        """Return the rows listed, by name: each word of ``text`` is in name, state, task or link."""
        rows = np.array(self.picture.by_name(), dtype=np.intp)
        if which is RobotChoice.TROUBLED:
            bad = self.shown_as != FRESH
            bad[[row for name in troubled if (row := self.picture.row(name)) is not None]] = True
            rows = rows[bad[rows]]
        elif which is not RobotChoice.ALL:
            busy = np.zeros(len(self), dtype=bool)
            for task in self.cache.under_way():
                row = self.picture.row(task.robot)
                if row is not None:
                    busy[row] = True
            rows = rows[busy[rows] == (which is RobotChoice.BUSY)]
        words = text.casefold().split()
        if not words:
            return rows
        names = [name.casefold() for name in self.names]
        has = np.logical_and.reduce([self._has(word, names) for word in words])
        return rows[has[rows]]

    def sorted(self, rows: Rows, title: str, descending: bool) -> Rows:
        """Return ``rows``, which are sorted by name, sorted by a column; unknown values come last."""
        if title == "Robot":
            return rows[::-1] if descending else rows
        keys = self._keys(rows, title)
        # NaN comes last in both orders.
        return rows[np.argsort(-keys if descending else keys, kind="stable")]

    def _keys(self, rows: Rows, title: str) -> Floats:
        if title == "State":
            look = self.shown_as[rows]
            # Between fresh and stale.
            return np.where(look == UNSURE, FRESH + 0.5, look)
        if title == "Off":
            return self._offs()[rows]
        if title == "Position":
            return self.xy[rows, 0]
        if title in self.numbers:
            return self.numbers[title][rows]
        words = self._text(title)
        rank = {word: float(place) for place, word in enumerate(sorted(set(words) - {""}, key=str.casefold))}
        return np.array([rank.get(word, np.nan) for word in words], dtype=np.float64)[rows]

    def _offs(self) -> Floats:
        """Return :meth:`off` of every robot; only one with a commanded place has a distance."""
        known = {report.robot for report in self.cache}
        offs = np.full(len(self), np.nan)
        for robot in known:
            row = self.picture.row(robot)
            if row is not None:
                offs[row] = self.off(row)
        return offs

    def _text(self, title: str) -> list[str]:
        """Return the texts of column Task or Link of every robot."""
        known = self._texts.get(title)
        if known is None:
            known = self._texts[title] = self._links() if title == "Link" else self._tasks()
        return known

    def _links(self) -> list[str]:
        return [short_link(link) for link in self.picture.texts("link")]

    def _tasks(self) -> list[str]:
        stopped = self.picture.column("stopped").tolist()
        says = self.picture.texts("status")
        silent = ("", tr("stopped"))
        texts = [text or silent[bool(stands)] for text, stands in zip(says, stopped, strict=True)]
        for row in self._paused_rows():
            texts[row] = says[row] or idle_in_words(stopped=True, paused=True)
        for task in self.cache.under_way():
            row = self.picture.row(task.robot)
            if row is not None:
                texts[row] = task_in_words(task, {})
        return texts

    def _has(self, word: str, names: list[str]) -> Bools:
        """Return which robots have ``word`` in their name, state, task or link; each text is checked once,
        however many robots have it."""
        has = np.fromiter((word in name for name in names), dtype=bool, count=len(names))
        has |= np.array([word in display_state_in_words(look).casefold() for look in LOOKS])[self.shown_as]
        return has | self.picture.says("link", word) | self._has_task(word)

    def _has_task(self, word: str) -> Bools:
        has = self.picture.says("status", word)
        if word in tr("stopped").casefold():
            has |= (self.picture.column("stopped") == 1.0) & ~self.picture.says("status", "")
        known = ~self.picture.says("status", "")
        for row in self._paused_rows():
            has[row] |= bool(known[row]) and word in tr("paused").casefold()
        for task in self.cache.under_way():
            row = self.picture.row(task.robot)
            if row is not None:
                has[row] = word in task_in_words(task, {}).casefold()
        return has

    def _paused_rows(self) -> list[int]:
        return [row for robot in self.paused if (row := self.picture.row(robot)) is not None]


def fleet_rows(
    picture: RobotStates, cache: CommandCache, queues: QueueCache, deviations: PathDeviations, moment: float
) -> FleetRows:
    """Return all robots at ``moment`` of the desk's clock."""
    robots = picture.arrays(moment)
    numbers = {
        "Speed": robots.v,
        "Batt.": picture.column("battery"),
        "Age": robots.age,
        "Ping": picture.column("latency"),
    }
    paused = frozenset(queue.robot for queue in queues if queue.state is QueueState.PAUSED)
    return FleetRows(picture, cache, deviations, robots.names, robots.shown_as, robots.xy, numbers, paused)


# Qt's own proxy queries every cell of ten thousand robots whenever one has changed; this one uses numpy.

ANSWERED_ROLES = frozenset(
    {
        Qt.ItemDataRole.DisplayRole,
        Qt.ItemDataRole.DecorationRole,
        Qt.ItemDataRole.ForegroundRole,
        Qt.ItemDataRole.ToolTipRole,
        Qt.ItemDataRole.TextAlignmentRole,
    }
)
"""The item roles that this model supports; a view queries as many others for each cell that it paints."""


class PositionTexts(Protocol):
    """The view of the robots, which has the CRS in which positions are shown."""

    def place_in_words(self, x: float, y: float) -> str:
        """Return the text of a position, given in metres in the site frame; empty where it is not known."""


class RobotModel(QAbstractTableModel):
    """One row for each listed robot. ``rows`` are computed afresh by :meth:`show`."""

    def __init__(
        self,
        robots: RobotStates,
        commands: CommandCache,
        queues: QueueCache,
        view: PositionTexts,
        parent: QObject | None = None,
    ):
        super().__init__(parent)
        self.deviations = PathDeviations(commands)
        self._queues = queues
        self._view = view
        self._fleet: FleetRows = fleet_rows(robots, commands, queues, self.deviations, 0.0)
        self._arrangement = robots.arrangement
        self._order: Rows = np.empty(0, dtype=np.intp)
        self._row_at: Rows = np.empty(0, dtype=np.intp)
        self._sorted_by = (TITLES.index("Robot"), Qt.SortOrder.AscendingOrder)
        self.which = RobotChoice.ALL
        self.text = ""
        self.troubled: set[str] = set()
        self._icons = StateIcons()

    def set_filter(self, text: str, which: RobotChoice) -> None:
        """List only robots that match ``text`` and ``which``, from the next update on."""
        self.text, self.which = text, which

    def set_troubled(self, robots: set[str]) -> None:
        """Record which robots have alarms."""
        self.troubled = robots

    def rowCount(self, parent: QModelIndex | None = None) -> int:
        return 0 if parent is not None and parent.isValid() else len(self._order)

    def columnCount(self, parent: QModelIndex | None = None) -> int:
        return 0 if parent is not None and parent.isValid() else len(COLUMNS)

    def headerData(self, section: int, orientation: Qt.Orientation, role: int = 0) -> object:
        if orientation != Qt.Orientation.Horizontal:
            return None
        if role == Qt.ItemDataRole.DisplayRole:
            return COLUMNS[section].head
        return COLUMNS[section].tip if role == Qt.ItemDataRole.ToolTipRole else None

    def data(self, index: QModelIndex, role: int = 0) -> object:
        if role not in ANSWERED_ROLES:
            return None
        row = int(self._order[index.row()])
        column = COLUMNS[index.column()]
        if role == Qt.ItemDataRole.DisplayRole:
            return self._text(row, column.title)
        if role == Qt.ItemDataRole.DecorationRole and column.title == "Robot":
            return self._icons.unsure if self._is_unsure(row) else self._icons[self._state(row)]
        if role == Qt.ItemDataRole.ForegroundRole and column.title == "State":
            return for_letters(UNSURE_COLOUR if self._is_unsure(row) else STATE_COLOURS[self._state(row)])
        if role == Qt.ItemDataRole.ToolTipRole:
            return self._tip(row)
        if role == Qt.ItemDataRole.TextAlignmentRole and column.is_number:
            return TO_THE_RIGHT
        return None

    def sort(self, column: int, order: Qt.SortOrder = Qt.SortOrder.AscendingOrder) -> None:
        self._sorted_by = (column, order)
        self._apply_order(self._sorted_rows())

    def show(self, moment: float) -> None:
        """Show the state at ``moment`` of the desk's clock."""
        picture = self._fleet.picture
        fleet = fleet_rows(picture, self._fleet.cache, self._queues, self.deviations, moment)
        if picture.arrangement != self._arrangement:
            # Rows of another arrangement belong to other robots.
            self._arrangement = picture.arrangement
            self.beginResetModel()
            self._fleet = fleet
            self._apply(self._sorted_rows())
            self.endResetModel()
            return
        self._fleet = fleet
        self._apply_order(self._sorted_rows())

    def count(self) -> int:
        """Return the number of robots, listed or not."""
        return len(self._fleet)

    def names(self) -> list[str]:
        """Return the names of all robots, listed or not."""
        return self._fleet.names

    def name_at(self, row: int) -> str:
        """Return the name of the robot in ``row``."""
        return self._fleet.names[self._order[row]]

    def rows_of(self, names: Iterable[str]) -> list[int]:
        """Return the rows of those robots that are listed."""
        known = (self._fleet.picture.row(name) for name in names)
        found = (int(self._row_at[row]) for row in known if row is not None and row < len(self._row_at))
        return [row for row in found if row >= 0]

    def _sorted_rows(self) -> Rows:
        rows = self._fleet.shown(self.which, self.text, self.troubled)
        column, order = self._sorted_by
        return self._fleet.sorted(rows, TITLES[max(0, column)], order == Qt.SortOrder.DescendingOrder)

    def _apply_order(self, order: Rows) -> None:
        if np.array_equal(order, self._order):
            self._row_at = _inverse(order, len(self._fleet))
            if len(order):
                self.dataChanged.emit(self.index(0, 0), self.index(len(order) - 1, len(COLUMNS) - 1))
        elif len(order) == len(self._order) and np.array_equal(np.sort(order), np.sort(self._order)):
            self._reorder(order)
        else:
            self.beginResetModel()
            self._apply(order)
            self.endResetModel()

    def _reorder(self, order: Rows) -> None:
        self.layoutAboutToBeChanged.emit()
        before = self.persistentIndexList()
        robots = [int(self._order[index.row()]) for index in before]
        self._apply(order)
        after = [
            self.index(int(self._row_at[robot]), index.column())
            for robot, index in zip(robots, before, strict=True)
        ]
        self.changePersistentIndexList(before, after)
        self.layoutChanged.emit()

    def _apply(self, order: Rows) -> None:
        self._order = order
        self._row_at = _inverse(order, len(self._fleet))

    def _is_unsure(self, row: int) -> bool:
        return bool(self._fleet.shown_as[row] == UNSURE)

    def _state(self, row: int) -> RobotState:
        return RobotState.FRESH if self._is_unsure(row) else STATES[int(self._fleet.shown_as[row])]

    def _text(self, row: int, title: str) -> str:
        fleet = self._fleet
        if title == "Robot":
            return fleet.names[row]
        if title == "State":
            return display_state_in_words(int(self._fleet.shown_as[row]))
        if title == "Task":
            return fleet.task(row)
        if title == "Link":
            return short_link(str(fleet.row_values(row).get("link", "")))
        if title == TITLES[POSITION]:
            return self._view.place_in_words(*fleet.xy[row].tolist())
        value = fleet.off(row) if title == "Off" else float(fleet.numbers[title][row])
        return number_in_words(title, value)

    def _tip(self, row: int) -> str:
        fleet, values = self._fleet, self._fleet.row_values(row)
        name, age = fleet.names[row], fleet.numbers["Age"][row]
        view = RobotView(name, values, self._state(row), float(age))
        last_seen = last_seen_in_words(robot_state_in_words(view), age, values.get("link"))
        lines = [f"{name}: {last_seen}"]
        if view.is_doubted:
            lines.append(str(values["doubt"]))
        ping = fleet.numbers["Ping"][row]
        if np.isfinite(ping):
            lines.append(tr("its link takes {ms:.1f} ms there and back", ms=ping * 1000))
        x, y = fleet.xy[row].tolist()
        if np.isfinite(x) and np.isfinite(y):
            lines.append(tr("at {x:.2f}, {y:.2f} m in the site frame", x=x, y=y))
        task = fleet.cache.task_of(name)
        if task is not None:
            lines.append(f"{command_in_words(task)}: {COMMAND_STATES[task.state]}")
        elif fleet.task(row) and not values.get("status"):
            lines.append(fleet.task(row))
        if values.get("status") and values["status"] != values.get("doubt"):
            lines.append(tr("it says: {text}", text=values["status"]))
        return "\n".join(lines)


def _inverse(order: Rows, count: int) -> Rows:
    """Return the row in the table of each robot, -1 for those not listed."""
    rows = np.full(count, -1, dtype=np.intp)
    rows[order] = np.arange(len(order))
    return rows

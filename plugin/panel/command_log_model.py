"""Model of the command log: rows and steps as text, filter, export."""

from __future__ import annotations

import bisect
from collections.abc import Container, Iterable, Iterator
from dataclasses import dataclass
from enum import Enum
from itertools import count, groupby

from qgis.PyQt.QtCore import QAbstractItemModel, QModelIndex, QObject, Qt, pyqtSignal
from qgis.PyQt.QtGui import QFont

from ...robot_bridge.core.messages.commands import CommandReport, CommandState, CommandStep
from ...robot_bridge.core.messages.robots import Abort
from ..gateway_client.command_cache import (
    CommandCache,
    command_in_words,
    place_of,
    requested_at,
    state_word,
)
from ..gateway_client.fleet_state import FleetState
from ..gateway_client.state_words import COMMAND_STATES
from ..ui.glyphs import COMMAND_COLOURS, for_letters
from ..ui.language import date_and_time, plain_tip, short_time, tr
from ..ui.tables import iso_time

FAILED = (CommandState.ABORTED, CommandState.FAILED, CommandState.EXPIRED)
CSV_HEAD = (
    "command",
    "robot",
    "operation",
    "what",
    "asked_by",
    "step",
    "state",
    "time",
    "by",
    "reason",
    "deviation_m",
    "target_x",
    "target_y",
)


class CommandChoice(str, Enum):
    """Which commands are listed."""

    ALL = "all"
    OPEN = "open"
    FAILED = "failed"


@dataclass(frozen=True)
class CommandFilter:
    """A filter: commands of these ``robots`` (None: of all) that match ``which``."""

    robots: frozenset[str] | None = None
    which: CommandChoice = CommandChoice.ALL

    def keeps(self, report: CommandReport) -> bool:
        """Return whether a command is listed."""
        if self.robots is not None and report.robot not in self.robots:
            return False
        if self.which is CommandChoice.OPEN:
            return report.state.is_open
        return self.which is CommandChoice.ALL or report.state in FAILED


def cells(report: CommandReport) -> tuple[str, str, str, str]:
    """Return a command's row: time, command, state, and deviation, reason or operator."""
    first = report.steps[0].at if report.steps else None
    return (
        short_time(first),
        f"{report.robot} · {command_in_words(report)}",
        state_word(report.op, report.state),
        _details(report),
    )


def step_cells(step: CommandStep, report: CommandReport) -> tuple[str, str, str, str]:
    """Return a step's row: time, operator, state, and deviation or reason."""
    off = _off(report) if step.state is CommandState.REACHED else ""
    by, state = tr("by {by}", by=step.by), state_word(report.op, step.state)
    return short_time(step.at), by, state, off or step.reason or ""


def summary(reports: Iterable[CommandReport]) -> str:
    """Return the number of open commands, as in ``3 open: 1 queued, 2 acknowledged``."""
    states = [report.state for report in reports if report.state.is_open]
    if not states:
        return tr("None open")
    counts = [f"{states.count(state)} {COMMAND_STATES[state]}" for state in CommandState if state in states]
    return tr("{number} open: {counts}", number=len(states), counts=", ".join(counts))


def csv_rows(reports: Iterable[CommandReport]) -> Iterator[tuple[object, ...]]:
    """Return a row for every step of every command; places in metres of the site frame."""
    for report in reports:
        x, y = place_of(report) or (None, None)
        what = command_in_words(report)
        for number, step in enumerate(report.steps, 1):
            deviation = report.deviation if step.state is CommandState.REACHED else None
            yield (
                report.command,
                report.robot,
                report.op,
                what,
                report.operator,
                number,
                step.state.value,
                iso_time(step.at),
                step.by,
                step.reason,
                deviation,
                x,
                y,
            )


def _details(report: CommandReport) -> str:
    reason = report.steps[-1].reason if report.steps else None
    return _off(report) or reason or tr("by {by}", by=report.operator)


def _off(report: CommandReport) -> str:
    """Return the distance of a robot from its target; an abort has no target."""
    if report.deviation is None or report.op == Abort.__name__:
        return ""
    return tr("{metres:.2f} m off", metres=report.deviation)


COLUMNS = (tr("Time"), tr("Command"), tr("State"), tr("Details"))
TIME, STATE = 0, 2
COMMAND_ROLE = Qt.ItemDataRole.UserRole
ANSWERED_ROLES = frozenset(
    {
        COMMAND_ROLE,
        Qt.ItemDataRole.DisplayRole,
        Qt.ItemDataRole.ToolTipRole,
        Qt.ItemDataRole.ForegroundRole,
        Qt.ItemDataRole.FontRole,
    }
)
"""The item roles that this model supports; a view queries as many others for each cell that it paints."""
PAGE = 200
"""Commands that a view gets at first, and each time that it reaches the end of those."""
MERGED = 500
"""New commands that are sorted in one by one; with more of them all are listed again."""


class LogModel(QAbstractItemModel):
    """Lists the commands that pass ``filter``. For a step, the index holds the number of its command.

    A view lays out every row of the model whenever one is added: it gets the newest, and
    older ones when it asks for more.
    """

    added = pyqtSignal()
    """Commands arrived that were not listed before."""

    def __init__(self, parent: QObject | None = None):
        super().__init__(parent)
        self._known = CommandCache()
        self._filter = CommandFilter()
        self._shown: list[CommandReport] = []
        self._row_count = 0
        """The number of those that a view gets."""
        self._rows: dict[str, int] | None = {}
        """The row of each command; None where it must be computed again."""
        self._next_number = count(1)
        self._numbers: dict[str, int] = {}
        self._by_number: dict[int, str] = {}
        self._bold = QFont()
        self._bold.setPointSizeF(max(7.0, self._bold.pointSizeF() - 1.0))
        self._bold.setBold(True)

    def follow(self, state: FleetState) -> None:
        """List commands from now on as they change in ``state``."""
        self._known = state.commands
        state.commands_changed.connect(self._apply)

    # --- Interface to Qt ---

    def index(self, row: int, column: int, parent: QModelIndex | None = None) -> QModelIndex:
        if not self.hasIndex(row, column, parent or QModelIndex()):
            return QModelIndex()
        if parent is None or not parent.isValid():
            return self.createIndex(row, column, 0)
        return self.createIndex(row, column, self._number(self._shown[parent.row()].command))

    def parent(self, index: QModelIndex | None = None) -> QModelIndex:
        if index is None or not index.isValid() or index.internalId() == 0:
            return QModelIndex()
        row = self.row_of(self._by_number.get(int(index.internalId()), ""))
        return QModelIndex() if row is None else self.createIndex(row, 0, 0)

    def rowCount(self, parent: QModelIndex | None = None) -> int:
        if parent is None or not parent.isValid():
            return self._row_count
        is_command = parent.internalId() == 0 and parent.column() == 0
        return len(self._shown[parent.row()].steps) if is_command else 0

    def canFetchMore(self, parent: QModelIndex) -> bool:
        return not parent.isValid() and self._row_count < len(self._shown)

    def fetchMore(self, parent: QModelIndex) -> None:
        if not self.canFetchMore(parent):
            return
        last = min(self._row_count + PAGE, len(self._shown)) - 1
        self.beginInsertRows(parent, self._row_count, last)
        self._row_count = last + 1
        self.endInsertRows()

    def columnCount(self, parent: QModelIndex | None = None) -> int:
        return len(COLUMNS)

    def headerData(self, section: int, orientation: Qt.Orientation, role: int = 0) -> object:
        if orientation == Qt.Orientation.Horizontal and role == Qt.ItemDataRole.DisplayRole:
            return COLUMNS[section]
        return None

    def data(self, index: QModelIndex, role: int = 0) -> object:
        if role not in ANSWERED_ROLES:
            return None
        report = self.report_at(index)
        if report is None:
            return None
        if role == Qt.ItemDataRole.ToolTipRole and index.column() == TIME:
            return date_and_time(
                requested_at(report) if index.internalId() == 0 else report.steps[index.row()].at
            )
        if role in (Qt.ItemDataRole.DisplayRole, Qt.ItemDataRole.ToolTipRole):
            text = self._cells(index, report)[index.column()]
            return text if role == Qt.ItemDataRole.DisplayRole else plain_tip(text)
        if role == COMMAND_ROLE:
            return report.command
        if index.column() == STATE and role in (Qt.ItemDataRole.ForegroundRole, Qt.ItemDataRole.FontRole):
            state = report.state if index.internalId() == 0 else report.steps[index.row()].state
            if state not in COMMAND_COLOURS:
                return None
            return self._bold if role == Qt.ItemDataRole.FontRole else for_letters(COMMAND_COLOURS[state])
        return None

    # --- Content ---

    @property
    def filter(self) -> CommandFilter:
        """The current filter."""
        return self._filter

    @property
    def shown(self) -> list[CommandReport]:
        """The commands that are listed, newest first."""
        return self._shown

    def show_all(self, reports: Iterable[CommandReport], filter: CommandFilter) -> None:
        """Show those of ``reports`` that pass the filter, and no others."""
        self.beginResetModel()
        self._filter = filter
        kept = [report for report in reports if filter.keeps(report)]
        # Of equal times those that arrived last come first.
        kept.sort(key=requested_at)
        self._shown = kept[::-1]
        self._row_count = min(PAGE, len(kept))
        self._rows = None
        # No index outlives this, so all numbers are dropped: they would add up over a shift.
        self._numbers.clear()
        self._by_number.clear()
        self.endResetModel()

    def merge(self, reports: Iterable[CommandReport]) -> list[str]:
        """Apply new reports and return the commands that were not listed before."""
        new, gone = [], []
        for report in reports:
            row = self.row_of(report.command)
            if self._filter.keeps(report):
                new.append(report) if row is None else self._renew(row, report)
            elif row is not None:
                gone.append(row)
        for row in sorted(gone, reverse=True):
            self._remove(row)
        self._insert(new)
        return [report.command for report in new]

    def keep(self, commands: Container[str]) -> None:
        """Remove commands that are not among ``commands``."""
        for row in reversed(range(len(self._shown))):
            if self._shown[row].command not in commands:
                self._remove(row)

    def shorten(self) -> None:
        """Give a view the first page only, unless it has asked for more than arrives in a while."""
        if self._row_count > 2 * PAGE:
            self.beginRemoveRows(QModelIndex(), PAGE, self._row_count - 1)
            self._row_count = PAGE
            self.endRemoveRows()

    def report_at(self, index: QModelIndex) -> CommandReport | None:
        """Return the command of a row, which may be a step's."""
        if not index.isValid():
            return None
        row = index.row() if index.internalId() == 0 else self.parent(index).row()
        return self._shown[row] if 0 <= row < self._row_count else None

    def row_of(self, command: str) -> int | None:
        """Return the row of a command, None where it is not listed."""
        if self._rows is None:
            self._rows = {report.command: row for row, report in enumerate(self._shown)}
        return self._rows.get(command)

    def _apply(self, reports: list[CommandReport]) -> None:
        """Add new commands, and update known ones."""
        if len(reports) > MERGED:
            self.show_all(self._known, self._filter)
        elif self.merge(reports):
            self.keep(self._known)
            self.added.emit()

    def _insert(self, reports: list[CommandReport]) -> None:
        # Newest first, and of equal times those that arrived last.
        newest_first = sorted(reports, key=requested_at)[::-1]
        places = [
            bisect.bisect_left(self._shown, -requested_at(report), key=lambda known: -requested_at(known))
            for report in newest_first
        ]
        end = len(newest_first)
        # From the oldest on, so that the positions of the others remain valid.
        for place, run in groupby(reversed(places)):
            begin = end - len(list(run))
            self._insert_at(place, newest_first[begin:end])
            end = begin

    def _insert_at(self, row: int, reports: list[CommandReport]) -> None:
        is_listed = row < self._row_count or self._row_count == len(self._shown)
        if is_listed:
            self.beginInsertRows(QModelIndex(), row, row + len(reports) - 1)
            self._row_count += len(reports)
        self._shown[row:row] = reports
        self._rows = None
        if is_listed:
            self.endInsertRows()

    def _renew(self, row: int, report: CommandReport) -> None:
        before = len(self._shown[row].steps)
        more = len(report.steps) - before
        if row >= self._row_count:
            self._shown[row] = report
            return
        top = self.index(row, 0)
        if more > 0:
            self.beginInsertRows(top, before, before + more - 1)
        self._shown[row] = report
        if more > 0:
            self.endInsertRows()
        self.dataChanged.emit(top, self.index(row, len(COLUMNS) - 1))

    def _remove(self, row: int) -> None:
        is_listed = row < self._row_count
        if is_listed:
            self.beginRemoveRows(QModelIndex(), row, row)
            self._row_count -= 1
        command = self._shown.pop(row).command
        self._rows = None
        if is_listed:
            self.endRemoveRows()
        number = self._numbers.pop(command, None)
        if number is not None:
            del self._by_number[number]

    def _number(self, command: str) -> int:
        number = self._numbers.get(command)
        if number is None:
            number = self._numbers[command] = next(self._next_number)
            self._by_number[number] = command
        return number

    def _cells(self, index: QModelIndex, report: CommandReport) -> tuple[str, str, str, str]:
        return cells(report) if index.internalId() == 0 else step_cells(report.steps[index.row()], report)

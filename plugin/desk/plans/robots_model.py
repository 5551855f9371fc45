"""The robots that may take part in a plan, as rows of a table in which the operator writes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import groupby

from qgis.PyQt.QtCore import QAbstractTableModel, QModelIndex, QObject, Qt, pyqtSignal
from qgis.PyQt.QtGui import QColor

from ...language import tr
from ..item_values import CHECKED, TO_THE_RIGHT, UNCHECKED, number_of
from .plan_settings import PlanSettings, RobotSettings

HEADS = (tr("Robot"), tr("Carries"), tr("Aboard"), tr("m/s"), tr("Range"))
_FIELDS = ("used", "capacity", "aboard", "speed", "range_m")
_LEAST = {"capacity": 1, "aboard": 0, "speed": 0.05, "range_m": 0.0}
_SHOWN_AWAY = QColor(Qt.GlobalColor.gray)


class RobotsModel(QAbstractTableModel):
    """A row for each robot, by name: ticked when it takes part, with its settings."""

    edited = pyqtSignal(str, object)
    """The operator changed a robot: its name and its RobotSettings now."""
    refused = pyqtSignal(str)
    """What was written is no number that a robot can have; it stays as it was."""

    def __init__(self, parent: QObject | None = None):
        super().__init__(parent)
        self._names: list[str] = []
        self._there: list[bool] = []
        self._settings = PlanSettings()

    def rowCount(self, parent: QModelIndex | None = None) -> int:
        return 0 if parent is not None and parent.isValid() else len(self._names)

    def columnCount(self, parent: QModelIndex | None = None) -> int:
        return 0 if parent is not None and parent.isValid() else len(HEADS)

    def headerData(self, section: int, orientation: Qt.Orientation, role: int = 0) -> object:
        is_head = orientation == Qt.Orientation.Horizontal and role == Qt.ItemDataRole.DisplayRole
        return HEADS[section] if is_head else None

    def flags(self, index: QModelIndex) -> Qt.ItemFlag:
        more = Qt.ItemFlag.ItemIsEditable if index.column() else Qt.ItemFlag.ItemIsUserCheckable
        return super().flags(index) | more

    def data(self, index: QModelIndex, role: int = 0) -> object:
        if index.column() == 0:
            return self._about(index.row(), role)
        if role in (Qt.ItemDataRole.DisplayRole, Qt.ItemDataRole.EditRole):
            return f"{getattr(self._of(index.row()), _FIELDS[index.column()]):g}"
        return TO_THE_RIGHT if role == Qt.ItemDataRole.TextAlignmentRole else None

    def setData(self, index: QModelIndex, value: object, role: int = Qt.ItemDataRole.EditRole) -> bool:
        column = index.column()
        if column == 0 and role == Qt.ItemDataRole.CheckStateRole:
            wanted: float | None = number_of(value) == CHECKED
        elif column and role == Qt.ItemDataRole.EditRole:
            wanted = self._number(index.row(), column, str(value))
        else:
            return False
        if wanted is None:
            return False
        name = self._names[index.row()]
        one = replace(self._of(index.row()), **{_FIELDS[column]: wanted})
        self._settings = self._settings.with_robot(name, one)
        self.dataChanged.emit(index, index)
        self.edited.emit(name, one)
        return True

    def show_robots(self, names: Sequence[str], there: Sequence[bool], settings: PlanSettings) -> None:
        """Show the robots ``names``, of whom ``there`` says who can take part, with their ``settings``.

        Nothing but what changed is told: with a thousand robots some come or go at any moment, and an editor
        that is open must not lose what is being typed.
        """
        self._show_settings(settings)
        if names != self._names:
            self._show_names(names, there)
        changed = [row for row, (new, old) in enumerate(zip(there, self._there, strict=True)) if new != old]
        if changed:
            self._there = list(there)
            roles = [Qt.ItemDataRole.ForegroundRole, Qt.ItemDataRole.ToolTipRole]
            self.dataChanged.emit(self.index(changed[0], 0), self.index(changed[-1], 0), roles)

    def _show_settings(self, settings: PlanSettings) -> None:
        before, self._settings = self._settings, settings
        if settings.robots != before.robots and self._names:
            self.dataChanged.emit(self.index(0, 0), self.index(len(self._names) - 1, len(HEADS) - 1))

    def _show_names(self, names: Sequence[str], there: Sequence[bool]) -> None:
        known = set(self._names)
        if not known <= set(names):
            self.beginResetModel()
            self._names, self._there = list(names), list(there)
            self.endResetModel()
            return
        for first, last in _newcomers(names, known):
            self.beginInsertRows(QModelIndex(), first, last)
            self._names[first:first] = names[first : last + 1]
            self._there[first:first] = there[first : last + 1]
            self.endInsertRows()

    def _of(self, row: int) -> RobotSettings:
        return self._settings.of_robot(self._names[row])

    def _about(self, row: int, role: int) -> object:
        name, there = self._names[row], self._there[row]
        if role == Qt.ItemDataRole.DisplayRole:
            return name
        if role == Qt.ItemDataRole.CheckStateRole:
            return CHECKED if self._of(row).used else UNCHECKED
        if role == Qt.ItemDataRole.ForegroundRole and not there:
            return _SHOWN_AWAY
        if role == Qt.ItemDataRole.ToolTipRole and not there:
            return tr("{name} is away: it takes no part", name=name)
        return None

    def _number(self, row: int, column: int, text: str) -> float | None:
        """Return what ``text`` says; None where it says nothing that the column can hold, which is told."""
        field = _FIELDS[column]
        kind = type(getattr(RobotSettings(), field))
        try:
            number = kind(text.strip().replace(",", "."))
            if not _LEAST[field] <= number < 1e7:
                raise ValueError
        except ValueError:
            self.refused.emit(
                tr(
                    "{column} of {robot} is {text!r}: give {least:g} or more.",
                    column=HEADS[column],
                    robot=self._names[row],
                    text=text.strip(),
                    least=_LEAST[field],
                )
            )
            return None
        return number


def _newcomers(names: Sequence[str], known: set[str]) -> Iterator[tuple[int, int]]:
    """Yield the first and the last row of each run of ``names`` that are not ``known``."""
    row = 0
    for is_new, run in groupby(names, key=lambda name: name not in known):
        count = len(list(run))
        if is_new:
            yield row, row + count - 1
        row += count

"""The alarms as rows of a table."""

from __future__ import annotations

from qgis.PyQt.QtCore import QModelIndex, QObject, Qt
from qgis.PyQt.QtGui import QFont

from ...language import tr
from ..row_model import RowModel
from ..wall_clock import short_time, time_of_day
from .alarm import Alarm
from .colours import colour_of
from .words import KINDS, state_in_words

COLUMNS = (tr("Since"), tr("Alarm"), tr("State"))


class AlarmModel(RowModel):
    """One row for each alarm, in the order in which they are given."""

    def __init__(self, parent: QObject | None = None):
        super().__init__(COLUMNS, parent)

    def data(self, index: QModelIndex, role: int = 0) -> object:
        alarm = self.rows[index.row()]
        if role == Qt.ItemDataRole.DisplayRole:
            return (short_time(alarm.began), alarm.text, state_in_words(alarm))[index.column()]
        if role == Qt.ItemDataRole.ToolTipRole:
            return tip(alarm)
        if role == Qt.ItemDataRole.ForegroundRole:
            return colour_of(alarm)
        if role == Qt.ItemDataRole.FontRole and alarm.is_new:
            font = QFont()
            font.setPointSizeF(max(7.0, font.pointSizeF() - 1.0))
            font.setBold(True)
            return font
        return None

    def show_alarms(self, alarms: list[Alarm]) -> None:
        """Show these; rows that stay the same alarms keep their selection."""
        self.show_rows(alarms, lambda alarm: alarm.key)

    def alarm_at(self, row: int) -> Alarm:
        """Return the alarm in ``row``."""
        return self.rows[row]

    def rows_of(self, keys: set) -> list[int]:
        """Return the rows of alarms by their keys."""
        return [row for row, alarm in enumerate(self.rows) if alarm.key in keys]


def tip(alarm: Alarm) -> str:
    """Return all that is known of an alarm."""
    lines = [f"{KINDS[alarm.kind]}: {alarm.text}", tr("since {time}", time=time_of_day(alarm.began))]
    if alarm.times > 1:
        lines.append(tr("it began {times} times", times=alarm.times))
    if alarm.ended is not None:
        lines.append(tr("over since {time}, not acknowledged yet", time=time_of_day(alarm.ended)))
    if alarm.acknowledged is not None:
        seen = time_of_day(alarm.acknowledged)
        lines.append(tr("acknowledged {time} by {operator}", time=seen, operator=alarm.by))
    return "\n".join(lines)

"""The log of alarms: what began, ended and was acknowledged in this session."""

from __future__ import annotations

from qgis.PyQt.QtCore import QObject
from qgis.PyQt.QtWidgets import (
    QDialog,
    QDialogButtonBox,
    QHeaderView,
    QLabel,
    QTableView,
    QVBoxLayout,
    QWidget,
)

from ...errors import FleetError
from ...file_dialogs import file_to_write
from ...language import tr, tr_count
from ...settings.preferences import export_path
from ..csv_files import iso_time, write_csv
from ..row_model import TextModel
from ..wall_clock import date_and_time
from .alarm import AlarmEvent
from .words import CHANGES, KINDS, who

COLUMNS = (tr("Time"), tr("What"), tr("Kind"), tr("Robot"), tr("Alarm"), tr("By"))
CSV_HEAD = ("time", "change", "kind", "robot", "other", "x", "y", "alarm", "by")


class AlarmLogDialog(QDialog):
    """Newest first; the whole of it can be written as CSV."""

    def __init__(self, parent: QWidget | None = None):
        super().__init__(parent)
        self.setObjectName("fleet_alarm_log_dialog")
        self.setWindowTitle(tr("Log of alarms"))
        self._events: list[AlarmEvent] = []
        self._model = EventModel(self)
        view = QTableView()
        view.setObjectName("fleet_alarm_events")
        view.setModel(self._model)
        view.setShowGrid(False)
        view.setWordWrap(False)
        view.verticalHeader().hide()
        change, kind = (max(known.values(), key=len) for known in (CHANGES, KINDS))
        widths = (date_and_time(0.0), change, kind, "robot-00", "", "operator")
        for column, widest in enumerate(widths):
            view.setColumnWidth(column, view.fontMetrics().horizontalAdvance(widest) + 16)
        view.horizontalHeader().setSectionResizeMode(4, QHeaderView.ResizeMode.Stretch)
        self._said = QLabel()
        self._said.setObjectName("fleet_alarm_log_said")
        self._said.setWordWrap(True)
        buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Close)
        export = buttons.addButton(tr("Export CSV…"), QDialogButtonBox.ButtonRole.ActionRole)
        export.setObjectName("fleet_export_alarms")
        export.clicked.connect(self._ask_where)
        buttons.rejected.connect(self.reject)
        rows = QVBoxLayout(self)
        rows.addWidget(view, 1)
        rows.addWidget(self._said)
        rows.addWidget(buttons)
        self.resize(1040, 440)

    def show_events(self, events: list[AlarmEvent]) -> None:
        """Show these, oldest given first."""
        self._events = events
        self._model.show_events(events[::-1])

    def export(self, path: str) -> None:
        """Write all that is shown to ``path`` and say so."""
        try:
            count = write_csv(path, CSV_HEAD, map(_csv_row, self._events))
        except FleetError as error:
            self._said.setText(str(error))
            return
        self._said.setText(
            tr_count(count, "1 line written to {path}", "%n lines written to {path}", path=path)
        )

    def _ask_where(self) -> None:
        title = tr("Export the log of alarms")
        path = file_to_write(self, title, export_path("alarms.csv"), tr("CSV (*.csv)"))
        if path:
            self.export(path)


class EventModel(TextModel):
    """One row for each event."""

    def __init__(self, parent: QObject | None = None):
        super().__init__(COLUMNS, _cells, parent)

    def show_events(self, events: list[AlarmEvent]) -> None:
        """Show these, in this order."""
        self.show_rows(events)


def _cells(event: AlarmEvent) -> tuple[str, ...]:
    alarm = event.alarm
    what = CHANGES[event.change], KINDS[alarm.kind], who(alarm), alarm.text
    return (date_and_time(event.at), *what, event.by)


def _csv_row(event: AlarmEvent) -> tuple[object, ...]:
    alarm = event.alarm
    x, y = alarm.xy if alarm.xy is not None else (None, None)
    return (
        iso_time(event.at),
        event.change.value,
        alarm.kind.value,
        alarm.robot,
        alarm.other,
        x,
        y,
        alarm.text,
        event.by,
    )

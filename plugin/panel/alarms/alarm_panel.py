"""Panel of alarms: table, log, and form and dialog of thresholds."""

from __future__ import annotations

from qgis.PyQt.QtCore import QItemSelection, QItemSelectionModel, QModelIndex, QObject, Qt, pyqtSignal
from qgis.PyQt.QtGui import QFont
from qgis.PyQt.QtWidgets import (
    QAbstractItemView,
    QCheckBox,
    QDialog,
    QDialogButtonBox,
    QDoubleSpinBox,
    QGridLayout,
    QHBoxLayout,
    QHeaderView,
    QLabel,
    QPushButton,
    QSizePolicy,
    QTableView,
    QVBoxLayout,
    QWidget,
)

from ...settings.profile import export_path
from ...ui.dialogs import file_to_write, push_button
from ...ui.errors import FleetError
from ...ui.language import date_and_time, plain_tip, short_time, time_of_day, tr, tr_count
from ...ui.steady_widgets import ElidedText
from ...ui.tables import RowModel, TextModel, TimeColumn, ZoomMenu, iso_time, shrink_view, write_csv
from .board import CHANGES, alarm_state_in_words, colour_of, robots_of
from .rules import THRESHOLDS, Alarm, AlarmEvent, AlarmKind, Threshold, Thresholds
from .watch import AlarmWatch

# --- Thresholds ---


SITE_SETS = tr("the site's settings say after how long (see the robots' state)")
GATEWAY_JUDGES = tr("the gateway judges it by the published site, and says what it does")


class ThresholdsForm(QWidget):
    """A box for each kind of alarm, with its thresholds beside it."""

    def __init__(self, parent: QWidget | None = None):
        super().__init__(parent)
        self._boxes: dict[AlarmKind, QCheckBox] = {}
        self._numbers: dict[str, QDoubleSpinBox] = {}
        grid = QGridLayout(self)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setColumnStretch(1, 1)
        # So far all of it fits QGIS's options on a small screen with large type; else it is scrolled there.
        grid.setVerticalSpacing(2)
        for kind in AlarmKind:
            self._add(grid, kind)

    def show_limits(self, limits: Thresholds) -> None:
        """Show these thresholds."""
        for kind, box in self._boxes.items():
            box.setChecked(kind in limits.kinds)
        for name, threshold in THRESHOLDS.items():
            self._numbers[name].setValue(getattr(limits, name) * threshold.scale)

    def limits(self) -> Thresholds:
        """Return the thresholds in the fields."""
        return Thresholds(
            **{name: self._numbers[name].value() / one.scale for name, one in THRESHOLDS.items()},
            kinds=frozenset(kind for kind, box in self._boxes.items() if box.isChecked()),
        )

    def _add(self, grid: QGridLayout, kind: AlarmKind) -> None:
        row = grid.rowCount()
        box = QCheckBox(kind.words[0].upper() + kind.words[1:])
        box.setObjectName(f"fleet_watch_{kind.name.lower()}")
        self._boxes[kind] = box
        grid.addWidget(box, row, 0)
        numbers = [(name, one) for name, one in THRESHOLDS.items() if one.kind is kind]
        if not numbers:
            explanation = ElidedText("", SITE_SETS if kind is AlarmKind.LOST else GATEWAY_JUDGES)
            grid.addWidget(explanation, row, 1, 1, 2)
        for below, (name, threshold) in enumerate(numbers):
            grid.addWidget(QLabel(threshold.label), row + below, 1)
            grid.addWidget(self._spin_box(name, threshold, box), row + below, 2)

    def _spin_box(self, name: str, threshold: Threshold, box: QCheckBox) -> QDoubleSpinBox:
        spin = QDoubleSpinBox()
        spin.setObjectName(f"fleet_{name}")
        spin.setDecimals(threshold.decimals)
        spin.setRange(threshold.least * threshold.scale, threshold.most * threshold.scale)
        spin.setSuffix(threshold.unit)
        box.toggled.connect(spin.setEnabled)
        self._numbers[name] = spin
        return spin


class ThresholdsDialog(QDialog):
    """The form of thresholds with its buttons."""

    chosen = pyqtSignal(object)
    """The Thresholds, when OK was pressed."""

    def __init__(self, limits: Thresholds, parent: QWidget | None = None):
        super().__init__(parent)
        self.setObjectName("fleet_thresholds")
        self.setWindowTitle(tr("Alarm settings"))
        self._form = ThresholdsForm()
        self._buttons = QDialogButtonBox(
            QDialogButtonBox.StandardButton.Ok
            | QDialogButtonBox.StandardButton.Cancel
            | QDialogButtonBox.StandardButton.RestoreDefaults
        )
        self._buttons.accepted.connect(self._accept)
        self._buttons.rejected.connect(self.reject)
        defaults = self._buttons.button(QDialogButtonBox.StandardButton.RestoreDefaults)
        defaults.clicked.connect(lambda: self._form.show_limits(Thresholds()))
        rows = QVBoxLayout(self)
        rows.addWidget(self._form)
        rows.addWidget(self._buttons)
        self._form.show_limits(limits)

    def _accept(self) -> None:
        self.chosen.emit(self._form.limits())
        self.accept()


# --- The panel ---

ALARM_COLUMNS = (tr("Since"), tr("Alarm"), tr("State"))


class AlarmModel(RowModel):
    """One row for each alarm, in the order given."""

    def __init__(self, parent: QObject | None = None):
        super().__init__(ALARM_COLUMNS, parent)

    def data(self, index: QModelIndex, role: int = 0) -> object:
        alarm = self.rows[index.row()]
        if role == Qt.ItemDataRole.DisplayRole:
            return (short_time(alarm.began), alarm.text, alarm_state_in_words(alarm))[index.column()]
        if role == Qt.ItemDataRole.ToolTipRole:
            return plain_tip(tip(alarm))
        if role == Qt.ItemDataRole.ForegroundRole:
            return colour_of(alarm)
        if role == Qt.ItemDataRole.FontRole and alarm.is_new:
            font = QFont()
            font.setPointSizeF(max(7.0, font.pointSizeF() - 1.0))
            font.setBold(True)
            return font
        return None

    def show_alarms(self, alarms: list[Alarm]) -> None:
        """Show these alarms; rows of the same alarms stay selected."""
        self.show_rows(alarms, lambda alarm: alarm.key)

    def alarm_at(self, row: int) -> Alarm:
        """Return the alarm in ``row``."""
        return self.rows[row]

    def rows_of(self, keys: set) -> list[int]:
        """Return the rows of the alarms with these keys."""
        return [row for row, alarm in enumerate(self.rows) if alarm.key in keys]


def tip(alarm: Alarm) -> str:
    """Return all details of an alarm."""
    lines = [f"{alarm.kind.words}: {alarm.text}", tr("since {time}", time=time_of_day(alarm.began))]
    if alarm.times > 1:
        lines.append(tr("it began {times} times", times=alarm.times))
    if alarm.ended is not None:
        lines.append(tr("over since {time}, not acknowledged yet", time=time_of_day(alarm.ended)))
    if alarm.acknowledged is not None:
        seen = time_of_day(alarm.acknowledged)
        lines.append(tr("acknowledged {time} by {operator}", time=seen, operator=alarm.by))
    return "\n".join(lines)


LOG_COLUMNS = (tr("Time"), tr("What"), tr("Kind"), tr("Robot"), tr("Alarm"), tr("By"))
CSV_HEAD = ("time", "change", "kind", "robot", "other", "x", "y", "alarm", "by")


class AlarmLogDialog(QDialog):
    """The log of alarms, newest first, with export of all of it as CSV."""

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
        change = max(CHANGES.values(), key=len)
        kind = max((one.words for one in AlarmKind), key=len)
        widths = (date_and_time(0.0), change, kind, "robot-00", "", "operator")
        for column, widest in enumerate(widths):
            view.setColumnWidth(column, view.fontMetrics().horizontalAdvance(widest) + 16)
        view.horizontalHeader().setSectionResizeMode(4, QHeaderView.ResizeMode.Stretch)
        self._status = QLabel()
        self._status.setObjectName("fleet_alarm_log_said")
        self._status.setWordWrap(True)
        buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Close)
        export = buttons.addButton(tr("Export CSV…"), QDialogButtonBox.ButtonRole.ActionRole)
        export.setObjectName("fleet_export_alarms")
        export.clicked.connect(self._ask_where)
        buttons.rejected.connect(self.reject)
        rows = QVBoxLayout(self)
        rows.addWidget(view, 1)
        rows.addWidget(self._status)
        rows.addWidget(buttons)
        self.resize(1040, 440)

    def show_events(self, events: list[AlarmEvent]) -> None:
        """Show these events, given oldest first."""
        self._events = events
        self._model.show_events(events[::-1])

    def export(self, path: str) -> None:
        """Write all events shown to ``path`` and report it."""
        try:
            count = write_csv(path, CSV_HEAD, map(_csv_row, self._events))
        except FleetError as error:
            self._status.setText(str(error))
            return
        self._status.setText(
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
        super().__init__(LOG_COLUMNS, _cells, parent)

    def show_events(self, events: list[AlarmEvent]) -> None:
        """Show these, in this order."""
        self.show_rows(events)


def _cells(event: AlarmEvent) -> tuple[str, ...]:
    alarm = event.alarm
    what = CHANGES[event.change], alarm.kind.words, robots_of(alarm), alarm.text
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


class AlarmPanel(QWidget):
    """A row for each alarm; a double click or Enter goes to the robot."""

    robots_requested = pyqtSignal(list)
    """The names of robots to select and show."""
    counted = pyqtSignal(int)
    """The number of unacknowledged alarms."""

    def __init__(self, watch: AlarmWatch, parent: QWidget | None = None):
        super().__init__(parent)
        self.setObjectName("fleet_alarm_panel")
        self._watch = watch
        self._model = AlarmModel(self)
        self._view = QTableView()
        self._note = ElidedText("fleet_alarm_note")
        self._log: AlarmLogDialog | None = None
        self._set_up_view()
        self._lay_out()
        watch.changed.connect(self.refresh)
        watch.happened.connect(self._happened)
        self.refresh()

    def refresh(self) -> None:
        """Show the current alarms."""
        chosen = {alarm.key for alarm in self._chosen()}
        alarms = self._watch.board.alarms()
        self._model.show_alarms(alarms)
        self._times.make_room(min((alarm.began for alarm in alarms), default=None))
        self._choose(chosen)
        note = self._watch.why_not()
        self._note.setText(note)
        new = sum(alarm.is_new for alarm in alarms)
        self._all.setEnabled(new > 0)
        self._allow()
        self.counted.emit(new)

    def _set_up_view(self) -> None:
        view = self._view
        view.setObjectName("fleet_alarms")
        view.setAccessibleName(tr("Alarms"))
        view.setModel(self._model)
        view.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
        view.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        view.setShowGrid(False)
        view.setWordWrap(False)
        view.verticalHeader().hide()
        shrink_view(view)
        view.verticalHeader().setDefaultSectionSize(view.fontMetrics().height() + 8)
        self._times = TimeColumn(view, beside=14)
        view.setColumnWidth(2, view.fontMetrics().horizontalAdvance(tr("over") + " ×00") + 14)
        view.horizontalHeader().setSectionResizeMode(1, QHeaderView.ResizeMode.Stretch)
        view.horizontalHeader().setHighlightSections(False)
        ZoomMenu(view).requested.connect(lambda index: self._go(self._model.alarm_at(index.row())))
        view.selectionModel().selectionChanged.connect(self._allow)

    def _buttons(self) -> QHBoxLayout:
        self._seen = _button(
            "fleet_acknowledge", tr("Acknowledge"), tr("Say that you have seen the chosen alarms")
        )
        self._all = _button(
            "fleet_acknowledge_all", tr("Acknowledge all"), tr("Say that you have seen every alarm")
        )
        log = _button(
            "fleet_alarm_log", tr("Log…"), tr("Every alarm of this session, and who acknowledged it when")
        )
        limits = _button("fleet_alarm_limits", tr("Settings…"), tr("What is an alarm, and from where on"))
        self._seen.clicked.connect(lambda: self._watch.acknowledge([alarm.key for alarm in self._chosen()]))
        self._all.clicked.connect(self._watch.acknowledge_all)
        log.clicked.connect(self.show_log)
        limits.clicked.connect(self._ask_for_limits)
        buttons = QHBoxLayout()
        buttons.setSpacing(4)
        for button in (self._seen, self._all, log, limits):
            buttons.addWidget(button)
        return buttons

    def _lay_out(self) -> None:
        rows = QVBoxLayout(self)
        rows.setContentsMargins(0, 2, 0, 0)
        rows.setSpacing(4)
        # Aligned at the top: when the panel shrinks, the end of the list is cut.
        rows.addLayout(self._buttons())
        rows.addWidget(self._view, 1)
        rows.addWidget(self._note)

    def show_log(self) -> None:
        """Open the log of this session."""
        if self._log is None:
            self._log = AlarmLogDialog(self.window())
        self._log.show_events(list(self._watch.board.log))
        self._log.show()
        self._log.raise_()

    def remove(self) -> None:
        """Close its windows."""
        if self._log is not None:
            self._log.close()
            self._log.deleteLater()
            self._log = None

    def _happened(self, _events: list) -> None:
        if self._log is not None and self._log.isVisible():
            self._log.show_events(list(self._watch.board.log))

    def _ask_for_limits(self) -> None:
        dialog = ThresholdsDialog(self._watch.board.limits, self.window())
        dialog.chosen.connect(self._watch.set_limits)
        dialog.open()

    def _chosen(self) -> list[Alarm]:
        rows = self._view.selectionModel().selectedRows()
        return [self._model.alarm_at(index.row()) for index in rows]

    def _choose(self, keys: set) -> None:
        rows = self._model.rows_of(keys)
        if {index.row() for index in self._view.selectionModel().selectedRows()} == set(rows):
            return
        selection = QItemSelection()
        for row in rows:
            index = self._model.index(row, 0)
            selection.merge(QItemSelection(index, index), QItemSelectionModel.SelectionFlag.Select)
        flags = QItemSelectionModel.SelectionFlag
        self._view.selectionModel().select(selection, flags.ClearAndSelect | flags.Rows)

    def _allow(self, *_what: object) -> None:
        self._seen.setEnabled(any(alarm.is_new for alarm in self._chosen()))

    def _go(self, alarm: Alarm) -> None:
        self.robots_requested.emit([name for name in (alarm.other, alarm.robot) if name])


def _button(name: str, text: str, tip: str) -> QPushButton:
    button = push_button(name, text, tip)
    button.setAutoDefault(False)
    button.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
    # Four of them have to fit into a panel of 420 pixels, in longer languages as well.
    button.setMinimumWidth(40)
    return button

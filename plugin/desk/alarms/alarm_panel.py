"""The panel of alarms: what is the matter now, seen or not, and what to do about it."""

from __future__ import annotations

from qgis.PyQt.QtCore import QItemSelection, QItemSelectionModel, pyqtSignal
from qgis.PyQt.QtWidgets import (
    QAbstractItemView,
    QHBoxLayout,
    QHeaderView,
    QPushButton,
    QSizePolicy,
    QTableView,
    QVBoxLayout,
    QWidget,
)

from ...language import tr
from ..fixed_size import ElidedText
from ..going_there import GoingThere
from ..push_button import push_button
from ..small_views import shrink
from ..time_column import TimeColumn
from .alarm import Alarm
from .alarm_model import AlarmModel
from .log_dialog import AlarmLogDialog
from .thresholds_dialog import ThresholdsDialog
from .watch import AlarmWatch


class AlarmPanel(QWidget):
    """A row for each alarm; a double click or Enter goes to the robot."""

    robots_wanted = pyqtSignal(list)
    """The names of robots to be selected and shown."""
    counted = pyqtSignal(int)
    """How many alarms nobody has acknowledged yet."""

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
        """Show the alarms as they are."""
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
        view.setModel(self._model)
        view.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
        view.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
        view.setShowGrid(False)
        view.setWordWrap(False)
        view.verticalHeader().hide()
        shrink(view)
        view.verticalHeader().setDefaultSectionSize(view.fontMetrics().height() + 8)
        self._times = TimeColumn(view, beside=14)
        view.setColumnWidth(2, view.fontMetrics().horizontalAdvance(tr("over") + " ×00") + 14)
        view.horizontalHeader().setSectionResizeMode(1, QHeaderView.ResizeMode.Stretch)
        view.horizontalHeader().setHighlightSections(False)
        GoingThere(view, lambda index: self._go(self._model.alarm_at(index.row())))
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
        # At the top: what takes room from the panel takes it from the end of the list.
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
        """Close what it opened."""
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
        wanted = QItemSelection()
        for row in rows:
            index = self._model.index(row, 0)
            wanted.merge(QItemSelection(index, index), QItemSelectionModel.SelectionFlag.Select)
        flags = QItemSelectionModel.SelectionFlag
        self._view.selectionModel().select(wanted, flags.ClearAndSelect | flags.Rows)

    def _allow(self, *_what: object) -> None:
        self._seen.setEnabled(any(alarm.is_new for alarm in self._chosen()))

    def _go(self, alarm: Alarm) -> None:
        self.robots_wanted.emit([name for name in (alarm.other, alarm.robot) if name])


def _button(name: str, text: str, tip: str) -> QPushButton:
    button = push_button(name, text, tip)
    button.setAutoDefault(False)
    button.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
    # Four of them have to fit into a panel of 420 pixels, in longer languages as well.
    button.setMinimumWidth(40)
    return button

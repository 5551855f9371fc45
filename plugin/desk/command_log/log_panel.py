"""The log of commands with what is above it: whose, which, how many are open, and what to do with it."""

from __future__ import annotations

from qgis.PyQt.QtCore import QModelIndex, Qt, pyqtSignal
from qgis.PyQt.QtWidgets import (
    QAbstractItemView,
    QComboBox,
    QHBoxLayout,
    QHeaderView,
    QToolButton,
    QTreeView,
    QVBoxLayout,
    QWidget,
)

from ....robot_bridge.messages import CommandReport
from ...errors import FleetError
from ...file_dialogs import file_to_write
from ...language import tr, tr_count
from ...settings.preferences import export_path
from ..command_book import asked_at, in_words, place_of
from ..csv_files import write_csv
from ..desk import Desk
from ..fixed_size import ElidedText
from ..going_there import GoingThere
from ..messages import file_topic
from ..name_order import name_order
from ..small_views import shrink
from ..state_words import COMMAND_STATES, longest
from ..time_column import TimeColumn
from .entries import CSV_HEAD, Filter, Which, csv_rows, summary
from .log_model import PAGE, LogModel
from .older_commands import OlderCommands

EVERY_ROBOT, SELECTED = tr("All robots"), tr("Selected robots")
WHICH = {
    Which.ALL: tr("All commands"),
    Which.OPEN: tr("Open"),
    Which.FAILED: tr("Failed, aborted, expired"),
}
FILE = file_topic("command_log")
MERGED = 500
"""New commands that are sorted in one by one; of more of them all are listed anew."""


class CommandLog(QWidget):
    """Newest command on top; the newest one lies open until the next comes."""

    place_wanted = pyqtSignal(float, float)
    """Where a command leads to, metres in the site frame."""

    def __init__(self, desk: Desk, parent: QWidget | None = None):
        super().__init__(parent)
        self._desk = desk
        self._model = LogModel(self)
        self._opened: str | None = None
        self._older = OlderCommands(desk, self)
        self._listed: set[str] = set()
        """The robots that can be chosen."""
        self.view = _tree(self._model)
        self._times = TimeColumn(self.view, beside=2 * self.view.indentation() + 12)
        self._robots = _choices("fleet_log_robot", tr("Whose commands are listed"))
        self._robots.addItems([EVERY_ROBOT, SELECTED])
        self._which = _choices("fleet_log_filter", tr("Which commands are listed"))
        self._which.addItems([WHICH[which] for which in Which])
        self._summary = ElidedText("fleet_log_summary", tr("None open"))
        self._lay_out()
        self._robots.currentIndexChanged.connect(self.refresh)
        self._which.currentIndexChanged.connect(self.refresh)
        GoingThere(self.view, self._go)
        self.view.selectionModel().selectionChanged.connect(self._allow)
        desk.commands_changed.connect(self.show_reports)
        desk.site_changed.connect(self._site_changed)
        desk.selection_changed.connect(self._selection_changed)
        self._allow()

    def show_reports(self, reports: list[CommandReport]) -> None:
        """Add what is new, and bring what is known up to date."""
        self._list_robots({report.robot for report in reports})
        if len(reports) > MERGED:
            self.refresh()
            return
        if self._model.merge(reports):
            self._model.keep(self._desk.book)
            self._let_go_of_old()
            self._open(self._model.index(0, 0))
        self._show_what_is_open()

    def refresh(self, *_what: object) -> None:
        """List anew what the filters keep."""
        self._model.show_all(self._desk.book, self.filter())
        self._opened = None
        self._open(self._model.index(0, 0))
        self._show_what_is_open()
        self._allow()

    def filter(self) -> Filter:
        """Return what the fields above the log say."""
        whose = self._robots.currentIndex()
        robots = None if whose == 0 else frozenset({self._robots.currentText()})
        if whose == 1:
            robots = frozenset(self._desk.selection)
        return Filter(robots, list(Which)[self._which.currentIndex()])

    def export(self, path: str) -> None:
        """Write what is listed, every step of it, to ``path`` and say so."""
        self._desk.messages.end(FILE)
        try:
            count = write_csv(path, CSV_HEAD, csv_rows(self._model.shown))
        except FleetError as error:
            self._desk.report_failure(str(error), FILE)
            return
        self._desk.noted.emit(
            tr(
                "{commands} and {steps} written to {path}",
                commands=tr_count(len(self._model.shown), "1 command", "%n commands"),
                steps=tr_count(count, "1 step", "%n steps"),
                path=path,
            )
        )

    def ask_for_older(self) -> None:
        """Ask the gateway for what was asked for before this desk came."""
        self._older.ask(self.filter().robots)

    def _lay_out(self) -> None:
        tip = tr("Show where the chosen command leads to (double click)")
        go = _tool("fleet_log_go", tr("Go there"), tip)
        go.clicked.connect(lambda: self._go(self.view.currentIndex()))
        older = _tool("fleet_log_older", tr("Older"), tr("Ask the gateway for older commands"))
        older.clicked.connect(self.ask_for_older)
        tip = tr("Write what is listed, every step of it, as CSV")
        export = _tool("fleet_log_export", tr("Export…"), tip)
        export.clicked.connect(self._ask_where)
        self._go_button = go
        head = QHBoxLayout()
        head.setSpacing(4)
        head.addWidget(self._robots, 1)
        head.addWidget(self._which, 1)
        beneath = QHBoxLayout()
        beneath.setSpacing(4)
        beneath.addWidget(self._summary, 1)
        for button in (go, older, export):
            beneath.addWidget(button)
        rows = QVBoxLayout(self)
        rows.setContentsMargins(0, 2, 0, 0)
        rows.setSpacing(3)
        rows.addLayout(head)
        rows.addLayout(beneath)
        rows.addWidget(self.view, 1)

    def _list_robots(self, robots: set[str]) -> None:
        if robots <= self._listed:
            return
        self._listed |= robots
        chosen = self._robots.currentText()
        self._robots.blockSignals(True)
        while self._robots.count() > 2:
            self._robots.removeItem(2)
        self._robots.addItems(sorted(self._listed, key=name_order))
        self._robots.setCurrentText(chosen)
        self._robots.blockSignals(False)

    def _show_what_is_open(self) -> None:
        self._summary.setText(summary(self._desk.book))
        shown = self._model.shown
        self._times.make_room((asked_at(shown[-1]) if shown else None) or None)

    def _let_go_of_old(self) -> None:
        """Keep the view short while nobody looks at older commands: it lays out each row at each new one."""
        current = self.view.currentIndex()
        chosen = current.parent() if current.parent().isValid() else current
        if self.view.verticalScrollBar().value() == 0 and chosen.row() < PAGE:
            self._model.shorten()

    def _open(self, index: QModelIndex) -> None:
        report = self._model.report_at(index)
        if report is None or report.command == self._opened:
            return
        before = None if self._opened is None else self._model.row_of(self._opened)
        if before is not None:
            self.view.collapse(self._model.index(before, 0))
        self._opened = report.command
        self.view.expand(index)

    def _go(self, index: QModelIndex) -> None:
        report = self._model.report_at(index)
        if report is None:
            return
        place = place_of(report)
        if place is None:
            self._desk.complained.emit(
                tr("{what} of {robot} leads to no place.", what=in_words(report), robot=report.robot)
            )
            return
        self.place_wanted.emit(*place)

    def _allow(self, *_what: object) -> None:
        report = self._model.report_at(self.view.currentIndex())
        self._go_button.setEnabled(report is not None and place_of(report) is not None)

    def _selection_changed(self) -> None:
        if self._robots.currentText() == SELECTED:
            self.refresh()

    def _site_changed(self) -> None:
        if len(self._desk.book) == 0:
            self._listed.clear()
            self._robots.blockSignals(True)
            while self._robots.count() > 2:
                self._robots.removeItem(2)
            self._robots.blockSignals(False)
            self.refresh()

    def _ask_where(self) -> None:
        path = file_to_write(self, tr("Export commands"), export_path("commands.csv"), tr("CSV (*.csv)"))
        if path:
            self.export(path)


def _tree(model: LogModel) -> QTreeView:
    view = QTreeView()
    view.setObjectName("fleet_command_log")
    view.setModel(model)
    view.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
    view.setAlternatingRowColors(True)
    view.setUniformRowHeights(True)
    view.setExpandsOnDoubleClick(False)
    view.setIndentation(14)
    shrink(view)
    for column, widest in ((2, longest(COMMAND_STATES)), (3, tr("{metres:.2f} m off", metres=0.0))):
        view.setColumnWidth(column, view.fontMetrics().horizontalAdvance(widest) + 12)
    view.header().setStretchLastSection(False)
    view.header().setSectionResizeMode(1, QHeaderView.ResizeMode.Stretch)
    return view


def _choices(name: str, tip: str) -> QComboBox:
    box = QComboBox()
    box.setObjectName(name)
    box.setToolTip(tip)
    box.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
    box.setMinimumContentsLength(8)
    return box


def _tool(name: str, text: str, tip: str) -> QToolButton:
    button = QToolButton()
    button.setObjectName(name)
    button.setText(text)
    button.setToolTip(tip)
    button.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
    return button

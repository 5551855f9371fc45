"""Command log: filter, tree, older commands fetched from the gateway."""

from __future__ import annotations

from dataclasses import dataclass

from qgis.PyQt.QtCore import QModelIndex, QObject, Qt, pyqtSignal
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

from ...robot_bridge.core.messages.commands import CommandReport, GetCommands
from ..control.fleet_controller import FleetController
from ..control.messages import file_topic
from ..control.request_tracker import SLOW_AFTER
from ..gateway_client import command_cache
from ..gateway_client.command_cache import command_in_words, place_of, requested_at
from ..gateway_client.fleet_state import RequestResult
from ..gateway_client.robot_states import name_order
from ..gateway_client.state_words import COMMAND_STATES, longest_word
from ..settings.profile import export_path
from ..ui.dialogs import file_to_write
from ..ui.errors import FleetError
from ..ui.language import tr, tr_count
from ..ui.steady_widgets import ElidedText
from ..ui.tables import TimeColumn, ZoomMenu, shrink_view, write_csv
from .command_log_model import CSV_HEAD, PAGE, CommandChoice, CommandFilter, LogModel, csv_rows, summary

OLDER = 1000
"""Commands requested at once."""
MOST_REQUESTS = 20
"""Robots that are queried one by one; for more of them the commands of all are."""


@dataclass
class HistoryRequest:
    """One press of the button: the commands ``known`` by then, and the results of its ``waiting`` queries."""

    known: frozenset[str]
    requested_at: float
    """On the monotonic clock, seconds."""
    waiting: int = 0
    came: int = 0
    """Number of commands that were new to the cache."""
    ends_here: bool = False
    """Whether there may be older ones that the log does not reach."""
    is_refused: bool = False
    is_overdue: bool = False
    """Whether it was reported that the gateway does not answer."""


class OlderCommands(QObject):
    """Requests the newest commands of robots, including those from before this desk connected."""

    def __init__(self, desk: FleetController, parent: QObject | None = None):
        super().__init__(parent)
        self._desk = desk
        self._requests: dict[str, HistoryRequest] = {}
        """By the keys of the queries that are not answered yet."""
        desk.orders.answered.connect(self._answered)
        desk.state.updated.connect(self._watch)
        desk.state.site_changed.connect(self._site_changed)

    def ask(self, robots: frozenset[str] | None) -> None:
        """Request the commands of ``robots``, None for all."""
        request = HistoryRequest(
            frozenset(report.command for report in self._desk.state.commands), self._desk.clock.steady()
        )
        try:
            # For very many robots the newest commands of all will do: the log holds no more.
            for robot in sorted(robots) if robots and len(robots) <= MOST_REQUESTS else [None]:
                self._requests[self._desk.orders.inquire(GetCommands(robot, OLDER), lasting=True)] = request
                request.waiting += 1
        except FleetError as error:
            request.is_refused = True
            self._desk.warning.emit(str(error))
            return
        # A repeated request is not reported twice, should the gateway answer after all.
        self._requests = {key: one for key, one in self._requests.items() if not one.is_overdue}

    def _answered(self, answer: RequestResult) -> None:
        request = self._requests.pop(answer.order.key, None)
        if request is None:
            return
        request.waiting -= 1
        if answer.error is not None:
            if not request.is_refused:
                self._desk.warning.emit(tr("Older commands: {why}", why=answer.error))
            request.is_refused = True
        else:
            self._count_new(_commands_in(answer), request)
        if request.waiting == 0 and not request.is_refused:
            self._desk.info.emit(_in_words(request))

    def _watch(self) -> None:
        """Report a request that waits too long for its answers, even if the link is lost."""
        now = self._desk.clock.steady()
        late = {
            id(request): request
            for request in self._requests.values()
            if not request.is_overdue and now - request.requested_at > SLOW_AFTER
        }
        for request in late.values():
            request.is_overdue = True
            self._desk.warning.emit(
                tr(
                    "Older commands: the gateway has not answered for {seconds:g} s. Press Older to ask once "
                    "more.",
                    seconds=SLOW_AFTER,
                )
            )

    def _site_changed(self) -> None:
        if len(self._desk.state.commands) == 0:
            # The link leads to other robots now: requests to the gateway before are dropped.
            self._requests.clear()

    def _count_new(self, notices: list[str], request: HistoryRequest) -> None:
        # The cache has stored them by now, and dropped the oldest where it was full.
        kept = [command for command in notices if command in self._desk.state.commands]
        request.came += sum(command not in request.known for command in kept)
        request.ends_here = request.ends_here or len(notices) >= OLDER or len(kept) < len(notices)


def _commands_in(answer: RequestResult) -> list[str]:
    """Return the ids in an answer; its commands were decoded before."""
    return [values["command"] for values in (answer.result or {}).get("commands", ())]


def _in_words(request: HistoryRequest) -> str:
    came = (
        tr_count(request.came, "1 older command came.", "%n older commands came.")
        if request.came
        else tr("No older commands came.")
    )
    if request.ends_here:
        end = tr(
            "The log reaches no further back: the newest {asked} of each chosen robot, or of all, are asked "
            "for, and {kept} kept. Older ones are in the gateway's database.",
            asked=OLDER,
            kept=command_cache.MOST_COMMANDS,
        )
    else:
        end = tr("The gateway knows no others.")
    return f"{came} {end}"


EVERY_ROBOT, SELECTED = tr("All robots"), tr("Selected robots")
COMMAND_CHOICES = {
    CommandChoice.ALL: tr("All commands"),
    CommandChoice.OPEN: tr("Open"),
    CommandChoice.FAILED: tr("Failed, aborted, expired"),
}
FILE = file_topic("command_log")


class CommandLog(QWidget):
    """The log, newest command on top; the newest one is expanded until the next comes."""

    place_requested = pyqtSignal(float, float)
    """The goal of a command, metres in the site frame."""

    def __init__(self, desk: FleetController, parent: QWidget | None = None):
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
        self._which.addItems([COMMAND_CHOICES[which] for which in CommandChoice])
        self._summary = ElidedText("fleet_log_summary", tr("None open"))
        self._lay_out()
        self._robots.currentIndexChanged.connect(self.refresh)
        self._which.currentIndexChanged.connect(self.refresh)
        ZoomMenu(self.view).requested.connect(self._go)
        self.view.selectionModel().selectionChanged.connect(self._allow)
        self._model.follow(desk.state)
        self._model.added.connect(self._show_newest)
        self._model.modelReset.connect(self._list_reset)
        desk.state.commands_changed.connect(self._commands_changed)
        desk.state.site_changed.connect(self._site_changed)
        desk.selection.changed.connect(self._selection_changed)
        self._allow()

    def refresh(self, *_what: object) -> None:
        """List the commands again by the filters."""
        self._model.show_all(self._desk.state.commands, self.filter())

    def filter(self) -> CommandFilter:
        """Return the filter set in the fields above the log."""
        whose = self._robots.currentIndex()
        robots = None if whose == 0 else frozenset({self._robots.currentText()})
        if whose == 1:
            robots = frozenset(self._desk.selection.robots)
        return CommandFilter(robots, list(CommandChoice)[self._which.currentIndex()])

    def export(self, path: str) -> None:
        """Write the listed commands with every step to ``path`` and report it."""
        self._desk.messages.end(FILE)
        try:
            count = write_csv(path, CSV_HEAD, csv_rows(self._model.shown))
        except FleetError as error:
            self._desk.report_failure(str(error), FILE)
            return
        self._desk.info.emit(
            tr(
                "{commands} and {steps} written to {path}",
                commands=tr_count(len(self._model.shown), "1 command", "%n commands"),
                steps=tr_count(count, "1 step", "%n steps"),
                path=path,
            )
        )

    def ask_for_older(self) -> None:
        """Request commands from before this desk connected."""
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

    def _commands_changed(self, reports: list[CommandReport]) -> None:
        self._list_robots({report.robot for report in reports})
        self._show_what_is_open()

    def _show_newest(self) -> None:
        self._drop_old()
        self._open(self._model.index(0, 0))

    def _list_reset(self) -> None:
        self._opened = None
        self._open(self._model.index(0, 0))
        self._show_what_is_open()
        self._allow()

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
        self._summary.setText(summary(self._desk.state.commands))
        shown = self._model.shown
        self._times.make_room((requested_at(shown[-1]) if shown else None) or None)

    def _drop_old(self) -> None:
        """Shorten the view while no older commands are viewed: it lays out each row at each new one."""
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
            self._desk.warning.emit(
                tr("{what} of {robot} leads to no place.", what=command_in_words(report), robot=report.robot)
            )
            return
        self.place_requested.emit(*place)

    def _allow(self, *_what: object) -> None:
        report = self._model.report_at(self.view.currentIndex())
        self._go_button.setEnabled(report is not None and place_of(report) is not None)

    def _selection_changed(self) -> None:
        if self._robots.currentText() == SELECTED:
            self.refresh()

    def _site_changed(self) -> None:
        if len(self._desk.state.commands) == 0:
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


COMMAND_DIGITS = 18
"""Digits that are as wide as a cone target with its robot and place."""


def _tree(model: LogModel) -> QTreeView:
    view = QTreeView()
    view.setObjectName("fleet_command_log")
    view.setAccessibleName(tr("Commands"))
    view.setModel(model)
    view.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
    view.setAlternatingRowColors(True)
    view.setUniformRowHeights(True)
    view.setExpandsOnDoubleClick(False)
    view.setIndentation(14)
    shrink_view(view)
    for column, widest in ((1, "0" * COMMAND_DIGITS), (2, longest_word(COMMAND_STATES.values()))):
        view.setColumnWidth(column, view.fontMetrics().horizontalAdvance(widest) + 12)
    view.header().setStretchLastSection(False)
    # Why a command failed is longer than all else in its row.
    view.header().setSectionResizeMode(3, QHeaderView.ResizeMode.Stretch)
    return view


def _choices(name: str, tip: str) -> QComboBox:
    box = QComboBox()
    box.setObjectName(name)
    box.setAccessibleName(tip)
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

"""Base dialog of a table that only supervisors may see and change, its menu entry and queries."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from qgis.gui import QgisInterface
from qgis.PyQt.QtCore import QObject, Qt, pyqtSignal
from qgis.PyQt.QtGui import QIcon, QShowEvent
from qgis.PyQt.QtWidgets import (
    QAbstractItemView,
    QAction,
    QDialog,
    QDialogButtonBox,
    QHBoxLayout,
    QPushButton,
    QTableView,
    QVBoxLayout,
    QWidget,
)

from ...robot_bridge.core.messages.base import Role
from ..control.fleet_controller import FleetController
from ..control.request_tracker import RequestTracker
from ..gateway_client.connection_status import ConnectionPhase, ConnectionStatus, role_in_words
from ..gateway_client.fleet_state import RequestResult
from ..help import HelpTopic, show_help
from ..panel.connection_panel import ConnectionMenu
from ..ui.actions import ICONS
from ..ui.dialogs import WrappingLabel, push_button
from ..ui.errors import FleetError
from ..ui.language import tr
from ..ui.tables import RowModel, fit_headers

Take = Callable[[dict[str, Any]], None]


class PendingQueries(QObject):
    """Hands each answer to its sender, however late it comes; never waits for one.

    An answer may be the only copy of a token, so it is accepted even after the link was lost.
    """

    refused = pyqtSignal(str)
    """A request was not carried out, or its answer is invalid: the reason, for the operator."""

    def __init__(self, requests: RequestTracker, parent: QObject | None = None):
        super().__init__(parent)
        self._requests = requests
        self._takers: dict[str, tuple[str, Take]] = {}
        requests.answered.connect(self._answered)

    def ask(self, request: Any, words: str, take: Take) -> None:
        """Send ``request``, described to the operator by ``words``; ``take`` receives the result."""
        try:
            self._takers[self._requests.inquire(request)] = words, take
        except FleetError as error:
            self.refused.emit(f"{words}: {error}")

    def _answered(self, answer: RequestResult) -> None:
        words, take = self._takers.pop(answer.order.key, ("", None))
        if take is None:
            return
        if answer.error is not None:
            self.refused.emit(f"{words}: {answer.error}")
        else:
            self._hand_over(words, take, answer.result or {})

    def _hand_over(self, words: str, take: Take, result: dict[str, Any]) -> None:
        try:
            take(result)
        except (KeyError, TypeError, ValueError) as error:
            # The result itself is not shown: a token may be in it.
            kind = type(error).__name__
            self.refused.emit(
                tr(
                    "{words}: the gateway's answer cannot be read ({kind}). Update the gateway or the "
                    "plugin, whichever is older.",
                    words=words,
                    kind=kind,
                )
            )


class DialogAction:
    """An entry of ``menu`` and of ``connections``, and the window. :meth:`remove` undoes the constructor.

    The window is made by ``make_dialog`` when it is first opened: QGIS starts without it.
    """

    def __init__(
        self,
        iface: QgisInterface,
        menu: str,
        connections: ConnectionMenu,
        make_dialog: Callable[[], QDialog],
        *,
        icon: str,
        text: str,
        name: str,
        tip: str,
    ):
        self._iface, self._menu, self._connections = iface, menu, connections
        self._make_dialog, self.dialog = make_dialog, None
        self.action = QAction(QIcon(str(ICONS / icon)), text, iface.mainWindow())
        self.action.setObjectName(name)
        self.action.setToolTip(tip)
        self.action.triggered.connect(self.open)
        iface.addPluginToMenu(menu, self.action)
        connections.offer(self.action)

    def open(self) -> None:
        """Open the window, or bring it to the front."""
        if self.dialog is None:
            self.dialog = self._make_dialog()
        self.dialog.show()
        self.dialog.raise_()
        self.dialog.activateWindow()

    def remove(self) -> None:
        """Close the window with all that it opened, and remove the entries."""
        if self.dialog is not None:
            self.dialog.close()
            self.dialog.deleteLater()
        self._connections.withdraw(self.action)
        self._iface.removePluginMenu(self._menu, self.action)
        self.action.deleteLater()


ASKING = tr("Asking the gateway …")
SIZE = (940, 420)
BESIDE = 16
"""Pixels in a cell beside its text."""


class SupervisorDialog(QDialog):
    """Requests its rows when it is shown and when a link comes up; shows why where that is impossible.

    It stays beside the map, where robots can be stopped meanwhile, and so do the questions that it opens.
    Derived classes implement ``_ask_rows``, and call :meth:`_lay_out` once their buttons are made.
    """

    def __init__(
        self, desk: FleetController, model: RowModel, name: str, title: str, topic: HelpTopic, parent: QWidget
    ):
        super().__init__(parent)
        self.setObjectName(name)
        self.setWindowTitle(title)
        self._desk, self.model, self._topic = desk, model, topic
        self._listing, self._changing = PendingQueries(desk.orders, self), PendingQueries(desk.orders, self)
        self.view = _table(model, f"{name}_table")
        self.status = WrappingLabel(lines=2)
        self.status.setObjectName(f"{name}_said")
        self.status.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        self._buttons: list[tuple[QPushButton, bool]] = []
        self._question: QDialog | None = None
        self.view.selectionModel().selectionChanged.connect(self._renew)
        self._listing.refused.connect(self._not_listed)
        self._changing.refused.connect(self._not_changed)
        desk.state.link_changed.connect(self._link_changed)
        self.finished.connect(self._close_question)

    def selected(self) -> Any:
        """Return the selected row, None without one."""
        rows = self.view.selectionModel().selectedRows()
        return self.model.rows[rows[0].row()] if rows else None

    def refresh(self) -> None:
        """Request the rows again, or show why that is impossible."""
        why = why_not(self._desk.state.link)
        if why:
            self._show_rows([])
            self.status.setText(why)
        else:
            self.status.setText(ASKING)
            self._ask_rows()
        self._renew()

    def showEvent(self, event: QShowEvent) -> None:
        super().showEvent(event)
        self.refresh()

    def _ask_rows(self) -> None:
        """Request the rows by :attr:`_listing`."""
        raise NotImplementedError

    def _key(self, row: Any) -> str:
        """Return the key by which a row is recognised in the next answer."""
        raise NotImplementedError

    def _can_change(self, row: Any) -> bool:
        """Return whether the buttons that change a row are enabled for this one."""
        return True

    def _show_rows(self, rows: list[Any]) -> None:
        """Show these rows, and keep the selection where its row is still there."""
        before = self.selected()
        self.model.show_rows(rows, self._key)
        for number, row in enumerate(rows):
            if before is not None and self._key(row) == self._key(before):
                self.view.selectRow(number)
        # A table that is filled again does not signal that nothing is selected any more.
        self._renew()

    def _show_once_known(self, text: str) -> None:
        """Show this now that the rows are there, unless the outcome of a change is shown."""
        if self.status.text() == ASKING:
            self.status.setText(text)

    def _button(self, name: str, text: str, press: Callable[[], None], *, for_row: bool) -> None:
        button = push_button(name, text, pressed=press)
        button.setAutoDefault(False)
        self._buttons.append((button, for_row))

    def _lay_out(self) -> None:
        line = QHBoxLayout()
        for button, _ in self._buttons:
            line.addWidget(button)
        line.addStretch()
        standard = QDialogButtonBox.StandardButton
        foot = QDialogButtonBox(standard.Close | standard.Help)
        foot.rejected.connect(self.reject)
        foot.helpRequested.connect(lambda: show_help(self._topic, self))
        rows = QVBoxLayout(self)
        rows.addWidget(self.view, 1)
        rows.addLayout(line)
        rows.addWidget(self.status)
        rows.addWidget(foot)
        # Only within the dialog: otherwise Enter would do nothing once another button had the focus.
        foot.button(standard.Close).setDefault(True)
        self.resize(*SIZE)
        self._renew()

    def _open(self, question: QDialog) -> None:
        """Open a question in place of the previous one."""
        self._close_question()
        self._question = question
        question.finished.connect(self._forget_question)
        # Message boxes are modal by default, and would block the map.
        question.setModal(False)
        question.show()

    def _forget_question(self) -> None:
        self._question = None

    def _close_question(self) -> None:
        if self._question is not None:
            self._question.reject()

    def _ask(self, request: Any, words: str, take: Take) -> None:
        """Request a change, described to the operator by ``words``; ``take`` receives the result."""
        self.status.setText(ASKING)
        self._changing.ask(request, words, take)

    def _changed(self, done: str) -> None:
        """Show the change made, and request the rows again unless it ended the link."""
        self.status.setText(done)
        if self.isVisible() and not why_not(self._desk.state.link):
            self._ask_rows()

    def _not_changed(self, why: str) -> None:
        self.status.setText(f"✘ {why}")
        if not self.isVisible():
            self._desk.failed.emit(why)

    def _not_listed(self, why: str) -> None:
        # Without a link that is shown already, and the rows are requested when it is back.
        if not why_not(self._desk.state.link):
            self.status.setText(f"✘ {why}")

    def _link_changed(self) -> None:
        # A question about one gateway's account must not be answered for another's.
        self._close_question()
        if self.isVisible():
            self.refresh()
        else:
            self._show_rows([])

    def _renew(self) -> None:
        can_ask = not why_not(self._desk.state.link)
        row = self.selected()
        can_change = can_ask and row is not None and self._can_change(row)
        for button, for_row in self._buttons:
            button.setEnabled(can_change if for_row else can_ask)


def why_not(link: ConnectionStatus) -> str:
    """Return why a desk with this link cannot make a supervisor's requests; empty where it can."""
    if link.phase is not ConnectionPhase.CONNECTED:
        return tr("The desk is not connected to a gateway. Press Connect first.")
    if not link.role:
        return tr("This gateway says nothing of roles: it is older than accounts. Update it.")
    if link.role != Role.SUPERVISOR.value:
        return tr(
            "This takes a supervisor, and {operator} is {role} here. If that was changed meanwhile, "
            "disconnect and connect again.",
            operator=link.operator,
            role=role_in_words(link.role),
        )
    return ""


def fit_columns(view: QTableView, widest: tuple[str, ...]) -> None:
    """Fit columns to their widest texts and their heads; the last one takes the rest."""
    for column, text in enumerate(widest):
        view.setColumnWidth(column, view.fontMetrics().horizontalAdvance(text) + BESIDE)
    fit_headers(view)
    view.horizontalHeader().setStretchLastSection(True)


def _table(model: RowModel, name: str) -> QTableView:
    view = QTableView()
    view.setObjectName(name)
    view.setModel(model)
    view.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
    view.setSelectionMode(QAbstractItemView.SelectionMode.SingleSelection)
    view.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
    view.setTabKeyNavigation(False)
    view.setAlternatingRowColors(True)
    view.setShowGrid(False)
    view.setWordWrap(False)
    # Bold heads over a selected row would be wider than their columns.
    view.horizontalHeader().setHighlightSections(False)
    view.verticalHeader().hide()
    return view

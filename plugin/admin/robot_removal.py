"""Robots that are gone, removed from every desk: which ones, the question before, and what became of it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from qgis.gui import QgisInterface
from qgis.PyQt.QtCore import Qt, pyqtSignal
from qgis.PyQt.QtGui import QIcon, QKeySequence
from qgis.PyQt.QtWidgets import QAction, QWidget

from ...robot_bridge.core.messages.administration import RemoveRobots
from ...robot_bridge.core.messages.safety import RobotState
from ..control.fleet_controller import FleetController
from ..gateway_client.robot_states import part_in_words
from ..panel.connection_panel import ConnectionMenu
from ..panel.robot_table import RobotTableView
from ..ui.actions import ICONS
from ..ui.dialogs import QuestionDialog
from ..ui.language import first_of, tr, tr_count
from .supervisor_dialog import PendingQueries, why_not

GONE = (RobotState.LOST, RobotState.OFFLINE)
LONGEST_REASON = 200
MOST_NAMES = 8
NAME_LINES = 3
"""Lines of the dialog that names get, so that the choice of others moves no button."""


class RemovalDialog(QuestionDialog):
    """Asks which robots are removed, ``selected`` ones or ``all_gone``, and why; Enter removes none."""

    confirmed = pyqtSignal(list, str)
    """The names of the robots, and the reason."""

    def __init__(self, selected: Sequence[str], all_gone: Sequence[str], parent: QWidget):
        super().__init__(
            "fleet_removal",
            tr("Remove robots that are gone?"),
            ("fleet_removal_confirm", tr("Remove")),
            is_safe=True,
            parent=parent,
        )
        chosen = tr_count(len(selected), "the selected one", "the %n selected ones")
        everyone = tr_count(
            len(all_gone), "the only one that is lost or offline", "all %n that are lost or offline"
        )
        choices = [(chosen, list(selected))] if selected else []
        self._which = self.add_choice(
            tr("&Robots"), [*choices, (everyone, list(all_gone))], "fleet_removal_which"
        )
        self._names = self.add_text(" ", lines=NAME_LINES)
        self._names.setObjectName("fleet_removal_names")
        self._which.currentIndexChanged.connect(self._name_them)
        self._name_them()
        self.add_text(
            tr(
                "They go from every desk. What is in their queues is removed, what they were told and have "
                "not done has failed; what they did stays stored."
            )
        )
        self.add_text(
            tr(
                "None is stopped by that. One that comes back is told to abort what it still does, and is a "
                "new robot."
            )
        )
        self._why = self.add_reason(tr("Why, for the log"), LONGEST_REASON, "fleet_removal_reason")
        self.lay_out()
        self.accepted.connect(
            lambda: self.confirmed.emit(self._which.currentData(), self._why.text().strip())
        )

    def _name_them(self, *_: object) -> None:
        self._names.setText(_in_words(self._which.currentData()))


class RobotRemoval:
    """An entry of ``menu``, of ``connections`` and of the robots' table. :meth:`remove` undoes the
    constructor.
    """

    def __init__(
        self,
        iface: QgisInterface,
        menu: str,
        connections: ConnectionMenu,
        desk: FleetController,
        table: RobotTableView,
    ):
        self._iface, self._menu, self._connections = iface, menu, connections
        self._desk, self._table = desk, table
        self._asking = PendingQueries(desk.orders, table)
        self._asking.refused.connect(desk.failed)
        self._question: RemovalDialog | None = None
        self.action = QAction(
            QIcon(str(ICONS / "remove_robots.svg")), tr("Remove robots…"), iface.mainWindow()
        )
        self.action.setObjectName("fleet_remove_robots")
        self.action.setToolTip(tr("Take robots that are lost or offline off every desk; takes a supervisor"))
        self.action.triggered.connect(self.ask)
        self._here = QAction(self.action.icon(), self.action.text(), table)
        self._here.setObjectName("fleet_remove_robots_here")
        self._here.setShortcut(QKeySequence(QKeySequence.StandardKey.Delete))
        self._here.setShortcutContext(Qt.ShortcutContext.WidgetShortcut)
        self._here.triggered.connect(self.ask)
        table.addAction(self._here)
        table.setContextMenuPolicy(Qt.ContextMenuPolicy.ActionsContextMenu)
        iface.addPluginToMenu(menu, self.action)
        connections.offer(self.action)

    def ask(self) -> None:
        """Ask which robots are removed, or say why none can be."""
        gone = self._gone()
        why = why_not(self._desk.state.link) or ("" if gone else tr("No robot is lost or offline."))
        if why:
            self._desk.complained.emit(tr("No robot was removed: {why}", why=why))
            return
        if told := part_in_words(self._desk.state.robots):
            self._desk.complained.emit(f"{told} {tr('Others cannot be chosen here.')}")
        chosen = set(self._desk.selection.robots)
        dialog = RemovalDialog([name for name in gone if name in chosen], gone, self._iface.mainWindow())
        dialog.confirmed.connect(self._remove)
        dialog.open()

    def remove(self) -> None:
        """Take the entries out."""
        self._table.setContextMenuPolicy(Qt.ContextMenuPolicy.DefaultContextMenu)
        self._table.removeAction(self._here)
        self._connections.withdraw(self.action)
        self._iface.removePluginMenu(self._menu, self.action)
        self.action.deleteLater()

    def _gone(self) -> list[str]:
        views = self._desk.state.robots.views(self._desk.clock.steady())
        return [view.name for view in views if view.state in GONE]

    def _remove(self, robots: list[str], reason: str) -> None:
        words = tr("Remove {names}", names=_in_words(robots))
        self._asking.ask(RemoveRobots(robots, reason or None), words, self._removed)

    def _removed(self, result: dict[str, Any]) -> None:
        removed, kept = result["removed"], result["kept"]
        text = tr_count(
            len(removed),
            "1 robot was removed: {names}",
            "%n robots were removed: {names}",
            names=_in_words(removed),
        )
        self._desk.noted.emit(text)
        if kept:
            why = "; ".join(first_of([one["reason"] for one in kept]))
            self._desk.complained.emit(
                tr_count(
                    len(kept), "1 robot was not removed: {why}", "%n robots were not removed: {why}", why=why
                )
            )


def _in_words(names: Sequence[str]) -> str:
    return ", ".join(first_of(names, MOST_NAMES))

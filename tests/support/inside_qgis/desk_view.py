"""An operator's eyes: reads what the plugin's panel shows, and does nothing."""

from __future__ import annotations

from dataclasses import dataclass

from qgis.gui import QgisInterface
from qgis.PyQt.QtCore import QObject, Qt
from qgis.PyQt.QtWidgets import QDockWidget, QLabel, QTableView, QTreeView

from tests.support.inside_qgis.found_again import FoundAgain


class NotHappenedError(Exception):
    """What was waited for did not happen; the text says what, and what was there instead."""


@dataclass(frozen=True)
class LoggedCommand:
    """One row of the command log, as it reads."""

    what: str
    state: str
    details: str


class DeskView:
    """What stands in the plugin's dock."""

    def __init__(self, iface: QgisInterface):
        self._window = iface.mainWindow()
        self._found = FoundAgain()

    def describe(self) -> str:
        """Return what the dock says now, for an error's text."""
        if self._window.findChild(QDockWidget, "fleet_dock") is None:
            return "the window has no fleet dock"
        return (
            f"link: {self.link_state()!r}; draft: {self.draft_text()!r}; robots: {self.robots()}; "
            f"commands: {self.commands()}; notices: {self.notices()}"
        )

    def link_state(self) -> str:
        """Return the dock's line on the connection."""
        return self._find(QLabel, "fleet_link_state").text()

    def draft_text(self) -> str:
        """Return what the dock says of the draft, or of what happened last."""
        return self._find(QLabel, "fleet_draft_text").text()

    def robots(self) -> dict[str, dict[str, str]]:
        """Return the robot table: a row of column title and text for each robot."""
        model = self._find(QTableView, "fleet_robot_table").model()
        horizontal = Qt.Orientation.Horizontal
        titles = [model.headerData(column, horizontal) for column in range(model.columnCount())]
        rows = (
            {title: str(model.index(row, column).data()) for column, title in enumerate(titles)}
            for row in range(model.rowCount())
        )
        return {row["Robot"]: row for row in rows}

    def selected_robots(self) -> list[str]:
        """Return the robots whose rows are selected in the table."""
        rows = self._find(QTableView, "fleet_robot_table").selectionModel().selectedRows()
        return [index.data() for index in rows]

    def speed(self, robot: str) -> float:
        """Return the speed that the table shows for ``robot``, m/s; 0 where it shows none."""
        text = self.robots().get(robot, {}).get("Speed", "").removesuffix(" m/s")
        return float(text) if text else 0.0

    def commands(self) -> list[LoggedCommand]:
        """Return the command log's commands, newest first."""
        model = self._find(QTreeView, "fleet_command_log").model()
        return [
            LoggedCommand(*(model.index(row, column).data() or "" for column in (1, 2, 3)))
            for row in range(model.rowCount())
        ]

    def notices(self) -> list[str]:
        """Return what hangs in the message bar."""
        return [label.text() for label in self._window.findChildren(QLabel, "fleet_notice")]

    def state_of(self, robot: str) -> str:
        """Return the state that the log shows for the newest command of ``robot``, empty when it has none."""
        return next((entry.state for entry in self.commands() if entry.what.startswith(f"{robot} ")), "")

    def _find(self, kind: type, name: str):
        found = self._found.get(
            (kind, name),
            search=lambda: self._window.findChild(kind, name),
            holds=lambda one: _is_inside(one, self._window),
        )
        if found is None:
            raise NotHappenedError(f"the window has no {kind.__name__} named {name}; is the plugin loaded?")
        return found


def _is_inside(one: QObject, window: QObject) -> bool:
    parent = one.parent()
    return parent is not None and (parent is window or _is_inside(parent, window))

"""An operator's eyes: reads what the plugin's panel shows, and does nothing."""

from __future__ import annotations

import weakref
from collections.abc import Callable, Hashable, Iterable
from dataclasses import dataclass

from qgis.gui import QgisInterface
from qgis.PyQt.QtCore import QObject, Qt
from qgis.PyQt.QtWidgets import QDockWidget, QLabel, QTableView, QTreeView
from qgis.PyQt.sip import isdeleted


class NotHappenedError(Exception):
    """What was waited for did not happen; the text says what, and what was there instead."""


@dataclass(frozen=True)
class LoggedCommand:
    """One row of the command log, as it reads."""

    what: str
    state: str
    details: str


class FoundAgain:
    """Remembers what each search found: to search all of QGIS's window takes its only thread 20 ms.

    Nothing stays because of it. What was made in C++ is searched for each time: nothing holds what Python
    knows it by.
    """

    def __init__(self) -> None:
        self._found: dict[Hashable, weakref.ref[QObject]] = {}

    def get(
        self, sought: Hashable, search: Callable[[], QObject | None], holds: Callable[[QObject], bool]
    ) -> QObject | None:
        """Return what was found for ``sought`` if it still ``holds``, and else what ``search`` finds now."""
        found = self._found[sought]() if sought in self._found else None
        if found is None or isdeleted(found) or not holds(found):
            found = search()
            if found is not None:
                self._found[sought] = weakref.ref(found)
        return found


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
        return self.find(QLabel, "fleet_link_state").text()

    def draft_text(self) -> str:
        """Return what the dock says of the draft, or of what happened last."""
        return self.find(QLabel, "fleet_draft_text").text()

    def robots(self) -> dict[str, dict[str, str]]:
        """Return the robot table: a row of column title and text for each robot."""
        model = self.find(QTableView, "fleet_robot_table").model()
        horizontal = Qt.Orientation.Horizontal
        titles = [model.headerData(column, horizontal) for column in range(model.columnCount())]
        rows = (
            {title: str(model.index(row, column).data()) for column, title in enumerate(titles)}
            for row in range(model.rowCount())
        )
        return {row["Robot"]: row for row in rows}

    def are_fresh(self, robots: Iterable[str]) -> bool:
        """Tell whether the table shows these robots, all of them fresh, and no others."""
        states = {name: row["State"] for name, row in self.robots().items()}
        return states == dict.fromkeys(robots, "fresh")

    def selected_robots(self) -> list[str]:
        """Return the robots whose rows are selected in the table."""
        rows = self.find(QTableView, "fleet_robot_table").selectionModel().selectedRows()
        return [index.data() for index in rows]

    def speed(self, robot: str) -> float:
        """Return the speed that the table shows for ``robot``, m/s; 0 where it shows none."""
        text = self.robots().get(robot, {}).get("Speed", "").removesuffix(" m/s")
        return float(text) if text else 0.0

    def commands(self) -> list[LoggedCommand]:
        """Return the command log's commands, newest first."""
        model = self.find(QTreeView, "fleet_command_log").model()
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

    def find(self, kind: type, name: str):
        """Return a part of the window by its kind and its object name.

        :raises NotHappenedError: when there is none.
        """
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

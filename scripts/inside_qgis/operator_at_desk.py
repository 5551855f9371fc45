"""An operator's hands and eyes: clicks what the window shows, reads what stands there, nothing else."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsCoordinateTransform,
    QgsPointXY,
    QgsProject,
    QgsRectangle,
)
from qgis.gui import QgisInterface
from qgis.PyQt.QtCore import QPoint, Qt
from qgis.PyQt.QtTest import QTest
from qgis.PyQt.QtWidgets import (
    QAbstractButton,
    QDockWidget,
    QLabel,
    QLineEdit,
    QTableView,
    QTreeView,
    QWidget,
)

POLL_MS = 50
SMALLEST = 0
"""Qt's word for the slowest and smallest PNG."""


class NotHappenedError(Exception):
    """What was waited for did not happen; the text says what, and what was there instead."""


@dataclass(frozen=True)
class LoggedCommand:
    """One row of the command log, as it reads."""

    what: str
    state: str
    details: str


class OperatorAtDesk:
    """Works the plugin's dock and the map canvas by mouse and keyboard."""

    def __init__(self, iface: QgisInterface):
        self._window = iface.mainWindow()
        self.canvas = iface.mapCanvas()

    # --- waiting and looking ---

    def wait(self, what: str, condition: Callable[[], object], seconds: float) -> float:
        """Let the window work until ``condition`` holds; return how many seconds that took.

        :raises NotHappenedError: when it does not hold within ``seconds``.
        """
        began = time.monotonic()
        while not condition():
            if time.monotonic() - began > seconds:
                raise NotHappenedError(f"{what} did not happen within {seconds:.0f} s; {self.describe()}")
            QTest.qWait(POLL_MS)
        return time.monotonic() - began

    def pause(self, seconds: float) -> None:
        """Let the window work for a while."""
        QTest.qWait(int(seconds * 1000))

    def describe(self) -> str:
        """Return what the dock says now, for an error's text."""
        dock = self._window.findChild(QDockWidget, "fleet_dock")
        if dock is None:
            return "the window has no fleet dock"
        link = self._find(QLabel, "fleet_link_state").text()
        draft = self._find(QLabel, "fleet_draft_text").text()
        return f"link: {link!r}; draft: {draft!r}; robots: {self.robots()}; commands: {self.commands()}"

    def link_state(self) -> str:
        """Return the dock's line on the connection."""
        return self._find(QLabel, "fleet_link_state").text()

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

    def state_of(self, robot: str) -> str:
        """Return the state that the log shows for the newest command of ``robot``, empty when it has none."""
        return next((entry.state for entry in self.commands() if entry.what.startswith(f"{robot} ")), "")

    # --- doing ---

    def connect(self, url: str, operator: str) -> None:
        """Type the gateway's address and the operator's name and press Connect."""
        for name, text in (("fleet_url", url), ("fleet_operator", operator)):
            field = self._find(QLineEdit, name)
            field.selectAll()
            QTest.keyClicks(field, text)
        self.press("fleet_connect")

    def select(self, robot: str) -> None:
        """Click the robot's row in the table."""
        table = self._find(QTableView, "fleet_robot_table")
        model = table.model()
        index = next(i for i in (model.index(r, 0) for r in range(model.rowCount())) if i.data() == robot)
        table.scrollTo(index)
        self._click(table.viewport(), table.visualRect(index).center())

    def close_panel(self, name: str) -> None:
        """Close one of QGIS's own panels."""
        self._find(QDockWidget, name).close()

    def press(self, action: str) -> None:
        """Click the dock's button of ``action``."""
        button = self._find(QAbstractButton, f"{action}_button")
        self.wait(f"button {action} becoming usable", button.isEnabled, 5)
        self._click(button, button.rect().center())

    def choose(self, tool: str) -> None:
        """Click the dock's button of a map tool, unless the tool is in hand already."""
        if not self._find(QAbstractButton, f"{tool}_button").isChecked():
            self.press(tool)

    def click_map(self, x: float, y: float, crs: str) -> None:
        """Click the map where (x, y) in ``crs`` is."""
        place = self._on_canvas(QgsPointXY(x, y), crs)
        if not self.canvas.viewport().rect().contains(place):
            raise NotHappenedError(f"({x}, {y}) is outside the map that is shown, so it cannot be clicked")
        QTest.mouseMove(self.canvas.viewport(), place)
        self._click(self.canvas.viewport(), place)

    def show_map(self, extent: tuple[float, float, float, float], crs: str) -> None:
        """Zoom to ``extent`` (x_min, y_min, x_max, y_max in ``crs``) and wait until it is drawn."""
        there = self._to_canvas_crs(crs).transformBoundingBox(QgsRectangle(*extent))
        self.canvas.setExtent(there)
        self.canvas.refresh()
        self.wait_for_map()

    def wait_for_map(self) -> None:
        """Wait until the map is drawn."""
        self.pause(0.3)
        self.wait("drawing the map", lambda: not self.canvas.isDrawing(), 30)

    def take_picture(self, widget: QWidget, path: Path) -> None:
        """Save ``widget`` as the operator sees it.

        :raises NotHappenedError: when the file cannot be written.
        """
        path.parent.mkdir(parents=True, exist_ok=True)
        if not widget.grab().save(str(path), "PNG", SMALLEST):
            raise NotHappenedError(f"the picture could not be saved as {path}")

    def _find(self, kind: type, name: str):
        found = self._window.findChild(kind, name)
        if found is None:
            raise NotHappenedError(f"the window has no {kind.__name__} named {name}; is the plugin loaded?")
        return found

    def _click(self, widget: QWidget, place: QPoint) -> None:
        QTest.mouseClick(widget, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier, place)

    def _to_canvas_crs(self, crs: str) -> QgsCoordinateTransform:
        target = self.canvas.mapSettings().destinationCrs()
        return QgsCoordinateTransform(QgsCoordinateReferenceSystem(crs), target, QgsProject.instance())

    def _on_canvas(self, point: QgsPointXY, crs: str) -> QPoint:
        at = self.canvas.mapSettings().mapToPixel().transform(self._to_canvas_crs(crs).transform(point))
        return QPoint(round(at.x()), round(at.y()))

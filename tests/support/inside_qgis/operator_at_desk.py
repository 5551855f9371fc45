"""An operator's hands: clicks what the window shows, nothing else."""

from __future__ import annotations

import time
from collections.abc import Callable
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
from qgis.PyQt.QtWidgets import QAbstractButton, QDockWidget, QLineEdit, QTableView, QWidget

from tests.support.inside_qgis.desk_view import DeskView, NotHappenedError
from tests.support.inside_qgis.mouse import move_mouse

POLL_MS = 50
SMALLEST = 0
"""Qt's word for the slowest and smallest PNG."""


class OperatorAtDesk(DeskView):
    """Works the plugin's dock and the map canvas by events that Qt is handed, and reads what they show."""

    def __init__(self, iface: QgisInterface):
        super().__init__(iface)
        self.canvas = iface.mapCanvas()

    # --- waiting ---

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
        move_mouse(self.canvas.viewport(), place)
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

    def _click(self, widget: QWidget, place: QPoint) -> None:
        QTest.mouseClick(widget, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier, place)

    def _to_canvas_crs(self, crs: str) -> QgsCoordinateTransform:
        target = self.canvas.mapSettings().destinationCrs()
        return QgsCoordinateTransform(QgsCoordinateReferenceSystem(crs), target, QgsProject.instance())

    def _on_canvas(self, point: QgsPointXY, crs: str) -> QPoint:
        at = self.canvas.mapSettings().mapToPixel().transform(self._to_canvas_crs(crs).transform(point))
        return QPoint(round(at.x()), round(at.y()))

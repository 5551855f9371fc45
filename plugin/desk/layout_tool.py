"""The map tool that places a cone layout: under the cursor, turned with the wheel, placed with a click."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from qgis.core import QgsCoordinateTransform, QgsPointXY, QgsProject, QgsWkbTypes
from qgis.gui import QgsMapCanvas, QgsMapMouseEvent, QgsMapTool, QgsRubberBand
from qgis.PyQt.QtCore import QPoint, Qt, pyqtSignal
from qgis.PyQt.QtGui import QColor, QKeyEvent, QWheelEvent
from qgis.PyQt.QtWidgets import QApplication

from ...robot_bridge.compass import theta_of
from ...robot_bridge.layouts.cone import Cone
from ...robot_bridge.layouts.layout import Layout
from ...robot_bridge.layouts.placing import placed
from ..errors import FleetError
from ..language import tr_count
from .cone_store import ConeStore
from .notices import Notices
from .placement import transformed

STEP, FINE_STEP = 15.0, 1.0
"""Degrees for one notch of the wheel, and with Shift held."""

NOTCH = 120.0

_TURNS = {
    Qt.Key.Key_PageUp: -1.0,
    Qt.Key.Key_PageDown: 1.0,
}


class LayoutTool(QgsMapTool):
    """Places ``layout`` and says in ``notices`` what came of it. Nothing is sent by it."""

    turned = pyqtSignal(float)
    """The wheel or a key has turned the layout; degrees as :attr:`heading`."""
    dimensions_wanted = pyqtSignal()
    """F2: the operator wants to type dimensions."""

    def __init__(self, canvas: QgsMapCanvas, project: QgsProject, notices: Notices):
        super().__init__(canvas)
        self._project = project
        self._notices = notices
        self._store = ConeStore(project)
        self._pressed_at: QPoint | None = None
        self._cursor: QgsPointXY | None = None
        self._band: QgsRubberBand | None = None
        self.layout: Layout | None = None
        self.heading = 90.0
        """Degrees clockwise from the north of the cones' CRS."""
        self.setCursor(Qt.CursorShape.CrossCursor)

    def show_layout(self, layout: Layout) -> None:
        """Place ``layout`` from now on; where the mouse is not over the map it is shown in its middle."""
        self.layout = layout
        self._show()

    def turn_to(self, heading: float) -> None:
        """Let the layout point that many degrees clockwise from north."""
        self.heading = heading % 360.0
        self._show()

    def preview(self) -> np.ndarray:
        """Return where the cones are shown, (n, 2) in the canvas's CRS."""
        if self._band is None:
            return np.empty((0, 2))
        points = [self._band.getPoint(0, k) for k in range(self._band.numberOfVertices())]
        return np.array([(point.x(), point.y()) for point in points]).reshape(-1, 2)

    def deactivate(self) -> None:
        self._pressed_at = self._cursor = None
        self._clear()
        super().deactivate()

    def canvasMoveEvent(self, event: QgsMapMouseEvent) -> None:
        self._cursor = event.mapPoint()
        self._show()

    def canvasPressEvent(self, event: QgsMapMouseEvent) -> None:
        self._pressed_at = event.pos()

    def canvasReleaseEvent(self, event: QgsMapMouseEvent) -> None:
        # The second click of a double click comes without a press and so is no click of its own.
        pressed, self._pressed_at = self._pressed_at, None
        if pressed is None or event.button() != Qt.MouseButton.LeftButton:
            return
        if (event.pos() - pressed).manhattanLength() <= QApplication.startDragDistance():
            self._cursor = event.mapPoint()
            self._try(self._place)

    def wheelEvent(self, event: QWheelEvent) -> None:
        if event.modifiers() & Qt.KeyboardModifier.ControlModifier:
            # Ctrl and the wheel zoom, as with every tool.
            event.ignore()
            return
        step = FINE_STEP if event.modifiers() & Qt.KeyboardModifier.ShiftModifier else STEP
        turned = event.angleDelta().y() or event.angleDelta().x()
        self._turn(step * turned / NOTCH)
        event.accept()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        """Do by keys what the mouse does: QGIS's own arrow keys move the map below the layout."""
        fine = bool(event.modifiers() & Qt.KeyboardModifier.ShiftModifier)
        if event.key() == Qt.Key.Key_Escape:
            self.canvas().unsetMapTool(self)
        elif event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            self._try(self._place)
        elif event.key() in _TURNS:
            self._turn(_TURNS[event.key()] * (FINE_STEP if fine else STEP))
        elif event.key() == Qt.Key.Key_F2:
            self.dimensions_wanted.emit()
        else:
            super().keyPressEvent(event)
            return
        event.accept()

    def remove(self) -> None:
        """Take the preview off the canvas."""
        self._clear()

    def _cones(self) -> tuple[list[Cone], QgsCoordinateTransform]:
        """Return the cones at the cursor in their own CRS, and the way to the canvas's.

        :raises FleetError: when there is no CRS in metres.
        """
        canvas_crs = self.canvas().mapSettings().destinationCrs()
        crs = self._store.crs(canvas_crs)
        forward = QgsCoordinateTransform(crs, canvas_crs, self._project.transformContext())
        back = QgsCoordinateTransform(canvas_crs, crs, self._project.transformContext())
        place = self._cursor or self.canvas().center()
        ((x, y),) = transformed(np.array([[place.x(), place.y()]]), back)
        cones = self.layout.cones(self._store.prefix(self.layout.NAME))
        return placed(cones, float(x), float(y), theta_of(self.heading)), forward

    def _turn(self, degrees: float) -> None:
        self.turn_to(self.heading + degrees)
        self.turned.emit(self.heading)

    def _show(self) -> None:
        """Draw the layout at the cursor; where that cannot be, nothing: a click there says why."""
        self._clear()
        if self.layout is None or self.canvas().mapTool() is not self:
            return
        try:
            cones, forward = self._cones()
            points = transformed(np.array([(cone.x, cone.y) for cone in cones]), forward)
        except FleetError:
            return
        self._band = QgsRubberBand(self.canvas(), QgsWkbTypes.GeometryType.PointGeometry)
        self._band.setIcon(QgsRubberBand.IconType.ICON_CIRCLE)
        self._band.setColor(QColor("#f26a1b"))
        self._band.setIconSize(8)
        self._band.setWidth(2)
        for number, (x, y) in enumerate(points.tolist(), 1):
            self._band.addPoint(QgsPointXY(x, y), number == len(points))

    def _place(self) -> None:
        if self.layout is None:
            return
        cones, _ = self._cones()
        crs = self._store.crs(self.canvas().mapSettings().destinationCrs())
        findings = self._store.check(cones, crs)
        layer = self._store.add(cones, self.layout.NAME, crs)
        if findings:
            wrong = len({finding.cone for finding in findings})
            self._notices.warning(
                tr_count(
                    len(cones),
                    "The cone should not stand there: {text} It is in the layer {layer}.",
                    "{wrong} of %n cones should not stand there: {text} All are in the layer {layer}.",
                    wrong=wrong,
                    text=findings[0].text,
                    layer=layer.name(),
                )
            )
        else:
            self._notices.info(
                tr_count(
                    len(cones),
                    "1 cone is in the layer {layer}.",
                    "%n cones are in the layer {layer}.",
                    layer=layer.name(),
                )
            )

    def _try(self, action: Callable[[], None]) -> None:
        try:
            action()
        except FleetError as error:
            self._notices.warning(error)

    def _clear(self) -> None:
        if self._band is not None:
            self.canvas().scene().removeItem(self._band)
            self._band = None

"""Map tool that places a cone layout, and its menu entries."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from qgis.core import (
    QgsCoordinateReferenceSystem,
    QgsCoordinateTransform,
    QgsPointXY,
    QgsProject,
    QgsWkbTypes,
)
from qgis.gui import QgisInterface, QgsMapCanvas, QgsMapMouseEvent, QgsMapTool, QgsRubberBand
from qgis.PyQt.QtCore import QEvent, QObject, QPoint, Qt, QTimer, pyqtSignal
from qgis.PyQt.QtGui import QColor, QIcon, QKeyEvent, QKeySequence, QWheelEvent
from qgis.PyQt.QtWidgets import QAction, QApplication, QMenu

from ....robot_bridge.core.geometry import theta_of
from ....robot_bridge.core.layouts.catalogue import LAYOUTS
from ....robot_bridge.core.layouts.layout import Cone, ConeFinding, Layout, cones_at_pose
from ...cone_texts import layout_in_words
from ...control.messages import MessageBar
from ...layers.site_transform import transform_or_raise
from ...ui import scheduling
from ...ui.actions import ICONS
from ...ui.errors import FleetError, MapTransformError
from ...ui.language import tr, tr_count
from ...ui.scheduling import BackgroundReading, CooperativeTask, Steps
from .dimensions import LayoutDimensions, remembered
from .layout_layer import LayoutFile, LayoutGroundReader, LayoutLayer, StandingCone, StandingReader

# --- The map tool that places a cone layout: under the cursor, turned with the wheel, placed with a click

STEP, FINE_STEP = 15.0, 1.0
"""Degrees per notch of the wheel, and with Shift held."""

NOTCH = 120.0

_TURNS = {
    Qt.Key.Key_PageUp: -1.0,
    Qt.Key.Key_PageDown: 1.0,
}


GOOD, BAD = QColor("#f26a1b"), QColor("#b00020")
"""Colours of cones that may stand where they are shown, and of those that should not."""
CHECK_MS = 60
"""Milliseconds that the mouse must rest before the cones under it are checked."""
UNDO, REDO = QKeySequence.StandardKey.Undo, QKeySequence.StandardKey.Redo


class PlacedLayout(NamedTuple):
    """Cones placed together."""

    cones: list[Cone]
    name: str
    crs: QgsCoordinateReferenceSystem
    layer: str
    """The id of their layer: another project has cones with the same names."""


class UncheckedLayout(NamedTuple):
    """Cones in ``layer`` that have not been checked, among those placed there before."""

    cones: list[Cone]
    standing: Sequence[StandingCone]
    crs: QgsCoordinateReferenceSystem
    layer: str


class LayoutTool(QgsMapTool):
    """Places ``layout`` and shows the outcome in ``notices``. It sends nothing.

    Cones that should not stand where they are shown are marked in red once the mouse rests.
    """

    turned = pyqtSignal(float)
    """The wheel or a key has turned the layout; degrees as in :attr:`heading`."""
    undo_changed = pyqtSignal(bool)
    """Whether there is a layout to undo."""
    dimensions_requested = pyqtSignal()
    """F2: the operator wants to type dimensions."""

    def __init__(self, canvas: QgsMapCanvas, project: QgsProject, notices: MessageBar):
        super().__init__(canvas)
        self._project = project
        self._notices = notices
        self._store = LayoutLayer(project)
        self._pressed_at: QPoint | None = None
        self._cursor: QgsPointXY | None = None
        self._band: QgsRubberBand | None = None
        self._bad: QgsRubberBand | None = None
        self._placed: list[PlacedLayout] = []
        self._taken_back: list[PlacedLayout] = []
        self._changes: deque[Steps[None]] = deque()
        """Pending changes of the layer of cones."""
        self._changing = CooperativeTask(self)
        self._unchecked: list[UncheckedLayout] = []
        self._patience = QTimer(self)
        self._patience.setSingleShot(True)
        self._patience.timeout.connect(self._give_up_checking)
        self._standing = np.empty((0, 2))
        """Positions of cones in the layer, as far as read; in its CRS."""
        self._standing_reading: BackgroundReading[list[StandingCone]] = BackgroundReading(self)
        self._standing_reading.ended.connect(self._have_standing)
        self._ground = LayoutGroundReader(project, self)
        self._ground.ready.connect(self._have_ground)
        self._ground.forgotten.connect(self._check_placed)
        self._rest = QTimer(self)
        self._rest.setSingleShot(True)
        self._rest.setInterval(CHECK_MS)
        self._rest.timeout.connect(self._mark_bad)
        self.layout: Layout | None = None
        self.heading = 90.0
        """Degrees clockwise from the north of the cones' CRS."""
        self.setCursor(Qt.CursorShape.CrossCursor)

    def show_layout(self, layout: Layout) -> None:
        """Place ``layout`` from now on; where the mouse is not over the map it is shown in its middle."""
        self.layout = layout
        self._read_standing()
        self._show()

    def turn_to(self, heading: float) -> None:
        """Turn the layout to that heading, degrees clockwise from north."""
        self.heading = heading % 360.0
        self._show()

    def preview(self) -> np.ndarray:
        """Return the positions of the cones shown, (n, 2) in the canvas's CRS."""
        return _points_of(self._band)

    def bad_preview(self) -> np.ndarray:
        """Return those of :meth:`preview` that should not stand where they are shown, (n, 2)."""
        return _points_of(self._bad)

    def undo(self) -> None:
        """Remove the layout placed last from its layer."""
        self._change(self._undoing())

    def redo(self) -> None:
        """Place the layout undone last again, if the cones' layer still has the same CRS."""
        self._change(self._redoing())

    def activate(self) -> None:
        super().activate()
        self.canvas().installEventFilter(self)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        # QGIS's own Undo is about layers; over the map the active tool takes precedence.
        is_ours = event.type() == QEvent.Type.ShortcutOverride
        if is_ours and any(event.matches(key) for key in (UNDO, REDO)):
            event.accept()
        return False

    def deactivate(self) -> None:
        self.canvas().removeEventFilter(self)
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
            self._place()

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
        """Provide the mouse's actions by keys: QGIS's own arrow keys move the map below the layout."""
        fine = bool(event.modifiers() & Qt.KeyboardModifier.ShiftModifier)
        if event.key() == Qt.Key.Key_Escape:
            self.canvas().unsetMapTool(self)
        elif event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            self._place()
        elif event.key() in _TURNS:
            self._turn(_TURNS[event.key()] * (FINE_STEP if fine else STEP))
        elif event.matches(UNDO):
            self.undo()
        elif event.matches(REDO):
            self.redo()
        elif event.key() == Qt.Key.Key_F2:
            self.dimensions_requested.emit()
        else:
            super().keyPressEvent(event)
            return
        event.accept()

    def remove(self) -> None:
        """Remove the preview from the canvas, and stop reading layers."""
        self._changing.stop()
        self._patience.stop()
        self._standing_reading.stop()
        self._ground.remove()
        self._clear()

    def _cones(self) -> tuple[list[Cone], QgsCoordinateTransform]:
        """Return the cones at the cursor in their own CRS, and the transform to the canvas's.

        :raises FleetError: when there is no CRS in metres.
        """
        canvas_crs = self.canvas().mapSettings().destinationCrs()
        crs = self._store.crs(canvas_crs)
        forward = QgsCoordinateTransform(crs, canvas_crs, self._project.transformContext())
        back = QgsCoordinateTransform(canvas_crs, crs, self._project.transformContext())
        place = self._cursor or self.canvas().center()
        ((x, y),) = transform_or_raise(np.array([[place.x(), place.y()]]), back)
        # Names matter only for cones that are placed.
        cones = self.layout.cones(self.layout.NAME)
        return cones_at_pose(cones, float(x), float(y), theta_of(self.heading)), forward

    def _turn(self, degrees: float) -> None:
        self.turn_to(self.heading + degrees)
        self.turned.emit(self.heading)

    def _show(self) -> None:
        """Draw the layout at the cursor; nothing where that is impossible: a click there shows why."""
        self._clear()
        if self.layout is None or self.canvas().mapTool() is not self:
            return
        try:
            cones, forward = self._cones()
            points = transform_or_raise(np.array([(cone.x, cone.y) for cone in cones]), forward)
        except FleetError:
            return
        self._band = self._drawn(points, GOOD, 8)
        self._rest.start()

    def _mark_bad(self) -> None:
        """Mark the cones that should not stand where they are shown, as far as the layers are read."""
        self._remove_bad()
        if self._band is None:
            return
        try:
            cones, forward = self._cones()
            ground = self._ground.ground(forward.sourceCrs())
            if ground is None:
                return
            bad = ground.bad_cones(cones, self._standing)
            points = transform_or_raise(bad, forward) if len(bad) else bad
        except FleetError:
            return
        if len(points):
            self._bad = self._drawn(points, BAD, 14)

    def _drawn(self, points: np.ndarray, colour: QColor, size: int) -> QgsRubberBand:
        """Return circles at ``points``, (n, 2) in the canvas's CRS, that are on the map."""
        band = QgsRubberBand(self.canvas(), QgsWkbTypes.GeometryType.PointGeometry)
        band.setIcon(QgsRubberBand.IconType.ICON_CIRCLE)
        band.setColor(colour)
        band.setIconSize(size)
        band.setWidth(2 if size < 10 else 3)
        for number, (x, y) in enumerate(points.tolist(), 1):
            band.addPoint(QgsPointXY(x, y), number == len(points))
        return band

    def _place(self) -> None:
        if self.layout is None:
            return
        try:
            cones, forward = self._cones()
        except FleetError as error:
            self._notices.warning(error)
            return
        self._change(self._placing(self.layout.NAME, cones, forward.sourceCrs()))

    def _change(self, change: Steps[None]) -> None:
        """Apply ``change`` to the layer of cones when those before it are done."""
        self._changes.append(change)
        if not self._changing.is_busy:
            self._changing.begin(self._do_changes())

    def _do_changes(self) -> Steps[None]:
        while self._changes:
            try:
                yield from self._changes.popleft()
            except FleetError as error:
                self._notices.warning(error)

    def _placing(self, name: str, cones: list[Cone], crs: QgsCoordinateReferenceSystem) -> Steps[None]:
        if self._ground.ground(crs) is None and self._ground.unusable:
            raise FleetError(self._ground.why)
        standing = yield from self._store.standing()
        prefix = self._store.prefix(name, standing)
        cones = [replace(cone, id=prefix + cone.id.removeprefix(name)) for cone in cones]
        layer = self._store.add(cones, name, crs)
        self._placed.append(PlacedLayout(cones, name, crs, layer.id()))
        self._taken_back.clear()
        self._unchecked.append(UncheckedLayout(cones, standing, crs, layer.name()))
        self._changed()
        self._check_placed()

    def _undoing(self) -> Steps[None]:
        while self._placed:
            last = self._placed[-1]
            found = yield from self._store.remove_cones(last.layer, {cone.id for cone in last.cones})
            self._placed.pop()
            if found:
                self._taken_back.append(last)
                break
        else:
            self._notices.info(tr("There is nothing to take back."))
        self._changed()

    def _redoing(self) -> Steps[None]:
        # Cones are written at once: the layer answers.
        yield from self._store.standing()
        if not self._taken_back:
            self._notices.info(tr("There is nothing to do again."))
            return
        last = self._taken_back.pop()
        if self._store.crs(last.crs) != last.crs:
            self._taken_back.clear()
            raise MapTransformError(tr("The layer of cones is another one now: place the layout again."))
        layer = self._store.add(last.cones, last.name, last.crs)
        self._placed.append(last._replace(layer=layer.id()))
        self._changed()

    # --- Findings on cones that were placed ---

    def _check_placed(self) -> None:
        """Check placed cones against the layers, as soon as these are read."""
        while self._unchecked:
            one = self._unchecked[0]
            ground = self._ground.ground(one.crs)
            if ground is None and not self._ground.why:
                if not self._patience.isActive():
                    self._patience.start(round(1000 * scheduling.STALLED_AFTER))
                return
            self._unchecked.pop(0)
            if ground is None:
                self._notices.warning(_unchecked_text(one, self._ground.why))
            else:
                self._report(one, ground.findings(one.cones, one.standing))
        self._patience.stop()

    def _give_up_checking(self) -> None:
        unchecked, self._unchecked = self._unchecked, []
        for one in unchecked:
            why = tr(
                "layers of road surfaces and obstacles have not been read within {seconds:g} s",
                seconds=scheduling.STALLED_AFTER,
            )
            self._notices.warning(_unchecked_text(one, why))

    def _report(self, placed: UncheckedLayout, findings: Sequence[ConeFinding]) -> None:
        if findings:
            wrong = len({finding.cone for finding in findings})
            self._notices.warning(
                tr_count(
                    len(placed.cones),
                    "The cone should not stand there: {text} It is in the layer {layer}.",
                    "{wrong} of %n cones should not stand there: {text} All are in the layer {layer}.",
                    wrong=wrong,
                    text=findings[0].text,
                    layer=placed.layer,
                )
            )
        else:
            self._notices.info(
                tr_count(
                    len(placed.cones),
                    "1 cone is in the layer {layer}.",
                    "%n cones are in the layer {layer}.",
                    layer=placed.layer,
                )
            )

    def _have_ground(self) -> None:
        self._check_placed()
        self._mark_bad()

    def _read_standing(self) -> None:
        layer = self._store.layer()
        if layer is not None:
            self._standing_reading.begin(StandingReader(layer))
        else:
            self._standing = np.empty((0, 2))

    def _have_standing(self) -> None:
        try:
            cones = self._standing_reading.result()
        except FleetError:
            # A click there shows why.
            cones = []
        self._standing = np.array([(cone.x, cone.y) for cone in cones], dtype=np.float64).reshape(-1, 2)
        self._rest.start()

    def _changed(self) -> None:
        """Check the preview against the cones that stand now, and update whether undo is possible."""
        self.undo_changed.emit(bool(self._placed))
        self._read_standing()
        self._rest.start()

    def _remove_bad(self) -> None:
        if self._bad is not None:
            self.canvas().scene().removeItem(self._bad)
            self._bad = None

    def _clear(self) -> None:
        self._rest.stop()
        self._remove_bad()
        if self._band is not None:
            self.canvas().scene().removeItem(self._band)
            self._band = None


def _unchecked_text(placed: UncheckedLayout, why: str) -> str:
    return tr("The cones in the layer {layer} were not checked: {why}", layer=placed.layer, why=why)


def _points_of(band: QgsRubberBand | None) -> np.ndarray:
    """Return the points of ``band``, (n, 2); empty without one."""
    if band is None:
        return np.empty((0, 2))
    points = [band.getPoint(0, k) for k in range(band.numberOfVertices())]
    return np.array([(point.x(), point.y()) for point in points]).reshape(-1, 2)


# --- The menu entries that activate the cone layout tool, one for each layout ---


class LayoutAction:
    """An entry of ``menu`` with a menu of layouts. :meth:`remove` undoes the constructor."""

    def __init__(self, iface: QgisInterface, menu: str, notices: MessageBar):
        self._iface, self._menu = iface, menu
        window = iface.mainWindow()
        self.action = QAction(QIcon(str(ICONS / "cone_layout.svg")), tr("Place cone layout"), window)
        self.action.setObjectName("fleet_cone_layout")
        self.action.setToolTip(
            tr(
                "Place a cone layout: it is shown under the cursor, the wheel turns it, with Shift finely, a "
                "click places it, Ctrl+Z takes it back, Esc ends; by keys PgUp and PgDown turn it, Enter "
                "places it, F2 leads to its dimensions. Nothing is sent to robots"
            )
        )
        self.tool = LayoutTool(iface.mapCanvas(), QgsProject.instance(), notices)
        self.dimensions = LayoutDimensions(window)
        self.dimensions.changed.connect(self.tool.show_layout)
        self.dimensions.turned.connect(self.tool.turn_to)
        self.dimensions.left.connect(iface.mapCanvas().setFocus)
        self.tool.turned.connect(self.dimensions.show_heading)
        self.tool.dimensions_requested.connect(self.dimensions.focus_heading)
        self.dimensions.undo_requested.connect(self.tool.undo)
        self.tool.undo_changed.connect(self.dimensions.undo.setEnabled)
        self._file = LayoutFile(QgsProject.instance(), notices)
        self.tool.deactivated.connect(self.dimensions.hide)
        self._layouts = QMenu(window)
        for kind in LAYOUTS.values():
            entry = self._layouts.addAction(layout_in_words(kind))
            entry.setObjectName(f"fleet_cone_layout_{kind.NAME}")
            entry.triggered.connect(lambda _=False, kind=kind: self.start_tool(remembered(kind)))
        self.action.setMenu(self._layouts)
        iface.addPluginToMenu(menu, self.action)

    def start_tool(self, layout: Layout) -> None:
        """Activate the tool with ``layout`` and its dimensions for editing."""
        self._iface.mapCanvas().setMapTool(self.tool)
        self.tool.show_layout(layout)
        self.dimensions.show_layout(layout, self.tool.heading)
        self._iface.mapCanvas().setFocus()

    def remove(self) -> None:
        """Deactivate the tool and remove the entries from the menu."""
        self._iface.mapCanvas().unsetMapTool(self.tool)
        self._file.remove()
        self.tool.remove()
        self.tool.deleteLater()
        self.dimensions.deleteLater()
        self._iface.removePluginMenu(self._menu, self.action)
        self._layouts.deleteLater()
        self.action.deleteLater()

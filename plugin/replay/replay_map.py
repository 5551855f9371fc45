"""Map of the replay beside the live one, and driven paths as a temporal line layer."""

from __future__ import annotations

from collections import deque
from pathlib import Path

import numpy as np
from qgis.core import (
    QgsApplication,
    QgsCoordinateReferenceSystem,
    QgsFeature,
    QgsFields,
    QgsGeometry,
    QgsLineString,
    QgsProject,
    QgsTask,
    QgsVectorLayer,
)
from qgis.gui import QgsMapCanvas, QgsMapToolPan
from qgis.PyQt import sip
from qgis.PyQt.QtCore import QObject, QSize, QTimer, pyqtSignal
from qgis.PyQt.QtWidgets import QWidget

from ...robot_bridge.core.messages.administration import SiteReport
from ...robot_bridge.core.sites.frame import SiteFrame
from ..layers import live_layers
from ..layers.site_transform import SiteToMapTransform, frame_of
from ..map.live_view import FRAME_MS
from ..map.overlay.fleet_overlay import FleetOverlay
from ..map.overlay.scene import SceneTransformer, SiteScene, TaskPaths, show_places
from ..map.overlay.trails import Trails
from ..ui.errors import MapTransformError
from ..ui.language import tr
from ..ui.scheduling import CooperativeTask, Steps
from .history import SILENT_AFTER, History, PastCommands
from .time_controls import local_time

OWN_LAYER = "replay"
"""The kind of the live layer that is shown here; the others show the present."""
AROUND = 10.0
"""Metres that are shown around the driven paths."""
JUMP = 20.0
"""Seconds over which a robot's trail is not drawn as if it had been seen driving."""


class ReplayMap(QgsMapCanvas):
    """Follows the layers, the CRS and the rotation of ``live``; its view is its own."""

    def __init__(self, live: QgsMapCanvas, parent: QWidget | None = None):
        super().__init__(parent)
        self.setObjectName("fleet_replay_map")
        self._live = live
        self._trails = Trails()
        self.overlay = FleetOverlay(self, self._trails)
        self._placer, self._plans = SceneTransformer(), TaskPaths()
        self._placement: SiteToMapTransform | None = None
        self._site: SiteReport | None = None
        self._moment: float | None = None
        self._soon = QTimer(self)
        self._soon.setSingleShot(True)
        self._soon.setInterval(FRAME_MS)
        self._soon.timeout.connect(self._continue)
        self.extentsChanged.connect(self._soon.start)
        self._pan = QgsMapToolPan(self)
        self.setMapTool(self._pan)
        self.setCanvasColor(live.canvasColor())
        live.layersChanged.connect(self.follow)
        live.destinationCrsChanged.connect(self.follow)
        live.rotationChanged.connect(self.follow)

    def sizeHint(self) -> QSize:
        # A canvas would request more room than the live one has.
        return QSize(340, 300)

    def remove(self) -> None:
        """Stop drawing and disconnect from the live map."""
        self._soon.stop()
        self._live.layersChanged.disconnect(self.follow)
        self._live.destinationCrsChanged.disconnect(self.follow)
        self._live.rotationChanged.disconnect(self.follow)
        self.stopRendering()
        self.setLayers([])
        self.unsetMapTool(self._pan)
        if not sip.isdeleted(self.overlay):
            self.overlay.remove()

    def begin(self, site: SiteReport) -> None:
        """Show the live map's view; robots of ``site`` follow."""
        self._site, self._placement, self._moment = site, None, None
        self._trails.clear()
        self._plans = TaskPaths()
        self.follow()
        self.setExtent(self._live.extent())
        self.refresh()

    def show_all(self, history: History) -> None:
        """Show where each robot in ``history`` was, and its surroundings.

        A robot that was somewhere without a place in the map's CRS is left out.

        :raises MapTransformError: when that holds for all of them.
        """
        if self._site is None or not len(history):
            return
        around = history.extents + np.array([[-AROUND], [AROUND]])
        # The corners of each robot's box: (least, greatest) of x with (least, greatest) of y.
        corners = np.stack([around[:, (0, 1, 1, 0), 0], around[:, (0, 0, 1, 1), 1]], axis=2)
        places = self._place().to_map_or_nan(corners)
        placed = places[np.isfinite(places[:, 0, 0])]
        if len(placed):
            show_places(self, placed.reshape(-1, 2))
        else:
            # It raises the reason.
            self._place().to_map(corners.reshape(-1, 2))

    def follow(self, *_what: object) -> None:
        """Copy the live map's layers, CRS and rotation; driven paths are above the layers."""
        self.setDestinationCrs(self._live.mapSettings().destinationCrs())
        self.setRotation(self._live.rotation())
        own = [
            one
            for one in live_layers.live_layers(QgsProject.instance())
            if one.customProperty(live_layers.MARK) == OWN_LAYER
        ]
        layers = own + [
            layer for layer in self._live.layers() if layer.customProperty(live_layers.MARK) is None
        ]
        if layers != self.layers():
            self.setLayers(layers)

    def show_moment(
        self, history: History, commands: PastCommands, moment: float, chosen: tuple[str, ...]
    ) -> None:
        """Draw robots and their tasks as they were at ``moment``.

        :raises MapTransformError: when the site has no place in the map's CRS.
        """
        if self._site is None:
            return
        robots = history.at(moment)
        if self._moment is None or not 0 <= moment - self._moment <= JUMP:
            self._trails.clear()
        self._moment = moment
        self._trails.extend(robots.xy, moment)
        plans = self._plans.of(commands.under_way_at(moment))
        rows = {
            name: row
            for name in {*chosen, *(p.robot for p in plans)}
            if (row := history.row(name)) is not None
        }
        scene = SiteScene(robots, moment, tuple(n for n in chosen if n in rows), plans, rows=rows)
        try:
            self.overlay.show_scene(self._placer.placed(scene, self._place()))
        except MapTransformError:
            self.overlay.show_scene(None)
            raise
        self._soon.start()

    def show_nothing(self) -> None:
        """Draw no robots."""
        self._site = self._moment = None
        self.overlay.show_scene(None)

    def _continue(self) -> None:
        """Complete the current moment for the present view: while time is paused no other update follows."""
        self.overlay.prepare()
        if not self.overlay.is_whole:
            self._soon.start()

    def _place(self) -> SiteToMapTransform:
        way = self.mapSettings().destinationCrs(), QgsProject.instance().transformContext()
        if self._placement is None or not self._placement.leads_to(*way):
            self._placement = SiteToMapTransform(self._site, *way)
        return self._placement


STYLE = Path(__file__).parents[2] / "resources" / "styles" / "trajectories.qml"
FIELDS = (
    "field=robot:string&field=begin:datetime&field=end:datetime&field=length_m:double&field=mean_speed:double"
)
MOST_LINES = 20_000
"""With more the lines are made longer."""
PIECE = 5.0
"""Duration of one line in seconds, so that a path appears as it is driven."""
AT_ONCE = 100
"""Lines written, or freed, in one step of a slice."""


class ReplayLayer(QObject):
    """The layer *Trajectories (replay)*, made in the background and written bit by bit.

    The replay's own map shows it; in the project it is not ticked.
    """

    failed = pyqtSignal(str)
    changed = pyqtSignal()
    """The layer was added to the project, or removed."""

    def __init__(self, project: QgsProject, parent: QObject | None = None):
        super().__init__(parent)
        self._project = project
        self._id: str | None = None
        self._task: LinesTask | None = None
        self._writing = CooperativeTask(self)
        self._freeing = CooperativeTask(self)
        self._lines: list[int] = []
        """The ids of the lines written; querying the layer for twenty thousand takes 10 ms."""
        self._out: list[tuple[QgsVectorLayer, list[int]]] = []
        """Layers removed from the project, and their remaining lines."""

    @property
    def layer(self) -> QgsVectorLayer | None:
        """The layer, None while there is none, or the user removed it."""
        return self._project.mapLayer(self._id) if self._id is not None else None

    @property
    def is_busy(self) -> bool:
        """Whether lines are still being made or written."""
        return self._task is not None or self._writing.is_busy

    def show(self, history: History, site: SiteReport) -> None:
        """Show ``history`` in place of the former one."""
        self.clear()
        if not len(history):
            return
        layer = self._make(QgsCoordinateReferenceSystem(site.crs))
        frame = frame_of(site)
        self._task = LinesTask(history.table, list(history.names), frame, layer.fields())
        self._task.taskCompleted.connect(self._made)
        self._task.taskTerminated.connect(self._gone)
        QgsApplication.taskManager().addTask(self._task)

    def clear(self) -> None:
        """Remove the layer from the project; the memory of its lines is freed bit by bit."""
        self._writing.stop()
        if self._task is not None:
            self._task.taskCompleted.disconnect(self._made)
            self._task.taskTerminated.disconnect(self._gone)
            self._task.cancel()
            self._task = None
        if self.layer is not None:
            dirty = self._project.isDirty()
            self._out.append((self._project.takeMapLayer(self.layer), self._lines))
            live_layers.remove_if_empty(self._project)
            live_layers.leave_clean(self._project, dirty)
            self._freeing.begin_soon(self._free())
        self._id, self._lines = None, []
        self.changed.emit()

    def remove(self) -> None:
        """Remove the layer from the project for good."""
        self.clear()
        self._freeing.finish()

    def _free(self) -> Steps[None]:
        """Free the removed layers: freeing twenty thousand lines at once blocks the window."""
        while self._out:
            layer, lines = self._out[-1]
            while lines:
                layer.dataProvider().deleteFeatures(lines[-AT_ONCE:])
                del lines[-AT_ONCE:]
                yield 0.0
            # Others may still use it, like any layer removed from a project.
            sip.delete(layer)
            self._out.pop()

    def _make(self, crs: QgsCoordinateReferenceSystem) -> QgsVectorLayer:
        dirty = self._project.isDirty()
        layer = QgsVectorLayer(f"LineString?{FIELDS}", tr("Trajectories (replay)"), "memory")
        layer.setCrs(crs)
        live_layers.make_live(layer, OWN_LAYER)
        if not live_layers.apply_style(self._project, layer):
            layer.loadNamedStyle(str(STYLE))
        self._project.addMapLayer(layer, False)
        # The past must not mix with the present: the layer is on the live map only if it is ticked.
        live_layers.fleet_group(self._project).addLayer(layer).setItemVisibilityChecked(False)
        self._id = layer.id()
        live_layers.leave_clean(self._project, dirty)
        self.changed.emit()
        return layer

    def _made(self) -> None:
        task, self._task = self._task, None
        self._writing.begin_soon(self._write(task.features))

    def _gone(self) -> None:
        self._task = None
        self.failed.emit(tr("The trajectories are not drawn: they could not be made into lines."))

    def _write(self, lines: deque[QgsFeature]) -> Steps[None]:
        """Write ``lines``, which are used up, unless the user removes the layer."""
        count = len(lines)
        while lines and self.layer is not None:
            batch = [lines.popleft() for _ in range(min(AT_ONCE, len(lines)))]
            provider = self.layer.dataProvider()
            is_written, written = provider.addFeatures(batch)
            self._lines += [line.id() for line in written]
            if not is_written:
                self.failed.emit(tr("Not all trajectories are drawn: {error}", error=provider.lastError()))
                break
            yield 1.0 - len(lines) / count
        if self.layer is not None:
            self.layer.updateExtents()
            self.layer.triggerRepaint()


class LinesTask(QgsTask):
    """Makes the lines of ``table``, the positions of a :class:`~.history.History`."""

    def __init__(self, table: np.ndarray, names: list[str], frame: SiteFrame, fields: QgsFields):
        super().__init__(tr("Drawing what robots drove"), QgsTask.Flag.CanCancel)
        self._table, self._names, self._frame, self._fields = table, names, frame, fields
        self.features: deque[QgsFeature] = deque()

    def run(self) -> bool:
        xy = self._frame.to_crs(self._table[:, 2:4])
        times = self._table[:, 1]
        # A robot that reported all the time has the most lines.
        span = len(self._names) * (times.max() - times.min())
        for rows in line_pieces(self._table[:, 0], times, max(PIECE, span / MOST_LINES)):
            if self.isCanceled():
                return False
            self.features.append(self._line(rows, xy[rows]))
        return True

    def _line(self, rows: np.ndarray, xy: np.ndarray) -> QgsFeature:
        begin, end = float(self._table[rows[0], 1]), float(self._table[rows[-1], 1])
        length = float(np.hypot(*np.diff(xy, axis=0).T).sum())
        feature = QgsFeature(self._fields)
        feature.setGeometry(QgsGeometry(QgsLineString(xy[:, 0].tolist(), xy[:, 1].tolist())))
        robot = self._names[int(self._table[rows[0], 0])]
        feature.setAttributes([robot, local_time(begin), local_time(end), length, length / (end - begin)])
        return feature


def line_pieces(robots: np.ndarray, times: np.ndarray, seconds: float) -> list[np.ndarray]:
    """Return the rows of each line: of one robot, without a silence, ``seconds`` long at most.

    ``robots`` and ``times`` are sorted by robot and time. A piece begins where the one before it ends.
    """
    found = []
    parted = (np.diff(robots) != 0) | (np.diff(times) > SILENT_AFTER)
    for part in np.split(np.arange(len(times)), np.flatnonzero(parted) + 1):
        if len(part) < 2:
            continue
        bins = np.floor((times[part] - times[part[0]]) / seconds)
        ends = [0, *(np.flatnonzero(np.diff(bins)) + 1).tolist(), len(part) - 1]
        for first, last in zip(ends, ends[1:]):  # noqa: B905, RUF007
            piece = part[first : last + 1]
            if len(piece) > 1 and times[piece[-1]] > times[piece[0]]:
                found.append(piece)
    return found

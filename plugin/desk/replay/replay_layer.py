"""What robots drove as a line layer with times: QGIS's temporal controller plays it."""

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
from qgis.PyQt import sip
from qgis.PyQt.QtCore import QObject, pyqtSignal

from ....robot_bridge.messages import SiteReport
from ....robot_bridge.sites.frame import SiteFrame
from ...language import tr
from ...sites.fleet_group import fleet_group, leave_clean, remove_if_empty
from ..live_layers import give_style, make_live
from ..placement import frame_of
from ..time_slices import Steps, TimeSlices
from .clockwork import local
from .history import SILENT_AFTER, History
from .replay_map import OWN_LAYER

STYLE = Path(__file__).parents[3] / "resources" / "styles" / "trajectories.qml"
FIELDS = (
    "field=robot:string&field=begin:datetime&field=end:datetime&field=length_m:double&field=mean_speed:double"
)
MOST_LINES = 20_000
"""With more the lines are made longer."""
PIECE = 5.0
"""Seconds of a drive that one line is long, so that it appears as it is driven."""
AT_ONCE = 100
"""Lines written, or given back, in one step of a slice."""


class ReplayLayer(QObject):
    """The layer *Trajectories (replay)*, made beside the window and written bit by bit.

    The replay's own map shows it; in the project it is not ticked.
    """

    failed = pyqtSignal(str)
    changed = pyqtSignal()
    """The layer is in the project now, or out of it."""

    def __init__(self, project: QgsProject, parent: QObject | None = None):
        super().__init__(parent)
        self._project = project
        self._id: str | None = None
        self._task: LinesTask | None = None
        self._writing = TimeSlices(self)
        self._freeing = TimeSlices(self)
        self._lines: list[int] = []
        """The ids of those that are written; to ask the layer for twenty thousand takes 10 ms."""
        self._out: list[tuple[QgsVectorLayer, list[int]]] = []
        """Layers that are out of the project, and the lines that they still hold."""

    @property
    def layer(self) -> QgsVectorLayer | None:
        """The layer, None while there is none, or the user took it out."""
        return self._project.mapLayer(self._id) if self._id is not None else None

    @property
    def is_busy(self) -> bool:
        """Whether lines are still being made or written."""
        return self._task is not None or self._writing.is_busy

    def show(self, history: History, site: SiteReport) -> None:
        """Show what is in ``history`` in place of what was shown."""
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
        """Take the layer out of the project; the memory of its lines is given back bit by bit."""
        self._writing.stop()
        if self._task is not None:
            self._task.taskCompleted.disconnect(self._made)
            self._task.taskTerminated.disconnect(self._gone)
            self._task.cancel()
            self._task = None
        if self.layer is not None:
            dirty = self._project.isDirty()
            self._out.append((self._project.takeMapLayer(self.layer), self._lines))
            remove_if_empty(self._project)
            leave_clean(self._project, dirty)
            self._freeing.begin_soon(self._free())
        self._id, self._lines = None, []
        self.changed.emit()

    def remove(self) -> None:
        """Take the layer out of the project and be done with it."""
        self.clear()
        self._freeing.finish()

    def _free(self) -> Steps[None]:
        """Give back the layers that are out: that of twenty thousand lines at once holds the window up."""
        while self._out:
            layer, lines = self._out[-1]
            while lines:
                layer.dataProvider().deleteFeatures(lines[-AT_ONCE:])
                del lines[-AT_ONCE:]
                yield 0.0
            # Others may hold it, as they may hold one that is removed from a project.
            sip.delete(layer)
            self._out.pop()

    def _make(self, crs: QgsCoordinateReferenceSystem) -> QgsVectorLayer:
        dirty = self._project.isDirty()
        layer = QgsVectorLayer(f"LineString?{FIELDS}", tr("Trajectories (replay)"), "memory")
        layer.setCrs(crs)
        make_live(layer, OWN_LAYER)
        if not give_style(self._project, layer):
            layer.loadNamedStyle(str(STYLE))
        self._project.addMapLayer(layer, False)
        # What was has no place among what is: only who ticks the layer has it on the live map.
        fleet_group(self._project).addLayer(layer).setItemVisibilityChecked(False)
        self._id = layer.id()
        leave_clean(self._project, dirty)
        self.changed.emit()
        return layer

    def _made(self) -> None:
        task, self._task = self._task, None
        self._writing.begin_soon(self._write(task.features))

    def _gone(self) -> None:
        self._task = None
        self.failed.emit(tr("The trajectories are not drawn: they could not be made into lines."))

    def _write(self, lines: deque[QgsFeature]) -> Steps[None]:
        """Write ``lines``, which are used up, unless the user takes the layer out."""
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
        # A robot that was heard of all the time has the most lines.
        span = len(self._names) * (times.max() - times.min())
        for rows in pieces(self._table[:, 0], times, max(PIECE, span / MOST_LINES)):
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
        feature.setAttributes([robot, local(begin), local(end), length, length / (end - begin)])
        return feature


def pieces(robots: np.ndarray, times: np.ndarray, seconds: float) -> list[np.ndarray]:
    """Return the rows of each line: of one robot, without a silence, about ``seconds`` long at most.

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

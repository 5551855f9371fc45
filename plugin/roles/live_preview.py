"""Keeps the counts and the picture up with the table, without the GUI thread ever waiting."""

from __future__ import annotations

from collections.abc import Sequence

from qgis.core import (
    QgsApplication,
    QgsCoordinateReferenceSystem,
    QgsExpressionContext,
    QgsExpressionContextUtils,
    QgsProject,
    QgsTask,
)
from qgis.PyQt.QtCore import QObject, QSize, QTimer, pyqtSignal
from qgis.PyQt.QtGui import QImage

from ...robot_bridge.sites.frame import SiteFrame
from ..errors import FleetError
from ..language import tr_count
from ..sites.obstacle_source import ObstacleSource, obstacle_sources
from ..sites.placing import SitePlacing
from ..sites.project_site import frame_in_project
from ..sites.roles import PUBLISHED_ROLES, LayerExpressions
from ..sites.site_crs import site_crs_for, stated_crs
from .measure import Measure, summary
from .preview_task import PreviewTask
from .rows import RoleRow

DELAY_MS = 250
"""How long the table must be left alone before layers are read anew."""

GIVE_UP_S = 5.0


class LivePreview(QObject):
    """Measures the layers of ``rows`` as they are set up now; what was measured once is kept.

    ``measured`` tells a layer's id and what it comes to, None as long as it is not known.
    """

    measured = pyqtSignal(str, object)
    drawn = pyqtSignal(QImage)
    summed = pyqtSignal(str)

    def __init__(self, project: QgsProject, rows: Sequence[RoleRow], parent: QObject):
        super().__init__(parent)
        self._project, self._rows = project, rows
        self._known: dict[object, Measure] = {}
        self._size, self._ratio = QSize(400, 300), 1.0
        self._task: PreviewTask | None = None
        self._timer = QTimer(self)
        self._timer.setSingleShot(True)
        self._timer.setInterval(DELAY_MS)
        self._timer.timeout.connect(self._start)

    @property
    def busy(self) -> bool:
        """Whether counts or picture are behind the table."""
        return self._timer.isActive() or self._task is not None

    def resize(self, size: QSize, ratio: float) -> None:
        """Draw for a widget of ``size`` from now on."""
        if (size, ratio) != (self._size, self._ratio) and not size.isEmpty():
            self._size, self._ratio = QSize(size), ratio
            self.refresh()

    def refresh(self) -> None:
        """Catch up with the rows soon."""
        for row in self._rows:
            self.measured.emit(row.layer_id, self._known.get(_key(row)))
        if self._task is not None:
            self._task.cancel()
        self._timer.start()

    def stop(self) -> None:
        """End what is under way, for good, and wait until no thread touches it."""
        self._timer.stop()
        task, self._task = self._task, None
        if task is None:
            return
        running = task.status() == QgsTask.TaskStatus.Running
        task.cancel()
        if running:
            task.left.wait(GIVE_UP_S)

    def _start(self) -> None:
        if self._task is not None:
            # The one that was cancelled ends soon, and starts this again.
            return
        wanted = [row for row in self._rows if row.setup.role in PUBLISHED_ROLES]
        missing = [row for row in wanted if _key(row) not in self._known]
        try:
            site = self._site(wanted)
        except FleetError as error:
            self.summed.emit(str(error))
            return
        sources = {_key(row): source for row in missing if (source := self._source(row)) is not None}
        known = {_key(row): self._known[_key(row)] for row in wanted if _key(row) in self._known}
        self.summed.emit(
            tr_count(len(sources), "Reading 1 layer …", "Reading %n layers …")
            if sources
            else summary(list(known.values()))
        )
        self._task = PreviewTask(sources, known, site, self._size, self._ratio)
        self._task.measured.connect(self._keep)
        self._task.drawn.connect(self.drawn)
        self._task.taskCompleted.connect(self._ended)
        self._task.taskTerminated.connect(self._ended)
        QgsApplication.taskManager().addTask(self._task)

    def _source(self, row: RoleRow) -> ObstacleSource | None:
        context = QgsExpressionContext()
        context.appendScope(QgsExpressionContextUtils.globalScope())
        context.appendScope(QgsExpressionContextUtils.projectScope(self._project))
        try:
            (source,) = obstacle_sources([row.layer], LayerExpressions(), context, lambda _: row.setup)
        except FleetError as error:
            self._keep(_key(row), Measure(row.setup.role, refused=str(error)))
            return None
        return source

    def _site(self, rows: Sequence[RoleRow]) -> SitePlacing:
        layers = [stated_crs(row.layer.crs()) for row in rows]
        crs = site_crs_for(QgsCoordinateReferenceSystem(), self._project.crs(), layers)
        frame = frame_in_project(self._project, crs) or SiteFrame(crs.authid(), (0.0, 0.0))
        return SitePlacing(crs, frame, self._project.transformContext())

    def _keep(self, key: object, found: Measure) -> None:
        self._known[key] = found
        layer_id, setup = key
        if any(row.layer_id == layer_id and row.setup == setup for row in self._rows):
            self.measured.emit(layer_id, found)

    def _ended(self) -> None:
        if self._task is None:
            return
        cancelled, self._task = self._task.isCanceled(), None
        if cancelled:
            self._timer.start()
            return
        keys = [_key(row) for row in self._rows if row.setup.role in PUBLISHED_ROLES]
        self.summed.emit(summary([self._known[key] for key in keys if key in self._known]))


def _key(row: RoleRow) -> object:
    return row.layer_id, row.setup

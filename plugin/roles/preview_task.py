"""Measures layers and draws the preview beside the GUI thread."""

from __future__ import annotations

import threading
from collections.abc import Mapping

from qgis.core import QgsFeedback, QgsTask
from qgis.PyQt.QtCore import QSize, pyqtSignal
from qgis.PyQt.QtGui import QImage

from ..language import tr
from ..sites.obstacle_source import ObstacleSource
from ..sites.placing import SitePlacing
from .measure import Measure, measure
from .picture import draw

Key = object


class PreviewTask(QgsTask):
    """Measures ``sources`` one by one, then draws them together with what is ``known``.

    ``measured`` and ``drawn`` are emitted in the worker; Qt brings them to the thread of whoever listens.
    """

    measured = pyqtSignal(object, object)
    drawn = pyqtSignal(QImage)

    def __init__(
        self,
        sources: Mapping[Key, ObstacleSource],
        known: Mapping[Key, Measure],
        site: SitePlacing | None,
        size: QSize,
        ratio: float,
    ):
        super().__init__(tr("Preview of the site"), QgsTask.Flag.CanCancel)
        self._sources, self._known, self._site = dict(sources), dict(known), site
        self._size, self._ratio = size, ratio
        self._feedback = QgsFeedback()
        self.left = threading.Event()
        """Set once the worker has left :meth:`run`."""

    def run(self) -> bool:
        try:
            return self._work()
        finally:
            self.left.set()

    def cancel(self) -> None:
        self._feedback.cancel()
        super().cancel()

    def _work(self) -> bool:
        for key, source in self._sources.items():
            found = measure(source, self._site, self._feedback)
            if found is None or self._feedback.isCanceled():
                return False
            self._known[key] = found
            self.measured.emit(key, found)
        image = draw(self._known.values(), self._size, self._ratio, self._feedback)
        if image is None:
            return False
        self.drawn.emit(image)
        return True

"""Knows when QGIS is in the middle of reading a project, and when another one is there."""

from __future__ import annotations

from qgis.core import QgsProject
from qgis.PyQt.QtCore import QObject, QTimer, pyqtSignal


class ProjectWatch(QObject):
    """While a project is read QGIS lets timers run, and ends abruptly if one of them touches its layers."""

    opened = pyqtSignal()
    """Another project is there, read to its end or a new one, and has none of the layers before."""

    def __init__(self, project: QgsProject, parent: QObject | None = None):
        super().__init__(parent)
        self._project = project
        self._is_cleared = False
        # Others that are told of a project's reading have their turn first; one of a file is not read yet.
        self._soon = QTimer(self)
        self._soon.setSingleShot(True)
        self._soon.setInterval(0)
        self._soon.timeout.connect(self._tell)
        project.cleared.connect(self._cleared)
        project.readProject.connect(self._read)
        project.projectSaved.connect(self._complete)

    def remove(self) -> None:
        """Hear of the project no more: it is there longer than the plugin, and keeps each connection."""
        self._soon.stop()
        self._project.cleared.disconnect(self._cleared)
        self._project.readProject.disconnect(self._read)
        self._project.projectSaved.disconnect(self._complete)

    @property
    def is_reading(self) -> bool:
        """Whether layers are being read: a project that is new has no file yet."""
        return self._is_cleared and bool(self._project.fileName())

    def _cleared(self) -> None:
        self._is_cleared = True
        self._soon.start()

    def _read(self, *_: object) -> None:
        self._complete()
        self._soon.start()

    def _complete(self, *_: object) -> None:
        self._is_cleared = False

    def _tell(self) -> None:
        if not self.is_reading:
            self.opened.emit()

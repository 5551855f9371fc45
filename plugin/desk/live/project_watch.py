"""Knows when QGIS is in the middle of reading a project."""

from __future__ import annotations

from qgis.core import QgsProject
from qgis.PyQt.QtCore import QObject


class ProjectWatch(QObject):
    """While a project is read QGIS lets timers run, and ends abruptly if one of them touches its layers."""

    def __init__(self, project: QgsProject, parent: QObject | None = None):
        super().__init__(parent)
        self._project = project
        self._is_cleared = False
        project.cleared.connect(self._cleared)
        project.readProject.connect(self._complete)
        project.projectSaved.connect(self._complete)

    @property
    def is_reading(self) -> bool:
        """Whether layers are being read: a project that is new has no file yet."""
        return self._is_cleared and bool(self._project.fileName())

    def _cleared(self) -> None:
        self._is_cleared = True

    def _complete(self, *_: object) -> None:
        self._is_cleared = False

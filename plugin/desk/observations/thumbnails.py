"""Small pictures of the images that robots sent, as files that layers and map tips show."""

from __future__ import annotations

from collections.abc import Set
from pathlib import Path

from qgis.core import QgsApplication
from qgis.PyQt.QtCore import QObject, QSize, Qt, QTemporaryDir, pyqtSignal

from ..robots.last_image import DecodeTask

SIDE = 256
"""Pixels of the longer side of a picture."""


class Thumbnails(QObject):
    """Makes the pictures beside the window, and keeps them in a folder that goes with the plugin."""

    made = pyqtSignal(int)
    """The picture of this observation is there."""
    failed = pyqtSignal(int)
    """The image of this observation cannot be read."""

    def __init__(self, parent: QObject | None = None):
        super().__init__(parent)
        self._folder = QTemporaryDir()
        self._tasks: dict[int, ThumbnailTask] = {}
        self._made: set[int] = set()

    def has(self, number: int) -> bool:
        """Tell whether the picture of an observation is there or being made."""
        return number in self._made or number in self._tasks

    def file(self, number: int) -> str:
        """Return the file of an observation's picture, empty while there is none."""
        return str(self._path(number)) if number in self._made else ""

    def make(self, number: int, answer: dict) -> bool:
        """Make a picture of the image in the gateway's ``answer``; False when there is none in it."""
        image = answer.get("image")
        if not isinstance(image, str) or not self._folder.isValid():
            return False
        task = ThumbnailTask(image, self._path(number))
        task.taskCompleted.connect(lambda: self._ended(number, task, done=True))
        task.taskTerminated.connect(lambda: self._ended(number, task, done=False))
        self._tasks[number] = task
        QgsApplication.taskManager().addTask(task)
        return True

    def keep(self, numbers: Set[int]) -> None:
        """Forget the pictures of all other observations; what is being made of them is of no use any more."""
        for number in self._tasks.keys() - numbers:
            self._tasks.pop(number).cancel()
        for number in self._made - numbers:
            self._path(number).unlink(missing_ok=True)
        self._made &= numbers

    def clear(self) -> None:
        """Forget every picture."""
        self.keep(frozenset())

    def remove(self) -> None:
        """Delete the folder."""
        tasks = list(self._tasks.values())
        self.clear()
        for task in tasks:
            task.waitForFinished(1000)
        self._folder.remove()

    def _path(self, number: int) -> Path:
        return Path(self._folder.path()) / f"observation-{number}.png"

    def _ended(self, number: int, task: ThumbnailTask, *, done: bool) -> None:
        if self._tasks.get(number) is not task:
            return
        del self._tasks[number]
        if done:
            self._made.add(number)
            self.made.emit(number)
        else:
            self.failed.emit(number)


class ThumbnailTask(DecodeTask):
    """Makes an image of base64 and writes it, small, to ``file``."""

    def __init__(self, text: str, file: Path):
        super().__init__(text)
        self._file = file

    def run(self) -> bool:
        if not super().run() or self.isCanceled():
            return False
        smooth = Qt.TransformationMode.SmoothTransformation
        small = self.image.scaled(QSize(SIDE, SIDE), Qt.AspectRatioMode.KeepAspectRatio, smooth)
        self.image = None
        return small.save(str(self._file), "PNG")

"""The last image that a robot sent: asked for when somebody looks, decoded beside the window."""

from __future__ import annotations

import base64
import binascii

from qgis.core import QgsApplication, QgsTask
from qgis.PyQt.QtCore import QBuffer, QByteArray, QIODevice, QObject, QSize, Qt, pyqtSignal
from qgis.PyQt.QtGui import QImage, QImageReader

from ....robot_bridge.messages import GetImage, GetObservations, SendImage
from ...errors import FleetError
from ...language import tr
from ...wire.outbox import Answer
from ..desk import Desk

LOOKED_THROUGH = 200
"""Observations among which the newest image is looked for."""
LARGEST_SIDE = 1024
"""Pixels to which a larger image is reduced."""


class LastImage(QObject):
    """``text`` says what ``image`` is, or why there is none."""

    changed = pyqtSignal()

    def __init__(self, desk: Desk, parent: QObject | None = None):
        super().__init__(parent)
        self._desk = desk
        self._robot = ""
        self._key = ""
        self._seen: dict = {}
        self._task: DecodeTask | None = None
        self.image: QImage | None = None
        self.text = ""
        desk.answered.connect(self._answered)

    def ask(self, robot: str) -> None:
        """Look for the newest image of ``robot``."""
        if robot != self._robot:
            self.image = None
        self._robot = robot
        self._drop()
        self._ask(GetObservations(robot=robot, limit=LOOKED_THROUGH), tr("looking for an image …"))

    def forget(self) -> None:
        """Show no image."""
        self._drop()
        self._robot, self._key = "", ""
        self._say("", None)

    def _ask(self, request: GetObservations | GetImage, text: str) -> None:
        try:
            self._key = self._desk.inquire(request)
        except FleetError as error:
            self._say(str(error), self.image)
            return
        self._say(text, self.image)

    def _answered(self, answer: Answer) -> None:
        if not self._key or answer.order.key != self._key:
            return
        self._key = ""
        if answer.error is not None:
            self._say(tr("No image: {why}", why=answer.error), None)
        elif answer.order.method == GetObservations.method:
            self._found(answer.result or {})
        else:
            self._decode(answer.result or {})

    def _found(self, result: dict) -> None:
        images = (one for one in result.get("observations", []) if one.get("op") == SendImage.__name__)
        newest = next(images, None)
        if newest is None:
            self._say(tr("{robot} has sent no image lately", robot=self._robot), None)
            return
        self._seen = newest
        self._ask(GetImage(newest["observation"]), tr("the image is coming …"))

    def _decode(self, result: dict) -> None:
        self._task = DecodeTask(str(result.get("image", "")))
        self._task.taskCompleted.connect(self._decoded)
        self._task.taskTerminated.connect(self._failed)
        QgsApplication.taskManager().addTask(self._task)

    def _decoded(self) -> None:
        image, self._task = (self._task.image if self._task else None), None
        x, y = self._seen.get("x"), self._seen.get("y")
        placed = isinstance(x, (int, float)) and isinstance(y, (int, float))
        where = tr(" at {x:.1f}, {y:.1f} m", x=x, y=y) if placed else ""
        what = self._seen.get("object") or self._seen.get("label") or ""
        self._say(f"{what}{where}".strip(), image)

    def _failed(self) -> None:
        self._task = None
        self._say(tr("The image that came cannot be read: it is none of a kind that QGIS knows."), None)

    def _drop(self) -> None:
        if self._task is not None:
            self._task.taskCompleted.disconnect(self._decoded)
            self._task.taskTerminated.disconnect(self._failed)
            self._task.cancel()
            self._task = None

    def _say(self, text: str, image: QImage | None) -> None:
        self.text, self.image = text, image
        self.changed.emit()


class DecodeTask(QgsTask):
    """Makes an image of base64, reduced where it is large."""

    def __init__(self, text: str):
        super().__init__(tr("Reading a robot's image"), QgsTask.Flag.CanCancel)
        self._text = text
        self.image: QImage | None = None

    def run(self) -> bool:
        try:
            content = base64.b64decode(self._text, validate=True)
        except (binascii.Error, ValueError):
            return False
        self.image = _image_of(content)
        return self.image is not None


def _image_of(content: bytes) -> QImage | None:
    buffer = QBuffer()
    buffer.setData(QByteArray(content))
    buffer.open(QIODevice.OpenModeFlag.ReadOnly)
    reader = QImageReader(buffer)
    reader.setAutoTransform(True)
    size = reader.size()
    if size.isValid() and max(size.width(), size.height()) > LARGEST_SIDE:
        largest = QSize(LARGEST_SIDE, LARGEST_SIDE)
        reader.setScaledSize(size.scaled(largest, Qt.AspectRatioMode.KeepAspectRatio))
    image = reader.read()
    return None if image.isNull() else image

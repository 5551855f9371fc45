"""Details of the selected robot: sections of values, last image."""

from __future__ import annotations

import base64
import binascii
from collections.abc import Iterable
from typing import Any

from qgis.core import QgsApplication, QgsTask
from qgis.PyQt.QtCore import QBuffer, QByteArray, QIODevice, QObject, QSize, Qt, pyqtSignal
from qgis.PyQt.QtGui import QFont, QImage, QImageReader, QPixmap, QResizeEvent, QShowEvent
from qgis.PyQt.QtWidgets import (
    QAbstractItemView,
    QHBoxLayout,
    QHeaderView,
    QLabel,
    QSizePolicy,
    QToolButton,
    QTreeWidget,
    QTreeWidgetItem,
    QVBoxLayout,
    QWidget,
)

from ...robot_bridge.core.messages.commands import CommandReport, GetCommands
from ...robot_bridge.core.messages.queues import QueueReport
from ...robot_bridge.core.messages.records import GetImage, GetObservations
from ...robot_bridge.core.messages.robots import SendImage
from ..control.fleet_controller import FleetController
from ..control.request_tracker import RequestTracker
from ..gateway_client import state_words
from ..gateway_client.command_cache import PathDeviations, command_in_words, requested_at, state_word
from ..gateway_client.fleet_state import RequestResult
from ..gateway_client.robot_states import RobotView
from ..gateway_client.state_words import task_state_in_words as task_state
from ..layers.site_transform import PositionCrs
from ..ui.errors import FleetError, MapTransformError
from ..ui.language import date_and_time, last_seen_in_words, plain_tip, time_of_day, tr
from ..ui.scheduling import SignallingTask
from ..ui.steady_widgets import ElidedText
from ..ui.tables import shrink_view
from .alarms.board import AlarmBoard, alarm_state_in_words
from .alarms.rules import Alarm

Row = tuple[str, str]
TIMES = ("device_time", "fix_time")
"""Fields in seconds since 1970, by the robot's own clock."""
UNITS = {
    "age": "s",
    "pose_age": "s",
    "latency": "s",
    "x": "m",
    "y": "m",
    "altitude": "m",
    "accuracy": "m",
    "v": "m/s",
    "theta": "rad",
}
MOST = 20
"""Number of commands and tasks that are listed."""


def state_rows(view: RobotView, task: CommandReport | None, off: str, position: str, crs: str) -> list[Row]:
    """Return a robot's current state, in the order that the operator needs."""
    values = view.values
    last_seen = last_seen_in_words(state_words.robot_state_in_words(view), view.age, values.get("link"))
    rows = [(tr("State"), last_seen)]
    doubt = values.get("doubt")
    if doubt:
        rows.append((tr("Why elsewhere"), str(doubt)))
    if position:
        rows.append((tr("Position, {crs}", crs=crs), position))
    rows.append(
        (
            tr("Task"),
            tr("none")
            if task is None
            else f"{command_in_words(task)}: {state_words.COMMAND_STATES[task.state]}",
        )
    )
    if off:
        rows.append((tr("Off path or target"), off))
    if values.get("status") and values["status"] != doubt:
        rows.append((tr("It says"), str(values["status"])))
    return rows


def received_rows(values: dict[str, Any]) -> list[Row]:
    """Return all fields received last by their own names, complete and unrounded."""
    return [(name, _value(name, value)) for name, value in values.items()]


def alarm_rows(alarms: Iterable[Alarm]) -> list[Row]:
    """Return a robot's alarms."""
    return [(time_of_day(alarm.began), f"{alarm.text} ({alarm_state_in_words(alarm)})") for alarm in alarms]


def queue_rows(queue: QueueReport | None) -> list[Row]:
    """Return a robot's queue: its state, then its tasks."""
    if queue is None:
        return []
    rows = [(tr("Queue"), state_words.queue_in_words(queue))]
    for number, task in enumerate(queue.tasks[:MOST], 1):
        rows.append((f"{number}.", f"{state_words.task_in_words(task)}: {task_state(task)}"))
    if len(queue.tasks) > MOST:
        rows.append(("…", tr("and {more} more", more=len(queue.tasks) - MOST)))
    return rows


def command_rows(commands: Iterable[CommandReport]) -> list[Row]:
    """Return a robot's commands, newest first."""
    rows = []
    for report in commands:
        why = report.steps[-1].reason if report.steps else None
        off = "" if report.deviation is None else tr(", {metres:.2f} m off", metres=report.deviation)
        because = f": {why}" if why else ""
        what = f"{command_in_words(report)}: {state_word(report.op, report.state)}{off}{because}"
        text = tr("{command}, by {operator}", command=what, operator=report.operator)
        rows.append((time_of_day(requested_at(report)), text))
    return rows


def _value(name: str, value: Any) -> str:
    if name in TIMES and isinstance(value, (int, float)):
        return f"{value!r} ({date_and_time(value)})"
    unit = f" {UNITS[name]}" if name in UNITS and isinstance(value, (int, float)) else ""
    return f"{value}{unit}"


LOOKED_THROUGH = 200
"""Observations among which the newest image is searched."""
LARGEST_SIDE = 1024
"""Pixels to which a larger image is reduced."""


class LastImage(QObject):
    """The newest image of a robot; ``text`` describes ``image``, or says why there is none."""

    changed = pyqtSignal()

    def __init__(self, requests: RequestTracker, parent: QObject | None = None):
        super().__init__(parent)
        self._requests = requests
        self._robot = ""
        self._key = ""
        self._seen: dict = {}
        self._task: DecodeTask | None = None
        self.image: QImage | None = None
        self.text = ""
        requests.answered.connect(self._answered)

    def ask(self, robot: str) -> None:
        """Request the newest image of ``robot``."""
        if robot != self._robot:
            self.image = None
        self._robot = robot
        self._drop()
        self._ask(GetObservations(robot=robot, limit=LOOKED_THROUGH), tr("looking for an image …"))

    def forget(self) -> None:
        """Show no image."""
        self._drop()
        self._robot, self._key = "", ""
        self._set_image("", None)

    def _ask(self, request: GetObservations | GetImage, text: str) -> None:
        try:
            self._key = self._requests.inquire(request)
        except FleetError as error:
            self._set_image(str(error), self.image)
            return
        self._set_image(text, self.image)

    def _answered(self, answer: RequestResult) -> None:
        if not self._key or answer.order.key != self._key:
            return
        self._key = ""
        if answer.error is not None:
            self._set_image(tr("No image: {why}", why=answer.error), None)
        elif answer.order.method == GetObservations.method:
            self._found(answer.result or {})
        else:
            self._decode(answer.result or {})

    def _found(self, result: dict) -> None:
        images = (one for one in result.get("observations", []) if one.get("op") == SendImage.__name__)
        newest = next(images, None)
        if newest is None:
            self._set_image(tr("{robot} has sent no image lately", robot=self._robot), None)
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
        self._set_image(f"{what}{where}".strip(), image)

    def _failed(self) -> None:
        self._task = None
        self._set_image(tr("The image that came cannot be read: it is none of a kind that QGIS knows."), None)

    def _drop(self) -> None:
        if self._task is not None:
            self._task.taskCompleted.disconnect(self._decoded)
            self._task.taskTerminated.disconnect(self._failed)
            self._task.cancel()
            self._task = None

    def _set_image(self, text: str, image: QImage | None) -> None:
        self.text, self.image = text, image
        self.changed.emit()


class DecodeTask(SignallingTask):
    """Decodes a base64 image, reduced where it is large."""

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


NOW, ALARMS, RECEIVED, QUEUE, COMMANDS = SECTIONS = (
    tr("Now"),
    tr("Alarms"),
    tr("Diagnostics as received"),
    tr("Queue"),
    tr("Commands"),
)
IMAGE_WIDTH = 150
AROUND_NAME = 40
"""Pixels of a row's indentation and margins."""
HISTORY = 200


class RobotDetails(QWidget):
    """Updated twice a second while visible; history and image are requested once for each robot."""

    def __init__(
        self,
        desk: FleetController,
        positions: PositionCrs,
        deviations: PathDeviations,
        parent: QWidget | None = None,
    ):
        super().__init__(parent)
        self.setObjectName("fleet_robot_details")
        self._desk = desk
        self._positions, self._deviations = positions, deviations
        self._turn = desk.beat.turn()
        self._requested_for = ""
        self._alarms: AlarmBoard | None = None
        self._title = ElidedText("fleet_details_title")
        font = QFont(self._title.font())
        font.setBold(True)
        self._title.setFont(font)
        self._tree = _tree()
        self._sections = {name: _section(self._tree, name) for name in SECTIONS}
        self._picture = _Picture()
        self._about = ElidedText("fleet_image_text")
        self._image = LastImage(desk.orders, self)
        self._lay_out()
        self._image.changed.connect(self._show_image)
        desk.selection.changed.connect(self.refresh)
        desk.state.updated.connect(self._pulled)
        self.refresh()

    def show_alarms_of(self, board: AlarmBoard | None) -> None:
        """Show each robot's alarms of ``board`` from now on, None for none."""
        self._alarms = board

    def refresh(self) -> None:
        """Show the details of the robot that was selected last."""
        robot = self._desk.selection.last
        view = None if robot is None else self._desk.state.robots.view(robot, self._desk.clock.steady())
        if robot is None or view is None:
            self._title.setText(tr("Select a robot in the table or on the map"))
            self._requested_for = ""
            self._image.forget()
            self._fill({})
            return
        several = tr("{robot}, selected last of several", robot=robot)
        self._title.setText(robot if len(self._desk.selection.robots) == 1 else several)
        if self.isVisible() and self._requested_for != robot:
            self.ask()
        cache = self._desk.state.commands
        at = (view.report.x, view.report.y) if view.has_pose else None
        off = self._deviations.of(robot, at)
        position = self._position(at)
        self._fill(
            {
                NOW: state_rows(
                    view,
                    cache.task_of(robot),
                    "" if off is None else f"{off:.2f} m",
                    position,
                    self._positions.name,
                ),
                ALARMS: alarm_rows([] if self._alarms is None else self._alarms.of(robot)),
                RECEIVED: received_rows(view.values),
                QUEUE: queue_rows(self._desk.state.queues.get(robot)),
                COMMANDS: command_rows(cache.of(robot, MOST)),
            }
        )

    def ask(self) -> None:
        """Request the robot's last image, and its commands from before this desk connected."""
        robot = self._desk.selection.last
        if robot is None:
            return
        self._requested_for = robot
        self._image.ask(robot)
        try:
            self._desk.orders.inquire(GetCommands(robot, HISTORY))
        except FleetError as error:
            self._about.setText(str(error))

    def showEvent(self, event: QShowEvent) -> None:
        super().showEvent(event)
        self.refresh()

    def _lay_out(self) -> None:
        again = QToolButton()
        again.setObjectName("fleet_details_ask")
        again.setText(tr("Ask again"))
        again.setToolTip(tr("Ask for the robot's last image and its commands again"))
        again.clicked.connect(self.ask)
        head = QHBoxLayout()
        head.addWidget(self._title, 1)
        head.addWidget(again)
        rows = QVBoxLayout(self)
        rows.setContentsMargins(0, 2, 0, 0)
        rows.setSpacing(3)
        rows.addLayout(head)
        body = QHBoxLayout()
        body.setSpacing(6)
        body.addWidget(self._tree, 1)
        body.addWidget(self._picture)
        rows.addLayout(body, 1)
        rows.addWidget(self._about)

    def _pulled(self) -> None:
        if self._turn.is_due() and self.isVisible():
            self.refresh()

    def _position(self, at: tuple[float, float] | None) -> str:
        if at is None:
            return ""
        try:
            return self._positions.place_in_words(*at, self._desk.site_to_canvas.transform())
        except MapTransformError as error:
            return str(error)

    def _fill(self, sections: dict[str, list[Row]]) -> None:
        for name, item in self._sections.items():
            rows = sections.get(name, [])
            item.setHidden(not rows)
            _write(item, rows)
        self._make_room_for([name for name, _ in sections.get(NOW, [])])

    def _make_room_for(self, names: list[str]) -> None:
        """Widen the first column to its longest name, up to a half; it is never made narrower."""
        widest = max(map(self._tree.fontMetrics().horizontalAdvance, names), default=0) + AROUND_NAME
        width = min(widest, self._tree.viewport().width() // 2)
        if width > self._tree.columnWidth(0):
            self._tree.setColumnWidth(0, width)

    def _show_image(self) -> None:
        self._about.setText(self._image.text)
        self._picture.show_image(None if self._image.image is None else QPixmap.fromImage(self._image.image))


class _Picture(QLabel):
    """An image as large as its place, with its aspect ratio kept."""

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("fleet_last_image")
        self.setAlignment(Qt.AlignmentFlag.AlignHCenter | Qt.AlignmentFlag.AlignTop)
        self.setFixedWidth(IMAGE_WIDTH)
        self.setSizePolicy(QSizePolicy.Policy.Fixed, QSizePolicy.Policy.Ignored)
        self._whole: QPixmap | None = None
        self.hide()

    def show_image(self, image: QPixmap | None) -> None:
        """Show ``image``, or nothing."""
        self._whole = image
        self.setVisible(image is not None)
        self._fit()

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._fit()

    def _fit(self) -> None:
        if self._whole is None:
            self.clear()
            return
        kind = Qt.TransformationMode.SmoothTransformation
        self.setPixmap(self._whole.scaled(self.size(), Qt.AspectRatioMode.KeepAspectRatio, kind))


def _tree() -> QTreeWidget:
    tree = QTreeWidget()
    tree.setObjectName("fleet_details")
    tree.setAccessibleName(tr("Robot"))
    tree.setColumnCount(2)
    tree.setHeaderHidden(True)
    tree.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
    tree.setAlternatingRowColors(True)
    tree.setIndentation(12)
    shrink_view(tree)
    tree.header().setStretchLastSection(True)
    tree.header().setSectionResizeMode(0, QHeaderView.ResizeMode.Interactive)
    name = tr("Position, {crs}", crs="EPSG:00000")
    tree.setColumnWidth(0, tree.fontMetrics().horizontalAdvance(name) + AROUND_NAME)
    return tree


def _section(tree: QTreeWidget, name: str) -> QTreeWidgetItem:
    item = QTreeWidgetItem(tree, [name])
    font = QFont(tree.font())
    font.setBold(True)
    item.setFont(0, font)
    item.setFirstColumnSpanned(True)
    item.setExpanded(True)
    return item


def _write(section: QTreeWidgetItem, rows: list[Row]) -> None:
    while section.childCount() > len(rows):
        section.removeChild(section.child(section.childCount() - 1))
    while section.childCount() < len(rows):
        QTreeWidgetItem(section)
    for number, row in enumerate(rows):
        item = section.child(number)
        for column, text in enumerate(row):
            if item.text(column) != text:
                item.setText(column, text)
                item.setToolTip(column, plain_tip(text))

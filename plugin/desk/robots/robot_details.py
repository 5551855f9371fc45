"""All that is known of the selected robot: a list in sections, and its last image."""

from __future__ import annotations

from collections.abc import Callable

from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtGui import QFont, QPixmap, QResizeEvent, QShowEvent
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

from ....robot_bridge.messages import GetCommands
from ...errors import FleetError, PlacementError
from ...language import tr
from ..alarms.alarm import Alarm
from ..desk import Desk
from ..fixed_size import ElidedText
from ..small_views import shrink
from . import detail_rows as rows_of
from .deviations import Deviations
from .last_image import LastImage
from .position_crs import PositionCrs

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
    """Renewed twice a second while somebody sees it; history and image are asked for once for each robot."""

    def __init__(
        self,
        desk: Desk,
        positions: PositionCrs,
        deviations: Deviations,
        parent: QWidget | None = None,
    ):
        super().__init__(parent)
        self.setObjectName("fleet_robot_details")
        self._desk = desk
        self._positions, self._deviations = positions, deviations
        self._turn = desk.beat.turn()
        self._asked_for = ""
        self.alarms_of: Callable[[str], list[Alarm]] = lambda robot: []
        """Returns a robot's alarms."""
        self._title = ElidedText("fleet_details_title")
        font = QFont(self._title.font())
        font.setBold(True)
        self._title.setFont(font)
        self._tree = _tree()
        self._sections = {name: _section(self._tree, name) for name in SECTIONS}
        self._picture = _Picture()
        self._about = ElidedText("fleet_image_text")
        self._image = LastImage(desk, self)
        self._lay_out()
        self._image.changed.connect(self._show_image)
        desk.selection_changed.connect(self.refresh)
        desk.pulled.connect(self._pulled)
        self.refresh()

    def refresh(self) -> None:
        """Show what is known of the robot that was selected last."""
        robot = self._desk.selected
        view = None if robot is None else self._desk.picture.view(robot, self._desk.clock())
        if robot is None or view is None:
            self._title.setText(tr("Select a robot in the table or on the map"))
            self._asked_for = ""
            self._image.forget()
            self._fill({})
            return
        several = tr("{robot}, selected last of several", robot=robot)
        self._title.setText(robot if len(self._desk.selection) == 1 else several)
        if self.isVisible() and self._asked_for != robot:
            self.ask()
        book = self._desk.book
        at = (view.report.x, view.report.y) if view.has_pose else None
        off = self._deviations.of(robot, at)
        position = self._position(at)
        self._fill(
            {
                NOW: rows_of.state_rows(
                    view,
                    book.task_of(robot),
                    "" if off is None else f"{off:.2f} m",
                    position,
                    self._positions.name,
                ),
                ALARMS: rows_of.alarm_rows(self.alarms_of(robot)),
                RECEIVED: rows_of.received_rows(view.told),
                QUEUE: rows_of.queue_rows(self._desk.queues.get(robot)),
                COMMANDS: rows_of.command_rows(book.of(robot, rows_of.MOST)),
            }
        )

    def ask(self) -> None:
        """Ask the gateway for the robot's last image, and for what was asked of it before this desk came."""
        robot = self._desk.selected
        if robot is None:
            return
        self._asked_for = robot
        self._image.ask(robot)
        try:
            self._desk.inquire(GetCommands(robot, HISTORY))
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
        if self._turn.has_come() and self.isVisible():
            self.refresh()

    def _position(self, at: tuple[float, float] | None) -> str:
        if at is None:
            return ""
        try:
            return self._positions.place_in_words(*at, self._desk.placement())
        except PlacementError as error:
            return str(error)

    def _fill(self, sections: dict[str, list[rows_of.Row]]) -> None:
        for name, item in self._sections.items():
            rows = sections.get(name, [])
            item.setHidden(not rows)
            _write(item, rows)
        self._make_room_for([name for name, _ in sections.get(NOW, [])])

    def _make_room_for(self, names: list[str]) -> None:
        """Widen the first column to what its longest name takes, up to a half; it is never made narrower."""
        widest = max(map(self._tree.fontMetrics().horizontalAdvance, names), default=0) + AROUND_NAME
        width = min(widest, self._tree.viewport().width() // 2)
        if width > self._tree.columnWidth(0):
            self._tree.setColumnWidth(0, width)

    def _show_image(self) -> None:
        self._about.setText(self._image.text)
        self._picture.show_image(None if self._image.image is None else QPixmap.fromImage(self._image.image))


class _Picture(QLabel):
    """An image as large as its place, in its own proportions."""

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
    tree.setColumnCount(2)
    tree.setHeaderHidden(True)
    tree.setEditTriggers(QAbstractItemView.EditTrigger.NoEditTriggers)
    tree.setAlternatingRowColors(True)
    tree.setIndentation(12)
    shrink(tree)
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


def _write(section: QTreeWidgetItem, rows: list[rows_of.Row]) -> None:
    while section.childCount() > len(rows):
        section.removeChild(section.child(section.childCount() - 1))
    while section.childCount() < len(rows):
        QTreeWidgetItem(section)
    for number, row in enumerate(rows):
        item = section.child(number)
        for column, text in enumerate(row):
            if item.text(column) != text:
                item.setText(column, text)
                item.setToolTip(column, text)

"""The robots that will be in each other's way, soonest first, and who shall give way."""

from __future__ import annotations

from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtWidgets import QHBoxLayout, QLabel, QSizePolicy, QToolButton, QVBoxLayout, QWidget

from ...robot_bridge.messages import ConflictReport, HoldReport
from ..language import tr
from .colours import DOUBTFUL_STYLE
from .desk import Desk
from .road_board import time_of_day

SHOWN = 3
"""Conflicts that are listed; all of them are in the layer."""


class ConflictPanel(QWidget):
    """Hidden as long as nobody is in anybody's way and nobody waits."""

    def __init__(self, desk: Desk, parent: QWidget | None = None):
        super().__init__(parent)
        self.setObjectName("fleet_conflicts")
        self._desk = desk
        self._rows = QVBoxLayout(self)
        self._rows.setContentsMargins(0, 0, 0, 0)
        self._rows.setSpacing(2)
        desk.roads.conflicts_changed.connect(self._show)
        self._show()

    def _show(self) -> None:
        while self._rows.count():
            self._rows.takeAt(0).widget().deleteLater()
        roads = self._desk.roads.conflicts
        for conflict in roads.conflicts[:SHOWN]:
            self._rows.addWidget(self._row(conflict))
        more = len(roads.conflicts) - SHOWN
        if more > 0:
            self._rows.addWidget(
                _label(
                    tr(
                        "and {more} more: see the layer Conflicts",
                        more=more,
                    ),
                    "fleet_more_conflicts",
                )
            )
        for hold in roads.waiting:
            self._rows.addWidget(_label(_waiting(hold), "fleet_waiting"))
        self.setVisible(bool(roads.conflicts or roads.waiting))

    def _row(self, conflict: ConflictReport) -> QWidget:
        row = QWidget()
        columns = QHBoxLayout(row)
        columns.setContentsMargins(0, 0, 0, 0)
        columns.setSpacing(4)
        columns.addWidget(_label(_in_words(conflict), "fleet_conflict"), 1)
        for robot, other in ((conflict.robot, conflict.other), (conflict.other, conflict.robot)):
            button = QToolButton()
            button.setObjectName(f"fleet_give_way_{robot}")
            button.setText(tr("{robot} gives way", robot=robot))
            button.setToolTip(
                tr(
                    "{robot} waits for {other} or takes another way, whichever gets it there sooner",
                    robot=robot,
                    other=other,
                )
            )
            button.clicked.connect(
                lambda _=False, robot=robot, other=other: self._desk.resolve_conflict(robot, other)
            )
            columns.addWidget(button)
        return row


def _in_words(conflict: ConflictReport) -> str:
    where = tr("at {x:.0f}, {y:.0f} m", x=conflict.x, y=conflict.y)
    return f"{time_of_day(conflict.nearest_at)}  {conflict.robot} × {conflict.other}: {conflict.kind} {where}"


def _waiting(hold: HoldReport) -> str:
    return tr(
        "{robot} waits for {other}, until {time_of_day} at the earliest",
        robot=hold.robot,
        other=hold.other,
        time_of_day=time_of_day(hold.until),
    )


def _label(text: str, name: str) -> QLabel:
    label = QLabel(text)
    label.setObjectName(name)
    label.setTextFormat(Qt.TextFormat.PlainText)
    label.setWordWrap(True)
    label.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Preferred)
    label.setStyleSheet(DOUBTFUL_STYLE if name == "fleet_conflict" else "")
    return label

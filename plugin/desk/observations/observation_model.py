"""Observations as a list: what, by whom, when, in which state, with its image."""

from __future__ import annotations

from typing import Any

from qgis.PyQt.QtCore import QAbstractListModel, QModelIndex, QObject, QSize, Qt
from qgis.PyQt.QtGui import QColor, QIcon, QPixmap

from ....robot_bridge.messages import ObservationReport
from ...language import tr
from ..wall_clock import time_of_day
from .observation_layer import COLOURS, STATES
from .thumbnails import Thumbnails

NUMBER = Qt.ItemDataRole.UserRole
ICON = QSize(56, 42)


class ObservationModel(QAbstractListModel):
    """The observations in the order that they are to be looked at; ``reports`` are its rows."""

    def __init__(self, thumbnails: Thumbnails, parent: QObject | None = None):
        super().__init__(parent)
        self._thumbnails = thumbnails
        self._icons: dict[int, QIcon] = {}
        self.reports: list[ObservationReport] = []

    def show(self, reports: list[ObservationReport]) -> None:
        """Take over the rows."""
        if reports == self.reports:
            return
        if [one.observation for one in reports] == [one.observation for one in self.reports]:
            self.reports = reports
            self.dataChanged.emit(self.index(0), self.index(len(reports) - 1))
            return
        self.beginResetModel()
        self.reports = reports
        known = {one.observation for one in reports}
        self._icons = {number: icon for number, icon in self._icons.items() if number in known}
        self.endResetModel()

    def row_of(self, number: int) -> int | None:
        """Return the row of an observation, None when it is not shown."""
        return next((row for row, one in enumerate(self.reports) if one.observation == number), None)

    def picture_came(self, number: int) -> None:
        """Show the picture that was made of an observation's image."""
        row = self.row_of(number)
        if row is not None:
            self.dataChanged.emit(self.index(row), self.index(row))

    def rowCount(self, parent: QModelIndex = QModelIndex()) -> int:  # noqa: B008
        return 0 if parent.isValid() else len(self.reports)

    def data(self, index: QModelIndex, role: int = Qt.ItemDataRole.DisplayRole) -> Any:
        if not index.isValid():
            return None
        one = self.reports[index.row()]
        if role == Qt.ItemDataRole.DisplayRole:
            return in_words(one)
        if role == Qt.ItemDataRole.DecorationRole:
            return self._icon(one)
        if role == Qt.ItemDataRole.ToolTipRole:
            return tr(
                "Observation {number} at {x:.2f}, {y:.2f} m; double click goes there",
                number=one.observation,
                x=one.x,
                y=one.y,
            )
        return one.observation if role == NUMBER else None

    def _icon(self, one: ObservationReport) -> QIcon:
        number = one.observation
        file = self._thumbnails.file(number)
        if not file:
            return _patch(one.state.value)
        if number not in self._icons:
            self._icons[number] = QIcon(file)
        return self._icons[number]


def in_words(one: ObservationReport) -> str:
    """Return two lines on an observation."""
    kind = tr("image") if one.media_type else one.semantics or one.label or tr("object")
    if one.doubts is not None:
        kind = tr("not there any more: {what}", what=one.label or one.doubts)
    state = STATES[one.state]
    if one.reviewed_by:
        state = tr("{state} by {by}", state=state, by=one.reviewed_by)
    return f"{one.object} · {kind}\n{one.robot}, {time_of_day(one.received_at)} · {state}"


def _patch(state: str) -> QIcon:
    picture = QPixmap(ICON)
    picture.fill(QColor(*(int(part) for part in COLOURS[state].split(","))))
    return QIcon(picture)

"""The robots that will be in each other's way, soonest first, and who shall give way."""

from __future__ import annotations

from qgis.PyQt.QtCore import QSize
from qgis.PyQt.QtWidgets import QHBoxLayout, QSizePolicy, QToolButton, QVBoxLayout, QWidget

from ...robot_bridge.messages import ConflictReport, HoldReport
from ..language import first_of, tr
from .colours import DOUBTFUL_STYLE
from .desk import Desk
from .state_words import MEETINGS
from .wall_clock import time_of_day
from .whole_text import WholeText

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
        self._pairs: list[tuple[str, str]] = []
        self._rows_shown: list[QWidget] = []
        self._labels: list[WholeText] = []
        self._rest = _label("fleet_waiting")
        self._rows.addWidget(self._rest)
        desk.roads.conflicts_changed.connect(self._show)
        self._show()

    def sizeHint(self) -> QSize:
        # As wide as its buttons. A panel that nobody has dragged yet is as wide as its parts wish to be: by a
        # text on one line it would push the map aside, under the mouse of who is about to click there.
        return QSize(self.minimumSizeHint().width(), super().sizeHint().height())

    def _show(self) -> None:
        roads = self._desk.roads.conflicts
        shown = roads.conflicts[:SHOWN]
        pairs = [(conflict.robot, conflict.other) for conflict in shown]
        if pairs != self._pairs:
            self._lay_out(pairs)
        for label, conflict in zip(self._labels, shown, strict=True):
            label.setText(_in_words(conflict))
        more = len(roads.conflicts) - SHOWN
        told = [tr("and {more} more: see the layer Conflicts", more=more)] if more > 0 else []
        told += first_of([_waiting(hold) for hold in roads.waiting], SHOWN)
        self._rest.setText("\n".join(told))
        self._rest.setVisible(bool(self._rest.text()))
        self.setVisible(bool(roads.conflicts or roads.waiting))

    def _lay_out(self, pairs: list[tuple[str, str]]) -> None:
        """Make a row for each pair. Rows that stay are left alone: somebody may be pressing a button."""
        for row in self._rows_shown:
            self._rows.removeWidget(row)
            row.deleteLater()
        self._pairs, self._labels = pairs, []
        self._rows_shown = [self._row(*pair) for pair in pairs]
        for at, row in enumerate(self._rows_shown):
            self._rows.insertWidget(at, row)

    def _row(self, one: str, another: str) -> QWidget:
        row = QWidget()
        columns = QHBoxLayout(row)
        columns.setContentsMargins(0, 0, 0, 0)
        columns.setSpacing(4)
        label = _label("fleet_conflict")
        label.setStyleSheet(DOUBTFUL_STYLE)
        self._labels.append(label)
        columns.addWidget(label, 1)
        for robot, other in ((one, another), (another, one)):
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
    kind = MEETINGS.get(conflict.kind, conflict.kind)
    return f"{time_of_day(conflict.nearest_at)}  {conflict.robot} × {conflict.other}: {kind} {where}"


def _waiting(hold: HoldReport) -> str:
    return tr(
        "{robot} waits for {other}, until {time_of_day} at the earliest",
        robot=hold.robot,
        other=hold.other,
        time_of_day=time_of_day(hold.until),
    )


def _label(name: str) -> WholeText:
    label = WholeText()
    label.setObjectName(name)
    label.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Preferred)
    return label

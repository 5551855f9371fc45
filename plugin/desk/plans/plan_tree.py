"""The plan as a table of robots with their stops: dragged, moved by keys, taken out."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from qgis.PyQt.QtCore import QPoint, Qt, pyqtSignal
from qgis.PyQt.QtGui import QColor, QDropEvent, QIcon, QKeyEvent, QPixmap
from qgis.PyQt.QtWidgets import QAbstractItemView, QMenu, QTreeWidget, QTreeWidgetItem, QWidget

from ....robot_bridge.assignment.plan import Plan
from ....robot_bridge.messages import TaskState
from ...language import tr, tr_count
from ..colours import WRONG, for_letters
from ..column_heads import fit_heads
from .draft import Draft
from .plan_rows import NOT_DONE, StopRow, clock, colour_of, end_of, place_for

HEADS = (tr("Robot, stop"), tr("Arrives"), tr("State"), tr("Off [m]"))
_NAME = Qt.ItemDataRole.UserRole
_KINDS = {"place": "", "collect": tr("collect "), "store": tr("store "), "home": tr("end at ")}


class PlanTree(QTreeWidget):
    """Shows a draft or the plan that is driven. Changes are asked for, and shown when they are made."""

    move_wanted = pyqtSignal(str, str, int, int)
    """A target to another robot, trip and place."""
    remove_wanted = pyqtSignal(str)
    place_wanted = pyqtSignal(float, float)
    """A stop was double clicked: where it is, in the site frame."""

    def __init__(self, parent: QWidget | None = None):
        super().__init__(parent)
        self.setObjectName("fleet_plan_tree")
        self.setHeaderLabels(HEADS)
        self.setDragDropMode(QAbstractItemView.DragDropMode.InternalMove)
        self.setContextMenuPolicy(Qt.ContextMenuPolicy.CustomContextMenu)
        self.customContextMenuRequested.connect(self._offer)
        self.itemDoubleClicked.connect(self._go_there)
        self.setToolTip(
            tr("Drag a cone to another place or robot; Alt+Up and Alt+Down move it, Del takes it out")
        )
        for column, width in enumerate((142, 66, 84, 44)):
            self.setColumnWidth(column, width)
        fit_heads(self)
        self.setIndentation(12)
        self._plan: Plan | None = None
        self._editable = False

    def show_plan(
        self,
        draft: Draft | None,
        rows: Mapping[str, Sequence[StopRow]],
        began_at: float | None = None,
        *,
        editable: bool,
    ) -> None:
        """Show a plan by the rows of each robot; it was begun at ``began_at``, if it is driven."""
        self._editable = editable
        if draft is None:
            self._plan = None
            self.clear()
            return
        if draft.plan is not self._plan:
            self._plan = draft.plan
            self._build(draft, rows)
        for k, one in enumerate(draft.plan.robots):
            top = self.topLevelItem(k)
            top.setText(1, clock(one.end_s, began_at) if one.stops or one.done else "")
            top.setText(2, _robot_in_words(rows[one.robot.id], one.lost))
            for child, row in enumerate(rows[one.robot.id]):
                _fill(top.child(child), row)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        target = self._target()
        moves = {Qt.Key.Key_Up: -1, Qt.Key.Key_Down: 1}
        if target and event.key() == Qt.Key.Key_Delete:
            self.remove_wanted.emit(target)
        elif target and event.key() in moves and event.modifiers() & Qt.KeyboardModifier.AltModifier:
            self._move_by(target, moves[event.key()])
        else:
            super().keyPressEvent(event)

    def dropEvent(self, event: QDropEvent) -> None:
        """Ask for the cone that is dragged to be where it is dropped; nothing is moved here."""
        onto = self.itemAt(_place(event))
        below = self.dropIndicatorPosition() != QAbstractItemView.DropIndicatorPosition.AboveItem
        target = self._target()
        event.setDropAction(Qt.DropAction.IgnoreAction)
        event.accept()
        if target and onto is not None:
            self._want(target, onto, after=below)

    def give_to(self, robot: str) -> None:
        """Ask for the selected cone to be the last one of ``robot``."""
        target = self._target()
        if target and self._plan is not None:
            self._emit(target, end_of(self._plan, target, robot))

    def _want(self, target: str, onto: QTreeWidgetItem, *, after: bool) -> None:
        name = onto.data(0, _NAME)
        if onto.parent() is None:
            self._emit(target, end_of(self._plan, target, name))
        elif name:
            self._emit(target, place_for(self._plan, target, name, after=after))

    def _move_by(self, target: str, step: int) -> None:
        item = self.currentItem()
        other = item.parent().child(item.parent().indexOfChild(item) + step)
        while other is not None and not other.data(0, _NAME):
            other = item.parent().child(item.parent().indexOfChild(other) + step)
        if other is not None:
            self._want(target, other, after=step > 0)

    def _emit(self, target: str, place: tuple[str, int, int] | None) -> None:
        if place is not None:
            self.move_wanted.emit(target, *place)

    def _target(self) -> str:
        """Return the cone that is selected and may be changed, else nothing."""
        item = self.currentItem()
        if not self._editable or item is None or item.parent() is None:
            return ""
        return item.data(0, _NAME) or ""

    def _offer(self, at: QPoint) -> None:
        target = self._target()
        if not target or self._plan is None:
            return
        menu = QMenu(self)
        for one in self._plan.robots:
            if not one.lost:
                name = one.robot.id
                menu.addAction(tr("Give to {name}", name=name), lambda name=name: self.give_to(name))
        menu.addAction(tr("Take out"), lambda: self.remove_wanted.emit(target))
        menu.exec(self.viewport().mapToGlobal(at))

    def _go_there(self, item: QTreeWidgetItem) -> None:
        place = item.data(0, _NAME + 1)
        if place is not None:
            self.place_wanted.emit(*place)

    def _build(self, draft: Draft, rows: Mapping[str, Sequence[StopRow]]) -> None:
        chosen = self._target()
        self.clear()
        for one in draft.plan.robots:
            top = QTreeWidgetItem([one.robot.id])
            top.setData(0, _NAME, one.robot.id)
            top.setIcon(0, _swatch(colour_of(draft.plan, one.robot.id)))
            top.setFlags(top.flags() & ~Qt.ItemFlag.ItemIsDragEnabled)
            self.addTopLevelItem(top)
            for row in rows[one.robot.id]:
                child = QTreeWidgetItem()
                child.setData(0, _NAME, row.stop.id if row.stop.is_target else "")
                child.setData(0, _NAME + 1, (row.stop.x, row.stop.y))
                if not row.stop.is_target:
                    child.setFlags(child.flags() & ~Qt.ItemFlag.ItemIsDragEnabled)
                top.addChild(child)
                if chosen and row.stop.id == chosen:
                    self.setCurrentItem(child)
            top.setExpanded(True)


def _fill(item: QTreeWidgetItem, row: StopRow) -> None:
    off = "" if row.deviation is None else f"{row.deviation:.2f}"
    name = f"{row.number}  {_KINDS[row.stop.kind]}{row.stop.id}"
    for column, text in enumerate((name, row.arrives, row.in_words(), off)):
        if item.text(column) != text:
            item.setText(column, text)
    if row.state in NOT_DONE:
        item.setForeground(2, for_letters(WRONG))


def _robot_in_words(rows: Sequence[StopRow], lost: bool) -> str:
    cones = [row for row in rows if row.stop.is_target]
    done = sum(row.state is TaskState.DONE for row in cones)
    text = (
        tr_count(len(cones), "{done} of 1 cone", "{done} of %n cones", done=done)
        if done
        else tr_count(len(cones), "1 cone", "%n cones")
    )
    return tr("LOST, {text}", text=text) if lost else text


def _place(event: QDropEvent) -> QPoint:
    """Return where in the view ``event`` happens; Qt 6 has no pos(), and Qt 5 no position()."""
    if hasattr(event, "position"):
        return event.position().toPoint()
    return event.pos()  # type: ignore[attr-defined]


def _swatch(colour: str) -> QIcon:
    pixmap = QPixmap(12, 12)
    pixmap.fill(QColor(colour))
    return QIcon(pixmap)

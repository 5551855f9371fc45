"""Conflicts between robots, and their possible resolutions."""

from __future__ import annotations

from collections.abc import Callable

from qgis.PyQt.QtCore import QObject, Qt, QTimer, pyqtSignal
from qgis.PyQt.QtGui import QHideEvent, QShowEvent
from qgis.PyQt.QtWidgets import (
    QAbstractItemView,
    QGridLayout,
    QListWidget,
    QListWidgetItem,
    QVBoxLayout,
    QWidget,
)

from ...robot_bridge.core.messages.roads import (
    ConflictReport,
    GetWaysOut,
    HoldReport,
    WayOut,
    ways_out_report,
)
from ..control.fleet_controller import FleetController
from ..control.request_tracker import RequestTracker
from ..gateway_client.fleet_state import FleetState, RequestResult
from ..gateway_client.state_words import MEETINGS
from ..ui.errors import NotSentError
from ..ui.language import plain_tip, time_of_day, tr
from ..ui.steady_widgets import ElidedButton, ElidedText
from ..ui.tables import shrink_view

Pair = tuple[str, str]

ASK_EVERY = 3.0
"""Seconds: robots drive on, and an option may vanish."""
ANSWERED_WITHIN = 10.0
"""Seconds after which another query is sent, though the last one was not answered."""


class ResolutionQuery(QObject):
    """Queries one pair at a time. The options of a pair are forgotten when another one is watched."""

    changed = pyqtSignal()

    def __init__(self, requests: RequestTracker, state: FleetState, parent: QObject | None = None):
        super().__init__(parent)
        self._requests, self._state = requests, state
        self._pair: Pair | None = None
        self._kind = ""
        self._ways: dict[tuple[str, str], WayOut] = {}
        self._key: str | None = None
        self._requested_at = 0.0
        self.why_not = ""
        """Why the options are unknown; empty where they are known or were just queried."""
        state.updated.connect(self._ask_again)
        requests.answered.connect(self._answered)

    def watch(self, pair: Pair | None, kind: str = "") -> None:
        """Query ``pair`` from now on, None for no pair; at once where the kind of conflict has changed."""
        if pair == self._pair:
            if kind != self._kind:
                self._kind = kind
                self._ask()
            return
        self._pair, self._kind, self._key, self.why_not = pair, kind, None, ""
        self._ways.clear()
        self._ask()
        self.changed.emit()

    def way(self, robot: str, how: str) -> WayOut | None:
        """Return an option of a robot: ``how`` is ``give way`` or ``aside``; None where that is not known."""
        return self._ways.get((robot, how))

    def _ask_again(self) -> None:
        waits = ASK_EVERY if self._key is None else ANSWERED_WITHIN
        if self._pair is not None and self._state.clock.steady() - self._requested_at >= waits:
            self._ask()

    def _ask(self) -> None:
        if self._pair is None:
            return
        self._requested_at = self._state.clock.steady()
        try:
            self._key = self._requests.inquire(GetWaysOut(*self._pair))
        except NotSentError as error:
            self._key = None
            self._set_ways({}, str(error))

    def _answered(self, answer: RequestResult) -> None:
        if self._key is None or answer.order.key != self._key:
            return
        self._key = None
        if answer.error is not None:
            self._set_ways({}, answer.error)
            return
        try:
            found = ways_out_report(answer.result or {}).ways
        except (KeyError, TypeError, ValueError):
            self._set_ways({}, tr("the gateway's answer cannot be read; it may be older than this plugin"))
            return
        self._set_ways({(way.robot, way.how): way for way in found}, "")

    def _set_ways(self, ways: dict[tuple[str, str], WayOut], why_not: str) -> None:
        if (ways, why_not) != (self._ways, self.why_not):
            self._ways, self.why_not = ways, why_not
            self.changed.emit()


OVER_MS = 3000
"""Time for which the row of an ended conflict stays, disabled: rows below it do not move up under
the mouse."""
PAIR = Qt.ItemDataRole.UserRole
NONE = tr("No robot is in another one's way.")
GIVE_WAY, ASIDE = "give way", "aside"
CHOOSE_FIRST = tr("Choose a conflict in the list first.")
NOT_KNOWN_YET = tr("the gateway is being asked")


class ConflictPanel(QWidget):
    """A row for each conflict, and buttons for the selected one: a column for each of both robots.

    An option that is not available is disabled, with the reason as its tip and as a text; buttons never move.

    A conflict keeps its row until it is over, whatever becomes more urgent meanwhile, and the buttons are
    always for the conflict that the operator chose; the first one is chosen automatically where none was.
    """

    counted = pyqtSignal(int)
    """The number of conflicts."""

    def __init__(self, desk: FleetController, parent: QWidget | None = None):
        super().__init__(parent)
        self.setObjectName("fleet_conflicts")
        self._desk = desk
        self._conflicts: dict[Pair, ConflictReport] = {}
        self._list = _conflict_list()
        self._list.currentItemChanged.connect(lambda *_: self._show_buttons())
        self._ways = ResolutionQuery(desk.orders, desk.state, self)
        self._give_ways = [self._button(lambda k=k: self._give_way(k)) for k in (0, 1)]
        self._asides = [self._button(lambda k=k: self._send_aside(k)) for k in (0, 1)]
        self._stops = [self._button(lambda k=k: self._stop(k)) for k in (0, 1)]
        self._reasons = ElidedText("fleet_conflict_reasons")
        self._over = QTimer(self)
        self._over.setSingleShot(True)
        self._over.setInterval(OVER_MS)
        self._over.timeout.connect(self._drop_over)
        self._lay_out()
        self._ways.changed.connect(self._show_buttons)
        desk.state.conflicts_changed.connect(self._show)
        self._show()

    @property
    def chosen(self) -> ConflictReport | None:
        """The conflict that the buttons are about; None for none."""
        item = self._list.currentItem()
        return None if item is None else self._conflicts.get(item.data(PAIR))

    def texts(self) -> list[str]:
        """Return the texts of the rows."""
        return [self._list.item(row).text() for row in range(self._list.count())]

    def _lay_out(self) -> None:
        grid = QGridLayout()
        grid.setSpacing(4)
        for column, buttons in enumerate((self._give_ways, self._asides, self._stops)):
            for row, button in enumerate(buttons):
                grid.addWidget(button, row, column)
                grid.setColumnStretch(column, 1)
        rows = QVBoxLayout(self)
        rows.setContentsMargins(0, 2, 0, 0)
        rows.setSpacing(4)
        rows.addLayout(grid)
        rows.addWidget(self._reasons)
        rows.addWidget(self._list, 1)

    def showEvent(self, event: QShowEvent) -> None:
        super().showEvent(event)
        self._watch_chosen()

    def hideEvent(self, event: QHideEvent) -> None:
        super().hideEvent(event)
        # The panel is not visible: the gateway need not compute it.
        self._ways.watch(None)

    def _button(self, pressed: Callable[[], None]) -> ElidedButton:
        button = ElidedButton("")
        button.clicked.connect(lambda _=False: pressed())
        return button

    def _show(self) -> None:
        roads = self._desk.state.conflicts
        self._conflicts = {}
        for one in roads.conflicts:
            # If the same robots have two conflicts, take the sooner one, which comes first.
            self._conflicts.setdefault(_pair_of(one), one)
        self._drop_waiting()
        listed = self._renew_rows()
        for pair, conflict in self._conflicts.items():
            if pair not in listed:
                item = QListWidgetItem(_in_words(conflict), self._list)
                item.setData(PAIR, pair)
                item.setToolTip(plain_tip(item.text()))
        self._list_waiting(roads.waiting)
        if not self._list.count():
            self._add_note(NONE)
        if self._list.currentItem() is None:
            self._choose_first()
        self._show_buttons()
        self.counted.emit(len(self._conflicts))

    def _renew_rows(self) -> set[Pair]:
        """Update the rows of conflicts, and return their pairs."""
        listed = set()
        for item in self._items():
            pair = item.data(PAIR)
            conflict = self._conflicts.get(pair)
            if conflict is None:
                item.setFlags(Qt.ItemFlag.NoItemFlags)
                item.setText(tr("{robot} × {other}: over", robot=pair[0], other=pair[1]))
                if not self._over.isActive():
                    self._over.start()
            else:
                listed.add(pair)
                item.setFlags(Qt.ItemFlag.ItemIsEnabled | Qt.ItemFlag.ItemIsSelectable)
                item.setText(_in_words(conflict))
            item.setToolTip(plain_tip(item.text()))
        return listed

    def _drop_over(self) -> None:
        """Remove the rows of conflicts that are over."""
        for item in self._items():
            if item.data(PAIR) not in self._conflicts:
                self._list.takeItem(self._list.row(item))
        if not any(item.data(PAIR) in self._conflicts for item in self._list.selectedItems()):
            self._list.setCurrentItem(None)
        self._show()

    def _drop_waiting(self) -> None:
        for row in reversed(range(self._list.count())):
            if self._list.item(row).data(PAIR) is None:
                self._list.takeItem(row)

    def _list_waiting(self, waiting: list[HoldReport]) -> None:
        for hold in waiting:
            self._add_note(_waiting(hold))

    def _add_note(self, text: str) -> None:
        note = QListWidgetItem(text, self._list)
        note.setFlags(Qt.ItemFlag.ItemIsEnabled)
        note.setToolTip(plain_tip(text))

    def _items(self) -> list[QListWidgetItem]:
        rows = [self._list.item(row) for row in range(self._list.count())]
        return [item for item in rows if item.data(PAIR) is not None]

    def _choose_first(self) -> None:
        first = next((item for item in self._items() if item.data(PAIR) in self._conflicts), None)
        if first is not None:
            self._list.setCurrentItem(first)

    def _watch_chosen(self) -> None:
        chosen = self.chosen
        if chosen is None or not self.isVisible():
            self._ways.watch(None)
        else:
            self._ways.watch(_pair_of(chosen), chosen.kind)

    def _show_buttons(self) -> None:
        self._watch_chosen()
        chosen = self.chosen
        pair = ("", "") if chosen is None else _pair_of(chosen)
        reasons = []
        for column, robot, other in zip((0, 1), pair, reversed(pair), strict=True):
            self._give_ways[column].setObjectName(f"fleet_give_way_{robot}")
            self._asides[column].setObjectName(f"fleet_aside_{robot}")
            self._stops[column].setObjectName(f"fleet_stop_{robot}")
            if chosen is None:
                self._disable(column)
                continue
            reasons += [self._show_give_way(column, robot, other), self._show_aside(column, robot, other)]
            self._stops[column].setEnabled(True)
            self._stops[column].set_words(
                tr("Stop {robot}", robot=robot),
                tr("{robot} is paused: it stands, and keeps what it is doing for later", robot=robot),
            )
        # Both columns may have the same reason.
        self._reasons.setText("\n".join(dict.fromkeys(reason for reason in reasons if reason)))

    def _disable(self, column: int) -> None:
        words = (
            (self._give_ways, tr("Give way")),
            (self._asides, tr("Send aside")),
            (self._stops, tr("Stop")),
        )
        for buttons, text in words:
            buttons[column].setEnabled(False)
            buttons[column].set_words(text, CHOOSE_FIRST)

    def _show_give_way(self, column: int, robot: str, other: str) -> str:
        """Show whether a robot can give way; return why not. If unknown, pressing the button asks for it."""
        way = self._ways.way(robot, GIVE_WAY)
        tip = tr(
            "{robot} waits for {other} or takes another way, whichever gets it there sooner",
            robot=robot,
            other=other,
        )
        button = self._give_ways[column]
        button.setEnabled(way is None or way.possible)
        button.set_words(tr("{robot} gives way", robot=robot), tip if way is None else way.text)
        return "" if way is None or way.possible else way.text

    def _show_aside(self, column: int, robot: str, other: str) -> str:
        """Show whether a robot can go aside, and return why not."""
        way = self._ways.way(robot, ASIDE)
        possible = way is not None and way.possible
        why_not = "" if possible else self._why_not_aside(robot, way)
        tip = why_not
        if way is not None and possible:
            tip = tr("{text}; the route is shown first, and sent as any other", text=way.text)
        self._asides[column].setEnabled(possible)
        self._asides[column].set_words(tr("Send {robot} aside", robot=robot), tip)
        return why_not

    def _why_not_aside(self, robot: str, way: WayOut | None) -> str:
        if way is not None:
            return way.text
        why = self._ways.why_not or NOT_KNOWN_YET
        return tr("Nobody can be sent aside: {why}", why=why)

    def _give_way(self, which: int) -> None:
        chosen = self.chosen
        if chosen is not None:
            pair = _pair_of(chosen)
            self._desk.resolve_conflict(pair[which], pair[1 - which])

    def _send_aside(self, which: int) -> None:
        chosen = self.chosen
        way = None if chosen is None else self._ways.way(_pair_of(chosen)[which], ASIDE)
        if way is not None and way.possible:
            self._desk.propose_route(way.robot, way.points)

    def _stop(self, which: int) -> None:
        chosen = self.chosen
        if chosen is not None:
            self._desk.pause_robots([_pair_of(chosen)[which]])


def _pair_of(conflict: ConflictReport) -> Pair:
    """Return the robots by name: the order in reports changes with the kind of conflict.

    In that order, the buttons of one robot would suddenly become the other's.
    """
    first, second = sorted((conflict.robot, conflict.other))
    return first, second


def _conflict_list() -> QListWidget:
    view = QListWidget()
    view.setObjectName("fleet_conflict_list")
    view.setAccessibleName(tr("Conflicts"))
    view.setSelectionMode(QAbstractItemView.SelectionMode.SingleSelection)
    view.setAlternatingRowColors(True)
    view.setUniformItemSizes(True)
    shrink_view(view)
    return view


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

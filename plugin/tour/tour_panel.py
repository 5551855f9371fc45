"""The tour: its panel, its steps and its menu entry."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from qgis.core import Qgis, QgsSettings
from qgis.gui import QgisInterface, QgsMessageBarItem
from qgis.PyQt import sip
from qgis.PyQt.QtCore import QObject, QPoint, QRect, Qt, QTimer, pyqtSignal
from qgis.PyQt.QtGui import QColor, QIcon, QKeySequence, QMouseEvent, QPainter, QPaintEvent, QPen
from qgis.PyQt.QtWidgets import (
    QAction,
    QFrame,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QShortcut,
    QVBoxLayout,
    QWidget,
)

from ..control.messages import MessageLabel
from ..gateway_client.connection_status import ConnectionPhase, OperatorCredentials
from ..panel.connection_panel import URL_KEY
from ..panel.window import FleetWindow
from ..settings.profile import GatewayConnection
from ..ui.dialogs import push_button
from ..ui.errors import FleetError
from ..ui.glyphs import painting
from ..ui.language import tr
from .practice_fleet import PracticeFleet

PROJECT = "project"
FLEET = "fleet"


@dataclass(frozen=True)
class TourStep:
    """One page of the tour.

    ``target`` is the object name of the widget that it points at. ``offer`` is the action of its button, and
    ``button`` the button's text. ``practice`` is shown only while the desk is connected to the practice
    fleet, as it asks for actions that would move or stop real robots on another one.
    """

    title: str
    text: str
    target: str = ""
    offer: str = ""
    button: str = ""
    practice: str = ""


STEPS = (
    TourStep(
        tr("Five minutes with a practice fleet"),
        tr(
            "The tour needs no network: a gateway and three simulated robots run on this computer, and "
            "nothing real moves. Next and Back lead on, Esc closes. It is in the menu Plugins > Fleet "
            "Supervisor > Tour."
        ),
    ),
    TourStep(
        tr("The site"),
        tr(
            "A site is an ordinary QGIS project: an orthophoto, roads, obstacles, each layer with a role. "
            "Open the sample site; QGIS asks first if your own project is not saved."
        ),
        offer=PROJECT,
        button=tr("Open the sample site"),
    ),
    TourStep(
        tr("The link"),
        tr(
            "Here stand the gateway's address and your name, which every log shows. For a real fleet write "
            "them and press Connect. For the tour, start the practice fleet: it connects by itself."
        ),
        "fleet_connection_panel",
        FLEET,
        tr("Start the practice fleet"),
    ),
    TourStep(
        tr("The robots"),
        tr(
            "Each robot has a row: its state, its task, its battery, and how old its last message is. A "
            "robot that falls silent is stale, then lost; it stays on the map, marked."
        ),
        "fleet_robot_table",
        practice=tr("Click r1: it is selected on the map, too."),
    ),
    TourStep(
        tr("The map"),
        tr(
            "An arrow shows where a robot heads, its colour and shape the state. Hold the mouse over one "
            "for its card; with Select robot a click selects, a rectangle selects several, a double click "
            "goes there."
        ),
        "fleet_select_button",
    ),
    TourStep(
        tr("Send a robot"),
        tr(
            "Cone target, a click on the map, Enter: that sends the selected robot. Before that it is a "
            "draft, checked against the site; Esc takes it away, and nothing was sent."
        ),
        "fleet_cone_target_button",
        practice=tr("Try it: press Cone target, click on the road near r1, then Enter."),
    ),
    TourStep(
        tr("What became of it"),
        tr(
            "Every command is here with each of its steps: queued, delivered, acknowledged, reached; or "
            "why it failed. A double click shows its place on the map."
        ),
        "fleet_command_log",
    ),
    TourStep(
        tr("Stop"),
        tr(
            "Abort robot: the selected robots give up their task. ABORT ALL: every robot does. EMERGENCY "
            "STOP (F10): every robot stops now, and none can be sent anywhere until a supervisor clears it."
        ),
        "fleet_emergency_stop_button",
        practice=tr("Try it: only practice robots stop. Then clear it in the red banner."),
    ),
    TourStep(
        tr("That was the tour"),
        tr(
            "Closing it ends the practice fleet. What else the desk does is in the operator's guide, "
            "docs/operator.md; how real robots are connected in docs/integrator.md."
        ),
    ),
)


LOOK_MS = 50
"""Interval of checks whether its widget has moved: docks are dragged and tabs are changed."""
MARGIN = 4
COLOUR = QColor("#FF8F00")


class Spotlight(QWidget):
    """Covers the whole window, transparent for mouse and focus, and paints only the frame."""

    def __init__(self, window: QWidget):
        super().__init__(window)
        self.setObjectName("fleet_tour_spotlight")
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self._target: QWidget | None = None
        self.framed = QRect()
        self._clock = QTimer(self)
        self._clock.timeout.connect(self._poll)

    def point_at(self, name: str) -> None:
        """Frame the widget of that object name; nothing for an empty name or a missing widget."""
        self._target = self.parentWidget().findChild(QWidget, name) if name else None
        if self._target is not None:
            self._target.destroyed.connect(self._forget)
            self._clock.start(LOOK_MS)
            self.show()
        else:
            self._clock.stop()
            self.hide()
        self._poll()

    def paintEvent(self, event: QPaintEvent) -> None:
        if not self.framed.isNull():
            with painting(self) as painter:
                painter.setRenderHint(QPainter.RenderHint.Antialiasing)
                painter.setPen(QPen(COLOUR, 3))
                painter.drawRoundedRect(self.framed, 5, 5)

    def _forget(self) -> None:
        self._target = None

    def _poll(self) -> None:
        window = self.parentWidget()
        self.setGeometry(window.rect())
        framed = QRect()
        if self._target is not None and self._target.isVisible():
            corner = self._target.mapTo(window, QPoint(0, 0))
            framed = QRect(corner, self._target.size()).adjusted(-MARGIN, -MARGIN, MARGIN, MARGIN)
        if framed != self.framed:
            self.framed = framed
            self.update()


WIDTH = 400
FROM_LEFT, FROM_TOP = 12, 48
"""Pixels from the upper left corner of the covered area: beneath one item of the message bar."""


class TourPanel(QFrame):
    """Shows one step at a time; it can be dragged out of the way."""

    changed = pyqtSignal(int)
    """The step that is shown, from 0."""
    requested = pyqtSignal(str)
    """The action offered by the step's button was requested."""
    closed = pyqtSignal()

    def __init__(self, window: QWidget):
        super().__init__(window)
        self.setObjectName("fleet_tour")
        self.setFrameShape(QFrame.Shape.Box)
        # Themes of QGIS make frames transparent, and this one is over the map.
        self.setStyleSheet(
            "QFrame#fleet_tour { background: palette(window); border: 1px solid palette(mid); }"
        )
        self.setFixedWidth(WIDTH)
        self._at, self._practice = 0, False
        self._grip: QPoint | None = None
        self._title = _label("fleet_tour_title")
        self._text = _label("fleet_tour_text")
        self._status = _label("fleet_tour_said")
        self._count = QLabel()
        self._offer = _button("fleet_tour_offer", "", self._want)
        self._back = _button("fleet_tour_back", tr("&Back"), lambda: self.show_step(self._at - 1))
        self._next = _button("fleet_tour_next", tr("&Next"), self._continue)
        self._close = _button("fleet_tour_close", tr("C&lose"), self.closed.emit)
        self._lay_out()
        escape = QShortcut(QKeySequence(Qt.Key.Key_Escape), self)
        escape.setContext(Qt.ShortcutContext.WidgetWithChildrenShortcut)
        escape.activated.connect(self.closed)
        self.show_step(0)

    @property
    def step(self) -> TourStep:
        """The step that is shown."""
        return STEPS[self._at]

    def show_step(self, at: int) -> None:
        """Show a step, counted from 0."""
        self._at = min(max(at, 0), len(STEPS) - 1)
        self._status.clear()
        self._count.setText(f"{self._at + 1}/{len(STEPS)}")
        self._back.setEnabled(self._at > 0)
        self._next.setText(tr("&Finish") if self._at == len(STEPS) - 1 else tr("&Next"))
        self._offer.setText(self.step.button)
        self._offer.setVisible(bool(self.step.offer))
        self._offer.setEnabled(True)
        self._show_text()
        self._next.setFocus()
        self.changed.emit(self._at)

    def set_practice(self, on: bool) -> None:
        """Set whether the desk is connected to the practice fleet, so that things may be tried."""
        if on != self._practice:
            self._practice = on
            self._show_text()

    def say(self, text: str, *, busy: bool = False) -> None:
        """Show the outcome of the action of the step's button."""
        self._status.setText(text)
        self._status.setVisible(bool(text))
        if busy and self._offer.hasFocus():
            # By default, Close would get the focus.
            self._next.setFocus()
        self._offer.setEnabled(not busy)
        self._fit()

    def place(self, over: QWidget) -> None:
        """Move over a part of the window, at its upper left: the sample site's robots are further down."""
        self._fit()
        self.move(over.mapTo(self.parentWidget(), QPoint(FROM_LEFT, FROM_TOP)))

    def mousePressEvent(self, event: QMouseEvent) -> None:
        self._grip = event.pos()

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        if self._grip is not None:
            self.move(self.mapToParent(event.pos() - self._grip))

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        self._grip = None

    def _show_text(self) -> None:
        self._title.setText(f"<b>{self.step.title}</b>")
        tried = self.step.practice if self._practice else ""
        self._text.setText(f"{self.step.text}<p><b>{tried}</b></p>" if tried else self.step.text)
        self._status.setVisible(bool(self._status.text()))
        self._fit()

    def _fit(self) -> None:
        line = 2 * self.frameWidth()
        height_needed = self.layout().heightForWidth(WIDTH - line) + line
        self.setFixedHeight(max(height_needed, self.minimumSizeHint().height()))

    def _want(self) -> None:
        self.requested.emit(self.step.offer)

    def _continue(self) -> None:
        if self._at == len(STEPS) - 1:
            self.closed.emit()
        else:
            self.show_step(self._at + 1)

    def _lay_out(self) -> None:
        rows = QVBoxLayout(self)
        head = QHBoxLayout()
        head.addWidget(self._title, 1)
        head.addWidget(self._count)
        rows.addLayout(head)
        rows.addWidget(self._text)
        rows.addWidget(self._offer)
        rows.addWidget(self._status)
        foot = QHBoxLayout()
        foot.addWidget(self._close)
        foot.addStretch(1)
        foot.addWidget(self._back)
        foot.addWidget(self._next)
        rows.addLayout(foot)


def _label(name: str) -> QLabel:
    label = QLabel()
    label.setObjectName(name)
    label.setWordWrap(True)
    return label


def _button(name: str, text: str, pressed: Callable[[], object]) -> QPushButton:
    button = push_button(name, text, pressed=pressed)
    button.setAutoDefault(True)
    return button


OFFERED = "fleet_supervisor/tour_offered"
PROJECT_FILE = Path(__file__).parents[2] / "resources" / "sample_site" / "sample_site.qgz"
ICON = Path(__file__).parents[2] / "resources" / "icons" / "fleet.svg"
OPEN = (ConnectionPhase.CONNECTING, ConnectionPhase.CONNECTED, ConnectionPhase.RETRYING)


class TourAction(QObject):
    """Offers the tour once, starts it from the menu, and stops the practice fleet with it."""

    def __init__(
        self, iface: QgisInterface, menu: str, window: FleetWindow, fleet: PracticeFleet | None = None
    ):
        super().__init__(iface.mainWindow())
        self._iface, self._menu, self._window = iface, menu, window
        self.fleet = fleet or PracticeFleet(parent=self)
        self.fleet.ready.connect(self._connect)
        self.fleet.failed.connect(self._show_outcome)
        self.panel: TourPanel | None = None
        self._spotlight: Spotlight | None = None
        self._url_before = self._practice_url = ""
        self._offer: QgsMessageBarItem | None = None
        self.action = QAction(QIcon(str(ICON)), tr("Tour"), iface.mainWindow())
        self.action.setObjectName("fleet_tour_action")
        self.action.triggered.connect(self.start)
        iface.addPluginToMenu(menu, self.action)
        window.desk.state.link_changed.connect(self._show_practice)
        self._offer_once()

    def start(self) -> None:
        """Show the tour from its beginning."""
        self._remove_offer()
        if self.panel is None:
            self._window.dock.setUserVisible(True)
            self._spotlight = Spotlight(self._iface.mainWindow())
            self.panel = TourPanel(self._iface.mainWindow())
            self.panel.changed.connect(lambda _: self._point())
            self.panel.requested.connect(self._do)
            self.panel.closed.connect(self.end)
        self.panel.show_step(0)
        self._show_practice()
        self.panel.place(self._iface.mapCanvas())
        self.panel.show()
        self._point()

    def end(self) -> None:
        """Close the tour, and stop the practice fleet with it."""
        for part in (self.panel, self._spotlight):
            if part is not None:
                part.hide()
                part.deleteLater()
        self.panel = self._spotlight = None
        self._leave_practice()
        self.fleet.stop()

    def _leave_practice(self) -> None:
        """Disconnect from the practice fleet, and put back the address that was there before it."""
        panel, settings = self._window.dock.connection_panel, QgsSettings()
        if self._practice_url and panel.url() == self._practice_url:
            self._window.desk.close_link()
            panel.use(GatewayConnection("", self._url_before))
        if self._practice_url and settings.value(URL_KEY) == self._practice_url:
            # The operator has connected to it again by the button, which stores the address.
            settings.setValue(URL_KEY, self._url_before)
        self._practice_url = ""

    def remove(self) -> None:
        """Remove every part from the window."""
        self._window.desk.state.link_changed.disconnect(self._show_practice)
        self.end()
        self.fleet.remove()
        self._remove_offer()
        self._iface.removePluginMenu(self._menu, self.action)
        self.action.deleteLater()
        self.deleteLater()

    def _offer_once(self) -> None:
        settings = QgsSettings()
        if settings.value(OFFERED, False, type=bool):
            return
        settings.setValue(OFFERED, True)
        bar = self._iface.messageBar()
        # QGIS's own item cuts its text beside a button.
        label = MessageLabel(tr("A five-minute tour shows how it works."), bar)
        label.setObjectName("fleet_tour_offer_text")
        self._offer = QgsMessageBarItem(label, Qgis.MessageLevel.Info)
        button = QPushButton(tr("Start the tour"))
        button.setObjectName("fleet_tour_start")
        button.clicked.connect(lambda: self.start())
        self._offer.layout().addWidget(button)
        bar.pushWidget(self._offer, Qgis.MessageLevel.Info)

    def _remove_offer(self) -> None:
        if self._offer is not None and not sip.isdeleted(self._offer):
            self._iface.messageBar().popWidget(self._offer)
        self._offer = None

    def _do(self, what: str) -> None:
        if what == FLEET:
            self._start_fleet()
        elif self._iface.addProject(str(PROJECT_FILE)):
            self._show_outcome(tr("The sample site is open."))
        else:
            self._show_outcome(tr("The sample site was not opened: {path}.", path=PROJECT_FILE))

    def _start_fleet(self) -> None:
        if self._practising():
            self._show_outcome(tr("The practice fleet runs, and the desk is connected to it."))
        elif self._window.desk.state.link.phase in OPEN:
            self._show_outcome(
                tr(
                    "The desk is connected to another gateway. Disconnect first: the tour moves no real "
                    "robots."
                )
            )
        else:
            self.panel.say(tr("Starting …"), busy=True)
            self.fleet.start()

    def _connect(self, url: str) -> None:
        panel = self._window.dock.connection_panel
        if panel.url() not in (url, self._practice_url):
            self._url_before = panel.url()
        self._practice_url = url
        panel.use(GatewayConnection("", url))
        try:
            # Not by the button: that would store the address for the next session.
            self._window.desk.open_link(url, panel.operator() or "tour", OperatorCredentials())
        except FleetError as error:
            self._show_outcome(str(error))
            return
        self._show_outcome(tr("The practice fleet runs, and the desk is connected to it."))

    def _practising(self) -> bool:
        url = self._window.dock.connection_panel.url()
        return bool(self.fleet.url) and url == self.fleet.url and self._window.desk.state.link.phase in OPEN

    def _show_practice(self) -> None:
        if self.panel is not None:
            self.panel.set_practice(
                self._practising() and self._window.desk.state.link.phase is ConnectionPhase.CONNECTED
            )

    def _show_outcome(self, text: str) -> None:
        if self.panel is not None:
            self.panel.say(text)

    def _point(self) -> None:
        self._spotlight.point_at(self.panel.step.target)
        self._spotlight.raise_()
        self.panel.raise_()

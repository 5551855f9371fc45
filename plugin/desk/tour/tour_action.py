"""The tour's place in the window: its menu entry, its offer at the first start, and what its buttons do."""

from __future__ import annotations

from pathlib import Path

from qgis.core import Qgis, QgsSettings
from qgis.gui import QgisInterface, QgsMessageBarItem
from qgis.PyQt import sip
from qgis.PyQt.QtCore import QObject
from qgis.PyQt.QtGui import QIcon
from qgis.PyQt.QtWidgets import QAction, QPushButton

from ...errors import FleetError
from ...language import tr
from ...settings.gateway_connection import GatewayConnection
from ...wire.addresses import Credentials
from ...wire.status import Phase
from ..notices import NoticeLabel
from ..window import DeskWindow
from .practice_fleet import PracticeFleet
from .spotlight import Spotlight
from .steps import FLEET
from .tour_panel import TourPanel

OFFERED = "fleet_supervisor/tour_offered"
PROJECT = Path(__file__).parents[3] / "resources" / "sample_site" / "sample_site.qgz"
ICON = Path(__file__).parents[3] / "resources" / "icons" / "fleet.svg"
OPEN = (Phase.CONNECTING, Phase.CONNECTED, Phase.RETRYING)


class TourAction(QObject):
    """Offers the tour once, starts it from the menu, and ends the practice fleet with it."""

    def __init__(
        self, iface: QgisInterface, menu: str, window: DeskWindow, fleet: PracticeFleet | None = None
    ):
        super().__init__(iface.mainWindow())
        self._iface, self._menu, self._window = iface, menu, window
        self.fleet = fleet or PracticeFleet(parent=self)
        self.fleet.ready.connect(self._connect)
        self.fleet.failed.connect(self._tell)
        self.panel: TourPanel | None = None
        self._spotlight: Spotlight | None = None
        self._url_before = ""
        self._offer: QgsMessageBarItem | None = None
        self.action = QAction(QIcon(str(ICON)), tr("Tour"), iface.mainWindow())
        self.action.setObjectName("fleet_tour_action")
        self.action.triggered.connect(self.start)
        iface.addPluginToMenu(menu, self.action)
        window.desk.link_changed.connect(self._show_practice)
        self._offer_once()

    def start(self) -> None:
        """Show the tour from its begin."""
        self._take_offer_away()
        if self.panel is None:
            self._window.dock.setUserVisible(True)
            self._spotlight = Spotlight(self._iface.mainWindow())
            self.panel = TourPanel(self._iface.mainWindow())
            self.panel.changed.connect(lambda _: self._point())
            self.panel.wanted.connect(self._do)
            self.panel.closed.connect(self.end)
        self.panel.show_step(0)
        self._show_practice()
        self.panel.place(self._iface.mapCanvas())
        self.panel.show()
        self._point()

    def end(self) -> None:
        """Close the tour, and end the practice fleet with it."""
        for part in (self.panel, self._spotlight):
            if part is not None:
                part.hide()
                part.deleteLater()
        self.panel = self._spotlight = None
        if self._practising():
            self._window.desk.close_link()
            self._window.dock.connection_panel.use(GatewayConnection("", self._url_before))
        self.fleet.stop()

    def remove(self) -> None:
        """Take every part out of the window."""
        self._window.desk.link_changed.disconnect(self._show_practice)
        self.end()
        self._take_offer_away()
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
        label = NoticeLabel(tr("A five-minute tour shows how it works."), bar)
        label.setObjectName("fleet_tour_offer_text")
        self._offer = QgsMessageBarItem(label, Qgis.MessageLevel.Info)
        button = QPushButton(tr("Start the tour"))
        button.setObjectName("fleet_tour_start")
        button.clicked.connect(lambda: self.start())
        self._offer.layout().addWidget(button)
        bar.pushWidget(self._offer, Qgis.MessageLevel.Info)

    def _take_offer_away(self) -> None:
        if self._offer is not None and not sip.isdeleted(self._offer):
            self._iface.messageBar().popWidget(self._offer)
        self._offer = None

    def _do(self, what: str) -> None:
        if what == FLEET:
            self._start_fleet()
        elif self._iface.addProject(str(PROJECT)):
            self._tell(tr("The sample site is open."))
        else:
            self._tell(tr("The sample site was not opened: {path}.", path=PROJECT))

    def _start_fleet(self) -> None:
        if self._practising():
            self._tell(tr("The practice fleet runs, and the desk is connected to it."))
        elif self._window.desk.link.phase in OPEN:
            self._tell(
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
        self._url_before = panel.url()
        panel.use(GatewayConnection("", url))
        try:
            # Not by the button: that would keep the address for the next session.
            self._window.desk.open_link(url, panel.operator() or "tour", Credentials())
        except FleetError as error:
            self._tell(str(error))
            return
        self._tell(tr("The practice fleet runs, and the desk is connected to it."))

    def _practising(self) -> bool:
        url = self._window.dock.connection_panel.url()
        return bool(self.fleet.url) and url == self.fleet.url and self._window.desk.link.phase in OPEN

    def _show_practice(self) -> None:
        if self.panel is not None:
            self.panel.set_practice(self._practising() and self._window.desk.link.phase is Phase.CONNECTED)

    def _tell(self, text: str) -> None:
        if self.panel is not None:
            self.panel.say(text)

    def _point(self) -> None:
        self._spotlight.point_at(self.panel.step.target)
        self._spotlight.raise_()
        self.panel.raise_()

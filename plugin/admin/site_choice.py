"""The dialog in which a supervisor chooses the site to be served, and its menu entry."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from qgis.gui import QgisInterface
from qgis.PyQt.QtCore import QObject, Qt
from qgis.PyQt.QtWidgets import QHeaderView, QMessageBox, QWidget

from ...robot_bridge.core.messages.administration import ChooseSite, GetSites, SiteOffer
from ...robot_bridge.core.messages.json_values import sites_report
from ..control.fleet_controller import FleetController
from ..help import SITES
from ..panel.connection_panel import ConnectionMenu
from ..ui.dialogs import confirm
from ..ui.language import tr, tr_count
from ..ui.tables import TextModel
from .supervisor_dialog import DialogAction, SupervisorDialog, fit_columns

COLUMNS = (tr("Site"), tr("Folder"), tr("Version"), tr("State"))
SERVED = tr("served now")
READY = tr("can be chosen")


class SiteModel(TextModel):
    """One row for each site."""

    def __init__(self, parent: QObject | None = None):
        super().__init__(COLUMNS, site_cells, parent)


def site_cells(offer: SiteOffer) -> tuple[str, ...]:
    """Return what the columns show of a site."""
    version = "–" if offer.version is None else str(offer.version)
    return offer.name or "–", offer.site, version, state_in_words(offer)


def state_in_words(offer: SiteOffer) -> str:
    """Return whether a site is served, or can be, or why not."""
    return SERVED if offer.served else offer.refusal or READY


def confirm_site_choice(offer: SiteOffer, parent: QWidget, then: Callable[[], object]) -> QMessageBox:
    """Say what serving a site means for robots; ``then`` is done when it is to be."""
    name = offer.name or offer.site
    texts = (
        tr(
            "Every robot is sent the map of {site} ({folder}), every desk shows it, and it is served "
            "until another one is chosen, also by a gateway that is started anew.",
            site=name,
            folder=offer.site,
        ),
        tr(
            "No robot is stopped: commands and queues go on in the same metres, whatever roads and "
            "keepouts the new site has there. Stop robots first where that matters."
        ),
    )
    yes = ("fleet_site_confirm", tr("Serve this site"))
    box = confirm(parent, "fleet_site_question", "\n\n".join(texts), yes, tr("Cancel"), then)
    box.setWindowTitle(tr("Serve {site}?", site=name))
    box.setTextFormat(Qt.TextFormat.PlainText)
    return box


LIST = tr("Sites")
WIDEST = ("0" * 24, "sample_site_00", "0000", READY)


class SiteChoiceDialog(SupervisorDialog):
    """A row for each site."""

    def __init__(self, desk: FleetController, parent: QWidget):
        super().__init__(desk, SiteModel(), "fleet_sites_dialog", tr("Which site is served"), SITES, parent)
        self._button("fleet_site_serve", tr("&Serve this site…"), self._choose, for_row=True)
        self._button("fleet_sites_refresh", tr("Re&fresh"), self.refresh, for_row=False)
        fit_columns(self.view, WIDEST)
        # Why a site cannot be chosen takes several lines.
        self.view.setWordWrap(True)
        self.view.verticalHeader().setSectionResizeMode(QHeaderView.ResizeMode.ResizeToContents)
        desk.state.site_changed.connect(self._site_changed)
        self._lay_out()

    def _ask_rows(self) -> None:
        self._listing.ask(GetSites(), LIST, self._take_sites)

    def _key(self, row: SiteOffer) -> str:
        return row.site

    def _can_change(self, row: SiteOffer) -> bool:
        return not row.served and row.refusal is None

    def _take_sites(self, result: dict[str, Any]) -> None:
        offers = sites_report(result).sites
        self._show_rows(offers)
        self._say_once_known(tr_count(len(offers), "1 site", "%n sites"))

    def _choose(self) -> None:
        offer = self.selected()
        self._open(confirm_site_choice(offer, self, lambda: self._serve(offer)))

    def _serve(self, offer: SiteOffer) -> None:
        name = offer.name or offer.site
        self._ask(
            ChooseSite(offer.site),
            tr("Serve {site}", site=name),
            lambda _result: self._changed(tr("{site} is served now.", site=name)),
        )

    def _site_changed(self) -> None:
        # Also when another supervisor chose.
        if self.isVisible() and self._desk.state.site is not None:
            self._ask_rows()


class SiteChoiceAction(DialogAction):
    """The entry and its window."""

    def __init__(self, iface: QgisInterface, menu: str, connections: ConnectionMenu, desk: FleetController):
        super().__init__(
            iface,
            menu,
            connections,
            lambda: SiteChoiceDialog(desk, iface.mainWindow()),
            icon="sites.svg",
            text=tr("Site…"),
            name="fleet_site_choice",
            tip=tr("Which of the published sites the gateway serves; takes a supervisor"),
        )

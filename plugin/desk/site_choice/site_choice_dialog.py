"""The sites that lie beside the one that is served, of which a supervisor chooses."""

from __future__ import annotations

from typing import Any

from qgis.PyQt.QtWidgets import QHeaderView, QWidget

from ....robot_bridge.messages import ChooseSite, GetSites, SiteOffer, sites_report
from ...help.topics import SITES
from ...language import tr, tr_count
from ..desk import Desk
from ..supervisor_dialog import SupervisorDialog, fit_columns
from .site_model import READY, SiteModel
from .site_question import site_question

LIST = tr("Sites")
WIDEST = ("0" * 24, "sample_site_00", "0000", READY)


class SiteChoiceDialog(SupervisorDialog):
    """A row for each site."""

    def __init__(self, desk: Desk, parent: QWidget):
        super().__init__(desk, SiteModel(), "fleet_sites_dialog", tr("Which site is served"), SITES, parent)
        self._button("fleet_site_serve", tr("&Serve this site…"), self._choose, for_row=True)
        self._button("fleet_sites_refresh", tr("Re&fresh"), self.refresh, for_row=False)
        fit_columns(self.view, WIDEST)
        # Why a site cannot be chosen takes several lines.
        self.view.setWordWrap(True)
        self.view.verticalHeader().setSectionResizeMode(QHeaderView.ResizeMode.ResizeToContents)
        desk.site_changed.connect(self._site_changed)
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
        self._open(site_question(offer, self, lambda: self._serve(offer)))

    def _serve(self, offer: SiteOffer) -> None:
        name = offer.name or offer.site
        self._ask(
            ChooseSite(offer.site),
            tr("Serve {site}", site=name),
            lambda _result: self._changed(tr("{site} is served now.", site=name)),
        )

    def _site_changed(self) -> None:
        # Also when another supervisor chose.
        if self.isVisible() and self._desk.site is not None:
            self._ask_rows()

"""The sites that a gateway may serve, as rows of a table."""

from __future__ import annotations

from qgis.PyQt.QtCore import QObject

from ....robot_bridge.messages import SiteOffer
from ...language import tr
from ..row_model import TextModel

COLUMNS = (tr("Site"), tr("Folder"), tr("Version"), tr("State"))
SERVED = tr("served now")
READY = tr("can be chosen")


class SiteModel(TextModel):
    """One row for each site."""

    def __init__(self, parent: QObject | None = None):
        super().__init__(COLUMNS, cells, parent)


def cells(offer: SiteOffer) -> tuple[str, ...]:
    """Return what the columns show of a site."""
    version = "–" if offer.version is None else str(offer.version)
    return offer.name or "–", offer.site, version, state_in_words(offer)


def state_in_words(offer: SiteOffer) -> str:
    """Return whether a site is served, or can be, or why not."""
    return SERVED if offer.served else offer.refusal or READY

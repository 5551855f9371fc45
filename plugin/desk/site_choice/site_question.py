"""Asks whether another site is really to be served."""

from __future__ import annotations

from collections.abc import Callable

from qgis.PyQt.QtCore import Qt
from qgis.PyQt.QtWidgets import QMessageBox, QWidget

from ....robot_bridge.messages import SiteOffer
from ...language import tr
from ..safe_question import safe_question


def site_question(offer: SiteOffer, parent: QWidget, then: Callable[[], object]) -> QMessageBox:
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
    box = safe_question(parent, "fleet_site_question", "\n\n".join(texts), yes, tr("Cancel"), then)
    box.setWindowTitle(tr("Serve {site}?", site=name))
    box.setTextFormat(Qt.TextFormat.PlainText)
    return box

"""`tools/walkthrough` inside QGIS: says where things are and what they show, and does nothing."""

from __future__ import annotations

from qgis.utils import iface

from tests.support.inside_qgis.reporter import Reporter
from tests.support.inside_qgis.session import Session, start


def work(session: Session) -> None:
    """Answer questions until QGIS is closed."""
    session.draw_only_what_is_seen()
    Reporter(session.plan["socket"], iface.mainWindow())
    session.happened("ready", "QGIS is open")


start(work)

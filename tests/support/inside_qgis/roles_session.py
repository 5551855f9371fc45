"""`tools/roles_picture.py` inside QGIS: opens the dialog by its menu entry and takes its picture."""

from __future__ import annotations

from pathlib import Path

from qgis.PyQt.QtWidgets import QAction, QDialog, QLabel

from tests.support.inside_qgis.session import Session, end, start

TIMEOUT = 20


def work(session: Session) -> None:
    """Take the picture that the plan asks for."""
    plan, operator = session.plan, session.operator
    session.size_window(*plan["window"])
    session.open_project()
    session.window().findChild(QAction, "fleet_layer_roles").trigger()
    dialog = session.window().findChild(QDialog, "fleet_roles_dialog")
    summary = dialog.findChild(QLabel, "fleet_roles_summary")
    operator.wait("counting what is published", lambda: "obstacles of" in summary.text(), TIMEOUT)
    operator.wait("drawing the preview", lambda: not dialog.preview.busy, TIMEOUT)
    operator.pause(0.3)
    operator.take_picture(dialog, Path(plan["picture"]))
    session.happened("picture", f"{summary.text()}: saved as {plan['picture']}")
    dialog.reject()
    end()


start(work)

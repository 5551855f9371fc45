"""Loads and unloads the plugin again and again in QGIS Desktop, and tells what lives on of each version.

``plan["times"]`` is how often.
"""

from __future__ import annotations

import traceback

import qgis.utils
from qgis.PyQt.QtWidgets import QAction

from tests.support.inside_qgis.endurance.belongings import PACKAGE
from tests.support.inside_qgis.endurance.play import Player, Script
from tests.support.inside_qgis.endurance.versions import Versions
from tests.support.inside_qgis.session import Session, end, start

PANELS = ("fleet_plan_panel", "fleet_observations", "fleet_replay")
LOOKS, LOOK_EVERY = 60, 0.5
"""How often, and every how many seconds, it looks whether all is gone that goes when there is time."""


def script(session: Session) -> Script:
    """Load, open the panels, unload; wait until older versions than the last one are gone."""
    versions = Versions(PACKAGE)
    if not qgis.utils.unloadPlugin(PACKAGE):
        raise RuntimeError(f"QGIS did not unload {PACKAGE}")
    for _ in range(session.plan["times"]):
        if not (qgis.utils.loadPlugin(PACKAGE) and qgis.utils.startPlugin(PACKAGE)):
            raise RuntimeError(f"QGIS did not load {PACKAGE}")
        yield 0.2
        for name in PANELS:
            action = session.window().findChild(QAction, name)
            action.trigger()
            yield 0.1
            action.trigger()
        del action
        classes = versions.note()
        if not qgis.utils.unloadPlugin(PACKAGE):
            raise RuntimeError(f"QGIS did not unload {PACKAGE}")
        yield 0.2
        session.happened("unloaded", f"{classes} classes", classes=classes)
    for _ in range(LOOKS):
        if not any(versions.living()[:-1]):
            break
        yield LOOK_EVERY
    session.happened("end", "what lives on of each version", living=versions.living())


def work(session: Session) -> None:
    """Begin, and end QGIS afterwards."""

    def done(error: Exception | None) -> None:
        if error is not None:
            session.failed("".join(traceback.format_exception(error)))
        end()

    Player(script(session), done).begin()


start(work)
